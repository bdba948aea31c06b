// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/paper_model.h"

#include <algorithm>
#include <cmath>

namespace weft::calibration {

std::optional<PaperTerm> paper_term(const LineOfSight& sight, const NearLight& led, const Paper& paper,
                                    const Pose& pose) {
  const std::optional<Vec3> point = point_on_sheet(sight, pose);
  if (!point) return {};
  const Vec3 n = normal_of(pose), on = *point - pose.translation_mm;
  const Vec3 v = led.position_mm - *point;
  const double d = length(v), cosine = dot(n, v) / d, along = -dot(v, led.aim) / d;
  const double f = 1 - paper.delta * (1 - cosine);
  if (!(d > 0 && cosine > 0 && along > 0 && f > 0)) return {};

  const double U = dot(on, u_axis(pose)) / paper.half_width_mm;
  const double V = dot(on, v_axis(pose)) / paper.half_height_mm;
  const std::array<double, 5>& q = paper.log_albedo;
  PaperTerm term;
  term.by_log_albedo = {U, V, U * U, U * V, V * V};
  for (std::size_t i = 0; i < 5; ++i) term.log_value += q[i] * term.by_log_albedo[i];
  term.log_value += led.mu * std::log(along) + std::log(cosine * f) - 2 * std::log(d);
  term.by_mu = std::log(along);
  term.by_delta = -(1 - cosine) / f;
  term.by_aim = (led.mu / dot(v, led.aim)) * v;
  term.by_position = (led.mu / dot(v, led.aim)) * led.aim + (1 / dot(v, n)) * n -
                     ((led.mu + 3) / (d * d)) * v + (paper.delta / f / d) * (n - (cosine / d) * v);

  // The point slides along the line of sight as the sheet moves; the albedo moves with the sheet.
  const Vec3 by_normal = (1 / dot(v, n) + paper.delta / f / d) * v;
  const Vec3 by_place = ((q[0] + 2 * q[2] * U + q[3] * V) / paper.half_width_mm) * u_axis(pose) +
                        ((q[1] + q[3] * U + 2 * q[4] * V) / paper.half_height_mm) * v_axis(pose);
  const Vec3 w = sight.direction;
  const double slide = dot(by_place - term.by_position, w) / dot(n, w);
  term.by_centre = slide * n - by_place;
  term.by_turn = cross(n, by_normal) - slide * cross(n, on) - cross(on, by_place);
  return term;
}

std::array<double, 2> frame_place(Size frame, double x_px, double y_px) {
  return {2 * x_px / std::max(frame.width - 1, 1) - 1, 2 * y_px / std::max(frame.height - 1, 1) - 1};
}

std::optional<double> PaperScene::log_reading(std::size_t sheet, std::size_t led, int channel, double x_px,
                                              double y_px) const {
  const NearLight& light = lights.leds[led];
  const auto term = paper_term(sight_of(camera, x_px, y_px), light, paper, sheets[sheet].rig_from_sheet);
  if (!term) return {};
  const auto c = static_cast<std::size_t>(channel);
  const auto [u, v] = frame_place(camera.size, x_px, y_px);
  return term->log_value + std::log(light.flux_rgb[c] * paper.reflectance_rgb[c]) +
         lights.log_gain(led, channel, u, v) + shot_log_gain(sheet, led);
}

}  // namespace weft::calibration
