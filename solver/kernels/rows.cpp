// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/rows.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "solver/in_double/pixelwise.h"

namespace weft::solver {
namespace {

// What one thread keeps from tile to tile, so that tiles allocate nothing.
struct Workspace {
  std::vector<RowLight> lights;
  std::vector<float> scratch;
  std::vector<const float*> readings;
  std::vector<PixelRow> pixel_rows;
  RowPoints points;

  void reset(const TileInput& input) {
    write_row_lights(*input.field, lights);
    scratch.resize(row_scratch_floats(lights.size()));
    readings.resize(input.readings.size());
    pixel_rows.assign(lights.size(), {});
  }
};

RowLinePointer pointer_to(const LightField::RowLine& line) {
  return line.value.empty() ? RowLinePointer{} : RowLinePointer{line.value.data(), line.step.data()};
}

RowTask task_of(const TileInput& input, const PixelOptions& options) {
  const std::size_t lights = input.field->count();
  RowTask task;
  task.light_count = lights;
  task.width = static_cast<std::size_t>(input.tile.width());
  task.shadow_mask = options.shadow_mask;
  task.bright_rank = static_cast<std::size_t>(std::max(bright_rank(lights), kLeastKept));
  task.bright_index = static_cast<std::size_t>(bright_rank(lights)) - 1;
  task.estimator = options.estimator;
  task.trim_from = static_cast<float>(options.trim_from);
  for (std::size_t p = 0; p < 3; ++p) task.plane_weight[p] = static_cast<float>(options.plane_weights[p]);
  task.has_noise = input.planes == 1 && options.noise.has_value();
  if (task.has_noise) {
    task.noise_per_reading = static_cast<float>(options.noise->per_reading);
    task.noise_floor = static_cast<float>(options.noise->floor);
    task.noise_shared = static_cast<float>(options.noise->shared);
    task.dark_reading =
        static_cast<float>(kDarkSigmas * std::sqrt(options.noise->floor + options.noise->shared));
  }
  return task;
}

void point_to_row(const TileInput& input, const TileOutput& output, int y, RowTask& task) {
  const auto planes = static_cast<std::size_t>(input.planes);
  for (std::size_t c = 0; c < 3; ++c) task.normal[c] = output.normal[c].row(y);
  for (std::size_t p = 0; p < planes; ++p) {
    task.albedo[p] = output.albedo[p].row(y);
    task.sigma_albedo[p] = output.sigma_albedo[p].row(y);
  }
  task.sigma_normal_deg = output.sigma_normal_deg.row(y);
  task.residual = output.residual.row(y);
  task.status = output.status.row(y);
  if (planes == 1) {
    const int py = input.tile.y0 + y;
    task.channel[0] = static_cast<std::size_t>(input.cfa.channel_at(input.tile.x0, py));
    task.channel[1] = static_cast<std::size_t>(input.cfa.channel_at(input.tile.x0 + 1, py));
  }
}

}  // namespace

void write_row_lights(const LightField& field, std::vector<RowLight>& rows) {
  rows.clear();
  if (const auto* distant = std::get_if<DistantLights>(&field.lights())) {
    for (const DistantLight& light : distant->lights) {
      RowLight& row = rows.emplace_back();
      row.distant = true;
      row.position[0] = static_cast<float>(light.direction.x);
      row.position[1] = static_cast<float>(light.direction.y);
      row.position[2] = static_cast<float>(light.direction.z);
      for (std::size_t c = 0; c < 3; ++c)
        row.inverse_flux[c] = static_cast<float>(1 / light.irradiance_rgb[c]);
    }
    return;
  }
  for (const NearLight& led : std::get<NearLights>(field.lights()).leds) {
    RowLight& row = rows.emplace_back();
    row.position[0] = static_cast<float>(led.position_mm.x);
    row.position[1] = static_cast<float>(led.position_mm.y);
    row.position[2] = static_cast<float>(led.position_mm.z - field.cloth_height_mm());
    row.against_aim[0] = static_cast<float>(-led.aim.x);
    row.against_aim[1] = static_cast<float>(-led.aim.y);
    row.against_aim[2] = static_cast<float>(-led.aim.z);
    row.mu = static_cast<float>(led.mu);
    for (std::size_t c = 0; c < 3; ++c) row.inverse_flux[c] = static_cast<float>(1 / led.flux_rgb[c]);
  }
}

void RowPoints::read(const LightField& field, int y, int x0, int x1) {
  // What the field does not write is left from another one.
  row.x_mm.value.clear();
  row.y_mm.value.clear();
  field.read_row(y, x0, x1, row);
  x_mm = pointer_to(row.x_mm);
  y_mm = pointer_to(row.y_mm);
  led_gain.clear();
  if (!field.has_gain()) return;
  for (std::size_t c = 0; c < 3; ++c) gain_rgb[c] = pointer_to(row.gain_rgb[c]);
  for (const LightField::RowLine& line : row.led_gain) led_gain.push_back(pointer_to(line));
}

void solve_rows(const TileInput& input, const TileOutput& output, const PixelOptions& options,
                bool (*row_kernel)(RowTask&)) {
  thread_local Workspace w;
  w.reset(input);
  std::optional<PixelSolver> solver_in_double;
  RowTask task = task_of(input, options);
  task.lights = w.lights.data();
  task.points = &w.points;
  task.readings = w.readings.data();
  task.scratch = w.scratch.data();
  std::int64_t in_double = 0;
  for (int y = 0; y < input.tile.height(); ++y) {
    w.points.read(*input.field, input.tile.y0 + y, input.tile.x0, input.tile.x1);
    for (std::size_t i = 0; i < w.readings.size(); ++i) w.readings[i] = input.readings[i].row(y);
    point_to_row(input, output, y, task);
    if (!row_kernel(task)) continue;
    for (int x = 0; x < input.tile.width(); ++x) {
      if (!(task.status[x] & kSolveAgain)) continue;
      if (!solver_in_double) solver_in_double.emplace(options);
      read_pixel(input, x, y, w.pixel_rows);
      write_pixel(solver_in_double->solve(w.pixel_rows), input.planes, output, x, y);
      ++in_double;
    }
  }
  if (output.tally == nullptr) return;
  output.tally->by_kernel += static_cast<std::int64_t>(input.tile.pixels()) - in_double;
  output.tally->rejected_readings += task.rejected;
}

}  // namespace weft::solver
