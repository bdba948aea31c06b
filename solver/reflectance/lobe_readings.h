// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/base/vec.h"
#include "solver/method.h"
#include "solver/reflectance/pixel_fit.h"

namespace weft::solver {

/// Unit vectors from the cloth to the camera.
class Sight {
 public:
  /// The centre of the camera in the rig frame, mm; none: it looks straight down from far away.
  explicit Sight(std::optional<Vec3> camera_mm, double cloth_height_mm)
      : camera_mm_(camera_mm), height_mm_(cloth_height_mm) {}
  Vec3 from(double x_mm, double y_mm) const {
    return camera_mm_ ? normalized(*camera_mm_ - Vec3{x_mm, y_mm, height_mm_}) : Vec3{0, 0, 1};
  }
  bool is_far() const { return !camera_mm_.has_value(); }
  /// The camera from the plane of the cloth; 0 where it is far.
  Vec3 above_cloth_mm() const { return camera_mm_ ? *camera_mm_ - Vec3{0, 0, height_mm_} : Vec3{}; }

 private:
  std::optional<Vec3> camera_mm_;
  double height_mm_;
};

/// The readings of one pixel of a tile after another, in double, with the weights that a lobe is fitted by. A
/// reading that is saturated or missing, that the LED does not reach, or that is in the dark beside the
/// bright ones of its state of the films (kShadowShare) has none. Of RGB the weighted sum of the channels,
/// each over its strength.
class LobeReader {
 public:
  LobeReader(const TileInput& input, Sight sight);
  /// Readings of a pixel: one a light, and where the input has parallel ones as many again, after the others.
  std::size_t count() const;
  /// Column and row of the tile. `readings` has count().
  void read(int x, int y, std::span<LobeReading> readings);
  /// Reads one channel of RGB where `mixed` is what read() says: a reading has no weight where the sum has
  /// none.
  void read_plane(int x, int y, int plane, std::span<const LobeReading> mixed,
                  std::span<LobeReading> readings) const;

 private:
  void read_row(int y);
  void read_state(int x, int y, std::span<const View<const float>> state, double lobe_share,
                  std::span<LobeReading> readings);

  const TileInput& input_;
  Sight sight_;
  int row_ = -1;  ///< that `points_` is of
  LightField::Row points_;
  std::vector<double> bright_;
};

}  // namespace weft::solver
