// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "material/surface.h"
#include "material/vec2.h"

namespace weft::material {

/// How alike a map is to itself moved by a lag: 1 at no lag, 0 where nothing is in common.
class Correlation {
 public:
  Correlation() = default;
  explicit Correlation(Image<float> values);

  /// Farthest lag along x and along y, pixels.
  int reach() const { return reach_; }
  float whole(int x, int y) const { return values_(reach_ + x, reach_ - y); }
  /// Between whole lags by cubic convolution; nothing beyond the reach.
  std::optional<double> at(Vec2 lag) const;

  struct Peak {
    Vec2 lag;
    double value = 0;
  };
  /// The highest whole lag within `radius` of `lag`, and the top of the parabolas through it and its
  /// neighbours; nothing where the highest lies on the border of what is searched.
  std::optional<Peak> peak_near(Vec2 lag, double radius) const;
  /// Tops of more than `least` among their 24 neighbours, in the half plane y >= 0, from `nearest` to
  /// `farthest` pixels from no lag, the strongest first.
  std::vector<Peak> peaks(double least, double nearest, double farthest) const;

 private:
  Peak top_of(int x, int y) const;

  Image<float> values_;
  int reach_ = 0;
};

/// Autocorrelations of a cloth: of the slopes to the right and up, and of the logarithm of its luminance.
struct Correlations {
  std::array<Correlation, 3> of;
  bool slope_repeats(int channel) const { return level[static_cast<std::size_t>(channel)] > 0.2; }
  std::array<double, 3> level = {};     ///< of the four strongest peaks of each
  std::array<double, 3> variance = {};  ///< of each, to a factor that the slopes have in common
};

/// Correlates the `crop` of a surface. Trends over more than 64 pixels are taken out first; pixels without a
/// solution count as 0. Lags reach half the crop's shorter side, and each sum is divided by the pixels in it.
/// A Gaussian of 0.8 pixels takes noise out of the lags.
Correlations correlate(const Surface& surface, Rect crop, int threads);

/// The mean of some correlations, each within -1 and 1.
Correlation mean_of(std::span<const Correlation* const> correlations);

}  // namespace weft::material
