// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/maps_studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/accuracy_scenes.h"
#include "bench/accuracy/score.h"
#include "bench/base/measured_rig.h"
#include "bench/maps/cloths.h"
#include "bench/oracles/mesh.h"
#include "bench/oracles/sky_oracle.h"
#include "core/base/vec.h"
#include "material/maps/flatten.h"
#include "material/maps/occlusion.h"
#include "material/opacity/opacity.h"
#include "simulator/geometry/scene_surface.h"
#include "solver/height/height.h"
#include "solver/height/tiled_height.h"
#include "solver/transport/horizon.h"
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

Result<Json> row_of_level(const ScannedCloth& cloth, const Contender& level, const ClothPatch& patch,
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
    if (Result<void> ok = add_row(rows, row_of_truth(cloth, *scene, size, options.threads)); !ok)
      return ok.error();
    const Result<ClothPatch> patch = render_patch(*scene, centre_of(scene->camera, size), options.threads);
    if (!patch) return patch.error();
    const Result<Image<float>> truth = flat_height(patch->normal, options.threads);
    if (!truth) return truth.error();
    for (const Contender& level : *levels) {
      if (level.is_yardstick) continue;
      if (Result<void> ok = add_row(rows, row_of_level(cloth, level, *patch, *truth, options.threads)); !ok)
        return ok.error();
    }
  }
  return rows;
}

namespace {

using SlopePair = std::array<double, 2>;
using SlowError = SlopePair (*)(double u, double v);

constexpr double kBias_deg = 1.5, kYarn_px = 10, kTurned_deg = 1.3, kWander = 0.04;

SlopePair no_error(double, double) {
  return {0, 0};
}
SlopePair cubic_error(double u, double v) {
  const double d = radians(kBias_deg);
  return {d * (0.8 * u + 0.3 * u * u * u + 0.2 * v * u * u), d * (0.7 * v + 0.25 * v * v * v - 0.2 * u * v)};
}
SlopePair corner_error(double u, double v) {
  const double d = radians(kBias_deg);
  return {d * std::pow(u, 7), d * std::pow(v, 7) * (0.5 + 0.5 * u)};
}

SlopePair at_pixel(SlowError error, Size size, int x, int y) {
  return error((2 * x + 1.0) / size.width - 1, 1 - (2 * y + 1.0) / size.height);
}

/// A yarn's way off its place in pitches: one of twelve numbers of about a normal distribution.
double off_place(std::int64_t yarn, int set) {
  const auto n = static_cast<int>((yarn % 100000 + 100000) % 100000);
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += solver::hash_of(n, 12 * set + i).first * 0x1p-32;
  return kWander * sum;
}

/// Slopes of the simulator's weave, turned, each point moved as its two yarns are.
class WanderingWeave {
 public:
  WanderingWeave() : surface_(simulator::surface_of(cloth_of(simulator::Family::kPlain))) {}

  SlopePair slopes(double x, double y) const {
    return {height(x + 0.5, y) - height(x - 0.5, y), height(x, y - 0.5) - height(x, y + 0.5)};
  }

 private:
  double height(double x, double y) const {
    const double c = std::cos(radians(kTurned_deg)), s = std::sin(radians(kTurned_deg));
    const double u = (x * c + y * s) / kYarn_px, v = (y * c - x * s) / kYarn_px;
    const double right = u - off_place(std::llround(std::floor(u)), 0);
    const double down = v - off_place(std::llround(std::floor(v)), 1);
    const double pitch_mm = kYarn_px * kClothPitch_mm;
    return simulator::point_at(surface_, right * pitch_mm, -down * pitch_mm).height_mm / kClothPitch_mm;
  }
  simulator::Surface surface_;
};

struct Slopes {
  Image<float> right, up;

  explicit Slopes(Size size) : right(size), up(size) {}
};

Slopes with_error(const Slopes& cloth, SlowError error) {
  const Size size = cloth.right.size();
  Slopes out(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const SlopePair slow = at_pixel(error, size, x, y);
      out.right(x, y) = cloth.right(x, y) + static_cast<float>(slow[0]);
      out.up(x, y) = cloth.up(x, y) + static_cast<float>(slow[1]);
    }
  }
  return out;
}

struct Flattened {
  double left_deg = 0, us_per_pixel = 0;
};

Result<Flattened> flattened(const Slopes& cloth, SlowError error, const material::FlattenOptions& options) {
  const Slopes slopes = with_error(cloth, error);
  const Size size = slopes.right.size();
  Image<float> removed;
  std::optional<Error> failure;
  const double seconds = processor_seconds([&] {
    const auto slow = material::slow_slopes(slopes.right.plane(), slopes.up.plane(), {}, options);
    if (slow)
      removed = material::removed_slopes(*slow, options.threads);
    else
      failure = slow.error();
  });
  if (failure) return *failure;
  double sum = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const SlopePair slow = at_pixel(error, size, x, y);
      for (int p = 0; p < 2; ++p) {
        const double e = static_cast<double>(removed(x, y, p)) - slow[static_cast<std::size_t>(p)];
        sum += e * e;
      }
    }
  }
  const double pixels = static_cast<double>(size.pixels());
  return Flattened{degrees(std::sqrt(sum / pixels)), seconds / pixels * 1e6};
}

struct Way {
  std::string name;
  material::FlattenOptions options;
};

