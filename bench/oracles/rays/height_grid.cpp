// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/height_grid.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <sys/types.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>

#include "solver/transport/planes.h"

namespace weft::test {
namespace {

using namespace solver;

constexpr int kLongestGridSide = 32767;  // vertices count in 32 bits

std::atomic<std::int64_t> bytes_held = 0;

bool count_bytes(void*, ssize_t bytes, bool) {
  bytes_held += bytes;
  return true;
}

/// One for the process, with Embree's own threads (oneTBB's). Never released: oneTBB may be gone by then.
RTCDevice device() {
  static const RTCDevice made = [] {
    const RTCDevice d = rtcNewDevice(nullptr);
    if (d != nullptr) rtcSetDeviceMemoryMonitorFunction(d, count_bytes, nullptr);
    return d;
  }();
  return made;
}

struct Release {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

Error embree_failed(RTCError code) {
  Error error = bad_transport("height grid", "out of memory", "use smaller blocks or fewer threads");
  error.kind = ErrorKind::kTryAgain;
  if (code == RTC_ERROR_OUT_OF_MEMORY) return error;
  return {ErrorKind::kInternal, error.what, error.where,
          fmt::format("Embree reports error {}", static_cast<int>(code)), "report this with the picture"};
}

Rect grown_within(Rect r, int pixels, Rect bounds) {
  return {std::max(r.x0 - pixels, bounds.x0), std::max(r.y0 - pixels, bounds.y0),
          std::min(r.x1 + pixels, bounds.x1), std::min(r.y1 + pixels, bounds.y1)};
}

std::string words_of(Rect r) {
  return fmt::format("columns {} to {}, rows {} to {}", r.x0, r.x1, r.y0, r.y1);
}

void write_vertices(const Relief& relief, Rect area, float* xyz) {
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x, xyz += 3) {
      xyz[0] = static_cast<float>(x);
      xyz[1] = static_cast<float>(-y);
      xyz[2] = relief.z_px(x, y);
    }
  }
}

/// Clockwise from the top left; Embree parts each from its top right to its bottom left.
void write_cells(Rect area, std::uint32_t* corners) {
  const auto width = static_cast<std::uint32_t>(area.width()),
             height = static_cast<std::uint32_t>(area.height());
  for (std::uint32_t row = 0; row + 1 < height; ++row) {
    for (std::uint32_t column = 0; column + 1 < width; ++column, corners += 4) {
      corners[0] = row * width + column;
      corners[1] = corners[0] + 1;
      corners[2] = corners[1] + width;
      corners[3] = corners[0] + width;
    }
  }
}

/// The rays of a packet in Embree's structure, from a little after their start to their length. Processors
/// without AVX-512 make Embree trace a packet of sixteen as a stream, which does not look at who takes part:
/// a ray that ends before it begins is left out by any of its ways.
void write_rays(const RayPacket& rays, RTCRay16& to) {
  for (int i = 0; i < kPacket; ++i) {
    const bool is_active = rays.is_active[i] != 0;
    to.org_x[i] = is_active ? rays.start_x[i] : 0;
    to.org_y[i] = is_active ? rays.start_y[i] : 0;
    to.org_z[i] = is_active ? rays.start_z[i] : 0;
    to.dir_x[i] = is_active ? rays.direction_x[i] : 0;
    to.dir_y[i] = is_active ? rays.direction_y[i] : 0;
    to.dir_z[i] = is_active ? rays.direction_z[i] : 1;
    to.tfar[i] = is_active ? rays.length[i] : -1;
  }
  std::fill_n(to.tnear, kPacket, 0.0f);
  std::fill_n(to.time, kPacket, 0.0f);
  std::fill_n(to.mask, kPacket, ~0U);
  std::fill_n(to.flags, kPacket, 0U);
}

/// Not marked as coherent: Embree then takes the rays of a packet one by one, which is quicker here even for
/// rays side by side, as each meets but a few cells.
RTCIntersectContext one_by_one() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  return context;
}

/// As quads, which Embree's traversal takes a third less time for than its compressed grids.
Result<void> attach_cells(const Relief& relief, Rect area, RTCScene scene) {
  const auto width = static_cast<std::size_t>(area.width()), height = static_cast<std::size_t>(area.height());
  const Owned<RTCGeometry> geometry(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_QUAD));
  if (!geometry) return embree_failed(rtcGetDeviceError(device()));
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), width * height));
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                              4 * sizeof(std::uint32_t), (width - 1) * (height - 1)));
  if (vertices == nullptr || corners == nullptr) return embree_failed(rtcGetDeviceError(device()));
  write_vertices(relief, area, vertices);
  write_cells(area, corners);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene, geometry.get());
  return {};
}

}  // namespace

