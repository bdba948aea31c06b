// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/studies.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/base/cloth_mosaics.h"
#include "bench/base/rig.h"
#include "bench/base/yardsticks.h"
#include "core/parallel.h"
#include "pipeline/bands.h"
#include "solver/kernels/linear.h"
#include "solver/method.h"
#include "solver/normals/seed.h"

namespace weft::bench {
namespace {

constexpr std::size_t kLights = 10;
constexpr int kSolveRepeats = 3;

struct Timing {
  double seconds = 0;
  double pixels = 0;
  double bytes_a_pixel = 0;  ///< read and written
};

Result<Timing> time_method(const pipeline::Photographs& photographs, const solver::Method& method,
                           int threads, const pipeline::BandOptions& options = {}) {
  std::optional<Error> failure;
  const double seconds = least_seconds(kSolveRepeats, [&] {
    const Result<double> done = pipeline::solve_bands(
        photographs, method, pipeline::kSolveTile, {threads, {}, [](std::string_view, double) {}},
        [](const pipeline::MapBand&) { return Result<void>(); }, options);
    if (!done) failure = done.error();
  });
  if (failure) return *failure;
  // Eleven frames of counts in; normal, albedo, their sigmas, residual and status out.
  return Timing{seconds, static_cast<double>(photographs.size.pixels()), 2 * (kLights + 1) + 4.0 * 11 + 2};
}

// Planes whose rows lie side by side, as the tiles of a solve have them. Thirty planes of 64 MB, one behind
// the other, would measure how the processor finds its pages: 2.2 times as long on an EPYC at 16 megapixels.
class RowPlanes {
 public:
  RowPlanes(Size size, int planes)
      : size_(size), planes_(planes), rows_({size.width, size.height * planes}) {}
  View<float> plane(int p) { return {rows_.plane().row(p), size_, rows_.plane().stride() * planes_}; }

 private:
  Size size_;
  int planes_;
  Image<float> rows_;
};

Timing time_bare(Size size, int threads) {
  constexpr int kReadings = 3 * static_cast<int>(kLights);
  const LightField field = *LightField::make(bench_lights(0, false), bench_camera(size), size, 0);
  RowPlanes planes(size, kReadings + 6);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (std::size_t k = 0; k < kLights; ++k) {
      for (int x = 0; x < size.width; ++x) {
        const LightField::Light light = field.at(k, 0, x, y);
        for (int c = 0; c < 3; ++c) {
          planes.plane(static_cast<int>(k) * 3 + c)(x, y) =
              static_cast<float>(0.4 * light.strength * light.direction.z);
        }
      }
    }
  });
  const double seconds = least_seconds(kSolveRepeats, [&] {
    const TileOptions tiles = {.width = size.width, .height = 16, .threads = threads};
    const Result<void> done = for_each_tile({0, 0, size.width, size.height}, tiles, {}, [&](Rect tile, int) {
      std::vector<View<const float>> views;
      for (int i = 0; i < kReadings; ++i) views.emplace_back(planes.plane(i).crop(tile));
      const auto out = [&](int i) { return planes.plane(kReadings + i).crop(tile); };
      solver::solve_bare(tile, views, field, {out(0), out(1), out(2)}, {out(3), out(4), out(5)});
    });
    if (!done) std::terminate();
  });
  return {seconds, static_cast<double>(size.pixels()), 4.0 * (3 * kLights + 6)};
}

// The four systems a pixel and nothing else of the seed's method.
Timing time_seed(const LightField& field, Size size, int threads) {
  const int rows = std::clamp(100000 / size.width, 1, size.height);
  std::vector<double> sums(static_cast<std::size_t>(rows));
  const double seconds = least_seconds(kSolveRepeats, [&] {
    parallel_for(static_cast<std::size_t>(rows), threads, [&](std::size_t row, int) {
      const int y = static_cast<int>(row);
      std::vector<solver::PixelRow> pixel(kLights);
      for (int x = 0; x < size.width; ++x) {
        for (std::size_t k = 0; k < kLights; ++k) {
          for (std::size_t c = 0; c < 3; ++c) {
            const LightField::Light light = field.at(k, static_cast<int>(c), x, y);
            pixel[k].direction = light.direction;
            pixel[k].strength[c] = light.strength;
            pixel[k].reading[c] = 0.4 * light.strength * light.direction.z;
          }
        }
        sums[row] += solver::solve_seed_pixel(pixel).n[3].z;
      }
    });
  });
  return {seconds, static_cast<double>(rows) * size.width, 8 * (3 * kLights + 12)};
}

}  // namespace

