// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/image/image.h"
#include "solver/method.h"

// Between the shots of a session the cloth or the camera may move. Each shot is lit from elsewhere, so shots
// cannot be compared with each other; but the normal and albedo that explain them all predict each.

namespace weft::solver {

/// How the cloth of one shot lies against the cloth of the others, in pixels of the frame: x to the right, y
/// down, turned about the frame's centre.
struct ClothShift {
  double dx_px = 0;
  double dy_px = 0;
  double turn = 0;  ///< radians, from x to the right towards up

  struct Displacement {
    double x = 0, y = 0;
  };
  /// Displacement of what lies `x`, `y` pixels right of and below the frame's centre.
  Displacement at(double x, double y) const { return {dx_px + turn * y, dy_px - turn * x}; }
  friend bool operator==(const ClothShift&, const ClothShift&) = default;
};

struct ShotRegistration {
  ClothShift shift;
  double sigma_px = 0;       ///< standard error of a component of the displacement, rms over the sample tiles
  double cost_deg = 0;       ///< rms angle by which the shift, left alone, turns the normals
  bool significant = false;  ///< the displacement is not explained by its error
};

struct Registration {
  std::vector<ShotRegistration> shots;  ///< by light of the field
  double explained = 0;                 ///< share of the residuals' sum of squares that the shifts take away
  bool found = true;  ///< false: no alignment within kMostShift_px explains the shots; `shots` are not to be
                      ///< corrected by
};

/// No shift beyond this is looked for.
inline constexpr double kMostShift_px = 8;
/// The sigma_px of a shot about which nothing was learnt: shifts of this size are taken to be likely
/// beforehand.
inline constexpr double kUnknownShift_px = 4;
/// Shadow, bounces and gloss look like a shift that is the same on all of a cloth, so no scatter between
/// places shows it. They add kModelShift_px to sigma_px, and kModelShiftOfShadow_px times the share of
/// readings that are in shadow. The latter is set so that a deep weave that lies still, a fifth of it in
/// shadow, is found to lie still.
inline constexpr double kModelShift_px = 0.02;
inline constexpr double kModelShiftOfShadow_px = 0.7;
/// Gloss moves with the light, so it gives every shot a shift of its own; a cloth that is touched moves in a
/// few shots. So the spread of the shots about their median adds to sigma_px, unless the shifts explain more
/// than gloss ever lets them: on still satins they take 0.33 to 0.60 of the residuals' squares away, on
/// smooth and plain cloth that was shaken in every shot 0.50 to 0.76.
inline constexpr double kExplainedByMovement = 0.7;

/// Each of more shots is solved by itself against b as all of them have it, so that the work grows with their
/// number: what one says of another by way of b is then a tenth of what it says of itself, and less.
inline constexpr int kMostTogether = 32;

/// Measures shift and turn of every shot on tiles of one frame (solver/sample_tiles.h): what aligns, in the
/// least-squares sense, each shot's green readings over strength with b . l_k of the b = rho n that explains
/// all of them. Gauss-Newton on shifts with b eliminated at every point (variable projection; Golub and
/// Pereyra 1973, with the Jacobian of Kaufman 1975), readings weighted by noise and Huber's function, those
/// in attached shadow left out. Greens are smoothed before they are compared and before gradients are taken.
/// What noise adds to the energy of the gradients is subtracted, so that a cloth without features says so.
/// Rounds end where no shot stands out of its error, where they settle, or where they show that they will
/// not: then no alignment is found. The standard errors come from the scatter between 16 blocks of each tile
/// and from the spread of the shots.
///
/// Shifts are against the median of all shots, component by component: the cloth as it lay most of the time.
/// Nothing can be told from three lights, nor from tiles under about 40 pixels.
Registration register_shots(std::span<const TileInput> tiles, Size frame, int threads);

}  // namespace weft::solver
