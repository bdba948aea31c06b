// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/response_measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace weft::calibration {
namespace {

double linear(const Moments& moments, std::size_t channel, const TransferCurve& curve) {
  const auto [a, b] = curve.linearity[channel];
  const Moments m = shifted(moments, curve.offset);
  return m.v + a * m.v2 + b * m.v3;
}

// Mean of v over the squares that all exposures of a LED hold.
std::optional<double> mean_of_common(const std::vector<TimedLight>& led, const TimedLight& at,
                                     std::size_t c) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < at.light->blocks.size(); ++i) {
    const bool everywhere = std::all_of(
        led.begin(), led.end(), [&](const TimedLight& l) { return l.light->blocks[i][c].photosites > 0; });
    if (!everywhere) continue;
    sum += at.light->blocks[i][c].v;
    ++count;
  }
  if (count == 0) return {};
  return sum / count;
}

constexpr double kClippedShare = 0.01;  // of dark photosites at 0: the body clips black
constexpr double kUnlit = 0.05;         // of the light of the brightest LED
constexpr double kLeastLight = 0.05;    // of full scale, for sums to be looked at one by one
constexpr double kMostMissing = 0.05;   // of light that should add up
constexpr double kUsualDrift = 0.001;   // of a LED, where no frame was repeated
constexpr double kLeastDrift = 0.0003;  // warming that repeated frames, taken at once, do not show

using Channels = std::array<double, 3>;

std::string name_of_leds(const std::vector<int>& leds) {
  std::string name;
  for (const int led : leds) name += fmt::format("{}led{:02}", name.empty() ? "" : "+", led);
  return name.empty() ? "dark" : name;
}

// v without light by exposure time, from dark frames that are not clipped.
class DarkLine {
 public:
  static std::optional<DarkLine> of(const std::vector<ExposureFrames>* dark) {
    if (dark == nullptr) return {};
    DarkLine line;
    double w = 0, x = 0, xx = 0;
    Channels y = {}, xy = {};
    for (const ExposureFrames& e : *dark) {
      if (e.light.zero_share > kClippedShare) return {};
      const double weight = e.light.frames, t = e.exposure_us * 1e-6;
      w += weight;
      x += weight * t;
      xx += weight * t * t;
      for (std::size_t c = 0; c < 3; ++c) {
        y[c] += weight * e.light.mean[c];
        xy[c] += weight * t * e.light.mean[c];
      }
    }
    const double determinant = w * xx - x * x;
    for (std::size_t c = 0; c < 3; ++c) {
      if (dark->size() > 1) line.per_s_[c] = (w * xy[c] - x * y[c]) / determinant;
      line.level_[c] = (y[c] - line.per_s_[c] * x) / w;
    }
    return line;
  }
  Channels at(double exposure_us) const {
    Channels v = {};
    for (std::size_t c = 0; c < 3; ++c) v[c] = level_[c] + per_s_[c] * exposure_us * 1e-6;
    return v;
  }
  double level() const { return (level_[0] + level_[1] + level_[2]) / 3; }
  double per_s() const { return (per_s_[0] + per_s_[1] + per_s_[2]) / 3; }

 private:
  Channels level_ = {}, per_s_ = {};
};

double brightness(const ExposureFrames& e) {
  return e.light.mean[0] + e.light.mean[1] + e.light.mean[2];
}

class Measurement {
 public:
  explicit Measurement(const ResponseFrames& frames) : frames_(frames) {}

  Result<ResponseMeasurement> run() {
    using Step = Result<void> (Measurement::*)();
    for (const Step step :
         {&Measurement::look_at_dark, &Measurement::require_levels, &Measurement::require_light,
          &Measurement::measure_drift, &Measurement::measure_linearity, &Measurement::measure_black,
          &Measurement::measure_noise, &Measurement::measure_ratios, &Measurement::measure_balance}) {
      if (Result<void> ok = (this->*step)(); !ok) return std::move(ok).error();
    }
    return std::move(out_);
  }

 private:
  Result<void> look_at_dark() {
    const std::vector<ExposureFrames>* dark = frames_.of({});
    dark_ = DarkLine::of(dark);
    for (const ExposureFrames& e : dark != nullptr ? *dark : std::vector<ExposureFrames>()) {
      out_.clipped_share = std::max(out_.clipped_share, e.light.zero_share);
    }
    return {};
  }

