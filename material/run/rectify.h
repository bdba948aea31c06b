// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/product.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/compression.h"
#include "core/image/image.h"
#include "solve/session/current.h"

namespace weft::material {

inline constexpr ProductKind kRectifiedProduct = {"weft.rectified", "rectify.json", "set of rectified maps",
                                                  "rectify a solve first with weft rectify"};

struct RectifyOptions {
  std::filesystem::path session;            ///< or the folder of a solve of photographs
  std::string solve;                        ///< id of the solve; empty: the session's current one
  bool is_draft = false;                    ///< a preview will do
  std::filesystem::path calibration;        ///< empty: the session's own
  std::filesystem::path output;             ///< empty: <session>/rectified/<id>
  std::optional<double> mm_per_pixel = {};  ///< none: what the camera sees at the grid's centre
  double turn_deg = 0;  ///< of the grid's columns against the rig's x axis, counterclockwise
  Compression compression = Compression::kNone;  ///< of EXR files
  int band_rows = 64;                            ///< changes no byte; from 1
};
void describe(Fields& fields, RectifyOptions& options);

/// What rectify.json says of rectified maps (weft.rectified/1).
struct RectifyFacts {
  std::string id;
  solve::SourceFacts source;
  std::string calibration;
  Size size;  ///< of the maps
  double mm_per_pixel = 0;
  double height_mm = 0;  ///< of the cloth above the table
  double turn_deg = 0;   ///< of the grid, counterclockwise from above
  std::array<double, 2> centre_mm = {}, first_pixel_mm = {};
  std::string normals, filter;  ///< their axes, and how maps were sampled: a sentence each
  Compression compression = Compression::kNone;
  std::int64_t pixels = 0;  ///< with a solution
  Json document;            ///< as it was read, so that fields of newer versions survive
};
void describe(Fields& fields, RectifyFacts& facts);
Json json_of(const RectifyFacts& facts);

/// What a rectification left behind.
struct RectifyReport {
  std::filesystem::path folder;
  bool was_there = false;  ///< a complete one of the same solve and options was found
  RectifyFacts facts;      ///< with what is stale of the solve today
};

/// Puts the maps of a solve on a square grid of the table at the session's cloth_height_mm, lens and
/// perspective removed (material/table_grid.h): normal.exr, albedo.exr, sigma.exr, status.png, of a measured
/// lobe roughness.exr and specular.exr, and rectify.json (weft.rectified/1), made aside and published whole.
/// Sigma is that of the photographed pixels around: a mean of several, which the filter takes, has less. Maps
/// of half the frame's size, as the level preview gives, have half the camera's. Memory holds one map of the
/// solve at a time: 16 to 32 bytes a pixel.
///
/// Errors: kUsage (an option), kNoInput (no session), those of solve::solve_for_maps(), kBadData (a
/// calibration without camera, maps that are not of its size), kCannotCreate, kInputOutput, kInterrupted.
Result<RectifyReport> rectify_session(const RectifyOptions& options, const JobContext& context);

}  // namespace weft::material
