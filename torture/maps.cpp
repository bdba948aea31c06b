// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/solve/solve_record.h"
#include "material/filtering/detail.h"
#include "material/filtering/roughness_mips.h"
#include "material/maps/occlusion.h"
#include "material/opacity/opacity.h"
#include "torture/hard_case.h"

namespace weft::torture {
namespace {

constexpr int kSide = 48;

/// Openness as ambient occlusion is taught: one less the mean sine of the horizons above level.
double openness_above_level(View<const float> height_mm, int x, int y) {
  double sum = 0;
  for (int direction = 0; direction < 8; ++direction) {
    constexpr std::array<int, 8> kX = {1, 1, 0, -1, -1, -1, 0, 1}, kY = {0, 1, 1, 1, 0, -1, -1, -1};
    const int dx = kX[static_cast<std::size_t>(direction)], dy = kY[static_cast<std::size_t>(direction)];
    double sine = 0;
    for (int i = 1;; ++i) {
      const int u = x + i * dx, v = y + i * dy;
      if (u < 0 || v < 0 || u >= height_mm.width() || v >= height_mm.height()) break;
      const double rise = height_mm(u, v) - height_mm(x, y), way = i * std::hypot(dx, dy);
      sine = std::max(sine, rise / std::hypot(rise, way));
    }
    sum += 1 - sine;
  }
  return sum / 8;
}

HardCase tilted_sheet() {
  Image<float> map({kSide, kSide});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) map(x, y) = static_cast<float>(x);
  }
  HardCase hard = {.stage = "maps",
                   .what = "openness of a sheet that is tilted by 45 degrees",
                   .unit = "% of the sky",
                   .plain = 100 * (1 - openness_above_level(map.plane(), kSide / 2, kSide / 2)),
                   .ours = {},
                   .within = 0};
  const Result<material::Occlusion> ours = material::occlusion(map.plane(), {.mm_per_pixel = 1});
  if (ours) {
    hard.ours = 100 * (1 - double{ours->openness(kSide / 2, kSide / 2)});
  } else {
    hard.flag = "refused: " + ours.error().what;
  }
  return hard;
}

/// A texel over two slopes, its yarns being mirrors, across the spread: alpha is the root of twice their
/// variance (Olano and Baker 2010).
HardCase steep_slopes() {
  constexpr double kFirst = 10, kSecond = 10.002;
  constexpr auto kA = static_cast<float>(kFirst), kB = static_cast<float>(kSecond);
  constexpr float kMean = (kA + kB) / 2, kVariance = (kA * kA + kB * kB) / 2 - kMean * kMean;
  const double plain = std::sqrt(2.0 * double{kVariance}), truth = (kSecond - kFirst) / std::sqrt(2.0);
  material::Footprint texel;
  for (const double slope : {kFirst, kSecond}) texel.add(0.5, normalized({-slope, 0, 1}), {0, 0, 0});
  const double ours = material::filtered(texel, material::MipRule::kLean).lobe.across;
  return {.stage = "maps",
          .what = "roughness of a mip over steep slopes that are nearly alike",
          .unit = "%",
          .plain = std::isfinite(plain) ? std::optional(100 * std::abs(plain / truth - 1)) : std::nullopt,
          .ours = 100 * std::abs(ours / truth - 1),
          .within = 0.01};
}

HardCase black_channel() {
  material::Surface surface;
  surface.mm_per_pixel = 1;
  surface.slope = Image<float>({8, 8}, 2);
  surface.albedo = Image<float>({8, 8}, 3);
  surface.sigma_deg = Image<float>({8, 8});
  surface.status = Image<std::uint16_t>({8, 8});
  const double plain = 0.0 / double{surface.albedo(0, 0, 2)};
  HardCase hard = {.stage = "maps",
                   .what = "a detail layer of cloth that reflects no blue",
                   .unit = "of the factor",
                   .plain = std::isfinite(plain) ? std::optional(std::abs(plain - 1)) : std::nullopt,
                   .ours = {},
                   .within = 0};
  const Result<material::DetailLayer> layer = material::detail_layer(surface, {});
  if (layer) {
    hard.ours = std::abs(layer->albedo(3, 3, 2) - 1.0);
  } else {
    hard.flag = "refused: " + layer.error().what;
  }
  return hard;
}

HardCase nearly_alike() {
  constexpr double kTilt_deg = 1e-3;
  const double tilt = radians(30), more = radians(30 + kTilt_deg);
  const auto dot_product = static_cast<float>(std::sin(tilt)) * static_cast<float>(std::sin(more)) +
                           static_cast<float>(std::cos(tilt)) * static_cast<float>(std::cos(more));
  const double plain = degrees(double{std::acos(std::min(dot_product, 1.0F))});
  const double ours = angle_deg({std::sin(tilt), 0, std::cos(tilt)}, {std::sin(more), 0, std::cos(more)});
  return {.stage = "maps",
          .what = "two normals a thousandth of a degree apart, compared",
          .unit = "% of the angle",
          .plain = 100 * std::abs(plain / kTilt_deg - 1),
          .ours = 100 * std::abs(ours / kTilt_deg - 1),
          .within = 1e-6};
}

/// Threads of 12 pixels with gaps of 12; one pixel of a gap is brighter than can be, one of a thread is no
/// number.
HardCase opacity_of_rubbish() {
  Image<float> share({96, 96});
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) share(x, y) = x / 12 % 2 == 0 ? 0.0F : 1.0F;
  }
  share(18, 40) = std::numeric_limits<float>::infinity();
  share(6, 40) = std::numeric_limits<float>::quiet_NaN();
  const double plain = 1 - std::clamp(double{share(6, 40)}, 0.0, 1.0);
  HardCase hard = {.stage = "maps",
                   .what = "light through cloth that reads as no number",
                   .unit = "of opacity",
                   .plain = std::isfinite(plain) ? std::optional(std::abs(plain - 1)) : std::nullopt,
                   .ours = {},
                   .within = 1e-6,
                   .must_say = "unreadable"};
  const Result<material::Opacity> ours = material::opacity_from_transmission({share.plane(), {}});
  if (ours) {
    hard.ours = std::abs(ours->map(6, 40) - 1.0);
    hard.flag = fmt::format("{} pixels unreadable", ours->facts.unreadable);
  } else {
    hard.flag = "refused: " + ours.error().what;
  }
  return hard;
}

}  // namespace

std::vector<HardCase> hard_maps() {
  return {tilted_sheet(), steep_slopes(), black_channel(), opacity_of_rubbish(), nearly_alike()};
}

}  // namespace weft::torture
