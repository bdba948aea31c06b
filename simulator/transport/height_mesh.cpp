// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/height_mesh.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <sys/types.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <type_traits>

namespace weft::simulator {
namespace {

constexpr double kFarthestMm = 1e6;
constexpr int kLongestSide = 32767;  // of RTCGrid
constexpr std::size_t kPacket = 16;

std::atomic<std::int64_t> bytes_held = 0;

bool count_bytes(void*, ssize_t bytes, bool) {
  bytes_held += bytes;
  return true;
}

/// Embree's own defaults: a device limited to one thread would limit oneTBB in the whole process. Never
/// released, as the order in which it and oneTBB end is not ours.
RTCDevice device() {
  static const RTCDevice made = [] {
    const RTCDevice d = rtcNewDevice(nullptr);
    if (d != nullptr) rtcSetDeviceMemoryMonitorFunction(d, count_bytes, nullptr);
    return d;
  }();
  return made;
}

template <typename Handle, void (*release)(Handle)>
struct Releaser {
  void operator()(Handle handle) const { release(handle); }
};
using OwnedScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<RTCScene, rtcReleaseScene>>;
using OwnedGeometry =
    std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Releaser<RTCGeometry, rtcReleaseGeometry>>;

Error unusable(std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "the cloth's surface cannot be traced", "height mesh", std::move(why),
          std::move(remedy)};
}

Error embree_failed(RTCError code) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) {
    return {ErrorKind::kTryAgain, "the cloth's surface cannot be traced", "height mesh", "out of memory",
            "use smaller tiles or fewer threads"};
  }
  return {ErrorKind::kInternal, "the cloth's surface cannot be traced", "height mesh",
          fmt::format("Embree reports error {}", static_cast<int>(code)), "report this with the scene"};
}

Result<void> check_points(Rect area, std::span<const Vec3> points_mm) {
  if (area.width() < 1 || area.height() < 1 || area.width() > kLongestSide || area.height() > kLongestSide) {
    return unusable(fmt::format("{} x {} points", area.width(), area.height()),
                    fmt::format("give from 1 to {} columns and rows", kLongestSide));
  }
  if (points_mm.size() != static_cast<std::size_t>(area.pixels())) {
    return unusable(fmt::format("{} points for {} pixels", points_mm.size(), area.pixels()),
                    "give a point for every pixel");
  }
  const auto in_reach = [](double v) { return std::abs(v) <= kFarthestMm; };
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    const Vec3 p = points_mm[i];
    if (in_reach(p.x) && in_reach(p.y) && in_reach(p.z)) continue;
    const auto width = static_cast<std::size_t>(area.width());
    return unusable(
        fmt::format("the point of pixel ({}, {}) is ({}, {}, {}) mm", area.x0 + static_cast<int>(i % width),
                    area.y0 + static_cast<int>(i / width), p.x, p.y, p.z),
        "give finite points within 1 km");
  }
  return {};
}

Vec3 position(const float* xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

struct CellPlace {
  double u, v;  ///< along the columns and the rows, in [0, 1] inside the cell
};

/// The place of a point on the triangle from `corner` along the edges e1 and e2.
CellPlace place_in_triangle(Vec3 point, Vec3 corner, Vec3 e1, Vec3 e2) {
  const Vec3 normal = cross(e1, e2), p = point - corner;
  const double scale = 1 / dot(normal, normal);
  return {scale * dot(cross(p, e2), normal), scale * dot(cross(e1, p), normal)};
}

/// The vertex nearest to a point of the mesh, in the coordinates of its cell. Embree's u and v run over the
/// whole mesh: good enough to name the triangle, but their rounding depends on the mesh's size. So the place
/// in the cell is found again from the points alone.
std::uint32_t nearest_vertex(const float* positions, int columns, int rows, Vec3 point, float u, float v) {
  const float x = u * static_cast<float>(columns - 1), y = v * static_cast<float>(rows - 1);
  const int column = std::clamp(static_cast<int>(x), 0, columns - 2);
  const int row = std::clamp(static_cast<int>(y), 0, rows - 2);
  const std::size_t top_left =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  const std::size_t bottom_left = top_left + static_cast<std::size_t>(columns);
  const Vec3 top_right = position(positions + 3 * (top_left + 1));
  const Vec3 below_left = position(positions + 3 * bottom_left);
  CellPlace place;
  if (x - static_cast<float>(column) + y - static_cast<float>(row) < 1) {
    const Vec3 corner = position(positions + 3 * top_left);
    place = place_in_triangle(point, corner, top_right - corner, below_left - corner);
  } else {
    const Vec3 corner = position(positions + 3 * (bottom_left + 1));
    place = place_in_triangle(point, corner, below_left - corner, top_right - corner);
    place = {1 - place.u, 1 - place.v};
  }
  return static_cast<std::uint32_t>((place.v > 0.5 ? bottom_left : top_left) + (place.u > 0.5 ? 1u : 0u));
}

}  // namespace

