// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/linear.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/kernels/linear_row.h"
#include "solver/normals/pixelwise.h"
#include "solver/reference/pixel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/kernels/linear.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#include "solver/kernels/linear-inl.h"

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(solve_mosaic_row);
HWY_EXPORT(solve_rgb_row);
HWY_EXPORT(solve_bare_row);

namespace {

// Float copies of what a row kernel needs of each light.
std::vector<RowLight> row_lights(const LightField& field) {
  std::vector<RowLight> lights;
  if (const auto* distant = std::get_if<DistantLights>(&field.lights())) {
    for (const DistantLight& light : distant->lights) {
      RowLight row;
      row.distant = true;
      row.position[0] = static_cast<float>(light.direction.x);
      row.position[1] = static_cast<float>(light.direction.y);
      row.position[2] = static_cast<float>(light.direction.z);
      for (std::size_t c = 0; c < 3; ++c)
        row.inverse_flux[c] = static_cast<float>(1 / light.irradiance_rgb[c]);
      lights.push_back(row);
    }
    return lights;
  }
  for (const NearLight& led : std::get<NearLights>(field.lights()).leds) {
    RowLight row;
    row.position[0] = static_cast<float>(led.position_mm.x);
    row.position[1] = static_cast<float>(led.position_mm.y);
    row.position[2] = static_cast<float>(led.position_mm.z - field.cloth_height_mm());
    row.aim[0] = static_cast<float>(led.aim.x);
    row.aim[1] = static_cast<float>(led.aim.y);
    row.aim[2] = static_cast<float>(led.aim.z);
    row.mu = static_cast<float>(led.mu);
    for (std::size_t c = 0; c < 3; ++c) row.inverse_flux[c] = static_cast<float>(1 / led.flux_rgb[c]);
    lights.push_back(row);
  }
  return lights;
}

RowPoints points_of(const LightField::Row& row) {
  const auto line = [&](const LightField::RowLine& l) {
    return l.value.empty() ? RowLinePointer{} : RowLinePointer{l.value.data(), l.step.data()};
  };
  RowPoints points;
  points.x_mm = line(row.x_mm);
  points.y_mm = line(row.y_mm);
  for (std::size_t c = 0; c < 3; ++c) points.gain_rgb[c] = line(row.gain_rgb[c]);
  for (const LightField::RowLine& l : row.led_gain) points.led_gain.push_back(line(l));
  return points;
}

}  // namespace

void solve_linear(const TileInput& input, const TileOutput& output, const LinearOptions& options) {
  const auto planes = static_cast<std::size_t>(input.planes);
  const std::vector<RowLight> lights = row_lights(*input.field);
  std::vector<float> scratch(row_scratch_floats(lights.size()));
  std::vector<const float*> readings(input.readings.size());
  std::vector<PixelRow> pixel_rows(lights.size());
  PixelSolver solve_in_double({input.planes, options.shadow_mask, input.noise});
  LightField::Row line;

  RowTask task;
  task.lights = lights.data();
  task.light_count = lights.size();
  task.readings = readings.data();
  task.scratch = scratch.data();
  task.width = static_cast<std::size_t>(input.tile.width());
  task.shadow_mask = options.shadow_mask;
  task.bright_rank = static_cast<std::size_t>(std::max(bright_rank(lights.size()), kLeastKept));
  task.bright_index = static_cast<std::size_t>(bright_rank(lights.size())) - 1;
  task.has_noise = input.noise.has_value();
  if (input.noise) {
    task.noise_per_reading = static_cast<float>(input.noise->per_reading);
    task.noise_floor = static_cast<float>(input.noise->floor);
    task.noise_shared = static_cast<float>(input.noise->shared);
    task.dark_reading = static_cast<float>(3 * std::sqrt(input.noise->floor + input.noise->shared));
  }
  for (int y = 0; y < input.tile.height(); ++y) {
    const int py = input.tile.y0 + y;
    input.field->read_row(py, input.tile.x0, input.tile.x1, line);
    const RowPoints points = points_of(line);
    task.points = &points;
    for (std::size_t i = 0; i < readings.size(); ++i) readings[i] = input.readings[i].row(y);
    for (std::size_t c = 0; c < 3; ++c) task.normal[c] = output.normal[c].row(y);
    for (std::size_t p = 0; p < planes; ++p) {
      task.albedo[p] = output.albedo[p].row(y);
      task.sigma_albedo[p] = output.sigma_albedo[p].row(y);
    }
    task.sigma_normal_deg = output.sigma_normal_deg.row(y);
    task.residual = output.residual.row(y);
    task.status = output.status.row(y);
    if (planes == 1) {
      task.channel[0] = static_cast<std::size_t>(input.cfa.channel_at(input.tile.x0, py));
      task.channel[1] = static_cast<std::size_t>(input.cfa.channel_at(input.tile.x0 + 1, py));
    }
    const bool again = planes == 1 ? HWY_DYNAMIC_DISPATCH(solve_mosaic_row)(task)
                                   : HWY_DYNAMIC_DISPATCH(solve_rgb_row)(task);
    if (!again) continue;
    for (int x = 0; x < input.tile.width(); ++x) {
      if (!(task.status[x] & kSolveAgain)) continue;
      read_pixel(input, x, y, pixel_rows);
      write_pixel(solve_in_double.solve(pixel_rows), input.planes, output, x, y);
    }
  }
}

void solve_bare(Rect tile, std::span<const View<const float>> readings, const LightField& field,
                const std::array<View<float>, 3>& normal, const std::array<View<float>, 3>& albedo) {
  const std::vector<RowLight> lights = row_lights(field);
  std::vector<const float*> rows(readings.size());
  LightField::Row line;
  RowTask task;
  task.lights = lights.data();
  task.light_count = lights.size();
  task.readings = rows.data();
  task.width = static_cast<std::size_t>(tile.width());
  for (int y = 0; y < tile.height(); ++y) {
    field.read_row(tile.y0 + y, tile.x0, tile.x1, line);
    const RowPoints points = points_of(line);
    task.points = &points;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = readings[i].row(y);
    for (std::size_t c = 0; c < 3; ++c) {
      task.normal[c] = normal[c].row(y);
      task.albedo[c] = albedo[c].row(y);
    }
    HWY_DYNAMIC_DISPATCH(solve_bare_row)(task);
  }
}

}  // namespace weft::solver
#endif
