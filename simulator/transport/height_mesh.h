// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "simulator/transport/rays.h"

// The cloth's surface as rays meet it: a mesh over a tile of pixels and its halo.

namespace weft::simulator {

/// What a ray met instead of a vertex.
inline constexpr std::uint32_t kLeft = 0xffffffff;  ///< nothing within its reach
inline constexpr std::uint32_t kDark = 0xfffffffe;  ///< the back of the cloth

/// A point of the cloth a pixel, in the rig frame: neighbours in the array are neighbours on the cloth, and
/// each cell of four is two triangles. The grid may be irregular, as seen through a lens, but must not fold:
/// each table point has one height, and the front of the cloth faces +z.
///
/// Points are kept as absolute float32 and rays are traced watertight (Woop, Benthin and Wald, JCGT 2(1),
/// 2013, as Embree 3's robust grids do), so what a ray meets does not depend on the rest of the mesh: tiles
/// of any size give the same bytes as long as their halo holds the ray. Takes about 32 bytes a point.
/// Const functions may be called from many threads at once; different meshes may be built at once.
class HeightMesh {
 public:
  /// Refuses (kBadData) a point that is not finite or over 1 km away, an area without pixels or over 32767
  /// wide or high, and a number of points that is not the area's. kTryAgain without memory.
  /// @param area absolute pixels, which may be negative: tile and halo
  /// @param points_mm row by row
  static Result<HeightMesh> build(Rect area, std::span<const Vec3> points_mm);

  HeightMesh(HeightMesh&&) noexcept;
  HeightMesh& operator=(HeightMesh&&) noexcept;
  ~HeightMesh();

  Rect area() const { return area_; }
  bool covers(Rect pixels) const;
  std::size_t vertices() const { return static_cast<std::size_t>(area_.pixels()); }
  /// The index of a pixel's vertex: row by row through the area.
  std::size_t vertex(int x, int y) const;
  /// x, y, z of each vertex in turn.
  std::span<const float> positions_mm() const;

  /// Where the rays of a pixel start: above its vertex by kLift times the distance on the table to the
  /// farthest of its neighbours in row and column, so that float32 does not make a ray meet the cells it
  /// leaves. A shadow's edge is off by as much over the tangent of the light's elevation.
  Vec3 ray_start_mm(int x, int y) const;
  static constexpr double kLift = 1.0 / 64;

  /// Sets blocked[i] to 1 where ray i meets the cloth, else 0. In packets of 16: quick if neighbours in the
  /// batch are neighbours in space.
  void occlude(const RayBatch& rays, std::span<std::uint8_t> blocked) const;

  /// Sets met[i] to the vertex nearest, in the cell's own coordinates, to where ray i meets the cloth first,
  /// or to kLeft or kDark. One by one: rays of a bounce point everywhere.
  void find_nearest_vertices(const RayBatch& rays, std::span<std::uint32_t> met) const;

  /// Bytes that all meshes of the process hold now.
  static std::int64_t bytes_in_use();

 private:
  struct Scene;
  HeightMesh(Rect area, std::unique_ptr<Scene> scene);

  Rect area_;
  std::unique_ptr<Scene> scene_;
};

/// kBadData where the mesh does not cover `pixels`.
Result<void> check_covered(const HeightMesh& mesh, Rect pixels);

}  // namespace weft::simulator
