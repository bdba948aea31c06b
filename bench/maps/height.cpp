// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/studies.h"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "bench/base/rig.h"
#include "bench/maps/cloths.h"
#include "bench/maps/height_difference.h"
#include "bench/maps/processor_time.h"
#include "core/vec.h"
#include "solver/height/tiled_height.h"
#include "solver/transport/pixel_hash.h"

namespace weft::bench {
namespace {

constexpr double kNoise_deg = 0.25;

// A normal number from a pixel's coordinates (Box and Muller 1958), two of them.
std::pair<double, double> normal_pair(int x, int y) {
  const solver::PixelHash hash = solver::hash_of(x, y);
  const double u = (hash.first + 0.5) * 0x1p-32, turn = 2 * kPi * hash.second * 0x1p-32;
  const double radius = std::sqrt(-2 * std::log(u));
  return {radius * std::cos(turn), radius * std::sin(turn)};
}

// Slopes err by noise of so many degrees, as the rms angle of a level normal.
void add_noise(SampledCloth& cloth, double sigma_deg) {
  const double sigma = radians(sigma_deg) / std::sqrt(2.0);
  for (int y = 0; y < cloth.normal.height(); ++y) {
    for (int x = 0; x < cloth.normal.width(); ++x) {
      const auto [along, up] = normal_pair(x, y);
      cloth.normal(x, y, 0) += static_cast<float>(sigma * along);
      cloth.normal(x, y, 1) += static_cast<float>(sigma * up);
    }
  }
}

struct TilesOf {
  int tile_px, halo_px;
};

}  // namespace

/// Heights of a draped plain weave with a quarter of a degree of noise (4 megapixels by default) as one solve
/// of the whole and in tiles, a row each. `to_whole_rms_px` and `to_whole_max_px` are against that whole
/// solve, `rms_error_px` is against the truth, each after the best plane; `us_per_pixel` is processor time.
Result<Rows> maps_height(const StudyOptions& options) {
  const Size size = bench_size(options.megapixels);
  SampledCloth cloth =
      sampled(draped_cloth(simulator::Family::kPlain), size, kClothPitch_mm, options.threads);
  add_noise(cloth, kNoise_deg);
  const solver::HeightOptions plain = {.mm_per_pixel = kClothPitch_mm, .threads = options.threads};
  const double pixels = static_cast<double>(size.pixels());

  std::optional<Result<solver::Height>> whole;
  const double whole_seconds =
      processor_seconds([&] { whole = solver::height_from_normals(cloth.normals(), {}, plain); });
  if (!*whole) return whole->error();
  const Image<float>& reference = (*whole)->height_mm;
  Rows rows = {{{"way", "whole"},
                {"width", size.width},
                {"height", size.height},
                {"rms_error_px", height_difference(reference, cloth.height_mm, kClothPitch_mm).rms},
                {"us_per_pixel", whole_seconds / pixels * 1e6}}};
  for (const TilesOf& way : {TilesOf{512, 128}, {512, 64}, {1024, 128}}) {
    std::optional<Result<solver::TiledHeight>> tiled;
    const double seconds = processor_seconds([&] {
      tiled = solver::tiled_height(solver::rows_of(cloth.normals(), {}), {plain, way.tile_px, way.halo_px});
    });
    if (!*tiled) return tiled->error();
    const HeightDifference to_whole = height_difference((*tiled)->height_mm, reference, kClothPitch_mm);
    rows.push_back(
        {{"way", "tiles of " + std::to_string(way.tile_px) + ", halo " + std::to_string(way.halo_px)},
         {"width", size.width},
         {"height", size.height},
         {"to_whole_rms_px", to_whole.rms},
         {"to_whole_max_px", to_whole.largest},
         {"rms_error_px", height_difference((*tiled)->height_mm, cloth.height_mm, kClothPitch_mm).rms},
         {"us_per_pixel", seconds / pixels * 1e6},
         {"ratio_to_whole", seconds / whole_seconds}});
  }
  return rows;
}

}  // namespace weft::bench
