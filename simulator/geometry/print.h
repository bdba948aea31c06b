// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/image/color_spaces.h"
#include "core/image/image.h"
#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/picture_grid.h"

namespace weft::simulator {

/// A pattern printed on the cloth: albedo, linear Rec.709.
struct PrintSettings {
  std::shared_ptr<const Image<float>> albedo;  ///< three planes, 0 to 1; none: nothing is printed
  PicturePlacement placement;
  std::string file = {};  ///< where it was read, absolute; empty: from no file

  bool operator==(const PrintSettings&) const = default;
};

/// Refuses, as kBadData, an albedo that has not three planes or is outside 0 to 1.
Result<void> check_print(const PrintSettings& print);

/// The printed albedo at a point of the table, bilinear between samples.
class Print {
 public:
  explicit Print(const PrintSettings& checked);
  /// Nothing beside a picture that does not repeat, or where none is printed.
  std::optional<Rgb> at(double x_mm, double y_mm) const;

 private:
  std::shared_ptr<const Image<float>> albedo_;
  PictureGrid grid_;
};

}  // namespace weft::simulator