  Result<void> require_levels() {
    int levels = 0;
    for (const auto& [leds, exposures] : frames_.by_leds) {
      for (const ExposureFrames& e : exposures) levels += !leds.empty() && e.light.frames >= 2;
    }
    if (levels >= 3) return {};
    return Error{
        ErrorKind::kBadData, "too few levels of light", "response frames",
        fmt::format(
            "{} exposures of a LED have two frames or more that are not full, 3 are needed"
            "{}",
            levels,
            frames_.full.empty() ? "" : fmt::format("; {} frames were full everywhere", frames_.full.size())),
        "take every light at four exposures or more, two frames of each"};
  }

  // At each exposure, every LED against the brightest.
  Result<void> require_light() {
    for (const auto& [leds, exposures] : frames_.by_leds) {
      if (leds.size() != 1) continue;
      for (const ExposureFrames& e : exposures) {
        const double least = kUnlit * brightest_at(e.exposure_us);
        const Channels dark = dark_at(e.exposure_us);
        const double light = brightness(e) - dark[0] - dark[1] - dark[2];
        if (light >= least && light > 0) continue;
        return Error{ErrorKind::kBadData, "a LED did not light", e.files.front().string(),
                     fmt::format("{} gives {:.1f} percent of full scale where another LED gives {:.1f}",
                                 name_of_leds(leds), 100 * light / 3, 100 * least / kUnlit / 3),
                     "check its wiring and take its frames again"};
      }
    }
    return {};
  }

  double brightest_at(double exposure_us) const {
    double most = 0;
    for (const auto& [leds, exposures] : frames_.by_leds) {
      for (const ExposureFrames& e : exposures) {
        if (leds.size() == 1 && e.exposure_us == exposure_us) most = std::max(most, brightness(e));
      }
    }
    return most;
  }

  Channels dark_at(double exposure_us) const { return dark_ ? dark_->at(exposure_us) : Channels{}; }

  // How much the light of frames alike differs, pooled over all.
  Result<void> measure_drift() {
    double square = 0, freedom = 0;
    for (const auto& [leds, exposures] : frames_.by_leds) {
      if (leds.empty()) continue;
      for (const ExposureFrames& e : exposures) {
        double mean = 0;
        for (const double b : e.brightness) mean += b / static_cast<double>(e.brightness.size());
        if (e.brightness.size() < 2 || !(mean > 0)) continue;
        for (const double b : e.brightness) square += std::pow(b / mean - 1, 2);
        freedom += static_cast<double>(e.brightness.size()) - 1;
      }
    }
    out_.drift = freedom > 0 ? std::sqrt(square / freedom) : kUsualDrift;
    return {};
  }

  // Triples of LED i, LED j and both, at each exposure that all three have.
  struct Triple {
    std::string name;
    const ExposureFrames *first, *second, *both;
    Channels dark;
  };

  std::vector<Triple> triples() const {
    std::vector<Triple> found;
    for (const auto& [leds, exposures] : frames_.by_leds) {
      const std::vector<ExposureFrames>*first = nullptr, *second = nullptr;
      if (leds.size() == 2) first = frames_.of({leds[0]}), second = frames_.of({leds[1]});
      if (first == nullptr || second == nullptr) continue;
      for (const ExposureFrames& both : exposures) {
        const auto same = [&](const ExposureFrames& e) { return e.exposure_us == both.exposure_us; };
        const auto i = std::find_if(first->begin(), first->end(), same);
        const auto j = std::find_if(second->begin(), second->end(), same);
        if (i == first->end() || j == second->end()) continue;
        found.push_back({name_of_leds(leds), &*i, &*j, &both, dark_at(both.exposure_us)});
      }
    }
    return found;
  }

  Result<void> measure_linearity() {
    const std::vector<Triple> lights = triples();
    if (lights.empty()) return {};
    std::vector<SuperposedLight> superposed;
    double frames = 0;
    for (const Triple& t : lights) {
      superposed.push_back({&t.first->light, &t.second->light, &t.both->light, dark_ ? &t.dark : nullptr});
      frames += t.first->light.frames / static_cast<double>(lights.size());
      if (Result<void> ok = require_sum(t, superposed.back()); !ok) return ok;
    }
    // The weights need the noise, whose slope a slight curve changes by a percent or two.
    const double full = frames_.counts_at_full();
    const auto first_guess = fit_photon_transfer(frames_.transfer, {}, full);
    if (!first_guess) return first_guess.error();
    SuperpositionNoise noise;
    noise.electrons_at_full = first_guess->electrons_per_count * full;
    noise.read_noise = first_guess->read_noise_counts / full;
    noise.drift = std::hypot(out_.drift * std::sqrt(2 / frames), kLeastDrift);
    Result<Superposition> fit = fit_superposition(superposed, noise);
    if (!fit) return std::move(fit).error();
    curve_.linearity = fit->linearity;
    out_.superposition = std::move(*fit);
    return {};
  }

