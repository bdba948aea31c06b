// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/count_levels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/rig/dark_counts.h"
#include "core/rig/radiometry.h"
#include "core/rig/reading_stop.h"

namespace weft::solve {
namespace {

constexpr double kFlatDark = 0.01;    // of the range: a dark shot that spreads further is lit
constexpr double kOffBlack = 0.015;   // of the range
constexpr double kSameRange = 0.005;  // relative
constexpr double kSameLevel = 0.01;   // relative
constexpr double kTellingBlack = 16;  // counts: less is black in any scale
constexpr double kFarAbove = 1.5;     // of the range
constexpr double kShareFarAbove = 1e-3;
constexpr int kMostDoublings = 8;

double mean_of(const auto& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double range_of(const RawFrame& frame) {
  return static_cast<double>(frame.white) - mean_black(frame);
}

// The power of two that a level is of another.
std::optional<double> doublings(double level, double of) {
  if (!(level >= kTellingBlack && of >= kTellingBlack)) return {};
  const double exponent = std::round(std::log2(level / of));
  const double scale = std::exp2(exponent);
  const bool is_one = std::abs(exponent) <= kMostDoublings && std::abs(level / of / scale - 1) <= kSameLevel;
  return is_one ? std::optional(scale) : std::nullopt;
}

class Levels {
 public:
  Levels(std::span<RawFrame> frames, std::size_t lit, bool has_dark, const std::optional<Response>& response,
         int threads)
      : frames_(frames), response_(response) {
    if (has_dark) {
      const DarkCounts dark = dark_counts(frames[lit]);
      if (dark.spread <= kFlatDark * range_of(frames[lit])) dark_ = mean_of(dark.median);
    }
    std::vector<std::array<TopTally, 3>> tallies(frames.size());
    parallel_for(frames.size(), threads, [&](std::size_t k, int) {
      if (!has_dark || k != lit) tallies[k] = top_tallies(frames[k]);
    });
    stops_ = find_count_stops(tallies, frames.front());
    far_above_ = share_above(tallies, mean_black(like()) + kFarAbove * range_of(like()));
  }

  Result<SettledLevels> settle() {
    const CountLevels* calibrated = response_ && response_->levels ? &*response_->levels : nullptr;
    if (calibrated != nullptr && !calibrated->are_of(like())) {
      if (Result<void> ok = settle_by(*calibrated); !ok) return std::move(ok).error();
    } else if (calibrated == nullptr && far_above_ > kShareFarAbove) {
      return far_above();
    } else if (calibrated == nullptr && dark_ &&
               std::abs(*dark_ - mean_black(like())) > kOffBlack * range_of(like())) {
      said_.push_back(
          fmt::format("the dark shot reads {:.0f} counts, the files call {:.0f} black: {:.0f} is taken",
                      *dark_, mean_black(like()), *dark_));
      const auto off = static_cast<float>(*dark_ - mean_black(like()));
      for (RawFrame& frame : frames_)
        for (auto& row : frame.black)
          for (float& black : row) black += off;
    }
    settle_full();
    return SettledLevels{std::move(said_), scale_};
  }

 private:
  const RawFrame& like() const { return frames_.front(); }

  static double share_above(std::span<const std::array<TopTally, 3>> tallies, double level) {
    std::int64_t above = 0, samples = 0;
    for (const auto& rgb : tallies)
      for (const TopTally& each : rgb) {
        samples += each.samples;
        for (std::size_t i = 0; i < each.counts.size(); ++i)
          if (static_cast<double>(each.first + i) > level) above += each.counts[i];
      }
    return samples == 0 ? 0 : static_cast<double>(above) / static_cast<double>(samples);
  }

  Error refusal(std::string why) const {
    return {ErrorKind::kBadData, "the levels of the frames are not to be trusted", "", std::move(why),
            "use raws as the calibration was made from, or calibrate the response with raws as these"};
  }

  Error far_above() const {
    return refusal(
        fmt::format("{:.2g} percent of the counts lie far above {:.0f}, which the files call white",
                    100 * far_above_, like().white));
  }

  // How many times the calibration's counts these are, for as much light.
  std::optional<double> scale_to(const CountLevels& calibrated) const {
    const double dark = mean_of(calibrated.dark_rgb);
    if (dark_)
      if (const auto scale = doublings(*dark_, dark)) return scale;
    if (!dark_)
      if (const auto scale = doublings(mean_black(like()), mean_of(calibrated.black))) return scale;
    for (std::size_t c = 0; c < calibrated.full_rgb.size(); ++c) {
      if (stops_[c] == 0 || calibrated.full_rgb[c] == 0) continue;
      const double here = static_cast<double>(stops_[c]) - dark_.value_or(mean_black(like()));
      if (const auto scale = doublings(here, calibrated.full_rgb[c] - dark)) return scale;
    }
    return {};
  }

  Result<void> settle_by(const CountLevels& calibrated) {
    const double black = mean_of(calibrated.black), range = calibrated.white - black;
    const std::optional<double> scale = scale_to(calibrated);
    scale_ = scale.value_or(1);
    if (std::abs(range_of(like()) / (scale_ * range) - 1) <= kSameRange) return {};
    if (!scale) {
      return refusal(
          fmt::format("they call {:.0f} black and {:.0f} white, those of the calibration {:.0f} and {:.0f}, "
                      "and no dark shot tells how their counts compare",
                      mean_black(like()), like().white, black, calibrated.white));
    }
    // A converter may have taken black away.
    const double dark = mean_of(calibrated.dark_rgb);
    const double zero = *scale * black + (dark_ ? *dark_ - *scale * dark : 0);
    said_.push_back(
        fmt::format("the files call {:.0f} black and {:.0f} white, their counts are the calibration's{}: "
                    "{:.0f} and {:.0f} are taken",
                    mean_black(like()), like().white, *scale == 1 ? "" : fmt::format(" times {:g}", *scale),
                    zero, zero + *scale * range));
    for (RawFrame& frame : frames_) {
      for (std::size_t i = 0; i < 4; ++i)
        frame.black[i / 2][i % 2] = static_cast<float>(*scale * (calibrated.black[i] - black) + zero);
      frame.white = static_cast<float>(zero + *scale * range);
    }
    for (std::size_t c = 0; c < calibrated.full_rgb.size(); ++c)
      full_[c] = calibrated.full_rgb[c] == 0
                     ? 0
                     : static_cast<float>(zero + *scale * (calibrated.full_rgb[c] - black));
    return {};
  }

  void settle_full() {
    if (response_ && full_ == std::array<float, 3>{}) full_ = measured_full(like(), *response_);
    constexpr std::array<const char*, 3> kNames = {"red", "green", "blue"};
    std::vector<std::string> stop_at;
    for (std::size_t c = 0; c < 3; ++c) {
      const double limit = mean_black(like()) + kSaturatedFrom * range_of(like());
      if (full_[c] > 0 || stops_[c] == 0 || static_cast<double>(stops_[c]) > limit) continue;
      full_[c] = stops_[c];
      stop_at.push_back(fmt::format("{} at {:.0f}", kNames[c], stops_[c]));
    }
    for (RawFrame& frame : frames_) frame.full = full_;
    if (stop_at.empty()) return;
    said_.push_back(
        fmt::format("counts stop below the files' white of {:.0f} ({}): taken as saturated from there",
                    like().white, fmt::join(stop_at, ", ")));
  }

  std::span<RawFrame> frames_;
  const std::optional<Response>& response_;
  std::optional<double> dark_;  // counts, where the dark shot is dark
  std::array<float, 3> stops_ = {}, full_ = {};
  double far_above_ = 0, scale_ = 1;
  std::vector<std::string> said_;
};

}  // namespace

Result<SettledLevels> settle_levels(std::span<RawFrame> frames, std::size_t lit, bool has_dark,
                                    const std::optional<Response>& response, int threads) {
  return Levels(frames, lit, has_dark, response, threads).settle();
}

Response scaled(Response response, double scale) {
  if (scale == 1) return response;
  response.electrons_per_count /= scale;
  response.read_noise_counts *= scale;
  if (response.black_counts) *response.black_counts *= scale;
  return response;
}

}  // namespace weft::solve
