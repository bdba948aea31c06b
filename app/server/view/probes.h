// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "app/server/view/pyramid.h"
#include "app/server/view/viewed_maps.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/calibration.h"

// What maps say in a place: numbers for people, from the maps' own values, never from tiles.

namespace weft::app {

/// The pyramid of a layer.
using OpenLayer = std::function<Result<std::shared_ptr<Pyramid>>(const Layer&)>;

/// {"level", "pixels", "layers": {NAME: {CHANNEL: {"mean", "deviation", "p5", "p50", "p95", "least", "most",
/// "bins"}}}, "status": {NAME: share}} of a rectangle, which lies inside. Up to four megapixels every pixel
/// counts (level 0); of larger ones the averages of the level that has no more do. "bins" are 64 counts from
/// least to most.
Result<Json> region_facts(const Layers& layers, const OpenLayer& open, Rect part);

/// A line over the frame, between centres of pixels of the maps.
struct Line {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Where pixels of maps lie on the cloth.
struct Ground {
  const Calibration* calibration =
      nullptr;              ///< has the camera that saw them; none: they are a grid of the table
  int pixels_each = 1;      ///< of the camera, a pixel of the maps and side
  double height_mm = 0;     ///< of the cloth
  double mm_per_pixel = 0;  ///< of the grid
};

/// A place on the plane of the cloth, in the rig frame; of a grid, from the first pixel's centre, y up.
Vec3 place_on(const Ground& ground, double x, double y);

/// {"mm", "sigma_mm", "profile": {"mm", "height_mm", "albedo"}} along a line. The length is that on the plane
/// of the cloth, its sigma from the covariance of the camera (null where there is none). The
/// profile is of the pixels under the line, at most 2000: heights are sums of slopes from the line's begin,
/// albedo is green's. kBadData where a layer of normals or albedo is not there.
Result<Json> line_facts(const Layers& layers, const OpenLayer& open, const Line& line, const Ground& ground);

}  // namespace weft::app
