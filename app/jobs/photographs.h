// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/json_document.h"
#include "core/light_field.h"
#include "core/radiometry.h"
#include "core/raw_frame.h"

namespace weft::app {

/// What a solve starts from, in memory: K photographs of one cloth, photograph k lit by light k of the field
/// alone. Either mosaics of counts or linear RGB.
struct Photographs {
  Size size;
  std::vector<RawFrame> mosaics;
  std::optional<RawFrame> dark;          ///< of the mosaics
  std::optional<Radiometry> radiometry;  ///< of the mosaics
  std::vector<Image<float>> rgb;         ///< readings, planes R, G, B (core/radiometry.h)
  std::optional<LightField> field;
  std::optional<NoiseModel> noise;        ///< of the mosaics
  std::string albedo_scale = "relative";  ///< "absolute" where a measured patch fixed it

  std::size_t count() const { return rgb.empty() ? mosaics.size() : rgb.size(); }
};

}  // namespace weft::app
