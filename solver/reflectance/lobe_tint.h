// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "solver/method.h"
#include "solver/reflectance/lobe_fit.h"
#include "solver/reflectance/measured_lobe.h"

// The colour of a highlight: white of glass and of most fibres, of metallic yarn and of coatings their own.

namespace weft::solver {

/// The readings of each channel of the pixels that a lobe is sought in. Of a mosaic a pixel has one channel,
/// of RGB all three.
struct ChannelSamples {
  explicit ChannelSamples(std::size_t lights, std::size_t states = 1)
      : of{LobeSamples(lights, states), LobeSamples(lights, states), LobeSamples(lights, states)} {}
  /// The next reading of the pixel with this number; its channel is that of its first reading.
  void add(std::size_t number, std::span<const LobeReading> readings);
  /// Those of some of the pixels, numbered anew.
  ChannelSamples part(std::span<const std::size_t> numbers) const;

  std::array<LobeSamples, 3> of;
  std::array<std::vector<std::size_t>, 3> pixel;  ///< number of each
};

struct TintOptions {
  std::array<double, 3> weights = kLuminance;  ///< of the channels in `f0`; none below 0, their sum is 1
  /// Errors of the lights, in the order of LobeByLights; empty where it is not known. Their drift is added.
  std::span<const double> light_errors = {};
  int threads = 0;
};

/// f0 of every channel of the pixels that `fit` was fitted to, its form held and each pixel's normal and
/// albedo free. What lights are wrong by in all channels alike hardly moves their ratio: covariances are of
/// form and of the three f0 together (variable projection, as LobeByLights). Empty where a channel has fewer
/// than kLeastTintPixels with readings, as one that is saturated.
std::optional<LobeTint> measure_tint(const LobeFit& fit, bool bends, const ChannelSamples& samples,
                                     const TintOptions& options);

/// Whether a channel is off the mean by more than kTintSigmas of its ratio.
bool is_off(const LobeTint& tint);

/// Puts tinted lobes in the place of those of `lobes`, as measure_materials() left them for `samples` and
/// `start`, where a channel is_off() and light that is left out is predicted better in its own f0 than in the
/// mean. Of a mosaic whose channels follow no lobe together the form is sought in green alone. Else `lobes`
/// stays as it is, bit by bit.
void find_tints(const LobeSamples& samples, const std::vector<Vec3>& start, const ChannelSamples& channels,
                const TintOptions& options, std::vector<MeasuredLobe>& lobes);

/// A channel with fewer leaves a lobe without a tint.
inline constexpr std::size_t kLeastTintPixels = 100;
inline constexpr double kTintSigmas = 3;  ///< of is_off()
/// Share of a ratio: light between yarns and what no family has are not the same in light and dark channels.
inline constexpr double kTintModelShare = 0.04;
/// How much bluer or redder a LED may be than calibrated, a share of each channel.
inline constexpr double kColourDrift = 0.002;

}  // namespace weft::solver
