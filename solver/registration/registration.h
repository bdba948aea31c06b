// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/image.h"
#include "solver/method.h"
#include "solver/registration/cloth_shift.h"

// Between the shots of a session the cloth or the camera may move. Each shot is lit from elsewhere, so shots
// cannot be compared with each other; but the normal and albedo that explain them all predict each.

namespace weft::solver {

struct ShotRegistration {
  ClothShift shift;
  double sigma_px = 0;       ///< standard error of a component of the displacement, rms over the sample tiles
  double cost_deg = 0;       ///< rms angle by which the shift, left alone, turns the normals
  bool significant = false;  ///< the displacement is not explained by its error
};

struct Registration {
  std::vector<ShotRegistration> shots;  ///< by light of the field
  bool found = true;  ///< false: no alignment within kMostShift_px explains the shots; `shots` are not to be
                      ///< corrected by
};

/// No shift beyond this is looked for.
inline constexpr double kMostShift_px = 8;
/// What nothing was learnt about has this sigma_px: a shift of so much is taken to be likely beforehand.
inline constexpr double kUnknownShift_px = 4;
/// What shadow, bounces and gloss add to sigma_px: they look like a shift, the same on all of a cloth and so
/// in no scatter. The second a unit of the share of readings that are in shadow, set so that
/// the deep weave (a fifth in shadow) is still when it is.
inline constexpr double kModelShift_px = 0.02;
inline constexpr double kModelShiftOfShadow_px = 0.7;

/// Measures shift and turn of every shot on tiles of one frame (solver/sample_tiles.h): what aligns, in the
/// least-squares sense, each shot's green readings over strength with b . l_k of the b = rho n that explains
/// all of them. Gauss-Newton on shifts with b eliminated at every point (variable projection; Golub and
/// Pereyra 1973, with the Jacobian of Kaufman 1975), readings weighted by noise and Huber's function, those
/// in attached shadow left out. Greens are smoothed before they are compared, gradients taken of what is
/// smooth; what noise adds to their energy is subtracted, so that a cloth without features says so. The
/// standard errors come from the scatter between 16 blocks of each tile.
///
/// Shifts are against the median of all shots, component by component: the cloth as it lay most of the time.
/// Nothing can be told from three lights, nor from tiles under about 40 pixels.
Registration register_shots(std::span<const TileInput> tiles, Size frame, int threads);

}  // namespace weft::solver
