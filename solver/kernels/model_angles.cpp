// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/model_angles.h"

#include "core/solve/solve_record.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/kernels/model_angles.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// All constants are fitted to the tuning set (bench/accuracy/accuracy_scenes.h), over all levels at once.

// Degrees by which light from the cloth turns a normal, over albedo and square of the slope: a slope sees as
// much of the cloth as it does not see of the sky. Flanks, steeper than what is around them, are turned by
// more than crests and furrows: by as much as their slope's square is over that around, to a limit. The slope
// is that of the cells around, and by a share the pixel's own.
constexpr float kBounced_deg = 10.5F, kMostOfFlank = 3.9F, kOwnSlope = 0.136F;
// What is left of it where it was taken out, over albedo and slope: the relief is no better known than the
// normals.
constexpr float kBouncesLeft_deg = 2.4F;
// Degrees over the slope of a pixel with shadowed readings: the edge of a shadow passes for light.
constexpr float kShadowed_deg = 0.63F;
// What a misfit turns, over what it would if it were independent from light to light: upright, and more of it
// on a slope, since a ring of lights has its highlights on all sides of an upright cloth. A robust start has
// left out the readings that pull, and their residuals still count. What fits here though all around does not
// may have been taken wrong as a whole, the more the steeper.
struct Pull {
  float upright, on_slope;
};
constexpr Pull kHere = {0.24F, 0.94F}, kAround = {0.45F, 0.25F};
constexpr Pull kHereOfRobust = {0.2F, 0.006F}, kAroundOfRobust = {0.13F, 0.17F};
constexpr float kSteep = 0.53F, kSteepOfRobust = 0.16F;
// Degrees of a preview over the cube of the slope around, as light that does not reach a slope is taken for
// little light, and what is added to the albedo, as pale cloth fills it with light of its own.
constexpr float kUnmasked_deg = 57, kUnmaskedOfBlack = 1.1F;
// Lighter cloth is as light as this.
constexpr float kMostAlbedo = 1.2F;
// A slope of 56 degrees, a residual of three times the albedo, and the least that is divided by.
constexpr float kMostSlope2 = 2.25F, kMostResidual = 3, kLeastAlbedo = 1e-3F, kLeastSlope2 = 1e-6F;
constexpr float kMostAngle_deg = 180;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using Bits = hn::Rebind<std::uint32_t, D>;
using Status = hn::Rebind<std::uint16_t, D>;

HWY_INLINE V number(float x) {
  return hn::Set(D(), x);
}
HWY_INLINE V square(V x) {
  return hn::Mul(x, x);
}

// Takes lanes by turns, from an even one on, unless a vector is one lane.
template <typename T>
HWY_INLINE T by_turns(T even, T odd, std::size_t lane) {
#if HWY_TARGET == HWY_SCALAR
  return lane % 2 == 0 ? even : odd;
#else
  (void)lane;
  return hn::OddEven(odd, even);
#endif
}

struct Noise {
  V x, y, z, floor;
};
HWY_INLINE Noise by_turns(const ResidualNoise& even, const ResidualNoise& odd, std::size_t lane) {
  const auto turns = [&](float a, float b) { return by_turns(number(a), number(b), lane); };
  return {turns(even.photons[0], odd.photons[0]), turns(even.photons[1], odd.photons[1]),
          turns(even.photons[2], odd.photons[2]), turns(even.floor, odd.floor)};
}

struct Pixels {
  V x, y, z, residual, albedo;
  hn::Vec<Bits> status;
  Noise noise;

  HWY_INLINE M has(std::uint16_t bit) const {
    const Bits d;
    return hn::RebindMask(D(), hn::Ne(hn::And(status, hn::Set(d, bit)), hn::Zero(d)));
  }
  HWY_INLINE V slope2() const {
    const V z2 = square(z), across2 = hn::Sub(number(1), z2), most = number(kMostSlope2);
    return hn::IfThenElse(hn::Lt(across2, hn::Mul(most, z2)), hn::Div(across2, z2), most);
  }
  HWY_INLINE V some_albedo() const { return hn::Max(albedo, number(kLeastAlbedo)); }
  HWY_INLINE V misfit2() const {
    const V inverse = hn::Div(number(1), some_albedo());
    const V photons = hn::Add(hn::Add(hn::Mul(noise.x, x), hn::Mul(noise.y, y)), hn::Mul(noise.z, z));
    const V left = hn::Mul(inverse, hn::Add(photons, hn::Mul(noise.floor, inverse)));
    return hn::Sub(square(hn::Min(residual, number(kMostResidual))), left);
  }
};

