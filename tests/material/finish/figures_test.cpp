// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

#include "material/finish/tile.h"
#include "tests/material/finish/cloths.h"
#include "tests/material/finish/repeating_share.h"

namespace weft::material {
namespace {

double seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

WeaveSettings satin(double bow_px) {
  return {.binding = kSatin5,
          .pitch_x_px = 11.3,
          .pitch_y_px = 13.7,
          .turn_deg = -0.8,
          .wander = 0.04,
          .warp_px = 1,
          .bow_px = bow_px};
}

const WeaveSettings kWeaves[] = {
    {.pitch_x_px = 21.6, .pitch_y_px = 21.6, .turn_deg = 1.9, .wander = 0.03, .warp_px = 1},
    {.binding = kTwill,
     .pitch_x_px = 14.2,
     .pitch_y_px = 13.1,
     .turn_deg = 2.1,
     .wander = 0.04,
     .warp_px = 1},
    satin(0),
    satin(12),
};

void print_straightened(const WeaveSettings& weave, Size size, const Straightened& cloth,
                        const Straightened& affine, double taken_s) {
  const TilingOptions options = tile_of(cloth), plain = tile_of(affine);
  std::printf(
      "%s, bow %.0f px: %.3f of the relief repeats (affine %.3f), farthest turn %.3f deg (%.3f), %.2f s; ",
      weave.binding.name, weave.bow_px,
      repeating_share(cloth.surface, options.repeat_x_px, options.repeat_y_px),
      repeating_share(affine.surface, plain.repeat_x_px, plain.repeat_y_px),
      farthest_turn_deg(cloth, weave, size), farthest_turn_deg(affine, weave, size), taken_s);
}

void print_tile(const Straightened& cloth, const Tile& tile, double taken_s) {
  std::printf("tile %d x %d of %d starts, normals %.2f deg at the cuts, %.1f everywhere, %.2f s\n",
              cloth.period_px.width, cloth.period_px.height, tile.places, tile.normal_p99_at_cuts_deg,
              tile.normal_p99_deg, taken_s);
  for (const Seam& seam : {tile.x, tile.y}) {
    std::printf("  wrap %.2f %.2f %.2f, gradient %.3f slopes %.3f albedo, residual %.3f, curl %.3f\n",
                seam.wrap_step_slope, seam.wrap_step_albedo, seam.wrap_step_height, seam.gradient_slope,
                seam.gradient_albedo, seam.residual, seam.curl);
    EXPECT_LE(seam.wrap_step_slope, 1.1);
    EXPECT_LE(seam.wrap_step_height, 1.1);
    EXPECT_GT(seam.gradient_slope, 0.8);
    EXPECT_LT(seam.gradient_slope, 1.1);
  }
}

// Prints what docs/finishing.md tells of straightening and of tiles: processor time of all threads.
TEST(FinishingFigures, AreThoseOfThePage) {
  for (const WeaveSettings& weave : kWeaves) {
    const Surface surface = weave_surface(weave, {1024, 1024});
    for (const int repeats : {0, 5}) {
      const Result<Lattice> lattice = find_lattice(surface);
      ASSERT_TRUE(lattice);
      const Result<Straightened> affine = straighten(surface, *lattice, {.lock_in_repeats = 0});
      ASSERT_TRUE(affine);
      const double start = seconds();
      const Result<Straightened> cloth =
          straighten(surface, *lattice, {.repeats_x = repeats, .repeats_y = repeats});
      ASSERT_TRUE(cloth) << cloth.error().message();
      print_straightened(weave, surface.size(), *cloth, *affine, seconds() - start);
      const double straight = seconds();
      const Result<Tile> found = tile(cloth->surface, tile_of(*cloth));
      ASSERT_TRUE(found) << found.error().message();
      print_tile(*cloth, *found, seconds() - straight);
    }
  }
}

}  // namespace
}  // namespace weft::material
