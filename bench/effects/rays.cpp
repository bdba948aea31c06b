// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/studies.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "bench/effects/patch.h"
#include "core/parallel.h"
#include "simulator/transport/bounces.h"

namespace weft::bench {
namespace {

using namespace simulator;

constexpr int kMostBenchRays = 4096;
constexpr int kReferenceRays = 64 * kMostBenchRays;
constexpr int kSampledPatch = 60;
constexpr int kRepeat = 20;  // of the weave: two yarns of ten pixels
constexpr Rect kRepeatPixels = {kRepeat, kRepeat, 2 * kRepeat, 2 * kRepeat};
constexpr double kAlbedo = 0.5;

/// A number a pixel.
using Estimate = std::function<Result<std::vector<double>>(Rect pixels, int rays, std::uint32_t stream)>;

struct Sampled {
  const char* effect;
  int default_rays;
  Estimate estimate;
};

std::vector<double> values_of(const Image<float>& image) {
  std::vector<double> values;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) values.push_back(static_cast<double>(image(x, y)));
  }
  return values;
}

Estimate soft_shadow(const TracedPatch& patch) {
  return [&patch](Rect pixels, int rays, std::uint32_t stream) -> Result<std::vector<double>> {
    const RaySettings settings = {rays, patch.halos.shadow_mm, 1, stream};
    const auto visible = visible_fraction(patch.mesh, pixels, patch.led, settings);
    if (!visible) return visible.error();
    return values_of(*visible);
  };
}

Estimate openness(const TracedPatch& patch) {
  return [&patch](Rect pixels, int rays, std::uint32_t stream) -> Result<std::vector<double>> {
    const RaySettings settings = {rays, patch.halos.bounce_mm, 1, stream};
    const auto bounces = Bounces::trace(patch.mesh, patch.normals, pixels, settings);
    if (!bounces) return bounces.error();
    return values_of(bounces->openness());
  };
}

Estimate one_bounce(const TracedPatch& patch) {
  const Vec3 to_led = normalized(patch.led.position_mm);
  std::vector<Rgb> direct, albedo(patch.normals.size(), Rgb{kAlbedo, kAlbedo, kAlbedo});
  for (const Vec3 normal : patch.normals) {
    const double cosine = std::max(dot(normal, to_led), 0.0);
    direct.push_back({cosine, cosine, cosine});
  }
  return
      [&patch, direct, albedo](Rect pixels, int rays, std::uint32_t stream) -> Result<std::vector<double>> {
        const RaySettings settings = {rays, patch.halos.bounce_mm, 1, stream};
        const auto bounces = Bounces::trace(patch.mesh, patch.normals, pixels, settings);
        if (!bounces) return bounces.error();
        const auto indirect = bounces->gather(direct, albedo);
        if (!indirect) return indirect.error();
        std::vector<double> values;
        for_each_pixel(pixels, [&](std::size_t, int x, int y) {
          values.push_back((*indirect)[patch.mesh.vertex(x, y)][1]);
        });
        return values;
      };
}

/// By rows, so that no more than a row's rays are in memory.
Result<std::vector<double>> reference(const Estimate& estimate, int threads) {
  std::vector<Result<std::vector<double>>> rows(kRepeat, std::vector<double>());
  parallel_for(kRepeat, threads, [&](std::size_t row, int) {
    Rect pixels = kRepeatPixels;
    pixels.y0 += static_cast<int>(row);
    pixels.y1 = pixels.y0 + 1;
    rows[row] = estimate(pixels, kReferenceRays, 2);
  });
  std::vector<double> all;
  for (const auto& row : rows) {
    if (!row) return row.error();
    all.insert(all.end(), row->begin(), row->end());
  }
  return all;
}

Result<Json> measured(const Sampled& sampled, int rays, std::span<const double> truth, const Rect patch) {
  Result<std::vector<double>> values = std::vector<double>();
  const double seconds = least_seconds(3, [&] { values = sampled.estimate(patch, rays, 1); });
  if (!values) return values.error();
  double square = 0, largest = 0;
  for_each_pixel(kRepeatPixels, [&](std::size_t i, int x, int y) {
    const double error = (*values)[index_in(patch, x, y)] - truth[i];
    square += error * error;
    largest = std::max(largest, std::abs(error));
  });
  return Json{{"effect", sampled.effect},
              {"rays", rays},
              {"default", rays == sampled.default_rays ? "<--" : ""},
              {"rms_error", std::sqrt(square / static_cast<double>(truth.size()))},
              {"largest_error", largest},
              {"ns_per_pixel", seconds * 1e9 / static_cast<double>(patch.pixels())},
              {"threads", 1}};
}

}  // namespace

/// Error and time of what is sampled, at 1, 4, 16 ... 4096 rays a pixel on the deep weave: the share of a LED
/// of 12 mm that each point sees, openness, and irradiance by one bounce at albedo 0.5 (1: that of a surface
/// that faces the LED). Errors are over one repeat of the weave against 64 times the most rays, of another
/// random stream; ns_per_pixel is of one thread, one frame for the LED, all frames for the others; `ratio` is
/// that over the default's. Threads are for the reference.
Result<Rows> effects_rays(const StudyOptions& options) {
  const Result<TracedPatch> patch = traced_patch(kSampledPatch);
  if (!patch) return patch.error();
  Rows rows;
  for (const Sampled& sampled : {Sampled{"soft shadow", kShadowRays, soft_shadow(*patch)},
                                 Sampled{"openness", kBounceRays, openness(*patch)},
                                 Sampled{"one bounce", kBounceRays, one_bounce(*patch)}}) {
    const auto truth = reference(sampled.estimate, options.threads);
    if (!truth) return truth.error();
    Rows of_this;
    double default_ns = 0;
    for (int rays = 1; rays <= kMostBenchRays; rays *= 4) {
      Result<Json> row = measured(sampled, rays, *truth, patch->pixels);
      if (!row) return row.error();
      if (rays == sampled.default_rays) default_ns = (*row)["ns_per_pixel"].get<double>();
      of_this.push_back(std::move(*row));
    }
    for (Json& row : of_this) {
      row["ratio"] = row["ns_per_pixel"].get<double>() / default_ns;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace weft::bench
