// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/studies.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bench/base/bare_embree.h"
#include "bench/effects/patch.h"
#include "simulator/transport/bounces.h"

namespace weft::bench {
namespace {

using namespace simulator;

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
