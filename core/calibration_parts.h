// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/json_document.h"
#include "core/result.h"

// The documents of a calibration's parts. Readers return kBadData with the field and `where`, the file.

namespace weft {

/// camera.json
struct CameraPart {
  CameraModel model;
  std::optional<ParameterCovariance> covariance;
  std::vector<Fiducial> fiducials;
  std::optional<PointSpread> spread;
  std::optional<LateralColor> lateral;
};
Json json_of(const CameraPart& part);
Result<CameraPart> camera_part_from_json(const Json& json, const std::string& where);

/// response.json
Json json_of(const Response& response);
Result<Response> response_from_json(const Json& json, const std::string& where);

/// color.json
Json json_of(const ColorTransform& color);
Result<ColorTransform> color_from_json(const Json& json, const std::string& where);

/// lights.json
struct LightsPart {
  Lights lights;
  std::vector<WhitePatch> patches;
  std::optional<ParameterCovariance> covariance;
};
Json json_of(const LightsPart& part);
Result<LightsPart> lights_part_from_json(const Json& json, const std::string& where);

}  // namespace weft
