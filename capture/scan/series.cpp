// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "capture/raw/decode_raw.h"
#include "capture/scan/histogram.h"
#include "capture/scan/scan_plan.h"
#include "core/base/files.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAside = ".taking";

ShotLight light_of(const std::vector<int>& leds) {
  return {.led = leds.empty() ? 0 : leds[0],
          .role = leds.empty() ? ShotRole::kDark : ShotRole::kLit,
          .second = leds.size() > 1 ? leds[1] : 0};
}

void empty(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) fs::remove_all(entry.path(), ignored);
}

}  // namespace

fs::path file_of(const fs::path& folder, const std::string& name) {
  const fs::path stem = folder / name;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(stem.parent_path(), ignored)) {
    if (entry.is_regular_file(ignored) && entry.path().stem() == stem.filename()) return entry.path();
  }
  return {};
}

Series::Series(fs::path folder, double iso, double f_number, Lamps& lamps, Camera& camera,
               const ScanEvents& events, const ScanControl& control, const ScanOptions& options)
    : folder_(std::move(folder)),
      aside_(folder_ / kAside),
      iso_(iso),
      f_number_(f_number),
      control_(control),
      options_(options),
      events_(events),
      report_(events_),
      shooter_(lamps, camera, no_film_, control_, options_, report_) {}

Series::~Series() {
  std::error_code ignored;
  fs::remove_all(aside_, ignored);
}

Result<void> Series::connect() {
  if (Result<void> made = make_writable_folder(aside_); !made) return made;
  if (const Result<CameraFacts> facts = shooter_.connect(); !facts) return facts.error();
  Result<std::vector<double>> times = shooter_.shutter_times_us();
  if (!times) return std::move(times).error();
  shutter_times_us_ = std::move(*times);
  return {};
}

Result<double> Series::metered_us(const std::vector<std::vector<int>>& lights, double start_us) {
  report_.phase(ScanPhase::kMetering);
  MeterInput input = {{}, {}, shutter_times_us_, start_us};
  for (std::size_t i = 0; i < lights.size(); ++i) input.leds.push_back(static_cast<int>(i) + 1);
  TestShotReader test_shots;
  const Result<Metering> metering = meter(input, [&](int light, double exposure_us) -> Result<Brightness> {
    const Result<Photograph> photograph =
        shoot({"test", lights[static_cast<std::size_t>(light) - 1], exposure_us});
    if (!photograph) return photograph.error();
    Result<RawFrame> frame = decode_raw(photograph->file);
    empty(aside_);
    if (!frame) return frame.error();
    return test_shots.read(std::move(*frame));
  });
  report_.phase(ScanPhase::kExposing);
  if (!metering) return metering.error();
  return metering->exposure_us;
}

double Series::share_of_us(double exposure_us, double share) const {
  return nearest_time_us(shutter_times_us_, share * exposure_us);
}

Result<Photograph> Series::shoot(const SeriesShot& shot) {
  const fs::path name = fs::path(shot.name).filename();
  const Result<double> exposure_us = settable_time_us(shutter_times_us_, shot.exposure_us);
  if (!exposure_us) return exposure_us.error();
  return shooter_.take(light_of(shot.leds), {*exposure_us, iso_, f_number_}, aside_ / name,
                       [&] { empty(aside_); });
}

Result<Photograph> Series::take(const SeriesShot& shot) {
  Result<Photograph> photograph = shoot(shot);
  if (!photograph) return photograph;
  const fs::path file = folder_ / (shot.name + photograph->file.extension().string());
  if (is_there(file)) {
    return Error{ErrorKind::kCannotCreate, "the photograph is there already", file.string(),
                 "it is never written over", "take it away, or take the photograph under another name"};
  }
  if (Result<void> made = make_writable_folder(file.parent_path()); !made) return made.error();
  std::error_code failed;
  fs::rename(photograph->file, file, failed);
  if (failed) return cannot_write(file, failed.value());
  if (Result<void> synced = sync_path(file.parent_path()); !synced) return synced.error();
  photograph->file = file;
  return photograph;
}

Result<void> Series::take_missing(const std::vector<SeriesShot>& shots) {
  std::vector<SeriesShot> missing;
  for (const SeriesShot& shot : shots) {
    if (file_of(folder_, shot.name).empty()) missing.push_back(shot);
  }
  const int there = static_cast<int>(shots.size() - missing.size());
  report_.change([&](ScanStatus& status) {
    status.frames_planned = static_cast<int>(shots.size());
    status.frames = there;
  });
  for (const SeriesShot& shot : missing) {
    report_.change([&](ScanStatus& status) { status.exposure_us = shot.exposure_us; });
    if (const Result<Photograph> taken = take(shot); !taken) return taken.error();
    report_.change([](ScanStatus& status) { ++status.frames; });
  }
  return {};
}

}  // namespace weft::capture