// Every second pixel, and the other ones.
HWY_INLINE Pixels every_second(const SolvedPixels& row, std::size_t cell, bool odd_column) {
  const auto of = [&](auto d, const auto* at) {
    hn::Vec<decltype(d)> even, odd;
    hn::LoadInterleaved2(d, at + 2 * cell, even, odd);
    return odd_column ? odd : even;
  };
  const D d;
  const ResidualNoise& noise = row.noise[odd_column ? 1 : 0];
  return {of(d, row.normal[0]),        of(d, row.normal[1]), of(d, row.normal[2]),
          of(d, row.residual),         of(d, row.albedo),    hn::PromoteTo(Bits(), of(Status(), row.status)),
          by_turns(noise, noise, cell)};
}

HWY_INLINE Pixels by_turns(const Pixels& even, const Pixels& odd, std::size_t cell) {
  const auto turns = [&](auto a, auto b) { return by_turns(a, b, cell); };
  return {turns(even.x, odd.x),
          turns(even.y, odd.y),
          turns(even.z, odd.z),
          turns(even.residual, odd.residual),
          turns(even.albedo, odd.albedo),
          turns(even.status, odd.status),
          {turns(even.noise.x, odd.noise.x), turns(even.noise.y, odd.noise.y),
           turns(even.noise.z, odd.noise.z), turns(even.noise.floor, odd.noise.floor)}};
}

HWY_INLINE Pixels all_of(const SolvedPixels& row, std::size_t x) {
  const D d;
  return {hn::LoadU(d, row.normal[0] + x),        hn::LoadU(d, row.normal[1] + x),
          hn::LoadU(d, row.normal[2] + x),        hn::LoadU(d, row.residual + x),
          hn::LoadU(d, row.albedo + x),           hn::PromoteTo(Bits(), hn::LoadU(Status(), row.status + x)),
          by_turns(row.noise[0], row.noise[1], x)};
}

// For a robust start, by its share.
HWY_INLINE V pull(const Pull& usual, const Pull& of_robust, float robust, V slope) {
  const auto between = [&](float a, float b) { return number(a + robust * (b - a)); };
  return hn::Add(between(usual.upright, of_robust.upright),
                 hn::Mul(between(usual.on_slope, of_robust.on_slope), slope));
}

// Square of the angle, degrees, from slopes and albedo of the pixels and of the cells around them.
HWY_INLINE V angle2(const Pixels& p, V slope2_of_cells, V albedo, const ModelSurroundings& around,
                    const ModelTraits& traits, bool has_noise) {
  const V slope2 = p.slope2(), slope = hn::Sqrt(slope2);
  albedo = hn::Min(albedo, number(kMostAlbedo));
  const V mixed2 =
      hn::Add(hn::Mul(number(kOwnSlope), slope2), hn::Mul(number(1 - kOwnSlope), slope2_of_cells));
  const float around2 = around.slope2 > kLeastSlope2 ? around.slope2 : kLeastSlope2;
  const V flank = hn::Min(hn::Mul(mixed2, number(1 / around2)), number(kMostOfFlank));
  V bounced = hn::Mul(hn::Mul(number(kBounced_deg), albedo), hn::Mul(mixed2, flank));
  if (traits.bounces_are_out) {
    bounced = hn::Min(bounced, hn::Mul(hn::Mul(number(kBouncesLeft_deg), albedo), hn::Sqrt(mixed2)));
  }
  const V shadowed = hn::IfThenElseZero(p.has(kShadowed), hn::Mul(number(kShadowed_deg), slope));
  const V scaled = hn::Div(hn::Mul(number(static_cast<float>(degrees(traits.sigma_slope))), slope),
                           hn::Add(number(1), slope2));
  V sum2 = hn::Add(hn::Add(square(bounced), square(shadowed)), square(scaled));
  if (has_noise) {
    const float scale2 = around.degrees_a_residual * around.degrees_a_residual, robust = around.robust;
    const V misfit2 = hn::Max(p.misfit2(), number(0));
    const V here2 = square(pull(kHere, kHereOfRobust, robust, slope));
    const V around2_of = square(pull(kAround, kAroundOfRobust, robust, slope));
    const V steep2 = square(hn::Mul(number(kSteep + robust * (kSteepOfRobust - kSteep)), slope2));
    const V pulled =
        hn::Add(hn::Mul(here2, misfit2), hn::Mul(hn::Add(around2_of, steep2), number(around.misfit2)));
    sum2 = hn::Add(sum2, hn::Mul(number(scale2), pulled));
  }
  if (traits.is_half) {
    const V unmasked =
        hn::Mul(number(kUnmasked_deg * around.slope2),
                hn::Mul(hn::Sqrt(number(around.slope2)), hn::Add(number(kUnmaskedOfBlack), albedo)));
    sum2 = hn::Add(sum2, square(unmasked));
  }
  return sum2;
}

}  // namespace

