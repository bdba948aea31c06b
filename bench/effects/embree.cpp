// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/embree.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bench/effects/patch.h"
#include "simulator/transport/bounces.h"

namespace weft::bench {
namespace {

using namespace simulator;
using std::chrono::steady_clock;

constexpr int kTimedPatch = 96;
constexpr int kRepeats = 5;
constexpr std::size_t kPacket = 16;

/// Embree with nothing of ours around it, on the points of a mesh.
class BareEmbree {
 public:
  explicit BareEmbree(const HeightMesh& mesh) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_GRID);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions_mm().data(), 0, 3 * sizeof(float), mesh.vertices());
    auto* grid = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    const auto columns = static_cast<unsigned short>(mesh.area().width());
    *grid = {0, columns, columns, static_cast<unsigned short>(mesh.area().height())};
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  double occlude_ns(const RayBatch& rays) const {
    const double singly = ns_per_ray(rays, 1, [&](std::span<RTCRay16>, std::span<RTCRayHit> one) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      for (RTCRayHit& ray : one) rtcOccluded1(scene_, &context, &ray.ray);
    });
    const double in_packets =
        ns_per_ray(rays, kPacket, [&](std::span<RTCRay16> packets, std::span<RTCRayHit>) {
          RTCIntersectContext context;
          rtcInitIntersectContext(&context);
          context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
          alignas(64) std::array<int, kPacket> valid;
          valid.fill(-1);
          for (RTCRay16& packet : packets) rtcOccluded16(valid.data(), scene_, &context, &packet);
        });
    return std::min(singly, in_packets);
  }

  double intersect_ns(const RayBatch& rays) const {
    return ns_per_ray(rays, 1, [&](std::span<RTCRay16>, std::span<RTCRayHit> one) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      for (RTCRayHit& ray : one) rtcIntersect1(scene_, &context, &ray);
    });
  }

 private:
  /// Times trace(packets, rays) alone, kRaysAtOnce rays at a time.
  template <typename Trace>
  static double ns_per_ray(const RayBatch& rays, std::size_t packet, const Trace& trace) {
    const std::size_t at_once = kRaysAtOnce, whole = rays.size() / at_once * at_once;
    std::vector<RTCRayHit> one(at_once);
    std::vector<RTCRay16> packets(at_once / kPacket);
    auto least = steady_clock::duration::max();
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      auto spent = steady_clock::duration::zero();
      for (std::size_t first = 0; first < whole; first += at_once) {
        packet == 1 ? fill(rays, first, one) : fill(rays, first, packets);
        const auto begin = steady_clock::now();
        trace(packets, one);
        spent += steady_clock::now() - begin;
      }
      least = std::min(least, spent);
    }
    return std::chrono::duration<double, std::nano>(least).count() / static_cast<double>(whole);
  }

  static void fill(const RayBatch& rays, std::size_t first, std::vector<RTCRayHit>& one) {
    for (std::size_t k = 0; k < one.size(); ++k) {
      const std::size_t i = first + k;
      RTCRayHit& r = one[k] = {};
      r.ray.org_x = rays.origin_x_mm[i];
      r.ray.org_y = rays.origin_y_mm[i];
      r.ray.org_z = rays.origin_z_mm[i];
      r.ray.dir_x = rays.direction_x[i];
      r.ray.dir_y = rays.direction_y[i];
      r.ray.dir_z = rays.direction_z[i];
      r.ray.tfar = rays.length_mm[i];
      r.ray.mask = ~0U;
      r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
  }

  static void fill(const RayBatch& rays, std::size_t first, std::vector<RTCRay16>& packets) {
    for (std::size_t k = 0; k < packets.size() * kPacket; ++k) {
      const std::size_t i = first + k, j = k % kPacket;
      RTCRay16& r = packets[k / kPacket];
      if (j == 0) r = {};
      r.org_x[j] = rays.origin_x_mm[i];
      r.org_y[j] = rays.origin_y_mm[i];
      r.org_z[j] = rays.origin_z_mm[i];
      r.dir_x[j] = rays.direction_x[i];
      r.dir_y[j] = rays.direction_y[i];
      r.dir_z[j] = rays.direction_z[i];
      r.tfar[j] = rays.length_mm[i];
      r.mask[j] = ~0U;
    }
  }

  RTCDevice device_;
  RTCScene scene_;
};

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

Result<Rows> effects_embree() {
  const Result<TracedPatch> made = traced_patch(kTimedPatch);
  if (!made) return made.error();
  const TracedPatch& patch = *made;
  const BareEmbree bare(patch.mesh);
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
    const double bare_ns = bare.occlude_ns(shadow_rays(patch.mesh, patch.pixels, led, settings));
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
  const double bare_ns = bare.intersect_ns(bounce_rays(patch.mesh, patch.normals, patch.pixels, settings));
  rows.push_back(row_of({"bounce", settings.rays, all, trace, bare_ns}, patch.pixels));
  return rows;
}

}  // namespace weft::bench
