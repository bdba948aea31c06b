// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calibration/lights/paper_model.h"
#include "core/base/vec.h"
#include "core/image/image.h"

namespace weft::calibration {

/// Cells that a frame is divided into.
struct CellGrid {
  Size frame;
  int columns = 26;
  int rows = 17;

  std::size_t cells() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t cell_of(double x_px, double y_px) const;
  /// Pixel coordinates of a cell's centre.
  std::array<double, 2> centre_px(std::size_t cell) const;
};

/// What one LED gives on the table, cell by cell: no model of a LED, only numbers. An intensity is the
/// reading of a white surface that faces the light; 0 where nothing is known.
struct LightMap {
  std::vector<Vec3> direction;  ///< unit, from the table to the light
  std::vector<std::array<double, 3>> intensity_rgb;
};

/// What a model of LEDs says of one cell's centre on the table.
struct CellLight {
  Vec3 direction;
  std::array<double, 3> intensity_rgb;
};
std::optional<CellLight> light_on_table(const CameraModel& camera, const NearLights& lights, std::size_t led,
                                        double x_px, double y_px);

/// The readings by LED and cell: indices into `readings`, [led * cells + cell].
std::vector<std::vector<std::size_t>> by_cell(std::span<const PaperReading> readings, const CellGrid& grid,
                                              std::size_t leds);

}  // namespace weft::calibration
