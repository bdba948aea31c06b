// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/paper_evenness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace weft::calibration {
namespace {

constexpr int kSquaresAcross = 60, kLeastSide_px = 8;
constexpr double kUneven = 0.03;  // of a square's reading, beside the surface
constexpr std::size_t kFewestSquares = 100;
constexpr Eigen::Index kFewestUneven = 3;  // squares

/// u and v are in [-1, 1] over the frame.
struct PaperSquare {
  PixelPoint middle;
  double u = 0, v = 0;
  double log_reading = 0;
};

/// Mean of the green photosites of a square over black; 0 where it is not above black.
double green_mean(const RawFrame& frame, int x0, int y0, int side) {
  double sum = 0;
  int count = 0;
  for (int y = y0; y < y0 + side; ++y) {
    const auto& black = frame.black[static_cast<std::size_t>(y & 1)];
    for (int x = x0; x < x0 + side; ++x) {
      if (frame.cfa.channel_at(x, y) != 1) continue;
      sum += frame.counts(x, y) - static_cast<double>(black[static_cast<std::size_t>(x & 1)]);
      ++count;
    }
  }
  return sum > 0 ? sum / count : 0;
}

std::vector<PaperSquare> paper_squares(const RawFrame& frame, const CameraModel& camera, const Sheet& sheet,
                                       const Pose& rig_from_sheet) {
  const Size size = frame.counts.size();
  const int side = std::max(size.width / kSquaresAcross & ~1, kLeastSide_px);
  std::vector<PaperSquare> squares;
  for (int y = 0; y + side <= size.height; y += side) {
    for (int x = 0; x + side <= size.width; x += side) {
      const PixelPoint middle = {x + 0.5 * (side - 1), y + 0.5 * (side - 1)};
      if (!shows_paper(camera, sheet, rig_from_sheet, middle.x, middle.y, side)) continue;
      const double mean = green_mean(frame, x, y, side);
      if (mean > 0)
        squares.push_back(
            {middle, 2 * middle.x / size.width - 1, 2 * middle.y / size.height - 1, std::log(mean)});
    }
  }
  return squares;
}

/// What is left of each square's logarithm beside the surface.
Eigen::VectorXd beside_surface(const std::vector<PaperSquare>& squares) {
  constexpr int kTerms = 10, kRounds = 3;
  constexpr double kLittle = 0.01;  // weight of a square that is not near it
  const auto count = static_cast<Eigen::Index>(squares.size());
  Eigen::MatrixXd terms(count, kTerms);
  Eigen::VectorXd values(count), weights = Eigen::VectorXd::Ones(count), beside(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [middle, u, v, value] = squares[static_cast<std::size_t>(i)];
    terms.row(i) << 1, u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v;
    values(i) = value;
  }
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd surface =
        (weights.asDiagonal() * terms).householderQr().solve(weights.asDiagonal() * values);
    beside = values - terms * surface;
    for (Eigen::Index i = 0; i < count; ++i) weights(i) = std::abs(beside(i)) < kUneven ? 1 : kLittle;
  }
  return beside;
}

}  // namespace

std::optional<PaperUnevenness> find_unevenness(const RawFrame& frame, const CameraModel& camera,
                                               const Sheet& sheet, const Pose& rig_from_sheet) {
  const std::vector<PaperSquare> squares = paper_squares(frame, camera, sheet, rig_from_sheet);
  if (squares.size() < kFewestSquares) return std::nullopt;
  const Eigen::VectorXd beside = beside_surface(squares);
  const Eigen::Index uneven = (beside.array().abs() > kUneven).count();
  if (uneven < kFewestUneven) return std::nullopt;
  Eigen::Index worst = 0;
  beside.cwiseAbs().maxCoeff(&worst);
  return PaperUnevenness{static_cast<int>(uneven), std::expm1(beside(worst)),
                         squares[static_cast<std::size_t>(worst)].middle};
}

}  // namespace weft::calibration
