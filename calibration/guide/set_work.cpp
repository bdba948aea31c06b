// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/set_work.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <variant>
#include <vector>

#include "calibration/guide/response_series.h"
#include "capture/raw/decode_raw.h"
#include "capture/scan/histogram.h"
#include "capture/scan/series.h"
#include "core/base/files.h"
#include "core/rig/calibration.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kStart_us = 1e6 / 60;
constexpr double kTooDark = 0.35, kTooBright = 0.95;  // brightest photosites: metered once more
// Linearity is seen as high up as both LEDs at once are bright.
constexpr double kUntilFull = 1.25;
// A sheet that is tilted towards a LED is brighter than it is flat.
constexpr double kTiltedSheet = 0.65;

Result<double> metered_us(capture::Series& series, const PhotographSet& set,
                          const std::vector<std::vector<int>>& lights) {
  return series.metered_us(lights, set.exposure_us > 0 ? set.exposure_us : kStart_us);
}

Result<void> remember(PhotographSet& set, double exposure_us) {
  set.exposure_us = exposure_us;
  return write_set(set);
}

/// One photograph by two LEDs, of an exposure that suits it.
Result<void> take_board(PhotographSet& set, const SetStep& step, const std::vector<int>& leds,
                        capture::Series& series) {
  set.asked[step.name] = step.pose;
  const bool is_metered = set.exposure_us > 0;
  if (!is_metered) {
    const Result<double> exposure_us = metered_us(series, set, {leds});
    if (!exposure_us) return exposure_us.error();
    set.exposure_us = *exposure_us;
  }
  if (Result<void> ok = write_set(set); !ok) return ok;
  const Result<capture::Photograph> taken = series.take({step.name, leds, set.exposure_us});
  if (!taken) return taken.error();
  if (!is_metered) return {};
  const Result<RawFrame> frame = capture::decode_raw(taken->file);
  if (!frame) return frame.error();
  const double bright = capture::brightness_of(*frame).bright;
  if (bright > kTooDark && bright < kTooBright) return {};
  const Result<double> exposure_us = metered_us(series, set, {leds});
  if (!exposure_us) return exposure_us.error();
  if (Result<void> ok = remember(set, *exposure_us); !ok) return ok;
  std::error_code failed;
  fs::remove(taken->file, failed);
  if (failed) return cannot_write(taken->file, failed.value());
  const Result<capture::Photograph> again = series.take({step.name, leds, *exposure_us});
  return again ? Result<void>() : again.error();
}

Result<void> take_series(PhotographSet& set, const SetStep& step, int leds, capture::Series& series) {
  if (!(set.exposure_us > 0)) {
    const std::vector<int> both =
        set.part == SetPart::kResponse && leds > 1 ? std::vector{1, 2} : std::vector{1};
    const Result<double> exposure_us = metered_us(series, set, {both});
    if (!exposure_us) return exposure_us.error();
    const double longer = set.part == SetPart::kResponse ? kUntilFull : 1;
    if (Result<void> ok = remember(set, series.share_of_us(*exposure_us, longer)); !ok) return ok;
  }
  return series.take_missing(
      series_of(step, leds, [&](double share) { return series.share_of_us(set.exposure_us, share); }));
}

Result<void> meter_sheet(PhotographSet& set, int leds, capture::Series& series) {
  std::vector<std::vector<int>> each;
  for (int led = 1; led <= leds; ++led) each.push_back({led});
  const Result<double> exposure_us = metered_us(series, set, each);
  if (!exposure_us) return exposure_us.error();
  return remember(set, series.share_of_us(*exposure_us, kTiltedSheet));
}

capture::ScanRequest scan_of(const PhotographSet& set, const SetStep& step, const capture::Rig& rig,
                             int leds) {
  capture::ScanRequest request;
  request.session = set.folder / step.name;
  request.fabric = set.part == SetPart::kChart ? "colour chart" : "white sheet";
  request.rig = rig.name;
  // Lights that are not known yet, or a sheet that is tilted from them, are no evidence against a photograph.
  if (set.part == SetPart::kChart) request.calibration = set.from;
  request.exposure = {set.part == SetPart::kSheet ? set.exposure_us : 0, rig.scan.iso, rig.scan.f_number};
  for (int led = 1; led <= leds; ++led) request.leds.push_back(led);
  return request;
}

}  // namespace

std::vector<int> board_leds(const capture::Rig& rig, const PhotographSet& set) {
  std::optional<Lights> lights;
  if (rig.lights) lights = *rig.lights;
  if (const Result<Calibration> before = read_calibration(set.from); !lights && before && before->lights)
    lights = before->lights;
  const auto* near = lights ? std::get_if<NearLights>(&*lights) : nullptr;
  if (near == nullptr || near->leds.size() < 2) return {1};
  const auto across = [&](const NearLight& led) {
    const Vec3 a = near->leds.front().position_mm, b = led.position_mm;
    return (a.x * b.x + a.y * b.y) / std::max(std::hypot(a.x, a.y) * std::hypot(b.x, b.y), 1e-9);
  };
  const auto least = std::ranges::min_element(near->leds, {}, across);
  const int other = static_cast<int>(least - near->leds.begin()) + 1;
  return other == 1 ? std::vector{1} : std::vector{1, other};
}

Result<void> take_step(PhotographSet& set, const SetStep& step, const capture::Rig& rig,
                       capture::Lamps& lamps, capture::Camera& camera, const capture::ScanEvents& events,
                       const capture::ScanControl& control) {
  const int leds = std::min(rig.leds, lamps.leds());
  const bool is_scan = step.kind == StepKind::kScan;
  if (!is_scan || (set.part == SetPart::kSheet && !(set.exposure_us > 0))) {
    capture::Series series(set.folder, rig.scan.iso, rig.scan.f_number, lamps, camera, events, control);
    if (Result<void> found = series.connect(); !found) return found;
    if (step.kind == StepKind::kPhotograph) return take_board(set, step, board_leds(rig, set), series);
    if (step.kind == StepKind::kSeries) return take_series(set, step, leds, series);
    if (Result<void> metered = meter_sheet(set, leds, series); !metered) return metered;
  }
  const Result<capture::ScanOutcome> scanned =
      capture::scan(scan_of(set, step, rig, leds), lamps, camera, events, control);
  return scanned ? Result<void>() : scanned.error();
}

}  // namespace weft::calibration
