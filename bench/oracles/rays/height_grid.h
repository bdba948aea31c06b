// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/relief.h"

// A relief as rays meet it, in the pixels of solver/transport/relief.h.

namespace weft::test {

/// Rays side by side from the pixels of the relief, in pixels. Directions need no unit length: a ray goes
/// from start to start + length * direction and its hits are counted in the same measure.
inline constexpr int kPacket = 16;
struct RayPacket {
  alignas(64) float start_x[kPacket], start_y[kPacket], start_z[kPacket];
  alignas(64) float direction_x[kPacket], direction_y[kPacket], direction_z[kPacket];
  alignas(64) float length[kPacket];
  alignas(64) int is_active[kPacket];  ///< -1 or 0: the others are not traced and may hold anything
};

/// Part of a relief in an Embree 3 scene: two triangles between each four pixels.
///
/// What a ray meets depends on nothing but the ray and the heights: vertices have whole coordinates of the
/// picture in float32, and the robust mode loses no triangle whatever the boxes around it (Woop, Benthin and
/// Wald, JCGT 2(1), 2013). So blocks of any size give the same bytes as long as their halo holds the rays'
/// reach. Takes about 105 bytes a pixel of `area`. Const functions may be called from many threads, and
/// different grids built at once.
class HeightGrid {
 public:
  /// Over `block` and `halo_px` pixels around it, as far as the relief has them; beyond the relief there is
  /// nothing to meet. kBadData where the block is empty, not inside the relief or, with its halo, over 32767
  /// pixels wide or high; kTryAgain without memory.
  static Result<HeightGrid> build(const solver::Relief& relief, Rect block, int halo_px);

  HeightGrid(HeightGrid&&) noexcept;
  HeightGrid& operator=(HeightGrid&&) noexcept;
  ~HeightGrid();

  const solver::Relief& relief() const { return relief_; }
  Rect block() const { return block_; }  ///< the pixels that rays may start from
  Rect area() const { return area_; }    ///< block and halo, cut off at the relief's border
  int halo_px() const { return halo_px_; }

  /// Rays start this far above their pixel's vertex.
  static constexpr float kLift = solver::kLift;

  /// Bit i is set where ray i meets the cloth.
  std::uint32_t occlude(const RayPacket& rays) const;

  /// Sets `met[i]` to how far along ray i the cloth is first met, or to infinity; nothing for inactive rays.
  void intersect(const RayPacket& rays, float* met) const;

  /// Bytes that all grids of the process hold now.
  static std::int64_t bytes_in_use();

 private:
  struct Scene;
  HeightGrid(const solver::Relief& relief, Rect block, Rect area, int halo_px, std::unique_ptr<Scene> scene);

  solver::Relief relief_;
  Rect block_, area_;
  int halo_px_;
  std::unique_ptr<Scene> scene_;
};

/// The pixels that rays of this reach from a tile may meet, and the one beyond.
Rect within_reach(const solver::Relief& relief, Rect tile, int reach_px);

/// kBadData where `tile` is empty or not inside the grid's block, or the grid does not hold all that is
/// within reach of it.
Result<void> check_tile(const HeightGrid& grid, Rect tile, int reach_px);

}  // namespace weft::test
