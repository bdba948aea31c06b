// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/image/image.h"

// Whether a cloth spreads light, told by its own photographs.

namespace weft::solver {

/// A part of a cloth after Lambert's law, at least kLeastToldSide cells wide and high, all solved.
struct LambertWindow {
  Image<float> normal;  ///< X, Y, Z, of unit length, by the axes of the picture
  Image<float> albedo;  ///< above 0
  int step = 1;         ///< to cells whose albedo is of the same colour, along rows and columns
};
inline constexpr int kLeastToldSide = 96;

/// Light that leaves a cloth beside where it entered (ClothSpread), as its photographs tell.
struct ToldSpread {
  double share = 0, mean_cells = 0;
  double sigma_share = 0;
  /// Slopes are so many times those that Lambert's law gives, and that factor may be off by this share.
  double slope_gain = 1, sigma_slope = 0;
  /// By this share the misfit of brightness falls, and by so many of its own standard deviations.
  double gain = 0, sure = 0;
};

/// Light that enters a cloth of albedo rho with normals n, directly and from the cloth around it, adds up to
/// E = n + c u n, with u the share of the sky that the cloth hides, and what leaves is rho S(E) with S(E) =
/// (1 - share) E + share K * E (solver/transport/cloth_spread.h). So albedo times normal, as Lambert's law
/// has them, is a vector of the length rho |S(E)|. Of a trial of share and distance the normals follow from
/// directions alone, and S of them says how that length should vary within a yarn; bounces brighten furrows
/// and not crests, spreading dims both, so c is fitted beside it. Trials are held against each other by the
/// steps of log length from cell to cell, which the colours of yarns disturb at few cells; outliers count
/// after Cauchy. None is returned where no trial is better than none by kLeastGain and by kLeastSure, where
/// slopes lie in one direction, which tells nothing, where there are none, where they are so steep that
/// yarns shade each other, where light would leave within 2.5 cells, as yarns that are not resolved
/// feign, and where more than 0.75 of it would leave elsewhere, as reflectance beyond Lambert's law feigns.
/// The result is the mean of trials, each weighed by how sure it is to be worse than the best. At most
/// `threads` threads (0: all); the same bytes for any number of them.
std::optional<ToldSpread> told_spread(std::span<const LambertWindow> windows, int threads);

}  // namespace weft::solver
