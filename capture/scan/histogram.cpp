// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/histogram.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/rig/radiometry.h"
#include "core/rig/reading_stop.h"

namespace weft::capture {
namespace {

constexpr std::size_t kLevels = 65536;

/// Counts of one site of the filter cell by their number.
using Tally = std::vector<std::uint32_t>;

std::size_t channel_of(const RawFrame& frame, int x, int y) {
  return static_cast<std::size_t>(frame.cfa.channel_at(x, y));
}

/// Shares of the way from black to where channels stop.
class Range {
 public:
  explicit Range(const RawFrame& frame)
      : frame_(frame), stops_(frame.full == std::array<float, 3>{} ? find_count_stops(frame) : frame.full) {}

  double share_of(int x, int y, double count) const {
    const double black =
        static_cast<double>(frame_.black[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
    const float stop = stops_[channel_of(frame_, x, y)];
    return (count - black) / (static_cast<double>(stop > 0 ? stop : frame_.white) - black);
  }

 private:
  const RawFrame& frame_;
  std::array<float, 3> stops_;
};

std::uint16_t believed(const View<const std::uint16_t>& counts, int x, int y) {
  std::uint16_t most = 0;
  if (x >= 2) most = std::max(most, counts(x - 2, y));
  if (x + 2 < counts.width()) most = std::max(most, counts(x + 2, y));
  if (y >= 2) most = std::max(most, counts(x, y - 2));
  if (y + 2 < counts.height()) most = std::max(most, counts(x, y + 2));
  return std::min(most, counts(x, y));
}

template <typename CountAt>
Tally tally_of(const RawFrame& frame, int x0, int y0, const CountAt& count_at) {
  Tally tally(kLevels);
  const View<const std::uint16_t> counts = frame.counts.plane();
  for (int y = y0; y < counts.height(); y += 2) {
    for (int x = x0; x < counts.width(); x += 2) ++tally[count_at(counts, x, y)];
  }
  return tally;
}

/// The count that all but `above` of the photosites do not exceed.
double quantile(const Tally& tally, double above) {
  std::uint64_t all = 0;
  for (const std::uint32_t n : tally) all += n;
  const auto allowed = static_cast<std::uint64_t>(above * static_cast<double>(all));
  std::uint64_t higher = 0;
  for (std::size_t count = kLevels; count-- > 0;) {
    higher += tally[count];
    if (higher > allowed) return static_cast<double>(count);
  }
  return 0;
}

}  // namespace

std::array<RawHistogram, 3> histogram_rgb(const RawFrame& frame) {
  const Range range(frame);
  std::array<RawHistogram, 3> histograms;
  std::array<std::uint64_t, 3> clipped = {}, all = {};
  for (int y0 = 0; y0 < 2; ++y0) {
    for (int x0 = 0; x0 < 2; ++x0) {
      const Tally tally =
          tally_of(frame, x0, y0, [](const auto& counts, int x, int y) { return counts(x, y); });
      const std::size_t c = channel_of(frame, x0, y0);
      for (std::size_t count = 0; count < kLevels; ++count) {
        if (tally[count] == 0) continue;
        const double share = range.share_of(x0, y0, static_cast<double>(count));
        histograms[c].bins[static_cast<std::size_t>(std::clamp(64 * share, 0.0, 63.0))] += tally[count];
        all[c] += tally[count];
        if (share >= 1) clipped[c] += tally[count];
      }
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    histograms[c].clipped = all[c] == 0 ? 0 : static_cast<double>(clipped[c]) / static_cast<double>(all[c]);
  }
  return histograms;
}

Brightness brightness_of(const RawFrame& frame) {
  const Range range(frame);
  Brightness brightness;
  for (int y0 = 0; y0 < 2; ++y0) {
    for (int x0 = 0; x0 < 2; ++x0) {
      const Tally tally = tally_of(frame, x0, y0, believed);
      const auto raise = [&](double& most, double above) {
        most = std::max(most, range.share_of(x0, y0, quantile(tally, above)));
      };
      raise(brightness.bright, 1e-3);
      raise(brightness.brightest, 1e-5);
      std::uint64_t full = 0, all = 0;
      for (std::size_t count = 0; count < kLevels; ++count) {
        all += tally[count];
        if (range.share_of(x0, y0, static_cast<double>(count)) >= kSaturatedFrom) full += tally[count];
      }
      brightness.clipped =
          std::max(brightness.clipped,
                   static_cast<double>(full) / static_cast<double>(std::max<std::uint64_t>(all, 1)));
    }
  }
  return brightness;
}

Brightness TestShotReader::read(RawFrame frame) {
  if (frame.full == std::array<float, 3>{}) {
    const std::array<float, 3> shown = find_count_stops(frame);
    for (std::size_t c = 0; c < 3; ++c) {
      if (shown[c] > 0) stops_[c] = shown[c];
    }
    frame.full = stops_;
  }
  return brightness_of(frame);
}

}  // namespace weft::capture
