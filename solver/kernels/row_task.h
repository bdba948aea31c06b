// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/rig/light_field.h"
#include "solver/in_double/pixel.h"

// What the row kernels are given: plain pointers, so that one definition serves every target.

namespace weft::solver {

struct RowLight {
  bool distant = false;
  float position[3] = {};     ///< mm above the cloth plane; the direction of a distant light
  float against_aim[3] = {};  ///< minus the aim
  float mu = 0;
  float inverse_flux[3] = {};  ///< 1 / Phi_c
};

/// A quantity along the row: value[i] + step[i] * (x - 16 i) in cell i.
struct RowLinePointer {
  const float* value = nullptr;
  const float* step = nullptr;
};

struct RowPoints {
  LightField::Row row;  ///< what the pointers point to
  RowLinePointer x_mm, y_mm;
  std::array<RowLinePointer, 3> gain_rgb;
  std::vector<RowLinePointer> led_gain;  ///< empty: no gains

  void read(const LightField& field, int y, int x0, int x1);
};

/// Set in `status` by a row kernel for pixels that must be solved again in double.
inline constexpr std::uint16_t kSolveAgain = 1 << 15;

struct RowTask {
  const RowLight* lights = nullptr;
  std::size_t light_count = 0;
  const RowPoints* points = nullptr;
  const float* const* readings = nullptr;  ///< [k * planes + p]
  float* scratch = nullptr;                ///< row_scratch_floats()
  std::size_t width = 0;
  std::size_t channel[2] = {};  ///< of even and odd columns of a mosaic
  float plane_weight[3] = {};   ///< of RGB

  bool shadow_mask = false;
  std::size_t bright_rank = 0;   ///< how many of the brightest readings are kept sorted
  std::size_t bright_index = 0;  ///< which of them is "bright"

  Estimator estimator = Estimator::kLeastSquares;
  float trim_from = 0;
  std::int64_t rejected = 0;  ///< readings that the kernel rejected so far

  bool has_noise = false;
  float noise_per_reading = 0;
  float noise_floor = 0;
  float noise_shared = 0;
  float dark_reading = 0;  ///< readings up to here do not stand out of the noise

  float* normal[3] = {};
  float* albedo[3] = {};
  float* sigma_albedo[3] = {};
  float* sigma_normal_deg = nullptr;
  float* residual = nullptr;
  std::uint16_t* status = nullptr;
};

/// With more lights than this, pixels whose readings scatter are trimmed in double.
inline constexpr std::size_t kMostTrimmedLights = 15;

/// Vectors that a light needs: direction, sum of the planes, 1 / e, three planes, what the shadow mask left
/// out, weight.
inline constexpr std::size_t kRowScratchSlots = 10;
/// Those of every light, and one of the sorted list.
inline std::size_t row_scratch_floats(std::size_t lights) {
  constexpr std::size_t kMostLanes = 64;
  return lights * (kRowScratchSlots + 1) * kMostLanes;
}

}  // namespace weft::solver
