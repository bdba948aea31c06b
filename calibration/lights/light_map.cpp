// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/light_map.h"

#include <algorithm>
#include <cmath>

namespace weft::calibration {

std::size_t CellGrid::cell_of(double x_px, double y_px) const {
  const auto place = [](double at, int pixels, int count) {
    return std::clamp(static_cast<int>((at + 0.5) * count / pixels), 0, count - 1);
  };
  return static_cast<std::size_t>(place(y_px, frame.height, rows)) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(place(x_px, frame.width, columns));
}

std::array<double, 2> CellGrid::centre_px(std::size_t cell) const {
  const auto column = static_cast<double>(cell % static_cast<std::size_t>(columns));
  const auto row = static_cast<double>(cell / static_cast<std::size_t>(columns));
  return {(column + 0.5) * frame.width / columns - 0.5, (row + 0.5) * frame.height / rows - 0.5};
}

std::optional<CellLight> light_on_table(const CameraModel& camera, const NearLights& lights, std::size_t led,
                                        double x_px, double y_px) {
  const NearLight& light = lights.leds[led];
  const Vec3 to_led = light.position_mm - point_on_plane(camera, x_px, y_px, 0);
  const double d = length(to_led), along = -dot(to_led, light.aim) / d;
  if (!(d > 0 && along > 0 && to_led.z > 0)) return {};
  CellLight cell = {(1 / d) * to_led, {}};
  const auto [u, v] = frame_place(camera.size, x_px, y_px);
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    cell.intensity_rgb[channel] = light.flux_rgb[channel] * std::exp(lights.log_gain(led, c, u, v)) *
                                  std::pow(along, light.mu) / (d * d);
  }
  return cell;
}

std::vector<std::vector<std::size_t>> by_cell(std::span<const PaperReading> readings, const CellGrid& grid,
                                              std::size_t leds) {
  std::vector<std::vector<std::size_t>> cells(leds * grid.cells());
  for (std::size_t i = 0; i < readings.size(); ++i)
    cells[readings[i].led * grid.cells() + grid.cell_of(readings[i].x_px, readings[i].y_px)].push_back(i);
  return cells;
}

}  // namespace weft::calibration
