// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/image/image.h"
#include "core/rig/light_field.h"
#include "solver/method.h"

namespace weft::solver {

struct LinearOptions {
  bool shadow_mask = false;
};

/// Least squares on equilibrated rows over one tile, in float32 vectors: light directions computed in
/// registers, one factorisation for all right-hand sides. Its truth is solve_pixel
/// (solver/in_double/pixel.h), to which it also hands every pixel that float32 cannot answer for.
void solve_linear(const TileInput& input, const TileOutput& output, const LinearOptions& options);

/// The same equations and nothing else, to show what everything else costs: RGB readings, near lights without
/// lobe or gain, every reading taken, normal and albedo out. `readings[k * 3 + c]` and the outputs cover the
/// whole tile.
void solve_bare(Rect tile, std::span<const View<const float>> readings, const LightField& field,
                const std::array<View<float>, 3>& normal, const std::array<View<float>, 3>& albedo);

}  // namespace weft::solver
