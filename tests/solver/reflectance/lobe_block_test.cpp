// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_block.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "tests/solver/reflectance/pixels.h"

// The vector kernels against pixels in double.

namespace weft::solver {
namespace {

constexpr std::size_t kBlockPixels = LobeBlock::kPixels;

const std::array<Lobe, 7> kBlockLobes = {
    Lobe{.family = LobeFamily::kLambert, .bend = 0.2},
    Lobe{.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.04},
    Lobe{.family = LobeFamily::kGgx, .alpha = 0.15, .f0 = 0.05, .bend = 0.1},
    Lobe{.family = LobeFamily::kAnisotropicGgx, .alpha = 0.45, .f0 = 0.05, .along = 0.35, .axis = 0.4},
    Lobe{.family = LobeFamily::kBeckmann, .alpha = 0.3, .f0 = 0.04},
    Lobe{.family = LobeFamily::kCloth, .alpha = 0.4, .f0 = 0.05},
    Lobe{.family = LobeFamily::kTwoGgx, .alpha = 0.15, .f0 = 0.05, .broad = 0.5, .broad_share = 0.4}};

struct YarnFit {
  PixelFit fit;
  double yarn = 0;
};

// By the yarn that costs less.
YarnFit fit_in_double(const Lobe& lobe, std::span<const LobeReading> readings, Vec3 start) {
  YarnFit best = {fit_pixel(lobe, readings, start, 0, 12)};
  if (lobe.family != LobeFamily::kAnisotropicGgx) return best;
  const PixelFit across = fit_pixel(lobe, readings, start, kPi / 2, 12);
  return across.cost < best.fit.cost ? YarnFit{across, kPi / 2} : best;
}

std::unique_ptr<LobeBlock> block_of(const PixelTruth& cloth) {
  auto block = std::make_unique<LobeBlock>(10);
  for (std::size_t i = 0; i < kBlockPixels; ++i) {
    block->put(i, cloth.samples.of(i));
    block->begin_at(i, cloth.start[i]);
  }
  return block;
}

TEST(LobeBlock, FitsAPixelAsDoubleDoes) {
  for (const Lobe& lobe : kBlockLobes) {
    const PixelTruth cloth = pixels_of(model_of(lobe), kBlockPixels, {.has_both_yarns = true}, 3);
    const auto block = block_of(cloth);
    improve_block(lobe, 0, *block, kBlockPixels);
    double worst = 0;
    int other_valley = 0;
    for (std::size_t i = 0; i < kBlockPixels; ++i) {
      const YarnFit truth = fit_in_double(lobe, cloth.samples.of(i), cloth.start[i]);
      // Where two valleys are as deep either may be taken.
      if (std::abs(block->cost[i] - truth.fit.cost) > 0.01 * (1 + truth.fit.cost)) {
        EXPECT_LT(block->cost[i], 1.5 * truth.fit.cost + 1) << name_of(lobe.family) << " pixel " << i;
        ++other_valley;
        continue;
      }
      EXPECT_EQ(block->across[i] > 0, truth.yarn > 0) << name_of(lobe.family) << " pixel " << i;
      worst = std::max(worst, angle_deg(block->b(i), truth.fit.b));
    }
    EXPECT_LT(worst, 0.05) << name_of(lobe.family);
    EXPECT_LE(other_valley, 3) << name_of(lobe.family);
  }
}

TEST(LobeBlock, FitsAPixelWhoseYarnIsKnownAsDoubleDoes) {
  for (const Lobe& lobe : kBlockLobes) {
    const PixelTruth cloth = pixels_of(model_of(lobe), kBlockPixels, {.has_both_yarns = true}, 4);
    const auto block = block_of(cloth);
    for (std::size_t i = 0; i < kBlockPixels; ++i) block->across[i] = cloth.yarn[i] > 0 ? 1 : 0;
    fit_block(lobe, *block, 12);
    double worst = 0;
    int other_valley = 0;
    for (std::size_t i = 0; i < kBlockPixels; ++i) {
      const PixelFit truth = fit_pixel(lobe, cloth.samples.of(i), cloth.start[i], cloth.yarn[i], 12);
      if (std::abs(block->cost[i] - truth.cost) > 0.01 * (1 + truth.cost)) {
        EXPECT_LT(block->cost[i], 1.5 * truth.cost + 1) << name_of(lobe.family) << " pixel " << i;
        ++other_valley;
        continue;
      }
      worst = std::max(worst, angle_deg(block->b(i), truth.b));
    }
    EXPECT_LT(worst, 0.05) << name_of(lobe.family);
    EXPECT_LE(other_valley, 3) << name_of(lobe.family);
  }
}

// Diagonal of the inverse in double, and what a lobe one sigma off moves b by.
struct VariancesInDouble {
  double along = 0, across = 0, along_of_lobe = 0, across_of_lobe = 0;
};

VariancesInDouble variances_in_double(const Lobe& lobe, const Lobe& off,
                                      std::span<const LobeReading> readings, Vec3 b, double yarn) {
  PixelSystem system, pull;
  for (const LobeReading& r : readings) {
    if (r.weight == 0) continue;
    const ModelledReading m = modelled_with_derivative(lobe, b, r.from, yarn);
    const double weight = r.weight * huber_weight((r.x - m.x) * std::sqrt(r.weight));
    system.add(m.by_b, weight, 0);
    pull.add(m.by_b, weight, modelled(off, b, r.from, yarn) - m.x);
  }
  const Vec3 n = normalized(b);
  const std::array<Vec3, 3> columns = {system.solved({1, 0, 0}), system.solved({0, 1, 0}),
                                       system.solved({0, 0, 1})};
  VariancesInDouble v;
  v.along = n.x * dot(columns[0], n) + n.y * dot(columns[1], n) + n.z * dot(columns[2], n);
  v.across = columns[0].x + columns[1].y + columns[2].z - v.along;
  const Vec3 change = system.solved(pull.gradient);
  v.along_of_lobe = dot(change, n) * dot(change, n);
  v.across_of_lobe = dot(change, change) - v.along_of_lobe;
  return v;
}

TEST(LobeBlock, KnowsTheVariancesOfAPixelAsDoubleDoes) {
  for (const Lobe& lobe : kBlockLobes) {
    if (!lobe.shines()) continue;
    const PixelTruth cloth = pixels_of(model_of(lobe), kBlockPixels, {.has_both_yarns = true}, 5);
    const auto block = block_of(cloth);
    improve_block(lobe, 0, *block, kBlockPixels);
    Lobe off = lobe;
    off.alpha *= 1.03;
    off.f0 *= 1.05;
    off.axis += 0.02;
    off.broad *= 1.05;
    off.broad_share += 0.02;
    const std::vector<Lobe> one_sigma_off = {off};
    BlockVariances variances;
    write_variances(lobe, one_sigma_off, *block, kBlockPixels, variances);
    for (std::size_t i = 0; i < kBlockPixels; ++i) {
      const double yarn = block->across[i] > 0 ? kPi / 2 : 0;
      const VariancesInDouble truth = variances_in_double(lobe, off, cloth.samples.of(i), block->b(i), yarn);
      const char* name = name_of(lobe.family);
      EXPECT_NEAR(variances.along_of_readings[i] / truth.along, 1, 0.02) << name << " pixel " << i;
      EXPECT_NEAR(variances.across_of_readings[i] / truth.across, 1, 0.02) << name << " pixel " << i;
      const double whole = truth.along_of_lobe + truth.across_of_lobe;
      EXPECT_NEAR(variances.along_of_lobe[i], truth.along_of_lobe, 0.02 * whole) << name << " pixel " << i;
      EXPECT_NEAR(variances.across_of_lobe[i], truth.across_of_lobe, 0.02 * whole) << name << " pixel " << i;
    }
  }
}

TEST(LobeBlock, GivesAPixelTheSameWhateverIsBesideIt) {
  const Lobe& lobe = kBlockLobes[3];
  const PixelTruth cloth = pixels_of(model_of(lobe), kBlockPixels, {.has_both_yarns = true}, 6);
  const auto block = block_of(cloth);
  improve_block(lobe, 0, *block, kBlockPixels);
  LobeBlock moved(10);
  for (std::size_t i = 0; i < kBlockPixels; ++i) {
    const std::size_t to = (7 * i + 5) % kBlockPixels;
    moved.put(to, cloth.samples.of(i));
    moved.begin_at(to, cloth.start[i]);
  }
  improve_block(lobe, 0, moved, kBlockPixels);
  for (std::size_t i = 0; i < kBlockPixels; ++i) {
    const std::size_t to = (7 * i + 5) % kBlockPixels;
    EXPECT_EQ(moved.cost[to], block->cost[i]) << "pixel " << i;
    EXPECT_EQ(moved.solved.x[to], block->solved.x[i]) << "pixel " << i;
    EXPECT_EQ(moved.across[to], block->across[i]) << "pixel " << i;
  }
}

TEST(LobeBlock, FitsPixelsOfTwoSharesOfTheLobeSideBySide) {
  const Lobe lobe = {.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.05};
  const PixelTruth cloth = pixels_of(model_of(lobe), kBlockPixels, {}, 8);
  LobeBlock block(10);
  std::vector<std::vector<LobeReading>> readings;
  for (std::size_t i = 0; i < kBlockPixels; ++i) {
    const auto of_pixel = cloth.samples.of(i);
    readings.emplace_back(of_pixel.begin(), of_pixel.end());
    for (LobeReading& r : readings.back()) r.from.lobe_share = i % 2 == 0 ? 1 : 0.4;
    block.put(i, readings.back());
    block.begin_at(i, cloth.start[i]);
  }
  fit_block(lobe, block, 12);
  double worst = 0;
  int other_valley = 0;
  for (std::size_t i = 0; i < kBlockPixels; ++i) {
    const PixelFit truth = fit_pixel(lobe, readings[i], cloth.start[i], 0, 12);
    const bool is_same = std::abs(block.cost[i] - truth.cost) <= 0.01 * (1 + truth.cost);
    if (is_same) worst = std::max(worst, angle_deg(block.b(i), truth.b));
    if (!is_same) ++other_valley;
  }
  EXPECT_LT(worst, 0.05);
  EXPECT_LE(other_valley, 3);
}

TEST(LobeBlock, KeepsWhatCostsLess) {
  const Lobe right = {.family = LobeFamily::kGgx, .alpha = 0.2, .f0 = 0.04};
  const Lobe wrong = {.family = LobeFamily::kGgx, .alpha = 0.5, .f0 = 0.1};
  const PixelTruth cloth = pixels_of(model_of(right), kBlockPixels, {.albedo = 0.1}, 7);
  const auto block = block_of(cloth);
  improve_block(wrong, 0, *block, kBlockPixels);
  improve_block(right, 1, *block, kBlockPixels);
  const LobeBlock::Lane cost = block->cost;
  improve_block(wrong, 0, *block, kBlockPixels);
  int by_right = 0;
  for (std::size_t i = 0; i < kBlockPixels; ++i) by_right += block->lobe[i] == 1 ? 1 : 0;
  EXPECT_GE(by_right, 60);
  EXPECT_EQ(cost, block->cost);
}

TEST(LobeBlock, FitsNoNumberThatIsNone) {
  const std::array<Lobe, 8> extremes = {
      Lobe{.family = LobeFamily::kGgx, .alpha = 0.02, .f0 = 0.6},
      Lobe{.family = LobeFamily::kGgx, .alpha = 1, .f0 = 0},
      Lobe{.family = LobeFamily::kAnisotropicGgx, .alpha = 0.02, .f0 = 0.6, .along = 20},
      Lobe{.family = LobeFamily::kAnisotropicGgx, .alpha = 0.02, .f0 = 0.6, .along = 0.05},
      Lobe{.family = LobeFamily::kBeckmann, .alpha = 0.02, .f0 = 0.1},
      Lobe{.family = LobeFamily::kCloth, .alpha = 1, .f0 = 0.6},
      Lobe{.family = LobeFamily::kTwoGgx, .alpha = 0.02, .f0 = 0.6, .broad = 1, .broad_share = 1},
      Lobe{.family = LobeFamily::kTwoGgx, .alpha = 0.02, .f0 = 0.6, .broad = 0.02, .broad_share = 0}};
  Random random(4);
  for (const Lobe& lobe : extremes) {
    LobeBlock block(10);
    for (std::size_t i = 0; i < kBlockPixels; ++i) {
      auto readings = readings_of(model_of(lobe), random_normal(random, 89), 0.3, 0, 0.01, random);
      if (i % 4 == 1) readings[0].weight = 0;
      if (i % 4 == 2)
        for (LobeReading& r : readings) r.weight = 0;
      if (i % 4 == 3)
        for (LobeReading& r : readings) r.x = 0;
      const std::array<Vec3, 4> starts = {Vec3{0, 0, 0.3}, {0, 0, -0.1}, {0.2, 0, 0}, {0, 0.2, 0}};
      block.put(i, readings);
      block.begin_at(i, starts[i / 4 % 4]);
    }
    improve_block(lobe, 0, block, kBlockPixels);
    BlockVariances variances;
    write_variances(lobe, std::vector<Lobe>{lobe}, block, kBlockPixels, variances);
    for (std::size_t i = 0; i < kBlockPixels; ++i) {
      const Vec3 b = block.b(i);
      const double all = variances.along_of_readings[i] + variances.across_of_readings[i] +
                         variances.along_of_lobe[i] + variances.across_of_lobe[i];
      EXPECT_TRUE(std::isfinite(b.x + b.y + b.z) && std::isfinite(block.cost[i]) && !std::isnan(all))
          << name_of(lobe.family) << " pixel " << i << ": cost " << block.cost[i] << ", variances " << all;
      EXPECT_GE(variances.along_of_readings[i], 0) << name_of(lobe.family) << " pixel " << i;
      EXPECT_GE(variances.across_of_readings[i], 0) << name_of(lobe.family) << " pixel " << i;
    }
  }
}

}  // namespace
}  // namespace weft::solver
