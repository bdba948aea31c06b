// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "bench/oracles/rays/gather.h"
#include "bench/oracles/rays/height_grid.h"
#include "bench/oracles/rays/ray_shadows.h"
#include "tests/solver/transport/cloths.h"

// What rays find of a cloth.

namespace weft::test {

inline HeightGrid grid_of(const solver::TestCloth& cloth, Rect block, int halo_px) {
  auto grid = HeightGrid::build(cloth.relief(), block, halo_px);
  EXPECT_TRUE(grid) << (grid ? "" : grid.error().message());
  return *std::move(grid);
}

inline Image<std::uint32_t> visible_in(const HeightGrid& grid, const solver::TestCloth& cloth, Rect tile,
                                       const solver::LightDirections& lights, int reach_px) {
  Image<std::uint32_t> bits({tile.width(), tile.height()}, solver::visibility_words(lights.count));
  const auto done =
      find_visible_lights(grid, tile, cloth.normals_of(tile), lights, reach_px, solver::planes_of(bits));
  EXPECT_TRUE(done) << (done ? "" : done.error().message());
  return bits;
}

inline Image<float> gathered_in(const HeightGrid& grid, const solver::TestCloth& cloth, Rect tile,
                                const Radiosity& radiosity, const GatherSettings& settings) {
  Image<float> light({tile.width(), tile.height()}, radiosity.count);
  const auto done =
      gather_light(grid, tile, cloth.normals_of(tile), radiosity, settings, solver::planes_of(light));
  EXPECT_TRUE(done) << (done ? "" : done.error().message());
  return light;
}

inline Image<float> openness_in(const HeightGrid& grid, const solver::TestCloth& cloth, Rect tile,
                                const GatherSettings& settings) {
  Image<float> openness({tile.width(), tile.height()});
  const auto done = trace_openness(grid, tile, cloth.normals_of(tile), settings, openness.plane());
  EXPECT_TRUE(done) << (done ? "" : done.error().message());
  return openness;
}

}  // namespace weft::test
