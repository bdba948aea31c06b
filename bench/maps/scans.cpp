// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/studies.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/contenders.h"
#include "bench/accuracy/scenes.h"
#include "bench/base/rig.h"
#include "bench/maps/cloths.h"
#include "bench/maps/height_difference.h"
#include "material/maps/flatten.h"
#include "solver/height/height.h"

namespace weft::bench {
namespace {

struct ScannedCloth {
  const char* name;
  const char* scene;  // of accuracy_scenes()
  bool is_twill;
};
constexpr ScannedCloth kCloths[] = {
    {"plain", "plain lambert", false}, {"twill", "plain lambert", true}, {"deep", "deep lambert", false}};

Result<simulator::Scene> scene_of(const ScannedCloth& cloth) {
  AccuracyTableOptions held_out;
  held_out.scene = cloth.scene;
  const Result<std::vector<AccuracyScene>> found = chosen_scenes(held_out);
  if (!found) return found.error();
  simulator::Scene scene = found->front().scene;
  if (cloth.is_twill) scene.geometry.kind = simulator::GeometryKind::kTwill;
  return scene;
}

Rect centre_of(const simulator::CameraSettings& camera, Size size) {
  const int x0 = (camera.width - size.width) / 2 & ~1, y0 = (camera.height - size.height) / 2 & ~1;
  return {x0, y0, x0 + size.width, y0 + size.height};
}

std::array<View<const float>, 3> planes_of_normal(const Image<float>& normal) {
  return {normal.plane(0), normal.plane(1), normal.plane(2)};
}

// Heights in pixels by normals whose slow slopes are taken off.
Result<Image<float>> flat_height(const Image<float>& normal, int threads) {
  const Size size = normal.size();
  Image<float> flat(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float z = std::max(normal(x, y, 2), 0.05F);
      flat(x, y, 0) = -normal(x, y, 0) / z;
      flat(x, y, 1) = -normal(x, y, 1) / z;
      flat(x, y, 2) = 1;
    }
  }
  const Result<material::SlowSlopes> slow =
      material::slow_slopes(flat.plane(0), flat.plane(1), {}, {.mm_per_pixel = 1, .threads = threads});
  if (!slow) return slow.error();
  material::flatten(*slow, {}, flat.plane(0), flat.plane(1), threads);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (const int p : {0, 1}) flat(x, y, p) = -flat(x, y, p);
    }
  }
  Result<solver::Height> height =
      solver::height_from_normals(planes_of_normal(flat), {}, {.threads = threads});
  if (!height) return std::move(height).error();
  return std::move(height->height_mm);
}

double mean_angle_deg(const Image<float>& a, const Image<float>& b) {
  double sum = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x)
      sum += angle_deg({a(x, y, 0), a(x, y, 1), a(x, y, 2)}, {b(x, y, 0), b(x, y, 1), b(x, y, 2)});
  }
  return sum / static_cast<double>(a.size().pixels());
}

Result<Json> row_of_truth(const ScannedCloth& cloth, const simulator::Scene& scene, Size size, int threads) {
  const SampledCloth truth = sampled(scene.geometry, size, kClothPitch_mm, threads);
  const Result<solver::Height> height =
      solver::height_from_normals(truth.normals(), {}, {.mm_per_pixel = kClothPitch_mm, .threads = threads});
  if (!height) return height.error();
  const double rms = height_difference(height->height_mm, truth.height_mm, kClothPitch_mm).rms;
  const double whole = relief(truth.height_mm, kClothPitch_mm);
  return Json{{"cloth", cloth.name}, {"normals", "true"}, {"mean_deg", 0},
              {"relief_px", whole},  {"rms_px", rms},     {"share", rms / whole}};
}

Result<Json> row_of_level(const ScannedCloth& cloth, const Contender& level, const Patch& patch,
                          const Image<float>& truth, int threads) {
  SolvedMaps maps(patch.size());
  if (Result<void> ok = level.solve(patch, threads, maps); !ok) return std::move(ok).error();
  const Result<Image<float>> height = flat_height(maps.normal, threads);
  if (!height) return height.error();
  const double rms = height_difference(*height, truth, 1).rms, whole = relief(truth, 1);
  return Json{
      {"cloth", cloth.name}, {"normals", level.name}, {"mean_deg", mean_angle_deg(maps.normal, patch.normal)},
      {"relief_px", whole},  {"rms_px", rms},         {"share", rms / whole}};
}

}  // namespace

/// Heights of plain, twill and deep weave, an eighth of a megapixel each: from true normals against the true
/// heights, and from the normals that levels solve of rendered photographs (near light, shadows, bounces,
/// noise; cloths that no method is tuned on) against those of the true normals, both flattened. `rms_px` is
/// after the best plane, `share` is that of the relief, the 1st to 99th percentile; `mean_deg` is the angle
/// of the normals to the true ones.
Result<Rows> maps_scans(const StudyOptions& options) {
  const Size size = bench_size(options.megapixels);
  const Result<std::vector<Contender>> levels = contenders_named({"standard", "robust", "reference"});
  if (!levels) return levels.error();
  Rows rows;
  for (const ScannedCloth& cloth : kCloths) {
    const Result<simulator::Scene> scene = scene_of(cloth);
    if (!scene) return scene.error();
    Result<Json> row = row_of_truth(cloth, *scene, size, options.threads);
    if (!row) return std::move(row).error();
    rows.push_back(std::move(*row));
    const Result<Patch> patch = render_patch(*scene, centre_of(scene->camera, size), options.threads);
    if (!patch) return patch.error();
    const Result<Image<float>> truth = flat_height(patch->normal, options.threads);
    if (!truth) return truth.error();
    for (const Contender& level : *levels) {
      if (level.is_yardstick) continue;
      row = row_of_level(cloth, level, *patch, *truth, options.threads);
      if (!row) return std::move(row).error();
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

}  // namespace weft::bench
