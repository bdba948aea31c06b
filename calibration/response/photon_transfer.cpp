// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/photon_transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/response/block_light.h"
#include "core/rig/dark_counts.h"
#include "core/rig/radiometry.h"

namespace weft::calibration {
namespace {

constexpr int kLineRounds = 4;
constexpr int kSignalBins = 40;

// Two sums over a square, by the site of the filter cell: the greens differ in black level.
struct PairSums {
  double mean = 0, difference = 0, square = 0, count = 0;
};

// A point after linearisation.
struct LinePoint {
  double signal, variance, freedom;
};

struct Line {
  double slope = 0, intercept = 0;
  double slope_variance = 0, intercept_variance = 0;

  double at(double signal) const { return intercept + slope * signal; }
};

std::vector<LinePoint> linearised(std::span<const TransferPoint> points, const TransferCurve& curve,
                                  double counts_at_full) {
  std::vector<LinePoint> line;
  line.reserve(points.size());
  for (const TransferPoint& p : points) {
    const auto [a, b] = curve.linearity[static_cast<std::size_t>(p.channel)];
    const double v = p.v - curve.offset;
    const double slope = 1 + v * (2 * a + 3 * b * v);
    line.push_back({counts_at_full * v * (1 + v * (a + b * v)), p.variance_counts2 * slope * slope,
                    p.degrees_of_freedom});
  }
  return line;
}

// `before` gives the variance that each point should have.
Line fitted(const std::vector<LinePoint>& points, const Line& before) {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const LinePoint& p : points) {
    const double expected = std::max(before.at(p.signal), 1e-12);
    const double weight = p.freedom / (2 * expected * expected);
    w += weight;
    x += weight * p.signal;
    y += weight * p.variance;
    xx += weight * p.signal * p.signal;
    xy += weight * p.signal * p.variance;
  }
  const double determinant = w * xx - x * x;
  return {(w * xy - x * y) / determinant, (xx * y - x * xy) / determinant, w / determinant, xx / determinant};
}

std::vector<TransferBin> binned(const std::vector<LinePoint>& points, const Line& line, double lowest,
                                double highest) {
  struct Sum {
    double weight = 0, signal = 0, variance = 0;
  };
  std::vector<Sum> sums(kSignalBins);
  const double low = std::log(std::max(lowest, highest * 1e-4)), high = std::log(highest);
  for (const LinePoint& p : points) {
    if (p.signal <= 0) continue;
    const double at = (std::log(p.signal) - low) / (high - low) * kSignalBins;
    Sum& s = sums[static_cast<std::size_t>(std::clamp(at, 0.0, kSignalBins - 1.0))];
    s.weight += p.freedom;
    s.signal += p.freedom * p.signal;
    s.variance += p.freedom * p.variance;
  }
  std::vector<TransferBin> bins;
  for (const Sum& s : sums) {
    if (s.weight == 0) continue;
    const double signal = s.signal / s.weight;
    bins.push_back(
        {signal, s.variance / s.weight, line.at(signal) * std::sqrt(2 / s.weight), line.at(signal)});
  }
  return bins;
}

Error cannot_fit(std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "the noise of the sensor cannot be measured", "photon transfer",
          std::move(why), std::move(remedy)};
}

}  // namespace

std::vector<TransferPoint> transfer_points(const RawFrame& first, const RawFrame& second,
                                           View<const std::uint8_t> bad) {
  const Size size = first.counts.size();
  const double file_black = mean_black(first);
  const double white = static_cast<double>(first.white), range = white - file_black;
  std::array<double, 4> full;  // by place in the filter cell
  for (int place = 0; place < 4; ++place)
    full[static_cast<std::size_t>(place)] = saturated_from(first, place & 1, place >> 1);
  std::vector<TransferPoint> points;
  for (int block_y = 0; block_y < size.height / kResponseBlock; ++block_y) {
    for (int block_x = 0; block_x < size.width / kResponseBlock; ++block_x) {
      std::array<PairSums, 4> sums;  // by place in the filter cell
      std::array<bool, 3> clipped = {};
      for (int y = block_y * kResponseBlock; y < (block_y + 1) * kResponseBlock; ++y) {
        for (int x = block_x * kResponseBlock; x < (block_x + 1) * kResponseBlock; ++x) {
          if (!bad.empty() && bad(x, y) != 0) continue;
          const double a = first.counts(x, y), b = second.counts(x, y), d = a - b;
          const auto place = static_cast<std::size_t>(2 * (y & 1) + (x & 1));
          clipped[static_cast<std::size_t>(first.cfa.channel_at(x, y))] |=
              a == 0 || b == 0 || a >= full[place] || b >= full[place];
          PairSums& s = sums[place];
          s.mean += (a + b) / 2;
          s.difference += d;
          s.square += d * d;
          ++s.count;
        }
      }
      for (int place = 0; place < 4; ++place) {
        const PairSums& s = sums[static_cast<std::size_t>(place)];
        const int x = place & 1, y = place >> 1, channel = first.cfa.channel_at(x, y);
        if (clipped[static_cast<std::size_t>(channel)] || s.count < 2) continue;
        const double black =
            static_cast<double>(first.black[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
        const double variance = (s.square - s.difference * s.difference / s.count) / (s.count - 1) / 2;
        points.push_back({channel, (s.mean / s.count - black) / range, variance, s.count - 1});
      }
    }
  }
  return points;
}

Result<PhotonTransfer> fit_photon_transfer(std::span<const TransferPoint> points, const TransferCurve& curve,
                                           double counts_at_full) {
  const std::vector<LinePoint> line_points = linearised(points, curve, counts_at_full);
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
  for (const LinePoint& p : line_points) {
    lowest = std::min(lowest, p.signal);
    highest = std::max(highest, p.signal);
  }
  if (line_points.size() < 3 || !(highest >= 4 * std::max(lowest, 1.0))) {
    return cannot_fit(line_points.empty()
                          ? "no square of the frames is neither full nor black"
                          : fmt::format("signals reach from {:.0f} to {:.0f} counts only", lowest, highest),
                      "take pairs of frames at more exposures, from nearly dark to nearly full");
  }
  Line line = {1, 1, 0, 0};
  for (int round = 0; round < kLineRounds; ++round) line = fitted(line_points, line);
  if (!(line.slope > 0)) {
    return cannot_fit("the variance of counts does not grow with light",
                      "use frames as the sensor gave them, without noise reduction");
  }
  double chi_square = 0;
  for (const LinePoint& p : line_points) {
    const double expected = std::max(line.at(p.signal), 1e-12), off = p.variance - expected;
    chi_square += off * off * p.freedom / (2 * expected * expected);
  }
  PhotonTransfer result;
  result.electrons_per_count = 1 / line.slope;
  result.sigma_electrons_per_count = std::sqrt(line.slope_variance) / (line.slope * line.slope);
  result.read_noise_counts = std::sqrt(std::max(line.intercept, 0.0));
  // Sigma of a root: sigma / (2 root), or where that is nothing, the root of sigma.
  const double sigma = std::sqrt(line.intercept_variance);
  result.sigma_read_noise_counts =
      line.intercept > sigma ? sigma / (2 * result.read_noise_counts) : std::sqrt(sigma);
  result.chi_square_per_freedom = chi_square / static_cast<double>(line_points.size() - 2);
  result.bins = binned(line_points, line, lowest, highest);
  return result;
}

}  // namespace weft::calibration