/// Time of the solver in memory, next to two yardsticks of the same run and the same threads:
///   copy    C: memcpy that reads and writes as many bytes in all as the bare kernel does
///   unpack  U: LibRaw's open and unpack of the eleven frames as DNG files
/// and the rows bare, fast, least-squares and seed (on fewer pixels: it takes as long a pixel).
/// `standard` also with the channels .model of sigma, which a solve of a session writes.
/// `ratio_to_copy` is against a copy of the bytes that the row itself moves, `ratio_to_unpack` against U.
Result<Rows> solve_speed(const StudyOptions& options) {
  const int threads = resolved_threads(options.threads);
  const Size size = bench_size(options.megapixels);
  const double pixels = static_cast<double>(size.pixels());
  Rows rows;

  const Timing bare = time_bare(size, threads);
  const double copy = copy_seconds(bare.bytes_a_pixel * pixels, threads);
  const double copy_a_byte = copy / (bare.bytes_a_pixel * pixels);

  const LightField field = *LightField::make(bench_lights(1, true), bench_camera(size), size, 0);
  pipeline::Photographs photographs = grey_mosaics(field, size, threads);
  const Result<double> unpack = unpack_seconds_a_pixel(photographs, threads);
  if (!unpack) return unpack.error();

  const auto add = [&](const char* kind, const char* name, const Timing& t) {
    const double seconds_a_pixel = t.seconds / t.pixels;
    rows.push_back({{kind, name},
                    {"megapixels", t.pixels * 1e-6},
                    {"threads", threads},
                    {"ns_per_pixel", seconds_a_pixel * 1e9},
                    {"bytes_per_pixel", t.bytes_a_pixel},
                    {"ratio_to_copy", seconds_a_pixel / (copy_a_byte * t.bytes_a_pixel)},
                    {"ratio_to_unpack", seconds_a_pixel / *unpack}});
  };
  add("method", "copy", {copy, pixels, bare.bytes_a_pixel});
  add("method", "unpack", {*unpack * pixels, pixels, 2 * (kLights + 1)});
  add("method", "bare", bare);
  const Result<Timing> fast = time_method(photographs, *solver::fast_method(), threads);
  if (!fast) return fast.error();
  add("quality", "fast", *fast);
  const Result<Timing> least_squares = time_method(photographs, *solver::least_squares_method(), threads);
  if (!least_squares) return least_squares.error();
  add("method", "least-squares", *least_squares);
  const Timing seed = time_seed(field, size, threads);
  add("method", "seed", seed);
  struct OnCloth {
    const char* kind;
    const char* name;
    std::unique_ptr<solver::Method> (*make)();
  };
  constexpr OnCloth kMethods[] = {{"method", "wls", &solver::weighted_method},
                                  {"quality", "standard", &solver::standard_method},
                                  {"quality", "robust", &solver::robust_method},
                                  {"method", "lts", &solver::trimmed_method}};
  for (const Cloth cloth : {Cloth::kSmooth, Cloth::kSatin}) {
    const char* cloth_name = cloth == Cloth::kSmooth ? "smooth" : "satin";
    put_cloth(photographs, cloth, threads);
    for (const OnCloth& m : kMethods) {
      const Result<Timing> timing = time_method(photographs, *m.make(), threads);
      if (!timing) return timing.error();
      add(m.kind, m.name, *timing);
      rows.back()["cloth"] = cloth_name;
      if (m.make != &solver::standard_method) continue;
      const Result<Timing> with_model =
          time_method(photographs, *m.make(), threads, {.model = solver::ModelTraits()});
      if (!with_model) return with_model.error();
      add(m.kind, m.name, *with_model);
      rows.back()["cloth"] = cloth_name;
      rows.back()["sigma"] = "with .model";
    }
  }
  for (Json& row : rows) {
    row["times_quicker_than_seed"] =
        (seed.seconds / seed.pixels) / (row["ns_per_pixel"].get<double>() * 1e-9);
  }
  return rows;
}

}  // namespace weft::bench
