// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "core/rig/lights.h"
#include "simulator/camera/scene_camera.h"
#include "simulator/camera/sensor.h"
#include "simulator/scene/scene.h"

namespace weft::simulator {

/// What files say of the lens. The geometry is that of CameraSettings, which knows no size of a photosite.
inline constexpr double kFocalLength_mm = 50;

/// The virtual rig that a scene describes, in numbers.
struct SceneRig {
  NearLights leds;
  Sensor sensor;
  CameraModel camera;
  std::optional<Lens> lens;  ///< none where the camera is straight above and nothing bends its rays
  double exposure_us = 0;    ///< whole microseconds
  /// What of the mirrored light arrives over what of the scattered does. `leds` have the flux of their
  /// scattered light: with films before them and the lens, a quarter of their own.
  double lobe_share = 1;
  double room_share = 1;    ///< likewise of light from the room
  bool blade_lies = false;  ///< Scene::blade is over the cloth

  /// Signal of a reading of 1: seconds at ISO 100.
  double exposure(double iso) const { return exposure_us * 1e-6 * iso / 100; }
  /// Signal of each LED, by channel, on a white surface with an irradiance of 1.
  std::vector<Rgb> signal_of_unit(double iso) const;
  Vec3 camera_centre_mm() const;
};

/// What a tilted cloth sees of the rig: itself level, and the rig about it. kBadData where the camera does
/// not see that plane.
Result<SceneRig> seen_from_cloth(const Scene& scene, SceneRig rig);

/// SceneRig::lobe_share through films in one state; of kBoth crossed ones, which are taken first.
double lobe_share_of(const FilmSettings& films, FilmStates state);

/// Checks the scene, places its LEDs, its films in their first state and its camera, and chooses the
/// exposure. kBadData where no LED lights the table's centre, a LED or the camera is not above the cloth, the
/// camera does not see the table, a target or a filter cannot be used, or the exposure would not be between 1
/// us and 1000 s.
Result<SceneRig> rig_of(const Scene& scene);

/// Each LED as the distant light that it is at the table's centre, on the cloth's plane.
DistantLights distant_lights(const SceneRig& rig, double cloth_height_mm);

/// Exposure time that a bracket shot of the rig is taken with, whole microseconds; with `as_gathered` the one
/// that its light is that of, as its shutter is not exact.
double bracket_exposure_us(const RetakeSettings& retakes, const SceneRig& rig, bool as_gathered);

/// The defects that the scene's effects call for; those of the others are zero.
DefectSettings defects_of(const Scene& scene);

/// On the plane z = cloth_height_mm, of a camera straight above, without lens.
inline double mm_per_pixel_of_cloth(const Scene& scene) {
  const CameraSettings& c = scene.camera;
  return c.mm_per_pixel * (c.distance_mm - scene.geometry.cloth_height_mm) / c.distance_mm;
}

/// The point of that plane which a pixel of that camera sees.
inline Vec3 point_of_pixel(const Scene& scene, int x, int y) {
  const CameraSettings& c = scene.camera;
  const double height_mm = scene.geometry.cloth_height_mm, mm_per_pixel = mm_per_pixel_of_cloth(scene);
  return {(x - (c.width - 1) / 2.0) * mm_per_pixel, ((c.height - 1) / 2.0 - y) * mm_per_pixel, height_mm};
}

/// Everything about the rig as a perfect calibration would have it.
Calibration exact_calibration(const Scene& scene, const SceneRig& rig);

}  // namespace weft::simulator