struct HeightGrid::Scene {
  Owned<RTCScene> embree;
};

HeightGrid::HeightGrid(const Relief& relief, Rect block, Rect area, int halo_px, std::unique_ptr<Scene> scene)
    : relief_(relief), block_(block), area_(area), halo_px_(halo_px), scene_(std::move(scene)) {}
HeightGrid::HeightGrid(HeightGrid&&) noexcept = default;
HeightGrid& HeightGrid::operator=(HeightGrid&&) noexcept = default;
HeightGrid::~HeightGrid() = default;

Result<HeightGrid> HeightGrid::build(const Relief& relief, Rect block, int halo_px) try {
  if (!holds_pixels(relief.pixels(), block) || halo_px < 0 || halo_px > kLongestGridSide) {
    return bad_transport("height grid",
                         fmt::format("a block of {} and a halo of {} in a picture of {}", words_of(block),
                                     halo_px, words_of(relief.pixels())),
                         "ask for a block inside the picture");
  }
  const Rect area = grown_within(block, halo_px, relief.pixels());
  if (area.width() > kLongestGridSide || area.height() > kLongestGridSide) {
    return bad_transport("height grid", fmt::format("{} x {} pixels", area.width(), area.height()),
                         fmt::format("build blocks of at most {} columns and rows", kLongestGridSide));
  }
  const RTCDevice d = device();
  if (d == nullptr) return embree_failed(rtcGetDeviceError(nullptr));
  rtcGetDeviceError(d);  // forget what an earlier call of this thread left

  auto scene = std::make_unique<Scene>();
  scene->embree.reset(rtcNewScene(d));
  if (!scene->embree) return embree_failed(rtcGetDeviceError(d));
  rtcSetSceneFlags(scene->embree.get(), RTC_SCENE_FLAG_ROBUST);
  // A single row or column has no cells.
  if (area.width() > 1 && area.height() > 1) {
    if (auto attached = attach_cells(relief, area, scene->embree.get()); !attached) return attached.error();
  }
  rtcCommitScene(scene->embree.get());
  if (const RTCError code = rtcGetDeviceError(d); code != RTC_ERROR_NONE) return embree_failed(code);
  return HeightGrid(relief, block, area, halo_px, std::move(scene));
} catch (const std::bad_alloc&) {
  return embree_failed(RTC_ERROR_OUT_OF_MEMORY);
}

std::uint32_t HeightGrid::occlude(const RayPacket& rays) const {
  RTCIntersectContext context = one_by_one();
  RTCRay16 packet;
  write_rays(rays, packet);
  rtcOccluded16(rays.is_active, scene_->embree.get(), &context, &packet);
  std::uint32_t blocked = 0;
  for (int i = 0; i < kPacket; ++i) {
    // Embree says so by a length of minus infinity.
    blocked |= static_cast<std::uint32_t>(rays.is_active[i] != 0 && packet.tfar[i] < 0) << i;
  }
  return blocked;
}

void HeightGrid::intersect(const RayPacket& rays, float* met) const {
  RTCIntersectContext context = one_by_one();
  RTCRayHit16 packet;
  write_rays(rays, packet.ray);
  std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
  rtcIntersect16(rays.is_active, scene_->embree.get(), &context, &packet);
  for (int i = 0; i < kPacket; ++i) {
    met[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity()
                                                             : packet.ray.tfar[i];
  }
}

std::int64_t HeightGrid::bytes_in_use() {
  return bytes_held;
}

Rect within_reach(const Relief& relief, Rect tile, int reach_px) {
  return grown_within(tile, reach_px + 1, relief.pixels());
}

Result<void> check_tile(const HeightGrid& grid, Rect tile, int reach_px) {
  if (!holds_pixels(grid.block(), tile)) {
    return bad_transport(
        "tile", fmt::format("{} are asked for, the block has {}", words_of(tile), words_of(grid.block())),
        "ask for a tile inside the block");
  }
  if (reach_px < 1 || reach_px > Relief::kMostSide_px) {
    return bad_transport("tile", fmt::format("a reach of {} pixels", reach_px),
                         "give a reach of at least 1 pixel");
  }
  if (!holds_pixels(grid.area(), within_reach(grid.relief(), tile, reach_px))) {
    return bad_transport("tile", fmt::format("rays reach {} pixels, the halo {}", reach_px, grid.halo_px()),
                         fmt::format("build the block with a halo of {} pixels", reach_px + 1));
  }
  return {};
}

}  // namespace weft::test
