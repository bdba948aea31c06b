// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/session_conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>

#include "core/image_io/image_io.h"
#include "core/parallel.h"
#include "solver/conditions/light_change.h"

namespace weft::app {
namespace {

constexpr double kMostChange = 0.2;   // of a LED between two shots; beyond it something else happened
constexpr double kMostFull = 0.99;    // share of a frame
constexpr double kLeastLight = 0.01;  // of what the best LED gives of its predicted light
constexpr int kStatisticsRows = 16;   // every so many rows, a filter cell is looked at

Result<std::vector<Photosite>> photosites_named_by(const std::filesystem::path& hot_picture, Size size) {
  const Result<LoadedImage> image = read_image(hot_picture);
  if (!image) return image.error();
  const Size found = image->planes.size();
  if (found != size) {
    return Error{ErrorKind::kBadData, "hot.png differs in size from the frames", hot_picture.string(),
                 fmt::format("it has {} x {} pixels, the frames {} x {}", found.width, found.height,
                             size.width, size.height),
                 "name the calibration of this camera with --calibration"};
  }
  std::vector<Photosite> named;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (image->planes(x, y) > 0) named.push_back({y, x});
    }
  }
  return named;
}

// Readings of a part of photograph k: views of one plane or three, (0, 0) at its corner. `scratch` must hold
// the part.
std::vector<View<const float>> readings_of(const Photographs& photographs, std::size_t k, Rect part,
                                           Image<float>& scratch) {
  std::vector<View<const float>> views;
  if (photographs.rgb.empty()) {
    const View<float> out = scratch.plane().crop({0, 0, part.width(), part.height()});
    photographs.read(k, part, out);
    views.emplace_back(out);
  } else {
    for (int c = 0; c < 3; ++c) views.push_back(photographs.rgb[k].plane(c).crop(part));
  }
  return views;
}

// What a frame looks like as a whole, from a part of its rows.
struct FrameStatistics {
  double full_share = 0;
  double mean = 0;       ///< of the readings that are finite
  double predicted = 0;  ///< of a white cloth that lies flat, by the field
  double doubt = 0;      ///< standard error of the mean of a dark frame
};

FrameStatistics statistics_of(const Photographs& photographs, std::size_t k) {
  const Size size = photographs.size;
  Image<float> scratch({size.width, 2});
  std::int64_t full = 0, finite = 0, all = 0;
  double sum = 0, predicted = 0;
  for (int y = 0; y < size.height; y += kStatisticsRows) {
    const Rect rows = {0, y, size.width, std::min(y + 2, size.height)};
    for (const View<const float>& plane : readings_of(photographs, k, rows, scratch)) {
      for (int j = 0; j < plane.height(); ++j) {
        for (int x = 0; x < plane.width(); ++x) {
          const float r = plane(x, j);
          ++all;
          full += r == std::numeric_limits<float>::infinity();
          if (!std::isfinite(r)) continue;
          ++finite;
          sum += static_cast<double>(r);
        }
      }
    }
    const LightField::Light light = photographs.field->at(k, 1, size.width / 2, y);
    predicted += light.strength * std::max(light.direction.z, 0.0);
  }
  const int looks = (size.height + kStatisticsRows - 1) / kStatisticsRows;
  const auto share_of = [](double value, std::int64_t count) {
    return value / static_cast<double>(std::max<std::int64_t>(count, 1));
  };
  const double floor = photographs.noise ? photographs.noise->floor + photographs.noise->shared : 0;
  return {share_of(static_cast<double>(full), all), share_of(sum, finite), predicted / looks,
          std::sqrt(share_of(floor, finite))};
}

template <typename T>
void erase_at(std::vector<T>& list, std::size_t k) {
  if (k < list.size()) list.erase(list.begin() + static_cast<std::ptrdiff_t>(k));
}

Result<LightField> field_of(const SessionPlan& plan, Lights lights) {
  return LightField::make(std::move(lights), plan.calibration.camera, plan.size,
                          plan.session.cloth_height_mm);
}

