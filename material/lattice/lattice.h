// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "core/base/result.h"
#include "material/surface.h"
#include "material/vec2.h"

namespace weft::material {

/// What a cloth's correlation with itself says of its repeat.
enum class LatticeKind {
  kRepeat,      ///< two ways carry the cloth onto itself
  kOneWay,      ///< ribs, as of corduroy: along them any way does
  kNone,        ///< felt, fleece, noise
  kFewRepeats,  ///< fewer than three repeats lie in the frame
  kTooFine,     ///< yarns are under four pixels wide
};
std::string_view name_of(LatticeKind kind);  ///< "repeat", "one-way", "none", "few-repeats", "too-fine"
std::string_view words_of(LatticeKind kind);

/// Two ways whose whole multiples carry a cloth onto itself. Pixels, x right, y up.
struct Cell {
  Vec2 a, b;  ///< counterclockwise from a to b

  double area() const { return cross(a, b); }
  Vec2 at(double i, double j) const { return i * a + j * b; }
};

/// The repeat of a cloth. Apart from `kind`, only kRepeat fills all of it; kOneWay has `weave.a` across the
/// ribs, which is also `axes.a`, and `axes.b` along them of no length.
struct Lattice {
  LatticeKind kind = LatticeKind::kNone;
  double mm_per_pixel = 0;
  Cell weave;   ///< the smallest repeat of the relief: shortest ways, a the nearer one to +x
  Cell colour;  ///< the smallest repeat of relief and colours; the weave's where colours repeat with it
  /// The shortest repeats of `colour` along the yarns, a the nearer one to +x: sides of a cell that may be
  /// larger than the smallest one, as two by two yarns of a plain weave are.
  Cell axes;
  bool colours_repeat = false;  ///< found in the luminance, and not assumed
  double yarn_x_px = 0;         ///< width of the yarns that follow each other along axes.a
  double yarn_y_px = 0;
  double yarn_share = 0;   ///< of the slopes' energy that goes on along either set of yarns, 0 to 1
  double turn_x_deg = 0;   ///< of axes.a from +x, counterclockwise
  double turn_y_deg = 0;   ///< of axes.b from +y
  double strength = 0;     ///< correlation of the slopes at the nearest repeats, the lower of both, 0 to 1
  double residual_px = 0;  ///< rms distance of `points` repeats from where the weave's cell puts them
  int points = 0;
  double sublattice_t =
      0;  ///< Student's t of the coarser lattice that was chosen, or of the best refused one
};

/// What somebody says of the yarns; what is not said is found.
struct SaidYarns {
  /// The turn of axes.a from +x, counterclockwise; a right angle more or less is the same.
  std::optional<double> turn_deg = {};
  double x_px = 0, y_px = 0;  ///< as Lattice::yarn_x_px and yarn_y_px; 0: not said
};

/// Where the repeat is looked for.
struct LatticeOptions {
  int crop_px = 1024;  ///< side of the square around the frame's centre, 64 to 4096
  SaidYarns said = {};
  int threads = 0;
};

/// The smallest true repeat of a cloth: peaks of the unbiased autocorrelation of its slopes, the pair of ways
/// whose multiples all are peaks, refined on all peaks in reach. A weave also nearly repeats from yarn to
/// next yarn, so every sublattice of index 2 to 8 is tested against the points beside it (Student's t), and
/// the surest one taken at t over 12. Colours are sought apart, at whole repeats of the weave.
///
/// kBadData where the surface has no pixels, is under 64 pixels wide or high, has no mm_per_pixel, or a value
/// is not finite; where nothing of the lattice lies within 5 degrees and a tenth of a yarn of what was said.
/// No repeat is not an error: `kind` says what was seen. Same bytes for any thread count.
Result<Lattice> find_lattice(const Surface& surface, const LatticeOptions& options = {});

}  // namespace weft::material
