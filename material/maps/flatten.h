// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "material/maps/gaussian_grid.h"
#include "material/maps/slope_polynomial.h"

namespace weft::material {

/// Two vectors from a place of a pattern to places where it is the same: pixels, y down the rows.
struct Repeat {
  double first_x = 0, first_y = 0, second_x = 0, second_y = 0;
};

/// The first two fit one polynomial to all pixels by weighted least squares. A weave's slopes are a hundred
/// times what is looked for, and leak into a fit where its window ends; so windows end softly.
enum class FlattenMethod {
  /// A Hann window over the frame: the least leak, also of folds; corners count for little.
  kHann,
  /// A window that falls over two whole repeats at the border: corners count nearly in full, but so do folds.
  kRepeat,
  /// All that is slower than a wavelength, folds too.
  kHighPass,
};

struct FlattenOptions {
  FlattenMethod method = FlattenMethod::kHann;
  int degree = 3;  ///< of the polynomial, 1 to 5: a cubic is safe, a quintic takes corner errors as well
  std::optional<Repeat> repeat = {};  ///< kRepeat
  double cut_mm = 0;                  ///< kHighPass: the wavelength of which half is removed
  double mm_per_pixel = 0;            ///< must be given
  /// What is known of slow slopes: where none is steeper than this, nothing is removed.
  double sigma_deg = 0;
  int threads = 0;  ///< 0: all the machine has. Changes no byte
};

/// The slow part of the slopes of a cloth, to be taken off: what wrong lights, a bent table and a tilt leave.
class SlowSlopes {
 public:
  FlattenMethod method = FlattenMethod::kHann;  ///< the one that ran
  /// The polynomial's degree, at most that asked for: folds that it cannot hold leave a lower one, or none
  /// (0). 0 for kHighPass.
  int degree = 0;
  bool lacks_repeats =
      false;             ///< kRepeat was asked for, but the frame holds fewer than six either way: kHann
  double tilt_deg = 0;   ///< of the mean slope
  double range_deg = 0;  ///< the largest angle between a slow slope and their mean
  double bow_mm = 0;  ///< how far the surface of these slopes, without its tilt, rises from lowest to highest
  bool acts = false;  ///< tilt or range is above sigma_deg; else the field is 0 everywhere

  Size size() const { return size_; }
  /// Row y of the field that is removed: mm a mm, to the right and up the picture.
  void read(int y, float* right, float* up) const;

 private:
  friend Result<SlowSlopes> slow_slopes(View<const float>, View<const float>, View<const std::uint16_t>,
                                        const FlattenOptions&);
  struct Grids {
    GaussianGrid right, up;
  };
  void read_found(int y, float* right, float* up) const;
  void state_facts(const FlattenOptions& options);

  Size size_;
  std::variant<SlopePolynomial, Grids> field_;
};

/// Finds the slow part of slopes (right, and up the picture; mm a mm). A pixel with kNoSolution in `status`,
/// which may be empty, or with a slope that is not finite has no part in it.
///
/// In slope space and not as a turn of normals towards the vertical, which would cost 4.3 degrees of detail.
/// Repeats are taken as they are, oblique or not, and may be off by a fiftieth. Under a Hann window
/// a cubic takes a twentieth of folds of which the frame holds four, less of shorter ones; a high pass takes
/// them, which is how to ask for that.
///
/// kUsage for shapes that differ and options out of range; kBadData where too few pixels have slopes.
Result<SlowSlopes> slow_slopes(View<const float> right, View<const float> up,
                               View<const std::uint16_t> status, const FlattenOptions& options);

/// Takes the field off, in place: n = (-(p - p'), -(q - q'), 1). Pixels with kNoSolution keep slope 0.
void flatten(const SlowSlopes& slow, View<const std::uint16_t> status, View<float> right, View<float> up,
             int threads = 0);

/// The field as a map of two planes: what was removed.
Image<float> removed_slopes(const SlowSlopes& slow, int threads = 0);

}  // namespace weft::material
