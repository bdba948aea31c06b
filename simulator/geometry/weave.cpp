// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/weave.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/vec.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {
namespace {

double mean_pitch_mm(const GeometrySettings& g) {
  return (g.warp_pitch_mm + g.weft_pitch_mm) / 2;
}

std::int64_t modulo(std::int64_t a, std::int64_t n) {
  return (a % n + n) % n;
}

/// Where a coordinate lies among parallel yarns: the nearest one and the next, on the other side of it.
struct Neighbours {
  std::int64_t nearest;
  std::int64_t next;
  double offset_mm;  ///< from the nearest yarn's axis
  double side;       ///< of the next yarn: -1 or 1
};

Neighbours neighbours_at(double coordinate_mm, double pitch_mm) {
  const double cell = std::floor(coordinate_mm / pitch_mm);
  const double offset_mm = coordinate_mm - (cell + 0.5) * pitch_mm;
  const auto nearest = static_cast<std::int64_t>(cell);
  const int side = offset_mm < 0 ? -1 : 1;
  return {nearest, nearest + side, offset_mm, static_cast<double>(side)};
}

/// A height and its derivatives across and along a yarn.
struct Profile {
  double height_mm;
  double across;
  double along;
};

/// The axis: from one side (-1 under, 1 over) at t = 0 to the other at t = 1.
Profile axis(double amplitude_mm, double from, double to, double t, double dt_dalong) {
  return {amplitude_mm * (from + (to - from) * t * t * (3 - 2 * t)), 0,
          amplitude_mm * (to - from) * 6 * t * (1 - t) * dt_dalong};
}

/// The cross-section: 0 at the crest.
Profile cross_section(double flat_mm, double radius_mm, double half_mm, double flank_slope,
                      double across_mm) {
  const double within_mm = std::min(std::abs(across_mm), half_mm);
  const double u = std::max(within_mm - flat_mm, 0.0);
  const double z = std::sqrt(radius_mm * radius_mm - u * u);
  const double beyond_mm = std::abs(across_mm) - within_mm;
  const double slope = beyond_mm > 0 ? flank_slope : u / z;
  return {z - radius_mm - flank_slope * beyond_mm, across_mm < 0 ? slope : -slope, 0};
}

/// Ridges of the plies: two from crossing to crossing, at 45 degrees if the crossings are a pitch apart; the
/// sign of `along_pitch_mm` turns them.
Profile twist(double amplitude_mm, double across_mm, double across_pitch_mm, double along_mm,
              double along_pitch_mm) {
  const double kx = 4 * kPi / across_pitch_mm, ky = 4 * kPi / along_pitch_mm;
  const double phase = kx * across_mm + ky * along_mm;
  const double slope = amplitude_mm * std::cos(phase);
  return {amplitude_mm * std::sin(phase), kx * slope, ky * slope};
}

Profile operator+(Profile a, Profile b) {
  return {a.height_mm + b.height_mm, a.across + b.across, a.along + b.along};
}

/// A yarn that may be the highest at a point.
struct Candidate {
  Profile profile;
  double across_mm;
  Yarn yarn;
};

}  // namespace

Fibres::Fibres(double amplitude_mm, double spacing_mm, double angle, double length_mm, int yarns,
               std::int64_t seed, std::uint32_t stream)
    : amplitude_mm_(amplitude_mm),
      yarns_(yarns),
      waves_{}

{
  const auto bits = static_cast<std::uint64_t>(seed);
  const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(bits),
                                            static_cast<std::uint32_t>(bits >> 32)};
  constexpr std::uint32_t kFrequencies = 0xFFFFFFFF;  // a yarn that no cloth has
  constexpr double kStraightness = 0.1;               // how far fibres stray from their angle, radians
  for (std::uint32_t w = 0; w < kWaves; ++w) {
    const auto r = philox({kFrequencies, w, stream, 0}, key);
    const double octaves = (w + uniform(r[0], r[1])) / kWaves - 0.5;  // stratified: the band is filled
    const double across = 2 * kPi / spacing_mm * std::exp2(octaves);
    const double lean = angle + kStraightness * (2 * uniform(r[2], r[3]) - 1);
    const double whole_turns = std::round(-across * std::tan(lean) * length_mm / (2 * kPi));
    waves_[w] = {across, whole_turns * 2 * kPi / length_mm};
  }
  for (std::uint32_t yarn = 0; yarn < static_cast<std::uint32_t>(yarns); ++yarn) {
    for (std::uint32_t w = 0; w < kWaves; ++w) {
      const auto r = philox({yarn, w, stream, 0}, key);
      phases_.push_back(2 * kPi * uniform(r[0], r[1]));
    }
  }
}

