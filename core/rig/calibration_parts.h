// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/describe/fields.h"
#include "core/rig/calibration.h"

// The documents of a calibration's parts. Each has the lowest version that says all of it.

namespace weft {

/// camera.json
struct CameraPart {
  CameraModel model;
  std::optional<ParameterCovariance> covariance;
  std::vector<Fiducial> fiducials;
  std::optional<PointSpread> spread;
  std::optional<LateralColor> lateral;
};
void describe(Fields& fields, CameraPart& part);
const char* schema_name(const CameraPart& part);

/// response.json
void describe(Fields& fields, Response& response);
const char* schema_name(const Response& response);

/// color.json
void describe(Fields& fields, ColorTransform& color);
const char* schema_name(const ColorTransform& color);

/// lights.json
struct LightsPart {
  Lights lights;
  std::vector<WhitePatch> patches;
  std::optional<ParameterCovariance> covariance;
  std::vector<FixedPoint> points;
};
void describe(Fields& fields, LightsPart& part);
const char* schema_name(const LightsPart& part);

}  // namespace weft
