// SPDX-License-Identifier: Apache-2.0
#include "material/maps/curl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"

namespace weft::material {
namespace {

constexpr int kBins = 1024;
constexpr std::uint16_t kUnknownBin = 0xffff;
constexpr double kLeastSigma_deg = 0.01;  ///< of slopes that float32 holds
constexpr int kUsualWindow_px = 25, kLeastWindow_px = 5, kMostWindow_px = 255;
constexpr double kYarnsAWindow = 1.3;
constexpr int kMedianRows = 64;

struct CurlInput {
  View<const float> right, up, sigma_deg;
  View<const std::uint16_t> status;
  double usual_sigma_deg;

  bool is_known(int x, int y) const {
    return (status.empty() || (status(x, y) & kNoSolution) == 0) && std::isfinite(right(x, y)) &&
           std::isfinite(up(x, y));
  }
  double slope_variance(int x, int y) const {
    const double p = static_cast<double>(right(x, y)), q = static_cast<double>(up(x, y));
    double sigma = sigma_deg.empty() ? usual_sigma_deg : static_cast<double>(sigma_deg(x, y));
    if (!(sigma >= kLeastSigma_deg)) sigma = kLeastSigma_deg;
    const double of_slope = radians(sigma) * (1 + p * p + q * q);  // 1 / n_z^2
    return of_slope * of_slope / 2;
  }
};

// |z| of the square whose upper left pixel is (x0, y0), in bins.
std::uint16_t bin_of(const CurlInput& in, int x0, int y0, int x1, int y1) {
  if (!in.is_known(x0, y0) || !in.is_known(x1, y0) || !in.is_known(x0, y1) || !in.is_known(x1, y1)) {
    return kUnknownBin;
  }
  const auto p = [&](int x, int y) { return static_cast<double>(in.right(x, y)); };
  const auto q = [&](int x, int y) { return -static_cast<double>(in.up(x, y)); };
  const double circulation = ((p(x0, y0) + p(x1, y0)) + (q(x1, y0) + q(x1, y1)) - (p(x0, y1) + p(x1, y1)) -
                              (q(x0, y0) + q(x0, y1))) /
                             2;
  const double variance = (in.slope_variance(x0, y0) + in.slope_variance(x1, y0) + in.slope_variance(x0, y1) +
                           in.slope_variance(x1, y1)) /
                          2;
  const double bins = std::abs(circulation) / std::sqrt(variance) / kCurlStep;
  return static_cast<std::uint16_t>(std::min(bins, kBins - 1.0));
}

Image<std::uint16_t> bins_of(const CurlInput& in, bool is_tile, int threads) {
  const Size size = in.right.size();
  Image<std::uint16_t> bins(size);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row), below = y + 1 < size.height ? y + 1 : 0;
    for (int x = 0; x < size.width; ++x) {
      const int beside = x + 1 < size.width ? x + 1 : 0;
      const bool is_there = is_tile || (beside > 0 && below > 0);
      bins(x, y) = is_there ? bin_of(in, x, y, beside, below) : kUnknownBin;
    }
  });
  return bins;
}

/// Counts of bins in a window that moves, with the bin of their median (Huang, Yang and Tang 1979).
class MovingMedian {
 public:
  MovingMedian() : counts_(kBins) {}
  void clear() {
    std::fill(counts_.begin(), counts_.end(), 0);
    all_ = below_ = 0;
    median_ = 0;
  }
  void add(std::uint16_t bin, int times) {
    if (bin == kUnknownBin) return;
    counts_[bin] += times;
    all_ += times;
    if (bin < median_) below_ += times;
  }
  float value() {
    if (all_ == 0) return 0;
    while (2 * below_ > all_) below_ -= counts_[--median_];
    while (2 * (below_ + counts_[median_]) <= all_) below_ += counts_[median_++];
    return static_cast<float>((static_cast<double>(median_) + 0.5) * kCurlStep);
  }

 private:
  std::vector<int> counts_;
  int all_ = 0, below_ = 0;
  std::size_t median_ = 0;
};

/// Squares about a pixel: those that it belongs to and as many more either way. They are one fewer than the
/// window's pixels, so that the window is centred.
class MedianWindow {
 public:
  MedianWindow(View<const std::uint16_t> bins, int side, bool is_tile)
      : bins_(bins), half_(side / 2), is_tile_(is_tile) {}

