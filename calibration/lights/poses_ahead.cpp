// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/poses_ahead.h"

#include <cmath>
#include <map>
#include <utility>

#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr double kTilt_deg = 20;
constexpr double kGolden = 2.399963229728653;  // radians

// The sheet of `pose`, tilted to this azimuth.
SheetPose tilted(SheetPose pose, double azimuth) {
  const Vec3 axis = {-std::sin(azimuth), std::cos(azimuth), 0};
  pose.rig_from_sheet.rotation = rotation_of(radians(kTilt_deg) * axis);
  return pose;
}

std::array<double, 3> usual_sigma(std::span<const PaperReading> readings) {
  std::array<double, 3> usual = {};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> all;
    for (const PaperReading& reading : readings) all.push_back(reading.relative_sigma[c]);
    usual[c] = median(std::move(all));
  }
  return usual;
}

// The places in the frame at which the sheet was read that shows most of it.
std::vector<std::pair<double, double>> places_of(std::span<const PaperReading> readings) {
  std::map<std::size_t, std::vector<std::pair<double, double>>> by_sheet;
  for (const PaperReading& reading : readings) {
    if (reading.led == readings.front().led) by_sheet[reading.sheet].emplace_back(reading.x_px, reading.y_px);
  }
  std::vector<std::pair<double, double>> most;
  for (auto& [sheet, places] : by_sheet) {
    if (places.size() > most.size()) most = std::move(places);
  }
  return most;
}

}  // namespace

PaperPhotographs with_more_poses(const PaperScene& scene, std::span<const PaperReading> readings,
                                 const Sheet& sheet, int more) {
  PaperPhotographs all = {scene, {readings.begin(), readings.end()}};
  const std::array<double, 3> sigma = usual_sigma(readings);
  const std::vector<std::pair<double, double>> places = places_of(readings);
  for (int i = 0; i < more; ++i) {
    all.scene.sheets.push_back(tilted(scene.sheets.front(), kGolden * i));
    if (!scene.shot_log_gains.empty()) all.scene.shot_log_gains.emplace_back(scene.lights.leds.size(), 0.0);
    const std::size_t at = all.scene.sheets.size() - 1;
    for (const auto& [x, y] : places) {
      if (!shows_paper(scene.camera, sheet, all.scene.sheets.back().rig_from_sheet, x, y, 1)) continue;
      for (std::size_t led = 0; led < scene.lights.leds.size(); ++led) {
        PaperReading reading = {at, led, x, y, {}, sigma};
        bool is_lit = true;
        for (int c = 0; c < 3; ++c) {
          const std::optional<double> log = all.scene.log_reading(at, led, c, x, y);
          is_lit = is_lit && log;
          if (log) reading.reading_rgb[static_cast<std::size_t>(c)] = std::exp(*log);
        }
        if (is_lit) all.readings.push_back(reading);
      }
    }
  }
  return all;
}

}  // namespace weft::calibration
