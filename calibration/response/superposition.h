// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "calibration/response/block_light.h"
#include "core/base/result.h"

// Linearity without a known reflectance: two LEDs together give the sum of what each gives, so a response
// that is linear adds up (the flux addition method of detector radiometry; Sanders, J. Res. NBS 76A, 1972).

namespace weft::calibration {

/// The same still scene by LED i, by LED j and by both, at one exposure.
struct SuperposedLight {
  const BlockLight* first = nullptr;
  const BlockLight* second = nullptr;
  const BlockLight* both = nullptr;
  /// v without light, as a dark frame of this exposure has it; empty: to be found with the rest.
  const std::array<double, 3>* dark = nullptr;
};

struct SuperpositionNoise {
  double electrons_at_full = 40000;  ///< gain times (white - black)
  double read_noise = 0;             ///< of v
  double drift = 0.001;              ///< standard deviation of a LED's light from frame to frame, relative
  double channel_spread = 0.002;     ///< of a and of b among channels, which share amplifier and converter
};

/// How far sums miss, before and after correction, for squares of like brightness.
struct SuperpositionBin {
  double v = 0;       ///< of the square lit by both
  double before = 0;  ///< (first + second - both) / both, drift taken out
  double after = 0;
};

struct Superposition {
  std::array<std::array<double, 2>, 3> linearity = {};   ///< a and b of v (1 + a v + b v^2), by channel
  std::array<std::array<double, 3>, 3> covariance = {};  ///< by channel: of a, of b, of a with b
  double offset = 0, sigma_offset = 0;                   ///< of v without light; 0 where dark frames gave it
  std::array<double, 3> highest_v = {};                  ///< that was seen, by channel
  double chi_square_per_freedom = 0;
  std::array<std::vector<SuperpositionBin>, 3> bins;

  /// Largest distance of the curve of a channel from a straight line through 0, over 0 <= v <= 1, in shares
  /// of full scale.
  double departure(std::size_t channel) const;
  /// Its standard deviation at mid scale, where it is largest, by the covariance.
  double sigma_departure(std::size_t channel) const;
};

/// Largest distance of v (1 + a v + b v^2) from the straight line that fits it best in the sense of least
/// maximum, found on a grid.
double departure_from_line(std::array<double, 2> linearity);

/// Least squares over all squares of all triples: lin(first) + lin(second) = lin(both), which is linear in a,
/// b and nearly so in the offset. A gain a triple and LED, with `drift` as prior, stands for light that is
/// not quite the same twice. Each channel's a and b is a common one, with a prior of 0.1, and a departure of
/// its own with `channel_spread` as prior: a channel in which the LEDs are dim follows the others where it
/// was not seen. The scale is fixed by lin'(0) = 1. kBadData if no square can be used.
Result<Superposition> fit_superposition(std::span<const SuperposedLight> lights,
                                        const SuperpositionNoise& noise);

/// Mean of (first + second) / both over the squares that all three hold: far from 1 a LED did not light, or
/// light came from elsewhere. Nothing usable gives 1.
double sum_over_both(const SuperposedLight& light);

}  // namespace weft::calibration