struct HeightMesh::Scene {
  OwnedScene embree;
  OwnedGeometry geometry;
  std::span<const float> positions_mm;
};

HeightMesh::HeightMesh(Rect area, std::unique_ptr<Scene> scene) : area_(area), scene_(std::move(scene)) {}
HeightMesh::HeightMesh(HeightMesh&&) noexcept = default;
HeightMesh& HeightMesh::operator=(HeightMesh&&) noexcept = default;
HeightMesh::~HeightMesh() = default;

Result<HeightMesh> HeightMesh::build(Rect area, std::span<const Vec3> points_mm) try {
  if (auto checked = check_points(area, points_mm); !checked) return checked.error();
  const RTCDevice d = device();
  if (d == nullptr) return embree_failed(rtcGetDeviceError(nullptr));
  rtcGetDeviceError(d);  // forget what an earlier call of this thread left

  auto scene = std::make_unique<Scene>();
  scene->embree.reset(rtcNewScene(d));
  scene->geometry.reset(rtcNewGeometry(d, RTC_GEOMETRY_TYPE_GRID));
  if (!scene->embree || !scene->geometry) return embree_failed(rtcGetDeviceError(d));
  rtcSetSceneFlags(scene->embree.get(), RTC_SCENE_FLAG_ROBUST);

  auto* positions =
      static_cast<float*>(rtcSetNewGeometryBuffer(scene->geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                  RTC_FORMAT_FLOAT3, 3 * sizeof(float), points_mm.size()));
  auto* grid = static_cast<RTCGrid*>(rtcSetNewGeometryBuffer(scene->geometry.get(), RTC_BUFFER_TYPE_GRID, 0,
                                                             RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
  if (positions == nullptr || grid == nullptr) return embree_failed(rtcGetDeviceError(d));
  scene->positions_mm = {positions, 3 * points_mm.size()};
  for (const Vec3& p : points_mm) {
    *positions++ = static_cast<float>(p.x);
    *positions++ = static_cast<float>(p.y);
    *positions++ = static_cast<float>(p.z);
  }
  *grid = {0, static_cast<unsigned>(area.width()), static_cast<unsigned short>(area.width()),
           static_cast<unsigned short>(area.height())};
  rtcCommitGeometry(scene->geometry.get());
  // A single row or column has no cells, and Embree no leave to be given none.
  if (area.width() > 1 && area.height() > 1) rtcAttachGeometry(scene->embree.get(), scene->geometry.get());
  rtcCommitScene(scene->embree.get());
  if (const RTCError code = rtcGetDeviceError(d); code != RTC_ERROR_NONE) return embree_failed(code);
  return HeightMesh(area, std::move(scene));
} catch (const std::bad_alloc&) {
  return embree_failed(RTC_ERROR_OUT_OF_MEMORY);
}

bool HeightMesh::covers(Rect r) const {
  return area_.x0 <= r.x0 && r.x0 <= r.x1 && r.x1 <= area_.x1 && area_.y0 <= r.y0 && r.y0 <= r.y1 &&
         r.y1 <= area_.y1;
}

Result<void> check_covered(const HeightMesh& mesh, Rect r) {
  if (mesh.covers(r)) return {};
  const Rect a = mesh.area();
  return unusable(fmt::format("pixels [{}, {}) x [{}, {}) are asked for, [{}, {}) x [{}, {}) are in the mesh",
                              r.x0, r.x1, r.y0, r.y1, a.x0, a.x1, a.y0, a.y1),
                  "build the mesh over the pixels and their halo");
}

std::size_t HeightMesh::vertex(int x, int y) const {
  return static_cast<std::size_t>(y - area_.y0) * static_cast<std::size_t>(area_.width()) +
         static_cast<std::size_t>(x - area_.x0);
}

std::span<const float> HeightMesh::positions_mm() const {
  return scene_->positions_mm;
}

Vec3 HeightMesh::ray_start_mm(int x, int y) const {
  const float* positions = scene_->positions_mm.data();
  const Vec3 p = position(positions + 3 * vertex(x, y));
  double step_squared = 0;
  const auto measure_step_to = [&](int nx, int ny) {
    if (!covers({nx, ny, nx + 1, ny + 1})) return;
    const Vec3 d = position(positions + 3 * vertex(nx, ny)) - p;
    step_squared = std::max(step_squared, d.x * d.x + d.y * d.y);
  };
  measure_step_to(x - 1, y);
  measure_step_to(x + 1, y);
  measure_step_to(x, y - 1);
  measure_step_to(x, y + 1);
  return {p.x, p.y, p.z + kLift * std::sqrt(step_squared)};
}

void HeightMesh::occlude(const RayBatch& rays, std::span<std::uint8_t> blocked) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  // Without this Embree goes on with single rays where few are left of a packet; those meet a triangle at a
  // distance that differs in the last bit, and how many are left depends on the rest of the mesh.
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRay16 packet = {};
  std::fill_n(packet.mask, kPacket, ~0u);
  alignas(64) int valid[kPacket];
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - first);
    for (std::size_t k = 0; k < kPacket; ++k) valid[k] = k < count ? -1 : 0;
    const auto copy = [&](const std::vector<float>& from, float* to) {
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(first), count, to);
    };
    copy(rays.origin_x_mm, packet.org_x);
    copy(rays.origin_y_mm, packet.org_y);
    copy(rays.origin_z_mm, packet.org_z);
    copy(rays.direction_x, packet.dir_x);
    copy(rays.direction_y, packet.dir_y);
    copy(rays.direction_z, packet.dir_z);
    copy(rays.length_mm, packet.tfar);
    rtcOccluded16(valid, scene_->embree.get(), &context, &packet);
    for (std::size_t k = 0; k < count; ++k) blocked[first + k] = packet.tfar[k] < 0;
  }
}