void see(const std::array<SolvedPixels, 2>& rows, bool odd_column, bool has_noise, std::size_t count,
         const std::array<float*, kCellFacts>& facts) {
  const D d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Pixels p = by_turns(every_second(rows[0], i, odd_column), every_second(rows[1], i, odd_column), i);
    const M unsolved = p.has(kNoSolution);
    const auto put = [&](CellFact fact, V value) {
      hn::StoreU(hn::IfThenZeroElse(unsolved, value), d, facts[fact] + i);
    };
    put(kCellPixels, number(1));
    put(kCellSlope2, p.slope2());
    put(kCellAlbedo, p.some_albedo());
    put(kCellMisfit2, has_noise ? p.misfit2() : number(0));
  }
}

void add(const float* cells, std::size_t count, float* sums) {
  const D d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Add(hn::LoadU(d, sums + i), hn::LoadU(d, cells + i)), d, sums + i);
  }
}

void average(const std::array<const float*, kCellFacts>& columns, std::size_t count, const CellMeans& means) {
  const D d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto sum = [&](CellFact fact) {
      const float* at = columns[fact] + i;
      return hn::Add(hn::Add(hn::LoadU(d, at), hn::LoadU(d, at + 1)), hn::LoadU(d, at + 2));
    };
    // At least one is divided by, so that none of none is none.
    const V share = hn::Div(number(1), hn::Max(sum(kCellPixels), number(1)));
    const V slope2 = hn::Mul(sum(kCellSlope2), share), albedo = hn::Mul(sum(kCellAlbedo), share);
    hn::StoreInterleaved2(slope2, slope2, d, means.slope2 + 2 * i);
    hn::StoreInterleaved2(albedo, albedo, d, means.albedo + 2 * i);
  }
}

void angles(const SolvedPixels& pixels, const CellMeans& cells, const float* within2,
            const ModelSurroundings& around, const ModelTraits& traits, bool has_noise, std::size_t count,
            float* angles_deg) {
  const D d;
  constexpr float kDegree = static_cast<float>(180 / kPi);
  for (std::size_t x = 0; x < count; x += hn::Lanes(d)) {
    const Pixels p = all_of(pixels, x);
    V sum2 =
        angle2(p, hn::LoadU(d, cells.slope2 + x), hn::LoadU(d, cells.albedo + x), around, traits, has_noise);
    if (within2 != nullptr) {
      sum2 = hn::Add(sum2, hn::Mul(number(kDegree * kDegree), hn::LoadU(d, within2 + x)));
    }
    const V angle = hn::Min(hn::Sqrt(sum2), number(kMostAngle_deg));
    hn::StoreU(hn::IfThenZeroElse(p.has(kNoSolution), angle), d, angles_deg + x);
  }
}

void albedo_sigma(const float* angles_deg, const float* albedo, std::size_t count, float* sigma) {
  const D d;
  constexpr float kRadian = static_cast<float>(kPi / 180);
  for (std::size_t x = 0; x < count; x += hn::Lanes(d)) {
    const V share = hn::Mul(number(kRadian), hn::LoadU(d, angles_deg + x));
    hn::StoreU(hn::Mul(share, hn::LoadU(d, albedo + x)), d, sigma + x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(see);
HWY_EXPORT(add);
HWY_EXPORT(average);
HWY_EXPORT(angles);
HWY_EXPORT(albedo_sigma);

void see_cells(const std::array<SolvedPixels, 2>& rows, bool odd_column, bool has_noise, std::size_t count,
               const std::array<float*, kCellFacts>& facts) {
  HWY_DYNAMIC_DISPATCH(see)(rows, odd_column, has_noise, count, facts);
}

void add_cells(const float* cells, std::size_t count, float* sums) {
  HWY_DYNAMIC_DISPATCH(add)(cells, count, sums);
}

void mean_around(const std::array<const float*, kCellFacts>& columns, std::size_t count,
                 const CellMeans& means) {
  HWY_DYNAMIC_DISPATCH(average)(columns, count, means);
}

void model_angles(const SolvedPixels& pixels, const CellMeans& cells, const float* within2,
                  const ModelSurroundings& around, const ModelTraits& traits, bool has_noise,
                  std::size_t count, float* angles_deg) {
  HWY_DYNAMIC_DISPATCH(angles)(pixels, cells, within2, around, traits, has_noise, count, angles_deg);
}

void model_albedo_sigma(const float* angles_deg, const float* albedo, std::size_t count, float* sigma) {
  HWY_DYNAMIC_DISPATCH(albedo_sigma)(angles_deg, albedo, count, sigma);
}

}  // namespace weft::solver
#endif