// Seconds of an ISO 8601 time since some fixed day; zones are not looked at, as a session has one.
std::optional<double> seconds_of(const std::string& time) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  double second = 0;
  if (std::sscanf(time.c_str(), "%d-%d-%dT%d:%d:%lf", &year, &month, &day, &hour, &minute, &second) != 6) {
    return {};
  }
  const std::chrono::sys_days days = std::chrono::year(year) / month / day;
  return 86400.0 * static_cast<double>(days.time_since_epoch().count()) + 3600.0 * hour + 60.0 * minute +
         second;
}

// When each shot was taken, by its time where all have one, else by its place in the order of capture.
class Clock {
 public:
  explicit Clock(const SessionPlan& plan) {
    for (const auto* shots : {&plan.lit, &plan.repeats}) {
      for (const Shot& shot : *shots) all_have_time_ = all_have_time_ && seconds_of(shot.time).has_value();
    }
  }
  double operator()(const Shot& shot) const { return all_have_time_ ? *seconds_of(shot.time) : shot.index; }

 private:
  bool all_have_time_ = true;
};

// Light of a repeat over that of the lit shot k of the same LED.
std::optional<double> ratio_of_repeat(const Photographs& photographs, std::size_t k, const MoreFrames& more,
                                      std::size_t repeat, int threads) {
  const Size size = photographs.size;
  constexpr int kBlock = solver::kLightBlock;
  const int across = (size.width + kBlock - 1) / kBlock;
  const auto down = static_cast<std::size_t>((size.height + kBlock - 1) / kBlock);
  std::vector<solver::BlockLight> blocks(down * static_cast<std::size_t>(across));
  std::vector<Image<float>> scratch;
  for (int i = 0; i < 2 * resolved_threads(threads); ++i) scratch.emplace_back(Size{kBlock, kBlock});
  parallel_for(down, threads, [&](std::size_t j, int worker) {
    const auto w = 2 * static_cast<std::size_t>(worker);
    for (int i = 0; i < across; ++i) {
      const Rect block = {i * kBlock, static_cast<int>(j) * kBlock, std::min((i + 1) * kBlock, size.width),
                          std::min((static_cast<int>(j) + 1) * kBlock, size.height)};
      std::vector<View<const float>> later;
      if (photographs.rgb.empty()) {
        const View<float> out = scratch[w + 1].plane().crop({0, 0, block.width(), block.height()});
        photographs.radiometry->read(more.repeats[repeat].counts.plane(), block, out);
        later.emplace_back(out);
      } else {
        for (int c = 0; c < 3; ++c) later.push_back(more.repeats_rgb[repeat].plane(c).crop(block));
      }
      blocks[j * static_cast<std::size_t>(across) + static_cast<std::size_t>(i)] =
          solver::block_light(readings_of(photographs, k, block, scratch[w]), later);
    }
  });
  return solver::light_ratio(std::move(blocks));
}

// Brightness of each light against its calibration, or nothing where the session does not say.
using Factors = std::vector<double>;

std::optional<Factors> factors_by_repeats(const SessionPlan& plan, const JobContext& context,
                                          Photographs& photographs, const MoreFrames& more) {
  const Clock time_of(plan);
  std::vector<solver::LightRepeat> repeats;
  for (std::size_t i = 0; i < plan.repeats.size(); ++i) {
    const Shot& again = plan.repeats[i];
    const auto k = static_cast<std::size_t>(
        std::find(photographs.leds.begin(), photographs.leds.end(), again.led) - photographs.leds.begin());
    if (k == photographs.leds.size()) continue;
    const auto lit =
        std::find_if(plan.lit.begin(), plan.lit.end(), [&](const Shot& s) { return s.led == again.led; });
    const std::optional<double> ratio = ratio_of_repeat(photographs, k, more, i, context.threads);
    if (!ratio || std::abs(*ratio - 1) > kMostChange) {
      photographs.warnings.push_back(fmt::format(
          "LED {} gave {} of its light when {} repeated it: too far off to be drift, so it was not "
          "used; see whether the LED was covered or failed",
          again.led, ratio ? fmt::format("{:.3g} times", *ratio) : "none", again.file));
      continue;
    }
    repeats.push_back({time_of(*lit), time_of(again), *ratio});
  }
  if (repeats.empty()) return {};
  const double rate = solver::drift_rate(repeats);
  double first = std::numeric_limits<double>::infinity();
  for (const Shot& shot : plan.lit) first = std::min(first, time_of(shot));
  Factors factors;
  for (const int led : photographs.leds) {
    const auto lit =
        std::find_if(plan.lit.begin(), plan.lit.end(), [&](const Shot& s) { return s.led == led; });
    factors.push_back(1 + rate * (time_of(*lit) - first));
  }
  return factors;
}

