// SPDX-License-Identifier: Apache-2.0
#include "material/finish/tile.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

#include "tests/material/weave.h"

namespace weft::material {
namespace {

TEST(Tile, Explore) {
  for (const WeaveSettings& w :
       {WeaveSettings{.pitch_x_px = 21.6, .pitch_y_px = 21.6, .turn_deg = 1.9, .wander = 0.03, .warp_px = 1},
        WeaveSettings{.binding = kTwill,
        .pitch_x_px = 14.2,
        .pitch_y_px = 13.1,
        .turn_deg = 2.1,
        .wander = 0.04,
        .warp_px = 1},
        WeaveSettings{.binding = kSatin5,
        .pitch_x_px = 11.3,
        .pitch_y_px = 13.7,
        .turn_deg = -.8,
        .wander = 0.04,
        .warp_px = 1}}) {
    const Surface s = weave_surface(w, {1024, 1024});
    const Result<Lattice> l = find_lattice(s);
    for (int n : {0, 5}) {
      const Result<Straightened> f = straighten(s, *l, {.repeats_x = n, .repeats_y = n});
      int un = 0;
      for (int y = 0; y < f->surface.size().height; ++y)
        for (int x = 0; x < f->surface.size().width; ++x)
          if (f->surface.status(x, y)) {
            if (++un < 5) std::printf("unsolved %d %d\n", x, y);
          }
      std::printf("unsolved %d of %d x %d\n", un, f->surface.size().width, f->surface.size().height);
      const double t0 = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
      const Result<Tile> t = tile(f->surface, tile_of(*f));
      const double t1 = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
      if (!t) {
        std::printf("%s\n", t.error().message().c_str());
        continue;
      }
      std::printf(
          "%s %d x %d from %d of %d starts, relief %.3f mm, mean slope %.4f %.4f, p99 cuts %.2f all %.2f, "
          "%.2f s\n",
          w.binding.name, t->surface.size().width, t->surface.size().height, t->x0, t->places, t->relief_mm,
          t->mean_right, t->mean_up, t->normal_p99_at_cuts_deg, t->normal_p99_deg, t1 - t0);
      for (const Seam& m : {t->x, t->y})
        std::printf(
            "  overlap %d cost %.3f wrap %.2f %.2f %.2f gradient slope %.3f albedo %.3f residual %.3f curl "
            "%.3f\n",
            m.overlap_px, m.cut_cost, m.wrap_step_slope, m.wrap_step_albedo, m.wrap_step_height,
            m.gradient_slope, m.gradient_albedo, m.residual, m.curl);
    }
  }
}

}  // namespace
}  // namespace weft::material