  void fill_row(int y, float* out) {
    median_.clear();
    for (int x = -half_; x < half_; ++x) add_column(x, y, 1);
    for (int x = 0; x < bins_.width(); ++x) {
      out[x] = median_.value();
      add_column(x - half_, y, -1);
      add_column(x + half_, y, 1);
    }
  }

 private:
  void add_column(int x, int y, int times) {
    if (!place(x, bins_.width())) return;
    for (int v = y - half_; v < y + half_; ++v) {
      int row = v;
      if (place(row, bins_.height())) median_.add(bins_(x, row), times);
    }
  }
  bool place(int& i, int count) const {
    if (is_tile_) i = ((i % count) + count) % count;
    return i >= 0 && i < count;
  }

  View<const std::uint16_t> bins_;
  int half_;
  bool is_tile_;
  MovingMedian median_;
};

double median_of_frame(View<const std::uint16_t> bins) {
  std::vector<std::int64_t> counts(kBins);
  std::int64_t all = 0;
  for (int y = 0; y < bins.height(); ++y) {
    for (int x = 0; x < bins.width(); ++x) {
      if (bins(x, y) == kUnknownBin) continue;
      ++counts[bins(x, y)];
      ++all;
    }
  }
  std::int64_t below = 0;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    if (counts[bin] > 0 &&
        2 * (below + counts[bin]) >= all) {  // within the bin as if they were spread evenly
      const double part =
          (static_cast<double>(all) / 2 - static_cast<double>(below)) / static_cast<double>(counts[bin]);
      return (static_cast<double>(bin) + part) * kCurlStep;
    }
    below += counts[bin];
  }
  return 0;
}

void count_flagged(View<const std::uint16_t> status, Curl& result) {
  std::int64_t known = 0, flagged = 0, specular = 0, shadowed = 0;
  for (int y = 0; y < result.median.height(); ++y) {
    for (int x = 0; x < result.median.width(); ++x) {
      known += result.median(x, y) > 0;
      if (!(static_cast<double>(result.median(x, y)) > kCurlLimit)) continue;
      ++flagged;
      specular += !status.empty() && (status(x, y) & kSpecular) != 0;
      shadowed += !status.empty() && (status(x, y) & kShadowed) != 0;
    }
  }
  const auto share = [](std::int64_t part, std::int64_t all) {
    return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0;
  };
  result.flagged_share = share(flagged, known);
  result.specular_share = share(specular, flagged);
  result.shadowed_share = share(shadowed, flagged);
}

int window_for(const CurlOptions& options) {
  if (options.yarn_px == 0) return kUsualWindow_px;
  const double side =
      std::clamp(kYarnsAWindow * options.yarn_px, 1.0 * kLeastWindow_px, 1.0 * kMostWindow_px);
  return static_cast<int>(side / 2) * 2 + 1;
}

}  // namespace

Result<Curl> curl(View<const float> right, View<const float> up, View<const float> sigma_deg,
                  View<const std::uint16_t> status, const CurlOptions& options) {
  const Size size = right.size();
  if (size.width <= 0 || size.height <= 0 || up.size() != size ||
      (!sigma_deg.empty() && sigma_deg.size() != size) || (!status.empty() && status.size() != size)) {
    return Error{ErrorKind::kUsage, "no circulation of these slopes", "", "maps differ in size, or are empty",
                 "give maps of one surface"};
  }
  if (!(options.yarn_px >= 0) || !(options.usual_sigma_deg > 0)) {
    return Error{ErrorKind::kUsage, "no circulation of these slopes", "",
                 "the pitch of the yarns or the usual sigma is out of range",
                 "leave them as they are by default"};
  }
  const CurlInput input = {right, up, sigma_deg, status, options.usual_sigma_deg};
  const Image<std::uint16_t> bins = bins_of(input, options.is_tile, options.threads);
  Curl result = {Image<float>(size), window_for(options)};
  parallel_for(static_cast<std::size_t>((size.height + kMedianRows - 1) / kMedianRows), options.threads,
               [&](std::size_t task, int) {
                 MedianWindow window(bins.plane(), result.window_px, options.is_tile);
                 const int y0 = static_cast<int>(task) * kMedianRows;
                 for (int y = y0; y < std::min(y0 + kMedianRows, size.height); ++y) {
                   window.fill_row(y, result.median.plane().row(y));
                 }
               });
  result.frame_median = median_of_frame(bins.plane());
  count_flagged(status, result);
  return result;
}

}  // namespace weft::material
