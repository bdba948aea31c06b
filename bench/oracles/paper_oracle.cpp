// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/paper_oracle.h"

#include <cmath>

#include "bench/oracles/oracle_rig.h"

namespace weft::test {
namespace {

// Turned about a unit axis.
Vec3 turned(Vec3 v, Vec3 axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         ((1 - std::cos(angle)) * dot(axis, v)) * axis;
}

// Axes of a sheet: u, v, n.
std::array<Vec3, 3> axes_of(const PaperRig::Lie& lie) {
  const double rotation = radians(lie.rotation_deg), azimuth = radians(lie.azimuth_deg);
  const Vec3 hinge = {-std::sin(azimuth), std::cos(azimuth), 0};
  std::array<Vec3, 3> axes = {
      {{std::cos(rotation), std::sin(rotation), 0}, {-std::sin(rotation), std::cos(rotation), 0}, {0, 0, 1}}};
  for (Vec3& axis : axes) axis = turned(axis, hinge, radians(lie.tilt_deg));
  return axes;
}

Vec3 random_direction(Random& random) {
  return normalized({random.normal(), random.normal(), random.normal()});
}

}  // namespace

double PaperRig::reading(std::size_t sheet, std::size_t led, std::size_t channel, double x_px,
                         double y_px) const {
  const auto [u, v, n] = axes_of(sheets[sheet]);
  const double x = x_px - (width_px - 1) / 2.0, y = (height_px - 1) / 2.0 - y_px;
  const Vec3 eye = {0, 0, distance_mm}, ray = {x * mm_per_pixel, y * mm_per_pixel, -distance_mm};
  const Vec3 centre = sheets[sheet].centre_mm;
  const Vec3 point = eye + (dot(n, centre - eye) / dot(n, ray)) * ray;
  const double U = dot(u, point - centre) / half_width_mm, V = dot(v, point - centre) / half_height_mm;
  const double albedo = std::exp(log_albedo[0] * U + log_albedo[1] * V + log_albedo[2] * U * U +
                                 log_albedo[3] * U * V + log_albedo[4] * V * V);
  const NearLight& light = lights.leds[led];
  const Vec3 to_led = light.position_mm - point;
  const double d = length(to_led);
  const Vec3 l = (1 / d) * to_led;
  const double fx = x / ((width_px - 1) / 2.0), fy = -y / ((height_px - 1) / 2.0);
  const auto& q = light.log_gain_quadratic;
  const double own = q[1] * fx + q[2] * fy + q[3] * fx * fx + q[4] * fx * fy + q[5] * fy * fy;
  const double shared = vignette * (fx * fx + fy * fy) / 2;
  return albedo * light.flux_rgb[channel] * std::exp(own + shared) *
         std::pow(std::max(0.0, -dot(l, light.aim)), light.mu) * std::max(0.0, dot(n, l)) *
         (1 - delta * (1 - dot(n, l))) / (d * d);
}

PaperRig common_rig() {
  PaperRig rig;
  rig.lights = ten_leds();
  Random random(7);
  for (NearLight& led : rig.lights.leds) {
    led.aim = normalized(led.aim + std::tan(radians(5)) * random.uniform() * random_direction(random));
    led.mu = 0.7 + 0.6 * random.uniform();
  }
  rig.vignette = std::log(0.8);
  rig.log_albedo = {0.002, -0.003, 0.004, 0.002, -0.002};
  rig.sheets = lies(5);
  return rig;
}

void give_gains(NearLights& lights, double sigma) {
  Random random(11);
  std::array<double, 6> mean = {};
  for (NearLight& led : lights.leds) {
    for (std::size_t i = 1; i < 6; ++i) {
      led.log_gain_quadratic[i] = sigma * random.normal();
      mean[i] += led.log_gain_quadratic[i] / static_cast<double>(lights.leds.size());
    }
  }
  for (NearLight& led : lights.leds) {
    for (std::size_t i = 1; i < 6; ++i) led.log_gain_quadratic[i] -= mean[i];
  }
}

std::vector<PaperRig::Lie> lies(int count, double tilt_deg) {
  std::vector<PaperRig::Lie> all = {{}};
  for (const double azimuth_deg : {0.0, 90.0, 180.0, 270.0, 45.0, 135.0, 225.0, 315.0})
    all.push_back({tilt_deg, azimuth_deg, 0, {}});
  all.resize(static_cast<std::size_t>(count));
  return all;
}

PaperCaptures captures_of(const PaperRig& rig, const PaperErrors& errors, int columns, int rows) {
  Random random(errors.seed);
  PaperCaptures captures;
  calibration::PaperScene& start = captures.start;
  start.camera = overhead_camera({rig.width_px, rig.height_px}, rig.distance_mm, rig.mm_per_pixel);
  start.paper.half_width_mm = rig.half_width_mm;
  start.paper.half_height_mm = rig.half_height_mm;
  for (const NearLight& led : rig.lights.leds) {
    NearLight taped;
    taped.position_mm = led.position_mm + errors.tape_mm * random_direction(random);
    taped.aim = normalized(-1.0 * taped.position_mm);
    start.lights.leds.push_back(taped);
  }
  for (const PaperRig::Lie& lie : rig.sheets) {
    auto axes = axes_of(lie);
    const Vec3 turn = radians(errors.turn_deg) * Vec3{random.normal(), random.normal(), random.normal()};
    for (Vec3& axis : axes) axis = length(turn) > 0 ? turned(axis, normalized(turn), length(turn)) : axis;
    const auto& [u, v, n] = axes;
    calibration::SheetPose& pose = start.sheets.emplace_back();
    pose.rig_from_sheet.rotation = {{{u.x, v.x, n.x}, {u.y, v.y, n.y}, {u.z, v.z, n.z}}};
    pose.rig_from_sheet.translation_mm =
        lie.centre_mm + errors.shift_mm * Vec3{random.normal(), random.normal(), random.normal()};
    for (std::size_t i = 0; i < 6; ++i) {
      const double sigma = i < 3 ? radians(errors.turn_deg) : errors.shift_mm;
      pose.covariance[7 * i] = sigma * sigma;
    }
  }
  Random flickering(errors.seed + 1000);
  for (std::size_t j = 0; j < rig.sheets.size(); ++j) {
    for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
      const double shot = 1 + errors.flicker * flickering.normal();
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
          calibration::PaperReading reading = {
              j,  k, (column + 0.5) * rig.width_px / columns - 0.5, (row + 0.5) * rig.height_px / rows - 0.5,
              {}, {}};
          for (std::size_t c = 0; c < 3; ++c) {
            reading.reading_rgb[c] = rig.reading(j, k, c, reading.x_px, reading.y_px) * shot *
                                     (1 + errors.noise * random.normal());
            reading.relative_sigma[c] = errors.noise;
          }
          captures.readings.push_back(reading);
        }
      }
    }
  }
  return captures;
}

double position_error_mm(const NearLights& found, const NearLights& truth) {
  double sum = 0;
  for (std::size_t k = 0; k < truth.leds.size(); ++k) {
    const Vec3 off = found.leds[k].position_mm - truth.leds[k].position_mm;
    sum += dot(off, off) / 3;
  }
  return std::sqrt(sum / static_cast<double>(truth.leds.size()));
}

double direction_error_deg(const NearLights& found, const NearLights& truth) {
  double sum = 0;
  for (std::size_t k = 0; k < truth.leds.size(); ++k) {
    const double angle = angle_deg(found.leds[k].position_mm, truth.leds[k].position_mm);
    sum += angle * angle;
  }
  return std::sqrt(sum / static_cast<double>(truth.leds.size()));
}

}  // namespace weft::test
