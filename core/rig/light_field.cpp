// SPDX-License-Identifier: Apache-2.0
#include "core/rig/light_field.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {
namespace {

Error bad_lights(std::string where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "lights cannot be solved with", std::move(where), std::move(why),
          std::move(remedy)};
}

bool any_gain(const NearLights& near) {
  const auto nonzero = [](double v) { return v != 0; };
  return std::any_of(near.log_gain_rgb.begin(), near.log_gain_rgb.end(),
                     [&](const GainSpline& s) {
                       return std::any_of(s.coefficients.begin(), s.coefficients.end(), nonzero);
                     }) ||
         std::any_of(near.leds.begin(), near.leds.end(), [&](const NearLight& led) {
           return std::any_of(led.log_gain_quadratic.begin(), led.log_gain_quadratic.end(), nonzero);
         });
}

Result<void> check_rank(const LightField& field, Size size) {
  const int right = size.width - 1, bottom = size.height - 1;
  struct Place {
    int x, y;
    const char* name;
  };
  const std::array<Place, 5> places = {{{right / 2, bottom / 2, "centre"},
                                        {0, 0, "top left corner"},
                                        {right, 0, "top right corner"},
                                        {0, bottom, "bottom left corner"},
                                        {right, bottom, "bottom right corner"}}};
  for (const Place& place : places) {
    std::vector<Vec3> directions;
    for (std::size_t k = 0; k < field.count(); ++k) {
      const LightField::Light light = field.at(k, 1, place.x, place.y);
      if (light.strength > 0) directions.push_back(light.direction);
    }
    const double condition = condition_number(directions);
    if (!(condition < kIllConditionedFrom)) {
      return bad_lights(
          fmt::format("{} of the frame", place.name),
          fmt::format("the directions of {} lights have condition number {:.3g}, so one component of the "
                      "normal is not lit",
                      directions.size(), condition),
          "use lights that do not lie in one plane with the cloth point");
    }
  }
  return {};
}

}  // namespace

double condition_number(const std::vector<Vec3>& directions) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  for (const Vec3& l : directions) {
    const Eigen::Vector3d v(l.x, l.y, l.z);
    g += v * v.transpose();
  }
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(g, Eigen::EigenvaluesOnly).eigenvalues();
  // Below this share of the largest one an eigenvalue of the normal matrix is rounding.
  if (!(eigenvalues[0] > 1e-15 * eigenvalues[2])) return std::numeric_limits<double>::infinity();
  return std::sqrt(eigenvalues[2] / eigenvalues[0]);
}

Result<LightField> LightField::make(Lights lights, const std::optional<CameraModel>& camera, Size size,
                                    double cloth_height_mm) {
  LightField field;
  field.lights_ = std::move(lights);
  field.cloth_height_mm_ = cloth_height_mm;
  if (field.count() < 3) {
    return bad_lights(fmt::format("{} lights", field.count()), "a normal and an albedo are three unknowns",
                      "give at least three lights");
  }
  if (const auto* near = std::get_if<NearLights>(&field.lights_)) {
    if (!camera) {
      return bad_lights("camera", "near lights need to know where each pixel looks",
                        "calibrate the camera first");
    }
    for (std::size_t k = 0; k < near->leds.size(); ++k) {
      if (near->leds[k].position_mm.z <= cloth_height_mm + 1) {
        return bad_lights(fmt::format("LED {}", k + 1),
                          fmt::format("it is {:.1f} mm above the table and the cloth {:.1f} mm",
                                      near->leds[k].position_mm.z, cloth_height_mm),
                          "correct the LED's position or the session's cloth_height_mm");
      }
    }
    field.columns_ = size.width / kCell + 2;
    const int rows = size.height / kCell + 2;
    const bool gain = any_gain(*near);
    // Exactly what the grid takes, so that a sanitizer sees a read beyond it.
    const auto points = static_cast<std::size_t>(field.columns_) * static_cast<std::size_t>(rows);
    for (Grid* grid : {&field.x_mm_, &field.y_mm_}) grid->reserve(points);
    if (gain) field.led_gain_.resize(near->leds.size());
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < field.columns_; ++i) {
        const Vec3 p = point_on_plane(*camera, i * kCell, j * kCell, cloth_height_mm);
        // Behind the camera, past the horizon or where the lens folds, the point is not the one the pixel
        // sees.
        const Vec3 back = project(*camera, p);
        if (!(back.z > 0 && std::hypot(back.x - i * kCell, back.y - j * kCell) < 0.01)) {
          return bad_lights("camera",
                            fmt::format("pixel ({}, {}) does not look at the table", i * kCell, j * kCell),
                            "calibrate the camera again");
        }
        field.x_mm_.push_back(p.x);
        field.y_mm_.push_back(p.y);
        if (!gain) continue;
        const double u = 2.0 * i * kCell / std::max(size.width - 1, 1) - 1;
        const double v = 2.0 * j * kCell / std::max(size.height - 1, 1) - 1;
        for (std::size_t c = 0; c < 3; ++c)
          field.gain_rgb_[c].push_back(std::exp(near->log_gain_rgb[c].at(u, v)));
        for (std::size_t k = 0; k < near->leds.size(); ++k) {
          const double shared = near->log_gain_rgb[0].at(u, v);
          field.led_gain_[k].push_back(std::exp(near->log_gain(k, 0, u, v) - shared));
        }
      }
    }
  }
  if (Result<void> ranked = check_rank(field, size); !ranked) return std::move(ranked).error();
  return field;
}

