// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "simulator/geometry/geometry_settings.h"

namespace weft::simulator {

/// The samples of a picture on the table: sample (column, row) is at the centre of its square of
/// mm_per_sample, row 0 at the top.
class PictureGrid {
 public:
  /// A place among samples: whole numbers are their centres.
  struct Place {
    double column;
    double row;
  };

  PictureGrid(Size size, const PicturePlacement& placement)
      : size_(size),
        placement_(placement),
        cosine_(std::cos(radians(placement.rotation_deg))),
        sine_(std::sin(radians(placement.rotation_deg))) {}

  Place place_of(double x_mm, double y_mm) const {
    const double dx = (x_mm - placement_.offset_x_mm) / placement_.mm_per_sample;
    const double dy = (y_mm - placement_.offset_y_mm) / placement_.mm_per_sample;
    return {within(cosine_ * dx + sine_ * dy + (size_.width - 1) / 2.0, size_.width),
            within(sine_ * dx - cosine_ * dy + (size_.height - 1) / 2.0, size_.height)};
  }
  /// Whether the place is on the picture, its outer half samples included.
  bool holds(Place p) const {
    return p.column >= -0.5 && p.column <= size_.width - 0.5 && p.row >= -0.5 && p.row <= size_.height - 0.5;
  }
  /// The column or row to read for a neighbour of a place: wraps where the picture repeats, else stays at
  /// the border.
  int column(double c) const { return index(c, size_.width); }
  int row(double r) const { return index(r, size_.height); }

  double cosine() const { return cosine_; }
  double sine() const { return sine_; }
  const PicturePlacement& placement() const { return placement_; }

 private:
  /// In [-0.5, count - 0.5) where the picture repeats; else a few samples beyond the border at most, as
  /// nothing changes there.
  double within(double at, int count) const {
    if (placement_.repeats) return at - count * std::floor((at + 0.5) / count);
    return std::clamp(at, -4.0, count + 3.0);
  }
  int index(double at, int count) const {
    const int i = static_cast<int>(at);
    if (placement_.repeats) return ((i % count) + count) % count;
    return std::clamp(i, 0, count - 1);
  }

  Size size_;
  PicturePlacement placement_;
  double cosine_;
  double sine_;
};

}  // namespace weft::simulator
