// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/surface_point.h"

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

/// How warp and weft cross: warp yarn i lies over weft yarn j where (j - step * i) mod period() < over.
struct Draft {
  int over = 1;
  int under = 1;
  int step = 1;
  int period() const { return over + under; }
};

Draft draft_of(const GeometrySettings& geometry);

/// Whether the highest yarn stays below its neighbours' crests at their axes, which is what keeps the height
/// of a Weave without jumps.
bool yarns_stay_beside_their_neighbours(const GeometrySettings& geometry);

/// Warp and weft yarns that go over and under each other; the surface is the highest of them at each point.
/// A yarn's axis rises and falls between crossings as 3 t^2 - 2 t^3. Its cross-section is a circular arc, up
/// to half a pitch from the axis, where the slope is tan(flank_deg), and straight beyond: so the height has
/// creases where yarns meet but no jumps. With flatness, the arc's halves stand apart and the yarn is level
/// between them (the racetrack section of Kemp 1958). Height 0 is the crest of a yarn half-way between over
/// and under. With twist_relief, the plies of Z-twisted yarns show as ridges at 45 degrees, two from crossing
/// to crossing. With fibre_relief, each yarn has Fibres of its own.
class Weave {
 public:
  explicit Weave(const GeometrySettings& geometry);
  SurfacePoint at(double x_mm, double y_mm) const;
  HeightRange heights_mm(const Area& anywhere = {}) const;
  /// The draft's period; with fibres, its multiple of at least kYarnsUntilFibresRepeat yarns.
  std::optional<Period> period_mm() const { return Period{period_x_mm(), period_y_mm()}; }
  double steepest_slope() const;

  double period_x_mm() const { return repeat_ * warp_.pitch_mm; }
  double period_y_mm() const { return repeat_ * weft_.pitch_mm; }

  static constexpr int kYarnsUntilFibresRepeat = 32;

 private:
  /// Yarns of one direction.
  struct Set {
    double pitch_mm;
    double flat_mm;    ///< from the axis to where the arc begins
    double radius_mm;  ///< of the arc
  };
  static Set set_of(const GeometrySettings& geometry, double pitch_mm);
  static double arc_drop_mm(const Set& set);

  int period_;
  int repeat_;
  double crimp_mm_;
  double twist_mm_;
  double relief_mm_;  ///< of plies and fibres: no point is lifted by more
  double flank_slope_;
  Set warp_;
  Set weft_;
  std::vector<double> warp_side_;  ///< [i * period + j]: 1 where warp yarn i lies over weft yarn j, else -1
  std::optional<Fibres> warp_fibres_;
  std::optional<Fibres> weft_fibres_;
};

}  // namespace weft::simulator
