// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/sets/scan_judgement.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "app/jobs/calibrate/chart_pictures.h"
#include "calibration/color/chart.h"
#include "calibration/lights/sheet.h"
#include "capture/raw/decode.h"
#include "capture/scan/histogram.h"
#include "core/calibration.h"

namespace weft::app {
namespace {

using calibration::ChartSide;

/// A lamp whose light is subtracted still flickers, and takes a share of the counts.
constexpr double kMostRoom = 0.05;
constexpr int kEachOf = 3;
constexpr int kSquaresAcross = 60;
constexpr double kUneven = 0.03;  // of a square's reading, beside a smooth surface
constexpr std::size_t kFewestSquares = 100;
constexpr Eigen::Index kFewestUneven = 3;  // squares

const Shot* first_of(const Session& session, ShotRole role) {
  const auto found = std::ranges::find_if(
      session.shots, [role](const Shot& shot) { return shot.role == role && !shot.superseded_by; });
  return found == session.shots.end() ? nullptr : &*found;
}

/// A square of a photograph that shows nothing but paper, u and v in [-1, 1] over the frame.
struct PaperSquare {
  double x_px = 0, y_px = 0, u = 0, v = 0;
  double log_reading = 0;
};

/// Mean of the green photosites of a square over black; 0 where it is not above black.
double green_mean(const RawFrame& frame, int x0, int y0, int side) {
  double sum = 0;
  int count = 0;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) {
      if (frame.cfa.channel_at(x, y) != 1) continue;
      sum +=
          frame.counts(x, y) -
          static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
      ++count;
    }
  }
  return sum > 0 ? sum / count : 0;
}

std::vector<PaperSquare> paper_squares(const RawFrame& frame, const CameraModel& camera,
                                       const TaggedSheet& sheet, const calibration::SheetPose& pose) {
  const Size size = frame.counts.size();
  const int side = std::max(size.width / kSquaresAcross & ~1, 8);
  std::vector<PaperSquare> squares;
  for (int y = 0; y + side <= size.height; y += side) {
    for (int x = 0; x + side <= size.width; x += side) {
      const double cx = x + 0.5 * (side - 1), cy = y + 0.5 * (side - 1);
      if (!calibration::shows_paper(camera, sheet.sheet, pose.rig_from_sheet, cx, cy, side)) continue;
      const double mean = green_mean(frame, x, y, side);
      if (mean > 0)
        squares.push_back({cx, cy, 2 * cx / size.width - 1, 2 * cy / size.height - 1, std::log(mean)});
    }
  }
  return squares;
}

/// What is left of each square's logarithm beside a smooth surface of third order, fitted to those that are
/// near it.
Eigen::VectorXd beside_smooth(const std::vector<PaperSquare>& squares) {
  constexpr int kTerms = 10, kRounds = 3;
  const auto count = static_cast<Eigen::Index>(squares.size());
  Eigen::MatrixXd terms(count, kTerms);
  Eigen::VectorXd values(count), weights = Eigen::VectorXd::Ones(count),
                                 beside = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [x, y, u, v, value] = squares[static_cast<std::size_t>(i)];
    terms.row(i) << 1, u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v;
    values(i) = value;
  }
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd surface =
        (weights.asDiagonal() * terms).householderQr().solve(weights.asDiagonal() * values);
    beside = values - terms * surface;
    for (Eigen::Index i = 0; i < count; ++i) weights(i) = std::abs(beside(i)) < kUneven ? 1 : 0.01;
  }
  return beside;
}

/// The sum of every third LED's photograph, linear.
Result<Image<float>> lit_picture(const Session& session, const std::filesystem::path& from) {
  const Result<Calibration> before = read_calibration(from);
  std::optional<Image<float>> sum;
  int lit = 0;
  for (const Shot& shot : session.shots) {
    if (shot.role != ShotRole::kLit || shot.superseded_by || lit++ % kEachOf != 0) continue;
    Result<ChartPicture> picture =
        read_chart_picture(session.path_of(shot), before ? &*before : nullptr, from, {});
    if (!picture) return picture.error();
    if (!sum) {
      sum = std::move(picture->rgb);
      continue;
    }
    for (int plane = 0; plane < 3; ++plane) {
      const View<float> to = sum->plane(plane);
      const View<const float> more = std::as_const(picture->rgb).plane(plane);
      for (int y = 0; y < to.height(); ++y) {
        for (int x = 0; x < to.width(); ++x) to(x, y) += more(x, y);
      }
    }
  }
  if (sum) return std::move(*sum);
  return Error{ErrorKind::kBadData, "no LED was lit", session.folder.string(), "", "scan it once more"};
}

}  // namespace

std::string lamp_in(const Session& session) {
  const Shot* dark = first_of(session, ShotRole::kDark);
  if (dark == nullptr) return "";
  const Result<RawFrame> frame = capture::decode_raw(session.path_of(*dark));
  if (!frame) return frame.error().message();
  const double bright = capture::brightness_of(*frame).bright;
  if (bright <= kMostRoom) return "";
  return fmt::format(
      "a lamp of the room is on: without any LED the picture is {:.0f} percent full, {:.0f} may be",
      100 * bright, 100 * kMostRoom);
}

std::string unevenness_of(const Session& session, const CameraModel& camera, const TaggedSheet& sheet,
                          const calibration::SheetPose& pose) {
  int lit = 0;
  for (const Shot& shot : session.shots) {
    if (shot.role != ShotRole::kLit || shot.superseded_by || lit++ % kEachOf != 0) continue;
    const Result<RawFrame> frame = capture::decode_raw(session.path_of(shot));
    if (!frame) return frame.error().message();
    const std::vector<PaperSquare> squares = paper_squares(*frame, camera, sheet, pose);
    if (squares.size() < kFewestSquares) continue;
    const Eigen::VectorXd beside = beside_smooth(squares);
    const auto uneven = (beside.array().abs() > kUneven).count();
    if (uneven < kFewestUneven) continue;
    Eigen::Index worst = 0;
    beside.cwiseAbs().maxCoeff(&worst);
    const PaperSquare& there = squares[static_cast<std::size_t>(worst)];
    return fmt::format(
        "the paper is not smooth: under LED {} it is {:.0f} percent {} around ({:.0f}, {:.0f}) than it "
        "should be; "
        "a fold, a stain or a shadow",
        shot.led, 100 * std::abs(std::expm1(beside(worst))), beside(worst) > 0 ? "brighter" : "darker",
        there.x_px, there.y_px);
  }
  return "";
}

ChartLook look_at_chart_scan(const Session& session, const std::filesystem::path& set,
                             const std::filesystem::path& from) {
  const Result<Image<float>> picture = lit_picture(session, from);
  if (!picture) return {picture.error().message(), ""};
  const auto corners = calibration::find_chart(*picture);
  if (!corners) return {"no chart was found in the picture: " + corners.error().why, ""};
  const auto patches = calibration::read_patches(*picture, *corners);
  if (!patches) return {patches.error().message(), ""};
  const Result<ChartColors> colors = read_chart_colors(set);
  if (!colors) return {colors.error().message(), ""};
  const ChartSide side = calibration::side_of(*patches, colors->reference);
  if (side == ChartSide::kMirrored) return {"the chart is mirrored: its columns or rows run backwards", ""};
  if (side == ChartSide::kNoChart)
    return {"this is not the chart: its patches do not have the colours that they should", ""};
  const bool runs_left = (*corners)[1][0] < (*corners)[0][0];
  const bool is_turned = runs_left != (side == ChartSide::kUpsideDown);
  return {"", is_turned ? "it lies upside down, and is read so" : ""};
}

}  // namespace weft::app
