// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/black_trap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/statistics.h"
#include "core/rig/veil.h"

namespace weft::calibration {
namespace {

constexpr int kSquaresAlong = 32;   // the shorter side
constexpr double kDarkShare = 0.1;  // of the frame's median
constexpr double kLeastSigma = 1e-4;

// Mean of a channel over a square; infinite where anything in it is full.
double mean_of(const Image<float>& picture, Rect square, int channel) {
  double sum = 0;
  for (int y = square.y0; y < square.y1; ++y) {
    for (int x = square.x0; x < square.x1; ++x) sum += static_cast<double>(picture(x, y, channel));
  }
  return sum / static_cast<double>(square.pixels());
}

// The middle of the darkest nine squares in green, if they are dark.
std::optional<Rect> find_trap(const Image<float>& picture) {
  const int side = std::max(2, std::min(picture.width(), picture.height()) / kSquaresAlong);
  std::vector<double> means;
  double least = std::numeric_limits<double>::infinity();
  Rect darkest;
  for (int y = 0; y + 3 * side <= picture.height(); y += side) {
    for (int x = 0; x + 3 * side <= picture.width(); x += side) {
      const double mean = mean_of(picture, {x, y, x + 3 * side, y + 3 * side}, 1);
      means.push_back(mean);
      if (mean < least) {
        least = mean;
        darkest = {x + side, y + side, x + 2 * side, y + 2 * side};
      }
    }
  }
  if (means.empty() || !(least < kDarkShare * median(means))) return {};
  return darkest;
}

// The part that a trap shows of the light seen around it is share / (1 + share).
std::array<double, 3> shares_of(const Image<float>& picture, Rect trap, double spread) {
  CoarseLight light({picture.width(), picture.height()});
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) light.add(x, y, c, picture(x, y, c));
    }
  }
  const SpreadLight spread_light(light, spread);
  std::array<double, 3> shares;
  for (int c = 0; c < 3; ++c) {
    const double around = spread_light.at((trap.x0 + trap.x1) / 2, (trap.y0 + trap.y1) / 2, c);
    const double part = mean_of(picture, trap, c) / around;
    shares[static_cast<std::size_t>(c)] = std::max(0.0, part / (1 - part));
  }
  return shares;
}

}  // namespace

Result<TrapReading> read_black_trap(const std::vector<Image<float>>& pictures) {
  TrapReading reading;
  std::vector<double> shares;
  for (const Image<float>& picture : pictures) {
    const std::optional<Rect> trap = find_trap(picture);
    if (!trap) continue;
    reading.places.push_back(*trap);
    const std::array<double, 3> share = shares_of(picture, *trap, reading.veil.spread);
    for (std::size_t c = 0; c < 3; ++c) reading.share_rgb[c] += share[c];
    shares.push_back((share[0] + share[1] + share[2]) / 3);
  }
  if (shares.size() < pictures.size() || shares.empty()) {
    return Error{
        ErrorKind::kBadData, "no black trap was found", "trap",
        fmt::format("in {} of {} photographs nothing as wide as a tenth of the frame is darker than a tenth "
                    "of what is around it",
                    pictures.size() - shares.size(), pictures.size()),
        "put a box lined with velvet behind a hole in white paper, wider than a tenth of the frame"};
  }
  const auto n = static_cast<double>(shares.size());
  for (double& share : reading.share_rgb) share /= n;
  double squares = 0;
  for (const double share : shares) reading.veil.share += share / n;
  for (const double share : shares) squares += std::pow(share - reading.veil.share, 2);
  const double scatter = shares.size() > 1 ? std::sqrt(squares / (n - 1) / n) : 0;
  reading.veil.sigma_share = std::max(scatter, kLeastSigma);
  return reading;
}

}  // namespace weft::calibration
