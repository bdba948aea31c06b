// SPDX-License-Identifier: Apache-2.0
#include "tests/calibration/checks/moved_rig.h"

#include <cmath>

#include "bench/oracles/oracle_rig.h"
#include "core/rig/camera.h"
#include "simulator/light/incidence.h"

namespace weft::test {
namespace {

using calibration::Pose;
constexpr double kTag_mm = 9;
constexpr int kColumns = 5, kRows = 4;  // of places on a sheet

CameraModel moved_camera(const CameraModel& camera, const Pose& body) {
  const Pose camera_from_rig =
      Pose{camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm} * inverse(body);
  CameraModel moved = camera;
  moved.camera_from_rig_rotation = camera_from_rig.rotation;
  moved.camera_from_rig_translation_mm = camera_from_rig.translation_mm;
  return moved;
}

void add_patch(Calibration& rig, double x_mm, double y_mm) {
  constexpr double kHalf_px = 30;
  const Vec3 c = project(*rig.camera, {x_mm, y_mm, 0});
  rig.patches.push_back({{{c.x - kHalf_px, c.y - kHalf_px},
                          {c.x + kHalf_px, c.y - kHalf_px},
                          {c.x + kHalf_px, c.y + kHalf_px},
                          {c.x - kHalf_px, c.y + kHalf_px}},
                         {0.88, 0.88, 0.88}});
}

/// What a place reads that really lies at `real`.
void read(calibration::LitPlace& place, Vec3 real, const Mishap& mishap, const CameraModel& camera,
          double white, const std::vector<double>& flicker, Random& random) {
  const Vec3 normal = mishap.table.rotation * Vec3{0, 0, 1};
  const Vec3 pixel = project(camera, real);
  place.x_px = pixel.x, place.y_px = pixel.y;
  for (std::size_t k = 0; k < mishap.leds.size(); ++k) {
    const NearLight& led = mishap.leds[k];
    const double light = white * flicker[k] * simulator::shading(simulator::incidence(led, real), normal);
    auto& reading = place.reading_rgb.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) reading[c] = light * led.flux_rgb[c] * (1 + 0.0003 * random.normal());
  }
}

}  // namespace

Calibration calibrated_rig() {
  Calibration rig;
  rig.camera = overhead_camera({1536, 1024}, 600, 0.13);
  NearLights lights = ten_leds(1.1);
  for (NearLight& led : lights.leds) led.flux_rgb = {1e7, 2e7, 1.4e7};
  rig.lights = lights;
  int id = 0;
  for (const double y : {57.0, -57.0}) {
    for (const double x : {-90.0, 90.0}) {
      Fiducial& tag = rig.fiducials.emplace_back();
      tag.dictionary = "DICT_APRILTAG_36h11";
      tag.id = id++;
      const double h = kTag_mm / 2;
      tag.corners_mm = {Vec3{x - h, y + h, 0}, {x + h, y + h, 0}, {x + h, y - h, 0}, {x - h, y - h, 0}};
      add_patch(rig, x / 2, y);
      add_patch(rig, x, y / 2);
    }
  }
  return rig;
}

Mishap no_mishap(const Calibration& rig) {
  return {{}, {}, std::get<NearLights>(*rig.lights).leds};
}

static calibration::RigEvidence evidence_of(const Calibration& rig, const Mishap& mishap, std::uint64_t seed,
                                            bool with_sheet) {
  Random random(seed);
  const CameraModel camera = moved_camera(*rig.camera, mishap.camera);
  calibration::RigEvidence evidence;
  for (const Fiducial& fiducial : rig.fiducials) {
    calibration::TagSighting& tag = evidence.tags.emplace_back();
    tag.dictionary = fiducial.dictionary;
    tag.id = fiducial.id;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 p = project(camera, mishap.table(fiducial.corners_mm[i]));
      tag.corners_px[i] = {p.x + 0.05 * random.normal(), p.y + 0.05 * random.normal()};
    }
  }
  std::vector<double> flicker;
  for (std::size_t k = 0; k < mishap.leds.size(); ++k) flicker.push_back(1 + 0.001 * random.normal());
  for (const WhitePatch& patch : rig.patches) {
    const auto& p = patch.polygon_px;
    calibration::LitPlace& place = evidence.places.emplace_back();
    place.surface = static_cast<int>(evidence.places.size());
    place.reflectance_sigma = 0.01;
    place.reflectance_rgb = patch.reflectance_rgb;
    place.point_mm = point_on_plane(*rig.camera, (p[0][0] + p[2][0]) / 2, (p[0][1] + p[2][1]) / 2, 0);
    const double white = 0.88 * (1 + 0.003 * random.normal());
    read(place, mishap.table(place.point_mm), mishap, camera, white, flicker, random);
  }
  if (!with_sheet) return evidence;
  for (int i = 0; i < kColumns * kRows; ++i) {
    calibration::LitPlace& place = evidence.places.emplace_back();
    place.on_table = false;
    place.reflectance_sigma = 1;
    const Vec3 real = mishap.table({40.0 * (i % kColumns) - 80, 33.0 * (i / kColumns) - 50, 1});
    read(place, real, mishap, camera, 0.7, flicker, random);
    place.point_mm = inverse(mishap.camera)(real);
    place.normal = inverse(mishap.camera).rotation * (mishap.table.rotation * Vec3{0, 0, 1});
  }
  return evidence;
}

calibration::RigEvidence seen(const Calibration& rig, const Mishap& mishap, std::uint64_t seed) {
  return evidence_of(rig, mishap, seed, false);
}

calibration::RigEvidence seen_with_sheet(const Calibration& rig, const Mishap& mishap, std::uint64_t seed) {
  return evidence_of(rig, mishap, seed, true);
}

}  // namespace weft::test
