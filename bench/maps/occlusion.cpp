// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/studies.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "bench/base/rig.h"
#include "bench/maps/cloths.h"
#include "bench/maps/processor_time.h"
#include "bench/oracles/sky_oracle.h"
#include "material/maps/occlusion.h"
#include "solver/transport/horizon.h"

namespace weft::bench {
namespace {

constexpr int kTileSide = 64;

struct OcclusionScene {
  std::string cloth;
  double yarn_px = 0;
  SampledCloth map;
  Rect tile;
  Image<float> truth;

  Json row(const std::string& way) const { return {{"cloth", cloth}, {"yarn_px", yarn_px}, {"way", way}}; }
};

Result<OcclusionScene> occlusion_scene(simulator::Family family, double yarn_px, Size size, int threads) {
  simulator::GeometrySettings geometry = cloth_of(family);
  geometry.warp_pitch_mm = geometry.weft_pitch_mm = yarn_px * kClothPitch_mm;
  OcclusionScene scene = {family == simulator::Family::kPlain ? "plain" : "deep",
                          yarn_px,
                          sampled(geometry, size, kClothPitch_mm, threads),
                          {},
                          {}};
  const int x = (size.width - kTileSide) / 2, y = (size.height - kTileSide) / 2;
  scene.tile = {x, y, x + kTileSide, y + kTileSide};
  Result<Image<float>> truth = test::openness_by_rays(scene.map.height_mm, kClothPitch_mm, scene.tile);
  if (!truth) return std::move(truth).error();
  scene.truth = std::move(truth).value();
  return scene;
}

// `found` begins at the tile's corner.
void add_errors(View<const float> found, const Image<float>& truth, Json& row) {
  double mean = 0, squares = 0, largest = 0;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const double e = static_cast<double>(found(x, y)) - static_cast<double>(truth(x, y));
      mean += e;
      squares += e * e;
      largest = std::max(largest, std::abs(e));
    }
  }
  const double count = static_cast<double>(truth.size().pixels());
  row["rms"] = std::sqrt(squares / count);
  row["bias"] = mean / count;
  row["largest"] = largest;
}

double bent_error_deg(const OcclusionScene& scene, const Image<float>& bent_normal) {
  constexpr int kEvery = 5;
  double sum = 0, count = 0;
  for (int y = scene.tile.y0; y < scene.tile.y1; y += kEvery) {
    for (int x = scene.tile.x0; x < scene.tile.x1; x += kEvery) {
      const Vec3 bent = {static_cast<double>(bent_normal(x, y, 0)), static_cast<double>(bent_normal(x, y, 1)),
                         static_cast<double>(bent_normal(x, y, 2))};
      sum += angle_deg(bent, test::sky_by_marching(scene.map.height_mm, kClothPitch_mm, x, y).bent_normal);
      count += 1;
    }
  }
  return sum / count;
}

Result<void> add_sweeps(const OcclusionScene& scene, int threads, Rows& rows) {
  for (const int directions : {4, 8, 16}) {
    std::optional<Result<material::Occlusion>> found;
    const double seconds = processor_seconds([&] {
      found =
          material::occlusion(scene.map.height_mm.plane(),
                              {.mm_per_pixel = kClothPitch_mm, .directions = directions, .threads = threads});
    });
    if (!*found) return found->error();
    Json row = scene.row("line sweep, " + std::to_string(directions) + " directions");
    add_errors((*found)->openness.plane().crop(scene.tile), scene.truth, row);
    row["bent_normal_deg"] = bent_error_deg(scene, (*found)->bent_normal);
    row["us_per_pixel"] = seconds * 1e6 / static_cast<double>(scene.map.height_mm.size().pixels());
    rows.push_back(std::move(row));
  }
  return {};
}

Result<void> add_steps(const OcclusionScene& scene, Rows& rows) {
  const auto relief = solver::Relief::of(scene.map.height_mm.plane(), kClothPitch_mm);
  if (!relief) return relief.error();
  const Image<float> normal = test::normals_of_heights(scene.map.height_mm, kClothPitch_mm, scene.tile);
  for (const int slices : {4, 8, 16}) {
    Image<float> found(scene.truth.size());
    Result<void> done;
    const double seconds = processor_seconds([&] {
      done = solver::scan_openness(*relief, scene.tile, {normal.plane(0), normal.plane(1), normal.plane(2)},
                                   {slices, 2 * slices, 64}, found.plane());
    });
    if (!done) return done;
    Json row = scene.row("horizon steps, " + std::to_string(slices) + " x " + std::to_string(2 * slices));
    add_errors(found.plane(), scene.truth, row);
    row["us_per_pixel"] = seconds * 1e6 / static_cast<double>(found.size().pixels());
    rows.push_back(std::move(row));
  }
  return {};
}

}  // namespace

/// Line sweeps of 4, 8 and 16 directions, and horizon steps of solver/transport, on plain and deep weaves of
/// 10 and 20.75 pixels a yarn: openness against 1024 rays a pixel, bent normals against marching, and
/// processor time on a map of one megapixel by default.
Result<Rows> maps_occlusion(const StudyOptions& options) {
  const Size size = bench_size(options.megapixels);
  Rows rows;
  for (const auto family : {simulator::Family::kPlain, simulator::Family::kDeep}) {
    for (const double yarn_px : {20.75, 10.0}) {
      const Result<OcclusionScene> scene = occlusion_scene(family, yarn_px, size, options.threads);
      if (!scene) return scene.error();
      if (Result<void> done = add_sweeps(*scene, options.threads, rows); !done)
        return std::move(done).error();
      if (Result<void> done = add_steps(*scene, rows); !done) return std::move(done).error();
    }
  }
  return rows;
}

}  // namespace weft::bench
