// SPDX-License-Identifier: Apache-2.0
#include "bench/base/bare_embree.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

namespace weft::bench {
namespace {

using std::chrono::steady_clock;

constexpr int kRuns = 7;
constexpr std::size_t kAtOnce = 64;  // packets

RTCGeometry grid_of(RTCDevice device, std::span<const float> xyz, Size vertices) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_GRID);
  std::ranges::copy(
      xyz, static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                       3 * sizeof(float), xyz.size() / 3)));
  auto* grid = static_cast<RTCGrid*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
  const auto columns = static_cast<unsigned short>(vertices.width);
  *grid = {0, columns, columns, static_cast<unsigned short>(vertices.height)};
  return geometry;
}

RTCGeometry quads_of(RTCDevice device, std::span<const float> xyz, Size vertices) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
  std::ranges::copy(
      xyz, static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                       3 * sizeof(float), xyz.size() / 3)));
  const auto width = static_cast<unsigned>(vertices.width), height = static_cast<unsigned>(vertices.height);
  auto* corner = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                                RTC_FORMAT_UINT4, 4 * sizeof(unsigned),
                                                                std::size_t{width - 1} * (height - 1)));
  for (unsigned y = 0; y + 1 < height; ++y) {
    for (unsigned x = 0; x + 1 < width; ++x) {
      const unsigned i = y * width + x;
      for (const unsigned vertex : {i, i + 1, i + width + 1, i + width}) *corner++ = vertex;
    }
  }
  return geometry;
}

RTCIntersectContext context_of(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

RTCRayHit lane_of(const RTCRayHit16& from, std::size_t lane) {
  RTCRayHit to = {};
  to.ray.org_x = from.ray.org_x[lane];
  to.ray.org_y = from.ray.org_y[lane];
  to.ray.org_z = from.ray.org_z[lane];
  to.ray.dir_x = from.ray.dir_x[lane];
  to.ray.dir_y = from.ray.dir_y[lane];
  to.ray.dir_z = from.ray.dir_z[lane];
  to.ray.tfar = from.ray.tfar[lane];
  to.ray.mask = from.ray.mask[lane];
  to.hit.geomID = from.hit.geomID[lane];
  return to;
}

std::vector<RTCRayHit> one_by_one(std::span<const BarePacket> packets) {
  std::vector<RTCRayHit> rays;
  for (const BarePacket& packet : packets) {
    for (std::size_t lane = 0; lane < packet.is_active.size(); ++lane) {
      if (packet.is_active[lane] != 0) rays.push_back(lane_of(packet.rays, lane));
    }
  }
  return rays;
}

/// trace_one(ray) for each active ray, or trace_packet(packet), whichever takes less.
template <typename TraceOne, typename TracePacket>
double least_ns(std::size_t packets, const BareEmbree::Fill& fill, const TraceOne& trace_one,
                const TracePacket& trace_packet) {
  auto least_singly = steady_clock::duration::max(), least_together = least_singly;
  std::size_t traced = 0;
  for (int repeat = 0; repeat < kRuns; ++repeat) {
    auto singly = steady_clock::duration::zero(), together = singly;
    traced = 0;
    for (std::size_t first = 0; first < packets; first += kAtOnce) {
      std::vector<BarePacket> ready(std::min(kAtOnce, packets - first));
      for (std::size_t i = 0; i < ready.size(); ++i) {
        std::fill_n(ready[i].rays.ray.mask, 16, ~0U);
        std::fill_n(ready[i].rays.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
        fill(first + i, ready[i]);
      }
      std::vector<RTCRayHit> rays = one_by_one(ready);
      traced += rays.size();
      const auto begin = steady_clock::now();
      for (RTCRayHit& ray : rays) trace_one(ray);
      const auto middle = steady_clock::now();
      for (BarePacket& packet : ready) trace_packet(packet);
      singly += middle - begin;
      together += steady_clock::now() - middle;
    }
    least_singly = std::min(least_singly, singly);
    least_together = std::min(least_together, together);
  }
  return std::chrono::duration<double, std::nano>(std::min(least_singly, least_together)).count() /
         static_cast<double>(traced);
}

}  // namespace

BareEmbree::BareEmbree(Cells cells, std::span<const float> xyz, Size vertices)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry =
      cells == Cells::kGrid ? grid_of(device_, xyz, vertices) : quads_of(device_, xyz, vertices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

BareEmbree::~BareEmbree() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

double BareEmbree::occlude_ns(std::size_t packets, const Fill& fill) const {
  RTCIntersectContext singly = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCIntersectContext together = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  return least_ns(
      packets, fill, [&](RTCRayHit& ray) { rtcOccluded1(scene_, &singly, &ray.ray); },
      [&](BarePacket& packet) {
        rtcOccluded16(packet.is_active.data(), scene_, &together, &packet.rays.ray);
      });
}

double BareEmbree::intersect_ns(std::size_t packets, const Fill& fill) const {
  RTCIntersectContext singly = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCIntersectContext together = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  return least_ns(
      packets, fill, [&](RTCRayHit& ray) { rtcIntersect1(scene_, &singly, &ray); },
      [&](BarePacket& packet) { rtcIntersect16(packet.is_active.data(), scene_, &together, &packet.rays); });
}

}  // namespace weft::bench
