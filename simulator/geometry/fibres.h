// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace weft::simulator {

/// The relief of the fibres of parallel yarns: a sum of waves of random phase, long along the fibre and
/// short across it, their wavelengths within half an octave of `spacing_mm`. The same seed gives the same
/// relief. Every yarn has phases of its own and repeats after `length_mm`; yarns repeat after `yarns`.
class Fibres {
 public:
  /// A height and its derivatives across and along the yarn.
  struct Relief {
    double height_mm;
    double across;
    double along;
  };

  /// `stream` tells warp from weft; `angle` (radians) is between fibre and yarn, positive where a fibre moves
  /// towards positive `across` with growing `along`.
  Fibres(double amplitude_mm, double spacing_mm, double angle, double length_mm, int yarns, std::int64_t seed,
         std::uint32_t stream);

  /// |height_mm| is at most amplitude_mm.
  Relief at(std::int64_t yarn, double across_mm, double along_mm) const;
  double steepest_slope() const;

 private:
  static constexpr int kWaves = 8;

  struct Frequency {
    double across;  ///< radians per mm
    double along;
  };

  double amplitude_mm_;
  std::int64_t yarns_;
  std::array<Frequency, kWaves> waves_;
  std::vector<double> phases_;  ///< [yarn * kWaves + wave]
};

}  // namespace weft::simulator
