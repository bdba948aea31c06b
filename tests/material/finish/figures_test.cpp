// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

#include "material/finish/mean_repeat.h"
#include "material/finish/tile.h"
#include "tests/material/finish/cloths.h"

namespace weft::material {
namespace {

double seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// Prints what docs/finishing.md tells of straightening and of tiles: processor time of all threads.
TEST(FinishingFigures, AreThoseOfThePage) {
  const WeaveSettings weaves[] = {
      {.pitch_x_px = 21.6, .pitch_y_px = 21.6, .turn_deg = 1.9, .wander = 0.03, .warp_px = 1},
      {.binding = kTwill,
       .pitch_x_px = 14.2,
       .pitch_y_px = 13.1,
       .turn_deg = 2.1,
       .wander = 0.04,
       .warp_px = 1},
      {.binding = kSatin5,
       .pitch_x_px = 11.3,
       .pitch_y_px = 13.7,
       .turn_deg = -0.8,
       .wander = 0.04,
       .warp_px = 1},
      {.binding = kSatin5,
       .pitch_x_px = 11.3,
       .pitch_y_px = 13.7,
       .turn_deg = -0.8,
       .wander = 0.04,
       .warp_px = 1,
       .bow_px = 12},
  };
  for (const WeaveSettings& weave : weaves) {
    const Surface surface = weave_surface(weave, {1024, 1024});
    for (const int repeats : {0, 5}) {
      const Result<Lattice> lattice = find_lattice(surface);
      ASSERT_TRUE(lattice);
      const double start = seconds();
      const Result<Straightened> cloth =
          straighten(surface, *lattice, {.repeats_x = repeats, .repeats_y = repeats});
      ASSERT_TRUE(cloth) << cloth.error().message();
      const double straight = seconds();
      const TileOptions options = tile_of(*cloth);
      const Result<Tile> found = tile(cloth->surface, options);
      ASSERT_TRUE(found) << found.error().message();
      const double done = seconds();
      const Result<Straightened> affine = straighten(surface, *lattice, {.lock_in_repeats = 0});
      ASSERT_TRUE(affine);
      const TileOptions plain = tile_of(*affine);
      std::printf(
          "%s, bow %.0f px: %.3f of the relief repeats (affine %.3f), farthest turn %.3f deg (%.3f), %.2f s; "
          "tile %d x %d of %d starts, normals %.2f deg at the cuts, %.1f everywhere, %.2f s\n",
          weave.binding.name, weave.bow_px,
          repeating_share(cloth->surface, options.repeat_x_px, options.repeat_y_px),
          repeating_share(affine->surface, plain.repeat_x_px, plain.repeat_y_px),
          farthest_turn_deg(*cloth, weave, surface.size()), farthest_turn_deg(*affine, weave, surface.size()),
          straight - start, cloth->period_px.width, cloth->period_px.height, found->places,
          found->normal_p99_at_cuts_deg, found->normal_p99_deg, done - straight);
      for (const Seam& seam : {found->x, found->y}) {
        std::printf("  wrap %.2f %.2f %.2f, gradient %.3f slopes %.3f albedo, residual %.3f, curl %.3f\n",
                    seam.wrap_step_slope, seam.wrap_step_albedo, seam.wrap_step_height, seam.gradient_slope,
                    seam.gradient_albedo, seam.residual, seam.curl);
        EXPECT_LE(seam.wrap_step_slope, 1.1);
        EXPECT_LE(seam.wrap_step_height, 1.1);
        EXPECT_GT(seam.gradient_slope, 0.8);
        EXPECT_LT(seam.gradient_slope, 1.1);
      }
    }
  }
}

}  // namespace
}  // namespace weft::material
