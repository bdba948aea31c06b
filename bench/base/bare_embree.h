// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "core/image/image.h"

namespace weft::bench {

/// Rays for Embree, 16 together. Those whose `is_active` is 0 are not traced, the others have -1.
struct BarePacket {
  alignas(64) std::array<int, 16> is_active = {};
  RTCRayHit16 rays = {};
};

/// Embree with nothing of ours around it, on the vertices of a height field: what our own tracing is held
/// against.
class BareEmbree {
 public:
  /// Embree's own grid of cells, or a quadrilateral for each cell.
  enum class Cells { kGrid, kQuads };

  /// `xyz` has x, y and z of each vertex, row by row; one more vertex than cells in each direction.
  BareEmbree(Cells cells, std::span<const float> xyz, Size vertices);
  ~BareEmbree();
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  /// Writes packet `i`. Called outside of what is timed.
  using Fill = std::function<void(std::size_t i, BarePacket& packet)>;

  /// Nanoseconds a ray, on one thread: the least of several runs, one by one or in packets. A few packets at
  /// a time, so that they are still in the cache.
  double occlude_ns(std::size_t packets, const Fill& fill) const;
  double intersect_ns(std::size_t packets, const Fill& fill) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace weft::bench