void HeightMesh::find_nearest_vertices(const RayBatch& rays, std::span<std::uint32_t> met) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit r = {};
    r.ray.org_x = rays.origin_x_mm[i];
    r.ray.org_y = rays.origin_y_mm[i];
    r.ray.org_z = rays.origin_z_mm[i];
    r.ray.dir_x = rays.direction_x[i];
    r.ray.dir_y = rays.direction_y[i];
    r.ray.dir_z = rays.direction_z[i];
    r.ray.tfar = rays.length_mm[i];
    r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_->embree.get(), &context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      met[i] = kLeft;
      continue;
    }
    const Vec3 direction = {r.ray.dir_x, r.ray.dir_y, r.ray.dir_z};
    const Vec3 normal = {r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z};
    const bool from_behind = dot(direction, normal) * normal.z > 0;
    met[i] = from_behind ? kDark
                         : nearest_vertex(scene_->positions_mm.data(), area_.width(), area_.height(),
                                          Vec3{r.ray.org_x, r.ray.org_y, r.ray.org_z} +
                                              static_cast<double>(r.ray.tfar) * direction,
                                          r.hit.u, r.hit.v);
  }
}

std::int64_t HeightMesh::bytes_in_use() {
  return bytes_held;
}

}  // namespace weft::simulator