  static Result<void> require_sum(const Triple& t, const SuperposedLight& light) {
    // An unknown black level would be much of little light.
    if (brightness(*t.both) < 3 * kLeastLight) return {};
    const double ratio = sum_over_both(light);
    if (std::abs(ratio - 1) <= kMostMissing) return {};
    return Error{ErrorKind::kBadData, "light does not add up", t.both->files.front().string(),
                 fmt::format("{} gives {:.1f} percent of what its LEDs give one by one: one of them did not "
                             "light, or the room was lit",
                             t.name, 100 / ratio),
                 "check which LEDs were on, and take these frames again in a dark room"};
  }

  Result<void> measure_black() {
    const double full = frames_.counts_at_full();
    double offset = 0, sigma = 0;
    if (dark_) {
      out_.black_from = BlackFrom::kDarkFrames;
      offset = dark_->level();
      out_.dark_counts_per_s = dark_->per_s() * full;
    } else if (out_.superposition) {
      out_.black_from = BlackFrom::kSuperposition;
      offset = out_.superposition->offset;
      sigma = out_.superposition->sigma_offset;
    } else if (const auto level = level_at_no_exposure(timed())) {
      out_.black_from = BlackFrom::kExposures;
      offset = level->v;
      sigma = level->sigma;
    }
    curve_.offset = offset;
    out_.black_counts = frames_.mean_black() + full * offset;
    out_.sigma_black_counts = full * sigma;
    return {};
  }

  std::vector<std::vector<TimedLight>> timed() const {
    std::vector<std::vector<TimedLight>> lists;
    for (const auto& [leds, exposures] : frames_.by_leds) {
      if (leds.empty()) continue;
      std::vector<TimedLight>& list = lists.emplace_back();
      for (const ExposureFrames& e : exposures) list.push_back({&e.light, e.exposure_us});
    }
    return lists;
  }

  Result<void> measure_noise() {
    Result<PhotonTransfer> transfer = fit_photon_transfer(frames_.transfer, curve_, frames_.counts_at_full());
    if (!transfer) return std::move(transfer).error();
    out_.transfer = std::move(*transfer);
    out_.response.electrons_per_count = out_.transfer.electrons_per_count;
    out_.response.read_noise_counts = out_.transfer.read_noise_counts;
    out_.response.linearity = curve_.linearity;
    if (out_.black_from == BlackFrom::kDarkFrames) {
      double photosites = 0;
      for (const ExposureFrames& e : *frames_.of({})) {
        photosites += e.light.frames * static_cast<double>(frames_.size.pixels());
      }
      out_.sigma_black_counts = out_.transfer.read_noise_counts / std::sqrt(photosites);
    }
    if (std::abs(out_.black_counts - frames_.mean_black()) > 3 * out_.sigma_black_counts) {
      out_.response.black_counts = out_.black_counts;
    }
    return {};
  }

