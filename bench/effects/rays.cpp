// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/effects_studies.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "bench/base/bare_embree.h"
#include "bench/effects/effect_scenes.h"
#include "core/base/parallel.h"
#include "simulator/effects/halos.h"
#include "simulator/geometry/scene_surface.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/transport/bounces.h"
#include "simulator/transport/height_mesh.h"
#include "simulator/transport/shadows.h"

namespace weft::bench {
namespace {

/// A square of cloth of the deep family, ready for rays.
struct TracedPatch {
  simulator::Scene scene;
  simulator::Halos halos;
  Rect pixels;
  simulator::HeightMesh mesh;  ///< over the pixels and all that their rays may meet
  std::vector<Vec3> normals;   ///< by vertex
  simulator::SphereLight led;  ///< 62 degrees from the zenith, 600 mm away, radius 12 mm
};

using namespace simulator;

Result<TracedPatch> traced_patch(int side_px) {
  constexpr double kLedRadius_mm = 12;
  constexpr std::size_t kLowLed = 4;
  Scene scene = cloth_scene(Family::kDeep, {side_px, side_px});
  scene.effects = effects_for(&EffectSettings::interreflection);
  scene.effects.cast_shadows = true;
  const Result<SceneRig> rig = rig_of(scene);
  if (!rig) return rig.error();
  const Result<Halos> halos = halos_of(scene, *rig);
  if (!halos) return halos.error();

  const Rect pixels = {0, 0, side_px, side_px}, area = grown(pixels, halos->all());
  std::vector<Vec3> points_mm, normals;
  std::visit(
      [&](const auto& surface) {
        for_each_pixel(area, [&](std::size_t, int x, int y) {
          const Vec3 p = point_of_pixel(scene, x, y);
          const SurfacePoint at = surface.at(p.x, p.y);
          points_mm.push_back(p + Vec3{0, 0, at.height_mm});
          normals.push_back(at.normal);
        });
      },
      surface_of(scene.geometry));
  Result<HeightMesh> mesh = HeightMesh::build(area, points_mm);
  if (!mesh) return mesh.error();
  const SphereLight led = {rig->leds.leds[kLowLed].position_mm, kLedRadius_mm};
  return TracedPatch{std::move(scene), *halos, pixels, std::move(*mesh), std::move(normals), led};
}

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

namespace {

constexpr int kTimedPatch = 96;
constexpr int kRepeats = 5;

/// Packet `p` of a batch, and what is left of it in the last one.
void fill(const RayBatch& rays, std::size_t p, BarePacket& packet) {
  const std::size_t lanes = packet.is_active.size(), first = p * lanes;
  RTCRay16& to = packet.rays.ray;
  for (std::size_t j = 0; j < std::min(lanes, rays.size() - first); ++j) {
    const std::size_t i = first + j;
    packet.is_active[j] = -1;
    to.org_x[j] = rays.origin_x_mm[i];
    to.org_y[j] = rays.origin_y_mm[i];
    to.org_z[j] = rays.origin_z_mm[i];
    to.dir_x[j] = rays.direction_x[i];
    to.dir_y[j] = rays.direction_y[i];
    to.dir_z[j] = rays.direction_z[i];
    to.tfar[j] = rays.length_mm[i];
  }
}

std::size_t packets_in(const RayBatch& rays) {
  return (rays.size() + 15) / 16;
}

struct Traced {
  const char* effect;
  int rays_a_pixel;
  double all_seconds, trace_seconds;
  double bare_ns;
};

Json row_of(const Traced& t, Rect pixels) {
  const double rays = static_cast<double>(pixels.pixels()) * t.rays_a_pixel;
  const double all_ns = t.all_seconds * 1e9 / rays, trace_ns = t.trace_seconds * 1e9 / rays;
  return {{"effect", t.effect},
          {"rays", t.rays_a_pixel},
          {"ns_per_ray", all_ns},
          {"trace_ns", trace_ns},
          {"bare_ns", t.bare_ns},
          {"ratio", all_ns / t.bare_ns},
          {"trace_ratio", trace_ns / t.bare_ns},
          {"ns_per_pixel", all_ns * t.rays_a_pixel},
          {"threads", 1}};
}

/// Our side of the comparison: ready rays, kRaysAtOnce at a time, as the effects hand them over.
template <typename Trace>
double trace_seconds(Rect pixels, int rays_a_pixel, const std::function<RayBatch(Rect)>& make,
                     const Trace& trace) {
  std::vector<RayBatch> batches;
  for_each_run(pixels, rays_a_pixel, [&](Rect run) { batches.push_back(make(run)); });
  return least_seconds(kRepeats, [&] {
    for (const RayBatch& batch : batches) trace(batch);
  });
}

}  // namespace

/// Shadow rays to a point, to a LED with a size, and bounce rays on the deep weave, one thread, against bare
/// Embree: a scene of one robust grid of the same points, the same rays ready in its own structures and in
/// the cache, traced one by one or (shadows) in packets of 16, whichever is quicker.
///   ns_per_ray  all of the effect: making rays, tracing them, adding up what they met
///   trace_ns    HeightMesh alone on ready rays
///   ratio       ns_per_ray over bare_ns;  trace_ratio  trace_ns over bare_ns
Result<Rows> effects_embree(const StudyOptions&) {
  const Result<TracedPatch> made = traced_patch(kTimedPatch);
  if (!made) return made.error();
  const TracedPatch& patch = *made;
  const Rect area = patch.mesh.area();
  const BareEmbree bare(BareEmbree::Cells::kGrid, patch.mesh.positions_mm(), {area.width(), area.height()});
  Rows rows;
  for (const bool is_soft : {false, true}) {
    SphereLight led = patch.led;
    if (!is_soft) led.radius_mm = 0;
    const RaySettings settings = {is_soft ? kShadowRays : 1, patch.halos.shadow_mm, 1, 1};
    std::optional<Error> failure;
    const double all = least_seconds(kRepeats, [&] {
      const auto visible = visible_fraction(patch.mesh, patch.pixels, led, settings);
      if (!visible) failure = visible.error();
    });
    if (failure) return *failure;
    std::vector<std::uint8_t> blocked(kRaysAtOnce);
    const double trace = trace_seconds(
        patch.pixels, settings.rays, [&](Rect run) { return shadow_rays(patch.mesh, run, led, settings); },
        [&](const RayBatch& rays) { patch.mesh.occlude(rays, std::span(blocked).first(rays.size())); });
    const RayBatch shadow = shadow_rays(patch.mesh, patch.pixels, led, settings);
    const double bare_ns = bare.occlude_ns(
        packets_in(shadow), [&](std::size_t p, BarePacket& packet) { fill(shadow, p, packet); });
    rows.push_back(
        row_of({is_soft ? "soft shadow" : "point shadow", settings.rays, all, trace, bare_ns}, patch.pixels));
  }
  const RaySettings settings = {kBounceRays, patch.halos.bounce_mm, 1, 1};
  std::optional<Error> failure;
  const double all = least_seconds(kRepeats, [&] {
    const auto bounces = Bounces::trace(patch.mesh, patch.normals, patch.pixels, settings);
    if (!bounces) failure = bounces.error();
  });
  if (failure) return *failure;
  std::vector<std::uint32_t> met(kRaysAtOnce);
  const double trace = trace_seconds(
      patch.pixels, settings.rays,
      [&](Rect run) { return bounce_rays(patch.mesh, patch.normals, run, settings); },
      [&](const RayBatch& rays) {
        patch.mesh.find_nearest_vertices(rays, std::span(met).first(rays.size()));
      });
  const RayBatch bounced = bounce_rays(patch.mesh, patch.normals, patch.pixels, settings);
  const double bare_ns = bare.intersect_ns(
      packets_in(bounced), [&](std::size_t p, BarePacket& packet) { fill(bounced, p, packet); });
  rows.push_back(row_of({"bounce", settings.rays, all, trace, bare_ns}, patch.pixels));
  return rows;
}

}  // namespace weft::bench