std::optional<Factors> factors_by_patches(const SessionPlan& plan, Photographs& photographs) {
  if (plan.calibration.patches.empty()) return {};
  const CfaPattern cfa = photographs.radiometry ? photographs.radiometry->cfa() : CfaPattern();
  Factors factors;
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    solver::PatchLight light;
    for (const WhitePatch& patch : plan.calibration.patches) {
      const Rect area = solver::area_of(patch, photographs.size);
      if (area.pixels() == 0) continue;
      Image<float> scratch(photographs.rgb.empty() ? Size{area.width(), area.height()} : Size{});
      const solver::PatchLight one = solver::patch_light(patch, *photographs.field, k, area,
                                                         readings_of(photographs, k, area, scratch), cfa);
      if (one.unusable > one.used) continue;
      light.reading += one.reading;
      light.predicted += one.predicted;
    }
    if (light.predicted <= 0) {
      photographs.warnings.push_back(
          fmt::format("no white patch can be read in the light of LED {}, as they lie outside the frame, are "
                      "saturated or unlit; patches were not used",
                      photographs.leds[k]));
      return {};
    }
    factors.push_back(light.reading / light.predicted);
  }
  return factors;
}

}  // namespace

Result<void> replace_bad_photosites(const SessionPlan& plan, const JobContext& context,
                                    Photographs& photographs, MoreFrames& more) {
  const double read_noise = plan.calibration.response->read_noise_counts;
  const RawFrame* dark = photographs.dark ? &*photographs.dark : nullptr;
  std::vector<Photosite> bad;
  if (dark != nullptr) bad = hot_photosites(*dark, read_noise, context.threads);
  const auto dead = dead_photosites(photographs.mosaics, dark, read_noise, context.threads);
  bad.insert(bad.end(), dead.begin(), dead.end());
  if (plan.calibration.hot_picture) {
    const auto named = photosites_named_by(*plan.calibration.hot_picture, plan.size);
    if (!named) return named.error();
    bad.insert(bad.end(), named->begin(), named->end());
  }
  std::sort(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());

  std::vector<RawFrame*> frames;
  for (auto* list : {&photographs.mosaics, &more.repeats, &more.brackets}) {
    for (RawFrame& frame : *list) frames.push_back(&frame);
  }
  if (photographs.dark) frames.push_back(&*photographs.dark);
  replace_photosites(frames, bad, context.threads);
  photographs.conditions["hot_photosites"] = bad.size();
  photographs.replaced = std::move(bad);
  return {};
}

void join_brackets(const SessionPlan& plan, Photographs& photographs, MoreFrames& more) {
  if (plan.brackets.empty()) return;
  const RawFrame* dark = photographs.dark ? &*photographs.dark : nullptr;
  const Response& response = *plan.calibration.response;
  photographs.brackets.resize(photographs.count());
  double least = 1;
  for (std::size_t i = 0; i < plan.brackets.size(); ++i) {
    const Shot& shot = plan.brackets[i];
    const Shot& lit = plan.lit.front();
    const double ratio = response.exposure_ratio(shot.exposure_us, lit.exposure_us).value();
    const auto k = static_cast<std::size_t>(
        std::find(photographs.leds.begin(), photographs.leds.end(), shot.led) - photographs.leds.begin());
    const Radiometry radiometry(more.brackets[i], dark, response, {lit.exposure_us * ratio, shot.iso});
    photographs.brackets[k].push_back({std::move(more.brackets[i]), radiometry});
    least = std::min(least, ratio);
  }
  // A reading that only the shortest bracket could take has its noise, and one noise model speaks for all.
  photographs.noise->per_reading /= least;
  photographs.noise->floor /= least * least;
  photographs.noise->shared /= least * least;
  photographs.conditions["brackets"] = plan.brackets.size();
}

