// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "core/image/image.h"

namespace weft::material {

/// A parameter over a whole material: the same everywhere, or a map. Normals are slopes, 2 planes, as in
/// Surface; directions of yarns are 2 planes (a cos 2t, a sin 2t) of anisotropy a and azimuth t.
struct ParameterField {
  int planes = 1;
  std::array<double, 3> constant = {};  ///< of each plane, where `map` is empty
  Image<float> map = {};

  static ParameterField same(double value) { return {1, {value}, {}}; }
  static ParameterField same(const std::array<double, 3>& values, int planes) { return {planes, values, {}}; }
  static ParameterField of(Image<float> map) {
    const int planes = map.planes();
    return {planes, {}, std::move(map)};
  }

  bool is_map() const { return !map.empty(); }
  double at(int x, int y, int plane = 0) const {
    return is_map() ? double{map(x, y, plane)} : constant[static_cast<std::size_t>(plane)];
  }
};

/// A copy, which Image does not make unasked.
ParameterField copy_of(const ParameterField& field);

/// The mean of each plane, in double and in the order of rows.
std::array<double, 3> means_of(const ParameterField& field);

/// Slopes of a unit normal whose z is below that of 89 degrees count as of 89 degrees.
std::array<double, 2> slopes_of_normal(double x, double y, double z);

/// (a cos 2t, a sin 2t), and back with t from 0 to below 180; 0 where a is 0.
std::array<double, 2> axis_of(double anisotropy, double azimuth_deg);
struct YarnAxis {
  double anisotropy = 0, azimuth_deg = 0;
};
YarnAxis axis_from(double cosine, double sine);

}  // namespace weft::material
