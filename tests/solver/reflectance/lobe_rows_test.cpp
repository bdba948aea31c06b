// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "solver/reflectance/glossy_method.h"
#include "tests/solver/reflectance/pixels.h"
#include "tests/solver/tiles.h"

// Readings in float32 vectors against readings in double, under near lights.

namespace weft::solver {
namespace {

using test::cloth;
using test::cloth_field;
using test::kClothTile;
using test::ten_leds;
using test::Trial;

const NoiseModel kNoise = {.per_reading = 2e-5, .floor = 1e-6};
const Sight kSight(Vec3{3, -5, 600}, 2);

// A tile with a reading of each kind that does not count, and its parallel readings where it has any.
class Tile {
 public:
  Tile(const LightField& field, int planes, bool is_pair)
      : crossed_(field, kClothTile, planes, cloth(35)), parallel_(field, kClothTile, planes, cloth(50)) {
    crossed_.reading(2)(5, 1) = test::kInfinity;
    crossed_.reading(3)(6, 1) = test::kNaN;
    crossed_.reading(9)(7, 1) = -test::kInfinity;
    for (std::size_t k = 0; k < field.count(); ++k) {
      for (int p = 0; p < planes; ++p) {
        readings_.push_back(crossed_.reading(k, p));
        if (is_pair) of_pair_.push_back(parallel_.reading(k, p));
      }
    }
    input.tile = kClothTile;
    input.planes = planes;
    input.readings = readings_;
    input.field = &field;
    if (planes == 1) input.noise = kNoise;
    input.lobe_share = is_pair ? 0.02 : 1;
    input.parallel = of_pair_;
  }

  TileInput input;

 private:
  Trial crossed_, parallel_;
  std::vector<View<const float>> readings_, of_pair_;
};

void expect_as_in_double(const TileInput& input, Sight sight) {
  LobeReader in_double(input, sight);
  LobeRows rows(input, sight);
  ASSERT_EQ(rows.count(), in_double.count());
  LobeBlock block(rows.count());
  std::vector<LobeReading> truth(rows.count());
  for (int y = 0; y < input.tile.height(); y += 5) {
    rows.go_to_row(y);
    for (int x = 0; x < input.tile.width(); ++x) {
      if (x % kRowGroup == 0) rows.read(x, block);
      in_double.read(x, y, truth);
      const auto i = static_cast<std::size_t>(x % kRowGroup);
      EXPECT_EQ(block.used[i], used_of(truth)) << x << ", " << y;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const LobeReading r = block.reading(i, k);
        const LobeReading& t = truth[k];
        ASSERT_EQ(r.weight > 0, t.weight > 0) << x << ", " << y << " reading " << k;
        EXPECT_LT(length(r.from.light - t.from.light) + length(r.from.half - t.from.half) +
                      length(r.from.view - t.from.view),
                  3e-6);
        EXPECT_NEAR(r.from.light_half, t.from.light_half, 2e-6);
        EXPECT_NEAR(block.lights()[k].grazing[i], std::pow(1 - t.from.light_half, 5), 2e-6);
        EXPECT_NEAR(r.from.lobe_share, t.from.lobe_share, 1e-6);
        if (t.weight == 0) continue;
        EXPECT_NEAR(r.x, t.x, 2e-6 * std::max(1.0, t.x)) << x << ", " << y << " reading " << k;
        EXPECT_NEAR(r.weight / t.weight, 1, 2e-5) << x << ", " << y << " reading " << k;
      }
    }
  }
}

TEST(LobeRows, ReadsAMosaicAsDoubleDoes) {
  const LightField field = cloth_field(ten_leds(1.7));
  for (const bool is_pair : {false, true}) expect_as_in_double(Tile(field, 1, is_pair).input, kSight);
}

TEST(LobeRows, ReadsRgbAsDoubleDoes) {
  const LightField field = cloth_field(ten_leds());
  expect_as_in_double(Tile(field, 3, false).input, kSight);
}

TEST(LobeRows, ReadsDistantLightsAsDoubleDoes) {
  DistantLights lights;
  for (const Vec3& l : ten_directions()) lights.lights.push_back({l, {1, 0.8, 0.7}});
  const auto field = LightField::make(lights, std::nullopt, test::kClothSize, 0);
  ASSERT_TRUE(field);
  expect_as_in_double(Tile(*field, 1, false).input, Sight(std::nullopt, 0));
}

// Maps of a tile, and of its parts.
TEST(GlossyMethod, GivesAPixelTheSameInTilesOfAnySize) {
  const LightField field = cloth_field(ten_leds());
  const Lobe lobe = {.family = LobeFamily::kAnisotropicGgx, .alpha = 0.35, .f0 = 0.05, .along = 0.4};
  const auto base = fast_method();
  const auto method = glossy_method(*base, {{lobe, {lobe}}}, kSight);
  Trial whole(field, kClothTile, 1, cloth(35));
  whole.solve(*method, kNoise);
  int glossy = 0;
  for (const Rect part : {Rect{64, 33, 128, 40}, Rect{128, 33, 195, 49}, Rect{64, 40, 128, 49}}) {
    Trial trial(field, part, 1, [&](int x, int y) {
      return cloth(35)(x + part.x0 - kClothTile.x0, y + part.y0 - kClothTile.y0);
    });
    trial.solve(*method, kNoise);
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        const int wx = x - kClothTile.x0, wy = y - kClothTile.y0, px = x - part.x0, py = y - part.y0;
        ASSERT_EQ(trial.normals(px, py, 0), whole.normals(wx, wy, 0)) << x << ", " << y;
        ASSERT_EQ(trial.albedo(px, py), whole.albedo(wx, wy)) << x << ", " << y;
        ASSERT_EQ(trial.sigma_normal_deg(px, py), whole.sigma_normal_deg(wx, wy)) << x << ", " << y;
        ASSERT_EQ(trial.status(px, py), whole.status(wx, wy)) << x << ", " << y;
        glossy += (trial.status(px, py) & kGlossy) != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(glossy, 1900);
}

}  // namespace
}  // namespace weft::solver