double LightField::sample(const Grid& grid, int x, int y) const {
  const int rows = static_cast<int>(grid.size()) / columns_;
  const int i = std::min(x / kCell, columns_ - 2), j = std::min(y / kCell, rows - 2);
  const double fx = static_cast<double>(x - i * kCell) / kCell,
               fy = static_cast<double>(y - j * kCell) / kCell;
  const double* upper = grid.data() + std::ptrdiff_t{j} * columns_ + i;
  const double* lower = upper + columns_;
  const double left = upper[0] + fy * (lower[0] - upper[0]);
  const double right = upper[1] + fy * (lower[1] - upper[1]);
  return left + fx * (right - left);
}

LightField::Light LightField::at(std::size_t k, int c, int x, int y) const {
  const auto channel = static_cast<std::size_t>(c);
  if (const auto* distant = std::get_if<DistantLights>(&lights_)) {
    return {distant->lights[k].direction, distant->lights[k].irradiance_rgb[channel]};
  }
  const NearLight& led = std::get<NearLights>(lights_).leds[k];
  const Vec3 to_led = led.position_mm - Vec3{sample(x_mm_, x, y), sample(y_mm_, x, y), cloth_height_mm_};
  const double d2 = dot(to_led, to_led);
  const Vec3 l = (1 / std::sqrt(d2)) * to_led;
  const double lobe = std::pow(std::max(0.0, -dot(l, led.aim)), led.mu);
  const double gain = has_gain() ? sample(gain_rgb_[channel], x, y) * sample(led_gain_[k], x, y) : 1.0;
  return {l, led.flux_rgb[channel] * gain * lobe / d2};
}

void LightField::blend(const Grid& grid, int y, int first_cell, int cells, RowLine& line) const {
  const double fy = static_cast<double>(y % kCell) / kCell;
  const double* upper = grid.data() + std::ptrdiff_t{y / kCell} * columns_ + first_cell;
  const double* lower = upper + columns_;
  line.value.resize(static_cast<std::size_t>(cells));
  line.step.resize(static_cast<std::size_t>(cells));
  double left = upper[0] + fy * (lower[0] - upper[0]);
  for (int i = 0; i < cells; ++i) {
    const double right = upper[i + 1] + fy * (lower[i + 1] - upper[i + 1]);
    line.value[static_cast<std::size_t>(i)] = static_cast<float>(left);
    line.step[static_cast<std::size_t>(i)] = static_cast<float>((right - left) / kCell);
    left = right;
  }
}

void LightField::read_row(int y, int x0, int x1, Row& row) const {
  if (std::holds_alternative<DistantLights>(lights_)) return;
  const int first = x0 / kCell, cells = (x1 + kCell - 1) / kCell - first;
  blend(x_mm_, y, first, cells, row.x_mm);
  blend(y_mm_, y, first, cells, row.y_mm);
  if (!has_gain()) return;
  for (std::size_t c = 0; c < 3; ++c) blend(gain_rgb_[c], y, first, cells, row.gain_rgb[c]);
  row.led_gain.resize(led_gain_.size());
  for (std::size_t k = 0; k < led_gain_.size(); ++k) blend(led_gain_[k], y, first, cells, row.led_gain[k]);
}

}  // namespace weft
