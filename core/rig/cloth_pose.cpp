// SPDX-License-Identifier: Apache-2.0
#include "core/rig/cloth_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace weft {
namespace {

Mat3 transposed(const Mat3& m) {
  return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

Mat3 product(const Mat3& a, const Mat3& b) {
  Mat3 result = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
    }
  }
  return result;
}

// The numbers of NAME.x, NAME.y and NAME.z, for each NAME that there is.
std::vector<std::array<std::size_t, 3>> vectors_of(const std::vector<std::string>& names) {
  std::vector<std::array<std::size_t, 3>> vectors;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].ends_with(".x")) continue;
    const std::string stem = names[i].substr(0, names[i].size() - 1);
    const auto y = std::ranges::find(names, stem + "y"), z = std::ranges::find(names, stem + "z");
    if (y == names.end() || z == names.end()) continue;
    vectors.push_back(
        {i, static_cast<std::size_t>(y - names.begin()), static_cast<std::size_t>(z - names.begin())});
  }
  return vectors;
}

}  // namespace

Mat3 rig_from_cloth(const ClothPose& pose) {
  if (pose.is_level()) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const double c = std::cos(radians(pose.tilt_deg)), s = std::sin(radians(pose.tilt_deg));
  const double u = std::cos(radians(pose.downhill_deg)), v = std::sin(radians(pose.downhill_deg));
  return {{{u * u * c + v * v, u * v * (c - 1), u * s},
           {u * v * (c - 1), v * v * c + u * u, v * s},
           {-u * s, -v * s, c}}};
}

Vec3 seen_from(const ClothPose& pose, double height_mm, Vec3 point_in_rig_mm) {
  const Vec3 centre = {0, 0, height_mm};
  return centre + transposed(rig_from_cloth(pose)) * (point_in_rig_mm - centre);
}

CameraModel seen_from(const ClothPose& pose, double height_mm, CameraModel camera) {
  const Mat3 turn = rig_from_cloth(pose);
  const Vec3 centre = {0, 0, height_mm};
  camera.camera_from_rig_translation_mm =
      camera.camera_from_rig_rotation * (centre - turn * centre) + camera.camera_from_rig_translation_mm;
  camera.camera_from_rig_rotation = product(camera.camera_from_rig_rotation, turn);
  return camera;
}

Lights seen_from(const ClothPose& pose, double height_mm, Lights lights) {
  const Mat3 cloth_from_rig = transposed(rig_from_cloth(pose));
  if (auto* distant = std::get_if<DistantLights>(&lights)) {
    for (DistantLight& light : distant->lights) light.direction = cloth_from_rig * light.direction;
  } else {
    for (NearLight& led : std::get<NearLights>(lights).leds) {
      led.position_mm = seen_from(pose, height_mm, led.position_mm);
      led.aim = cloth_from_rig * led.aim;
    }
  }
  return lights;
}

ParameterCovariance seen_from(const ClothPose& pose, ParameterCovariance covariance) {
  const Mat3 turn = transposed(rig_from_cloth(pose));
  const std::size_t count = covariance.parameters.size();
  const auto turned = [&](double* first, std::size_t stride, const std::array<std::size_t, 3>& at) {
    const Vec3 v = turn * Vec3{first[at[0] * stride], first[at[1] * stride], first[at[2] * stride]};
    first[at[0] * stride] = v.x;
    first[at[1] * stride] = v.y;
    first[at[2] * stride] = v.z;
  };
  for (const auto& at : vectors_of(covariance.parameters)) {
    for (std::size_t i = 0; i < count; ++i) turned(covariance.matrix.data() + i * count, 1, at);
    for (std::size_t i = 0; i < count; ++i) turned(covariance.matrix.data() + i, count, at);
  }
  return covariance;
}

}  // namespace weft
