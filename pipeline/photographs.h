// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/json_document.h"
#include "core/light_field.h"
#include "core/lights.h"
#include "core/photosites.h"
#include "core/radiometry.h"
#include "core/raw_frame.h"
#include "solver/registration/cloth_shift.h"

namespace weft::app {

/// A mosaic once more at another exposure.
struct Bracket {
  RawFrame frame;
  Radiometry radiometry;
};

/// What a solve starts from, in memory: K photographs of one cloth, photograph k lit by light k of the field
/// alone. Either mosaics of counts or linear RGB.
struct Photographs {
  Size size;
  std::vector<int> leds;  ///< number of each light in its rig; empty where there is none
  std::vector<RawFrame> mosaics;
  std::optional<RawFrame> dark;                ///< of the mosaics
  std::optional<Radiometry> radiometry;        ///< of the mosaics
  std::vector<std::vector<Bracket>> brackets;  ///< of each mosaic; empty where there are none at all
  std::vector<Photosite> replaced;             ///< sorted: their counts are what their neighbours say
  std::vector<Image<float>> rgb;               ///< readings, planes R, G, B (core/radiometry.h)
  std::vector<solver::ClothShift> shifts;      ///< put right as tiles are read (pipeline/shifts.h)
  std::optional<LightField> field;
  std::optional<CameraModel> camera;                    ///< where the lights are near
  std::optional<ParameterCovariance> light_covariance;  ///< where the calibration has one
  std::optional<NoiseModel> noise;                      ///< of the mosaics; of brackets the worst
  std::string albedo_scale = "relative";                ///< "absolute" where a measured patch fixed it
  std::optional<ColorTransform> color;                  ///< of solved albedo, where the calibration has one

  /// What was found and corrected under way, for solve.json: docs/conditions.md.
  Json conditions = Json::object();
  std::vector<std::string> warnings;  ///< a sentence each

  std::size_t count() const { return rgb.empty() ? mosaics.size() : rgb.size(); }

  /// Readings of mosaic k with its brackets, as Radiometry::read gives them.
  void read(std::size_t k, Rect tile, View<float> out) const;
};

/// Marks with INVALID_READING the pixels of `band`, as high as `status`, whose counts were replaced.
void mark_replaced(const std::vector<Photosite>& replaced, Rect band, View<std::uint16_t> status);

}  // namespace weft::app