Fibres::Relief Fibres::at(std::int64_t yarn, double across_mm, double along_mm) const {
  const auto own = static_cast<std::size_t>((yarn % yarns_ + yarns_) % yarns_) * kWaves;
  Relief sum = {0, 0, 0};
  for (std::size_t w = 0; w < kWaves; ++w) {
    const auto& k = waves_[w];
    const double phase = k.across * across_mm + k.along * along_mm + phases_[own + w];
    const double cosine = std::cos(phase);
    sum.height_mm += std::sin(phase);
    sum.across += k.across * cosine;
    sum.along += k.along * cosine;
  }
  const double each_mm = amplitude_mm_ / kWaves;
  return {each_mm * sum.height_mm, each_mm * sum.across, each_mm * sum.along};
}

double Fibres::steepest_slope() const {
  double sum = 0;
  for (const Frequency& k : waves_) sum += std::hypot(k.across, k.along);
  return amplitude_mm_ / kWaves * sum;
}

Draft draft_of(const GeometrySettings& g) {
  switch (g.kind) {
    case GeometryKind::kTwill:
      return {g.over.value_or(2), g.under.value_or(2), g.step.value_or(1)};
    case GeometryKind::kSatin:
      return {g.over.value_or(4), g.under.value_or(1), g.step.value_or(2)};
    default:
      return {1, 1, 1};
  }
}

bool yarns_stay_beside_their_neighbours(const GeometrySettings& g) {
  const double flank = radians(g.flank_deg);
  const double drop = (1 - g.flatness) * (1 - std::cos(flank)) / (2 * std::sin(flank)) +
                      std::tan(flank) / 2;  // over one pitch
  return 2 * (g.crimp + g.twist_relief + g.fibre_relief) * mean_pitch_mm(g) <=
         drop * std::min(g.warp_pitch_mm, g.weft_pitch_mm);
}

Weave::Weave(const GeometrySettings& g)
    : period_(draft_of(g).period()),
      repeat_(g.fibre_relief > 0 ? period_ * ((kYarnsUntilFibresRepeat + period_ - 1) / period_) : period_),
      crimp_mm_(g.crimp * mean_pitch_mm(g)),
      twist_mm_(g.twist_relief * mean_pitch_mm(g)),
      relief_mm_((g.twist_relief + g.fibre_relief) * mean_pitch_mm(g)),
      flank_slope_(std::tan(radians(g.flank_deg))),
      warp_(set_of(g, g.warp_pitch_mm)),
      weft_(set_of(g, g.weft_pitch_mm)) {
  const Draft draft = draft_of(g);
  for (std::int64_t i = 0; i < period_; ++i) {
    for (std::int64_t j = 0; j < period_; ++j) {
      warp_side_.push_back(modulo(j - draft.step * i, period_) < draft.over ? 1 : -1);
    }
  }
  if (g.fibre_relief > 0) {
    const double angle = radians(g.fibre_angle_deg);  // Z on both: across turns the other way in the weft
    const auto fibres_of = [&](double pitch_mm, double lean, double length_mm, std::uint32_t stream) {
      return Fibres(g.fibre_relief * mean_pitch_mm(g), g.fibre_spacing * pitch_mm, lean, length_mm, repeat_,
                    g.fibre_seed, stream);
    };
    warp_fibres_ = fibres_of(warp_.pitch_mm, angle, period_y_mm(), 0);
    weft_fibres_ = fibres_of(weft_.pitch_mm, -angle, period_x_mm(), 1);
  }
}

Weave::Set Weave::set_of(const GeometrySettings& g, double pitch_mm) {
  return {pitch_mm, g.flatness * pitch_mm / 2,
          pitch_mm / 2 * (1 - g.flatness) / std::sin(radians(g.flank_deg))};
}