Result<void> leave_out_useless_lights(const SessionPlan& plan, Photographs& photographs) {
  std::vector<FrameStatistics> statistics;
  double best = 0;  // 0 where no frame stands out of the noise: then none looks darker than the others
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    const FrameStatistics& s = statistics.emplace_back(statistics_of(photographs, k));
    if (s.predicted > 0 && s.mean > 5 * s.doubt) best = std::max(best, s.mean / s.predicted);
  }
  std::string reasons;
  for (std::size_t k = photographs.count(); k-- > 0;) {
    const FrameStatistics& s = statistics[k];
    const bool is_full = s.full_share > kMostFull;
    if (!is_full && (s.predicted <= 0 || best == 0 || s.mean > kLeastLight * best * s.predicted)) continue;
    const int led = photographs.leds[k];
    const std::string why = is_full ? fmt::format("saturated {:.3g} percent of the frame", 100 * s.full_share)
                                    : "did not light the cloth: its frame looks like the dark shot";
    reasons = fmt::format("LED {} {}", led, why) + (reasons.empty() ? "" : "; " + reasons);
    photographs.warnings.insert(photographs.warnings.begin(),
                                fmt::format("LED {} {}; it was left out", led, why));
    Json& left_out = photographs.conditions["left_out"];
    if (left_out.is_null()) left_out = Json::array();
    left_out.insert(left_out.begin(), Json{{"led", led}, {"why", is_full ? "saturated" : "not lit"}});
    erase_at(photographs.mosaics, k);
    erase_at(photographs.rgb, k);
    erase_at(photographs.brackets, k);
    erase_at(photographs.leds, k);
  }
  if (photographs.count() == statistics.size()) return {};
  if (photographs.count() < 3) {
    return Error{ErrorKind::kBadData, "too few lights", plan.session.folder.string(),
                 fmt::format("{}, which leaves {}; a normal and an albedo are three unknowns", reasons,
                             photographs.count()),
                 "see to these LEDs and to the exposure, and scan the cloth again"};
  }
  Result<Lights> lights = select_lights(*plan.calibration.lights, photographs.leds);
  if (!lights) return std::move(lights).error();
  Result<LightField> field = field_of(plan, std::move(*lights));
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  return {};
}

Result<void> follow_drift(const SessionPlan& plan, const JobContext& context, Photographs& photographs,
                          const MoreFrames& more) {
  const char* from = "patches";
  std::optional<Factors> factors = factors_by_patches(plan, photographs);
  if (!factors) {
    from = "repeat";
    factors = factors_by_repeats(plan, context, photographs, more);
  }
  if (!factors) return {};
  Json drift = Json::array();
  for (std::size_t k = 0; k < factors->size(); ++k) {
    double& factor = (*factors)[k];
    const int led = photographs.leds[k];
    if (!(std::abs(factor - 1) <= kMostChange)) {
      photographs.warnings.push_back(
          fmt::format("LED {} gave {:.3g} times the light of its calibration: too far off to be drift, so it "
                      "was not corrected; see whether the LED was covered or replaced",
                      led, factor));
      factor = 1;
    }
    drift.push_back({{"led", led}, {"factor", factor}, {"from", from}});
  }
  photographs.conditions["drift"] = std::move(drift);
  Result<LightField> field = field_of(plan, brightened(photographs.field->lights(), *factors));
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  return {};
}

}  // namespace weft::app
