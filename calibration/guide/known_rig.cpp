// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/known_rig.h"

#include <fmt/format.h>

#include <array>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "capture/rig.h"
#include "core/rig/camera.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

// From black to white of a raw file of 14 bits; the calibration says electrons a count.
constexpr double kCountsToWhite = 16000;
// Where no calibration says where the camera is, and what it sees.
constexpr Vec3 kPlanCamera_mm = {0, 0, 600};
constexpr double kHalfWidth_mm = 90, kHalfHeight_mm = 60;
// Where the places stand in the frame: a tenth of it from its edges.
constexpr std::array<double, 3> kFrameShares = {0.5, 0.1, 0.9};
constexpr double kNearestLed_mm = 10;

Error no_places(std::string where, std::string why) {
  return {ErrorKind::kBadData, "no lights to plan with", std::move(where), std::move(why),
          "write the LEDs' places into the rig file as [[led]], or calibrate its lights"};
}

Result<KnownRig> calibrated_rig(const fs::path& folder) {
  Result<Calibration> calibration = read_calibration(folder);
  if (!calibration) return std::move(calibration).error();
  if (!calibration->lights) return no_places(folder.string(), "the calibration is not of lights");
  const auto* near = std::get_if<NearLights>(&*calibration->lights);
  if (!near) return no_places(folder.string(), "its lights are distant, which have directions and no places");
  KnownRig rig = {
      .name = calibration->subject.rig, .where = folder.string(), .lights = *near, .calibration = {}};
  rig.calibration = std::move(*calibration);
  return rig;
}

}  // namespace

Result<KnownRig> read_known_rig(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return calibrated_rig(path);
  const Result<capture::Rig> file = capture::read_rig(path);
  if (!file) return file.error();
  KnownRig rig = {.name = file->name, .where = path.string(), .lights = {}, .calibration = {}};
  if (!file->scan.calibration.empty()) {
    Result<KnownRig> calibrated = calibrated_rig(file->scan.calibration);
    if (!calibrated) return std::move(calibrated).error();
    rig = std::move(*calibrated);
  } else if (file->lights) {
    rig.lights = *file->lights;
  } else {
    return no_places(path.string(), "the rig file has no [[led]] and names no calibration");
  }
  rig.cloth_height_mm = file->scan.cloth_height_mm;
  if (file->scan.exposure_us) rig.exposure_s = 1e-6 * *file->scan.exposure_us;
  return rig;
}

namespace {

// Nine places over the frame, its middle first.
std::vector<Vec3> frame_places(const KnownRig& rig) {
  std::vector<Vec3> places;
  for (const double v : kFrameShares) {
    for (const double u : kFrameShares) {
      if (!rig.calibration || !rig.calibration->camera) {
        places.push_back({(2 * u - 1) * kHalfWidth_mm, (2 * v - 1) * kHalfHeight_mm, rig.cloth_height_mm});
        continue;
      }
      const CameraModel& camera = *rig.calibration->camera;
      places.push_back(
          point_on_plane(camera, u * camera.size.width, v * camera.size.height, rig.cloth_height_mm));
    }
  }
  return places;
}

Result<void> check_places(const solver::ForeseenRig& rig, const std::string& where) {
  for (const Vec3 place : rig.places_mm) {
    if (!(length(place) < 1e5)) return no_places(where, "the camera does not look at the table");
  }
  for (std::size_t k = 0; k < rig.leds.size(); ++k) {
    for (const Vec3 place : rig.places_mm) {
      const double distance = length(rig.leds[k].position_mm - place);
      if (!(distance > kNearestLed_mm && distance < 1e5))
        return no_places(where, fmt::format("LED {} is {:.3g} mm from the cloth", k + 1, distance));
    }
  }
  return {};
}

}  // namespace

Result<solver::ForeseenRig> foreseen_of(const KnownRig& rig) {
  solver::ForeseenRig planned;
  planned.leds = rig.lights.leds;
  planned.camera_mm = kPlanCamera_mm;
  planned.places_mm = frame_places(rig);
  if (rig.calibration && rig.calibration->camera) planned.camera_mm = centre_of(*rig.calibration->camera);
  if (planned.leds.empty()) return no_places(rig.where, "it has no LED");
  if (Result<void> ok = check_places(planned, rig.where); !ok) return std::move(ok).error();
  if (rig.calibration && rig.calibration->response) {
    const Response& response = *rig.calibration->response;
    planned.full_well_electrons = kCountsToWhite * response.electrons_per_count;
    planned.read_noise_electrons = response.read_noise_counts * response.electrons_per_count;
  }
  const Vec3 middle = planned.places_mm.front();
  planned.led_covariance = solver::typical_led_covariance(planned.leds, middle);
  if (rig.calibration && rig.calibration->light_covariance) {
    Result<std::vector<double>> own =
        solver::led_covariance_of(planned.leds, middle, *rig.calibration->light_covariance);
    if (!own) return std::move(own).error();
    planned.led_covariance = std::move(*own);
  }
  return planned;
}

}  // namespace weft::calibration
