// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "solver/reflectance/lobe_fit.h"

namespace weft::solver {

/// The quarters of a frame, row by row.
inline constexpr std::size_t kFrameParts = 4;
const char* name_of_part(std::size_t part);

/// What a quarter of the frame says of the lobe that all of it shares.
struct LobePart {
  std::size_t part = 0;
  double alpha = 0;
  double sigma_alpha = 0;  ///< relative
  std::size_t pixels = 0;
};

/// Alpha of each quarter with kLeastPartPixels of the pixels that a lobe was fitted to, its other values
/// held: where f0 is free too, what noise does to the one the other makes up for. `part` is by pixel.
/// `sigma_alpha` of the whole, relative, counts in that of each part: what calibration or family do to alpha
/// they may do otherwise elsewhere.
std::vector<LobePart> measure_parts(const LobeSamples& samples, const LobeFit& fit,
                                    std::span<const std::size_t> part, double sigma_alpha, int threads);
/// A quarter with fewer says nothing.
inline constexpr std::size_t kLeastPartPixels = 100;

/// The smoothest and the roughest part, where they differ by more than kChangeSigmas of what is known of
/// both: the cloth is not the same all over.
std::optional<std::array<LobePart, 2>> change_across(std::span<const LobePart> parts);
inline constexpr double kChangeSigmas = 3;

}  // namespace weft::solver