std::vector<Way> ways(Size size, int threads) {
  const double c = 2 * kYarn_px * std::cos(radians(kTurned_deg)),
               s = 2 * kYarn_px * std::sin(radians(kTurned_deg));
  using material::FlattenMethod;
  std::vector<Way> all;
  for (const int degree : {3, 5}) {
    const std::string name = degree == 3 ? "cubic, " : "quintic, ";
    all.push_back({name + "Hann", {.method = FlattenMethod::kHann, .degree = degree}});
    all.push_back(
        {name + "repeats",
         {.method = FlattenMethod::kRepeat, .degree = degree, .repeat = material::Repeat{c, s, -s, c}}});
    all.push_back({name + "repeats off by 2 %",
                   {.method = FlattenMethod::kRepeat,
                    .degree = degree,
                    .repeat = material::Repeat{1.02 * c, 1.02 * s, -1.02 * s, 1.02 * c}}});
  }
  all.push_back({"high pass, a third of the width",
                 {.method = FlattenMethod::kHighPass, .cut_mm = size.width * kClothPitch_mm / 3}});
  for (Way& way : all) {
    way.options.mm_per_pixel = kClothPitch_mm;
    way.options.threads = threads;
  }
  return all;
}

}  // namespace

/// What each way of flattening leaves of a slow error of 1.5 degrees, a cubic one and one of seventh degree
/// in the corners, and what it takes from the same cloth without one, on a plain weave of 10 pixels a yarn,
/// turned by 1.3 degrees, whose yarns stand off their places by 4 percent of their pitch (rms). Frames of 512
/// x 512 and 1536 x 1024 pixels, rms in degrees.
Result<Rows> maps_flatten(const StudyOptions& options) {
  Rows rows;
  const WanderingWeave weave;
  for (const Size size : {Size{512, 512}, {1536, 1024}}) {
    Slopes cloth(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const SlopePair slope = weave.slopes(x, y);
        cloth.right(x, y) = static_cast<float>(slope[0]);
        cloth.up(x, y) = static_cast<float>(slope[1]);
      }
    }
    for (const Way& way : ways(size, options.threads)) {
      const auto clean = flattened(cloth, no_error, way.options),
                 cubic = flattened(cloth, cubic_error, way.options),
                 corner = flattened(cloth, corner_error, way.options);
      for (const auto* result : {&clean, &cubic, &corner}) {
        if (!*result) return result->error();
      }
      rows.push_back({{"width", size.width},
                      {"way", way.name},
                      {"cubic_left_deg", cubic->left_deg},
                      {"corner_left_deg", corner->left_deg},
                      {"taken_from_cloth_deg", clean->left_deg},
                      {"us_per_pixel", cubic->us_per_pixel}});
    }
  }
  return rows;
}

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

namespace {

struct NamedMesh {
  std::string name;
  MeshScene scene;
};

std::vector<NamedMesh> meshes() {
  std::vector<NamedMesh> all;
  const auto add = [&](const std::string& name, MeshScene scene) {
    scene.side_px = 256;
    for (const auto& [through, back] :
         {std::pair{0.0, 0.0}, std::pair{0.08, 0.0}, std::pair{0.08, 0.25}, std::pair{0.2, 0.25}}) {
      scene.through_yarns = through;
      scene.thrown_back = back;
      all.push_back({name, scene});
    }
    scene.through_yarns = 0.08;
    scene.blur_px = 0.8;
    scene.defocus_px = 1.5;
    all.push_back({name + ", blurred", scene});
  };
  add("mesh 12 px, yarns 5", {.pitch_px = 12, .yarn_px = 5});
  add("lace 9 px, yarns 6", {.pitch_px = 9, .yarn_px = 6, .is_lace = true});
  add("mesh 6 px, yarns 2.5", {.pitch_px = 6, .yarn_px = 2.5});
  return all;
}

struct MapError {
  double rms = 0, mean = 0;
};

MapError error_against(const Image<float>& truth, const std::function<double(int, int)>& found) {
  double squares = 0, sum = 0;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const double off = found(x, y) - double{truth(x, y)};
      squares += off * off;
      sum += off;
    }
  }
  const auto pixels = static_cast<double>(truth.size().pixels());
  return {std::sqrt(squares / pixels), sum / pixels};
}

}  // namespace

/// Opacity of rendered mesh and lace over a light: rms and mean error of 1 - T, and of what is found. `way`
/// says whether it was found; where it was not, both are the same.
Result<Rows> maps_opacity(const StudyOptions& options) {
  Rows rows;
  for (const NamedMesh& mesh : meshes()) {
    const RenderedMesh seen = rendered(mesh.scene);
    const Result<material::Opacity> found =
        material::opacity_from_transmission({seen.share.plane(), {}}, options.threads);
    if (!found) return found.error();
    const MapError straight = error_against(
        seen.coverage, [&](int x, int y) { return std::clamp(1 - double{seen.share(x, y)}, 0.0, 1.0); });
    const MapError error =
        error_against(seen.coverage, [&](int x, int y) { return double{found->map(x, y)}; });
    rows.push_back({{"cloth", mesh.name},
                    {"through", mesh.scene.through_yarns},
                    {"thrown_back", mesh.scene.thrown_back},
                    {"straight_rms", straight.rms},
                    {"straight_mean", straight.mean},
                    {"way", material::name_of(found->facts.way)},
                    {"through_found", found->facts.through_yarns},
                    {"open_found", found->facts.open},
                    {"found_rms", error.rms},
                    {"found_mean", error.mean}});
  }
  return rows;
}

}  // namespace weft::bench
