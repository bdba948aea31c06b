// SPDX-License-Identifier: Apache-2.0
#include "calibration/checks/flatness.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/checks/light_at.h"
#include "calibration/lights/paper_model.h"
#include "calibration/lights/sheet.h"

namespace weft::calibration {
namespace {

constexpr double kLeastCosine = 0.05;

/// Albedo times normal, by channel.
using Solved = std::array<Vec3, 3>;

Vec3 slope(Vec3 normal) {
  return {-normal.x / normal.z, -normal.y / normal.z, 0};
}

/// Nothing with fewer than three LEDs, or lights in one plane.
std::optional<Solved> solved(const NearLights& lights, Size frame, const SheetSquare& square, Vec3 point_mm,
                             Vec3 normal, double delta) {
  const auto [u, v] = frame_place(frame, square.x_px, square.y_px);
  Solved out;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    int used = 0;
    for (std::size_t k = 0; k < std::min(lights.leds.size(), square.reading_rgb.size()); ++k) {
      const double reading = square.reading_rgb[k][channel];
      const auto light = light_at(lights.leds[k], point_mm);
      if (!light || !(reading > 0) || !std::isfinite(reading)) continue;
      const double cosine = dot(normal, light->direction);
      const double flux = lights.leds[k].flux_rgb[channel];
      if (cosine < kLeastCosine || !(flux > 0)) continue;
      const double strength = flux * std::exp(light->log_geometry + lights.log_gain(k, c, u, v));
      // Photon noise: the weight of a reading is its inverse.
      const double weight = strength / reading;
      const double shading = reading / strength / (1 - delta * (1 - cosine));
      const Eigen::Vector3d l(light->direction.x, light->direction.y, light->direction.z);
      a += weight * l * l.transpose();
      b += weight * shading * l;
      ++used;
    }
    const Eigen::LDLT<Eigen::Matrix3d> factor(a);
    if (used < 3 || factor.rcond() < 1e-9) return std::nullopt;
    const Eigen::Vector3d x = factor.solve(b);
    if (!x.allFinite() || !(x[2] > 0)) return std::nullopt;
    out[channel] = {x[0], x[1], x[2]};
  }
  return out;
}

}  // namespace

SheetCheck check_sheet(const CameraModel& camera, const NearLights& lights, const SheetEvidence& evidence) {
  SheetCheck check;
  check.error_deg.assign(static_cast<std::size_t>(evidence.columns) * static_cast<std::size_t>(evidence.rows),
                         std::numeric_limits<double>::quiet_NaN());
  const Vec3 expected = evidence.known_normal.value_or(normal_of(evidence.rig_from_sheet));
  std::vector<Vec3> normals;
  Vec3 sum;
  for (const SheetSquare& square : evidence.squares) {
    const auto point = point_on_sheet(sight_of(camera, square.x_px, square.y_px), evidence.rig_from_sheet);
    if (!point) continue;
    const auto found = solved(lights, camera.size, square, *point, expected, evidence.paper_delta);
    if (!found) continue;
    Vec3 mean;
    for (std::size_t c = 0; c < 3; ++c) {
      mean = mean + normalized((*found)[c]);
      check.reflectance_rgb[c] += length((*found)[c]);
    }
    const Vec3 normal = normalized(mean);
    normals.push_back(normal);
    sum = sum + normal;
    const double off = angle_deg(normal, expected);
    check.error_deg[static_cast<std::size_t>(square.row) * static_cast<std::size_t>(evidence.columns) +
                    static_cast<std::size_t>(square.column)] = off;
    check.rms_deg += off * off;
    check.worst_deg = std::max(check.worst_deg, off);
  }
  check.squares = static_cast<int>(normals.size());
  check.tilt_deg = angle_deg(expected, {0, 0, 1});
  check.normal_sigma_deg = evidence.normal_sigma_deg;
  if (normals.empty()) return check;
  const auto n = static_cast<double>(normals.size());
  check.rms_deg = std::sqrt(check.rms_deg / n);
  for (double& r : check.reflectance_rgb) r /= n;
  const Vec3 mean = normalized(sum);
  double along = 0;
  const Vec3 true_slope = slope(expected);
  for (const Vec3 normal : normals) {
    const double off = angle_deg(normal, mean);
    check.pattern_rms_deg += off * off / n;
    along += dot(slope(normal), true_slope) / n;
  }
  check.pattern_rms_deg = std::sqrt(check.pattern_rms_deg);
  if (check.tilt_deg < kTiltedFrom_deg) return check;
  const double tilt = radians(check.tilt_deg);
  check.slope_gain = along / dot(true_slope, true_slope);
  // A normal off by an angle changes tan(tilt) by that over cos^2.
  check.slope_gain_sigma = radians(evidence.normal_sigma_deg) / (std::sin(tilt) * std::cos(tilt));
  return check;
}

}  // namespace weft::calibration