SurfacePoint Weave::at(double x_mm, double y_mm) const {
  const Neighbours warp = neighbours_at(x_mm, warp_.pitch_mm);
  const Neighbours weft = neighbours_at(y_mm, weft_.pitch_mm);
  const std::int64_t i[2] = {modulo(warp.nearest, period_), modulo(warp.next, period_)};
  const std::int64_t j[2] = {modulo(weft.nearest, period_), modulo(weft.next, period_)};
  const auto warp_side = [&](int a, int b) {
    return warp_side_[static_cast<std::size_t>(i[a] * period_ + j[b])];
  };

  const auto candidate = [&](bool is_weft, int k) -> Candidate {
    const Set& set = is_weft ? weft_ : warp_;
    const Neighbours& own = is_weft ? weft : warp;
    const Neighbours& crossing = is_weft ? warp : weft;
    const double crossing_pitch_mm = is_weft ? warp_.pitch_mm : weft_.pitch_mm;
    const double from = is_weft ? -warp_side(0, k) : warp_side(k, 0);
    const double to = is_weft ? -warp_side(1, k) : warp_side(k, 1);
    const double across_mm = own.offset_mm - k * own.side * set.pitch_mm;
    return {cross_section(set.flat_mm, set.radius_mm, set.pitch_mm / 2, flank_slope_, across_mm) +
                axis(crimp_mm_, from, to, std::abs(crossing.offset_mm) / crossing_pitch_mm,
                     crossing.side / crossing_pitch_mm),
            across_mm,
            {is_weft, k == 0 ? own.nearest : own.next}};
  };
  // Four yarns can be on top: the nearest and the next of either set.
  std::array<Candidate, 4> candidates = {candidate(false, 0), candidate(false, 1), candidate(true, 0),
                                         candidate(true, 1)};
  const auto lower = [](const Candidate& a, const Candidate& b) {
    return a.profile.height_mm < b.profile.height_mm;
  };
  if (relief_mm_ > 0) {
    const double top_mm = std::max_element(candidates.begin(), candidates.end(), lower)->profile.height_mm;
    for (Candidate& c : candidates) {
      if (c.profile.height_mm < top_mm - 2 * relief_mm_) continue;  // no relief lifts it to the top
      const Set& set = c.yarn.is_weft ? weft_ : warp_;
      const double along_mm = c.yarn.is_weft ? x_mm : y_mm;
      const double along_pitch_mm = c.yarn.is_weft ? warp_.pitch_mm : -weft_.pitch_mm;
      if (twist_mm_ > 0)
        c.profile = c.profile + twist(twist_mm_, c.across_mm, set.pitch_mm, along_mm, along_pitch_mm);
      if (const std::optional<Fibres>& fibres = c.yarn.is_weft ? weft_fibres_ : warp_fibres_) {
        const Fibres::Relief r = fibres->at(c.yarn.index, c.across_mm, along_mm);
        c.profile = c.profile + Profile{r.height_mm, r.across, r.along};
      }
    }
  }
  const Candidate& top = *std::max_element(candidates.begin(), candidates.end(), lower);
  const Profile& p = top.profile;
  const double slope_x = top.yarn.is_weft ? p.along : p.across;
  const double slope_y = top.yarn.is_weft ? p.across : p.along;
  return {p.height_mm, normal_of_slopes(slope_x, slope_y), top.yarn, top.yarn.is_weft ? 1.0 : 0.0,
          top.yarn.is_weft ? 0.0 : 1.0};
}

HeightRange Weave::heights_mm(const Area&) const {
  // The nearest yarn of either set is at most half a pitch away.
  const double drop_mm = std::min(arc_drop_mm(warp_), arc_drop_mm(weft_));
  return {-crimp_mm_ - drop_mm - relief_mm_, crimp_mm_ + relief_mm_};
}

double Weave::arc_drop_mm(const Set& set) {
  const double arc_mm = set.pitch_mm / 2 - set.flat_mm;
  return set.radius_mm - std::sqrt(set.radius_mm * set.radius_mm - arc_mm * arc_mm);
}

double Weave::steepest_slope() const {
  const auto slope_of = [&](const Set& set, double along_pitch_mm, const std::optional<Fibres>& fibres) {
    const double across = flank_slope_ + twist_mm_ * 4 * kPi / set.pitch_mm;
    const double along = 3 * crimp_mm_ / along_pitch_mm + twist_mm_ * 4 * kPi / along_pitch_mm;
    return std::hypot(across, along) + (fibres ? fibres->steepest_slope() : 0);
  };
  return std::max(slope_of(warp_, weft_.pitch_mm, warp_fibres_),
                  slope_of(weft_, warp_.pitch_mm, weft_fibres_));
}

}  // namespace weft::simulator