  // LED by LED, every exposure against every other; the mean of the LEDs.
  Result<void> measure_ratios() {
    struct Pair {
      double longer, shorter;
      std::vector<double> ratios;
    };
    std::vector<Pair> pairs;
    for (const auto& [leds, exposures] : frames_.by_leds) {
      if (leds.empty()) continue;
      for (std::size_t i = 0; i < exposures.size(); ++i) {
        for (std::size_t j = i + 1; j < exposures.size(); ++j) {
          const auto ratio = light_ratio(exposures[j].light, exposures[i].light, curve_);
          if (!ratio) continue;
          const double longer = exposures[j].exposure_us, shorter = exposures[i].exposure_us;
          auto found = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& p) {
            return p.longer == longer && p.shorter == shorter;
          });
          if (found == pairs.end()) found = pairs.insert(found, {longer, shorter, {}});
          found->ratios.push_back(*ratio);
        }
      }
    }
    for (const Pair& p : pairs) {
      const auto n = static_cast<double>(p.ratios.size());
      double mean = 0, square = 0;
      for (const double r : p.ratios) mean += r / n;
      for (const double r : p.ratios) square += std::pow(r / mean - 1, 2);
      out_.ratios.push_back({{p.longer, p.shorter, mean}, n > 1 ? std::sqrt(square / (n - 1)) : 0});
      out_.response.exposure_ratios.push_back(out_.ratios.back().ratio);
    }
    return {};
  }

  // From the longest exposure of each LED that is full nowhere.
  Result<void> measure_balance() {
    for (const auto& [leds, exposures] : frames_.by_leds) {
      if (leds.size() != 1) continue;
      for (auto e = exposures.rbegin(); e != exposures.rend(); ++e) {
        const auto& full = e->light.full_share;
        if (std::max({full[0], full[1], full[2]}) > 1e-4 && std::next(e) != exposures.rend()) continue;
        if (const auto light = light_by_channel(e->light, curve_)) {
          const double seconds = e->exposure_us * 1e-6 * std::max(frames_.camera.iso, 1.0) / 100;
          out_.balance.push_back(
              {leds[0], {(*light)[0] / seconds, (*light)[1] / seconds, (*light)[2] / seconds}});
        }
        break;
      }
    }
    return {};
  }

  const ResponseFrames& frames_;
  ResponseMeasurement out_;
  std::optional<DarkLine> dark_;
  TransferCurve curve_;
};

}  // namespace

std::optional<std::array<double, 3>> light_by_channel(const BlockLight& light, const TransferCurve& curve) {
  std::array<double, 3> sum = {};
  int count = 0;
  for (const auto& block : light.blocks) {
    if (block[0].photosites == 0 || block[1].photosites == 0 || block[2].photosites == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += linear(block[c], c, curve);
    ++count;
  }
  if (count == 0) return {};
  for (double& s : sum) s /= count;
  return sum;
}

std::optional<double> light_ratio(const BlockLight& light, const BlockLight& to, const TransferCurve& curve) {
  // With photon noise alone the best estimate of a ratio is the ratio of sums.
  double sum = 0, to_sum = 0;
  for (std::size_t i = 0; i < light.blocks.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Moments &a = light.blocks[i][c], &b = to.blocks[i][c];
      if (a.photosites == 0 || b.photosites == 0) continue;
      sum += linear(a, c, curve);
      to_sum += linear(b, c, curve);
    }
  }
  if (!(sum > 0) || !(to_sum > 0)) return {};
  return sum / to_sum;
}

std::optional<DarkLevel> level_at_no_exposure(std::span<const std::vector<TimedLight>> leds,
                                              double time_error) {
  // A line through each LED and channel, level and slope; the levels are then joined.
  double sum = 0, weight = 0, chi_square = 0, freedom = -1;
  std::vector<std::pair<double, double>> levels;  // with variances
  for (const std::vector<TimedLight>& led : leds) {
    for (std::size_t c = 0; c < 3; ++c) {
      double w = 0, x = 0, y = 0, xx = 0, xy = 0;
      int count = 0;
      for (const TimedLight& at : led) {
        const std::optional<double> v = mean_of_common(led, at, c);
        if (!v) continue;
        const double t = at.exposure_us, one = 1 / std::pow(time_error * *v + 1e-6, 2);
        w += one;
        x += one * t;
        y += one * *v;
        xx += one * t * t;
        xy += one * t * *v;
        ++count;
      }
      const double determinant = w * xx - x * x;
      if (count < 3 || !(determinant > 0)) continue;
      levels.emplace_back((xx * y - x * xy) / determinant, xx / determinant);
      sum += levels.back().first / levels.back().second;
      weight += 1 / levels.back().second;
    }
  }
  if (levels.empty()) return {};
  const double mean = sum / weight;
  for (const auto& [level, variance] : levels) {
    chi_square += (level - mean) * (level - mean) / variance;
    ++freedom;
  }
  const double inflation = freedom > 0 ? std::max(chi_square / freedom, 1.0) : 1.0;
  return DarkLevel{mean, std::sqrt(inflation / weight)};
}

Result<ResponseMeasurement> measure_response(const ResponseFrames& frames) {
  return Measurement(frames).run();
}

const char* name_of(BlackFrom from) {
  switch (from) {
    case BlackFrom::kDarkFrames:
      return "dark frames";
    case BlackFrom::kSuperposition:
      return "sums of light";
    case BlackFrom::kExposures:
      return "exposure times";
    case BlackFrom::kFile:
      break;
  }
  return "the file";
}

}  // namespace weft::calibration
