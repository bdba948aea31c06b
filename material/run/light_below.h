// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "material/run/rectify.h"

namespace weft::material {

/// Whether the session has a photograph by the light below the cloth.
bool has_light_below(const Session& session);

/// What comes through a cloth of the light below it, on the grid of its rectified maps.
struct ThroughCloth {
  Image<float> share;             ///< (cloth - dark) / (bare table - dark); NaN where the table is dark
  Image<std::uint8_t> saturated;  ///< 1 where a photograph is full
};

/// `bare` is a session of the table without cloth, photographed by the same light and at the same exposure.
/// Cells of 2 x 2 photosites are read, all colours together. kBadData where one of them has no such
/// photograph or no dark shot, the exposures differ, or the sizes; kNoInput.
Result<ThroughCloth> light_through_cloth(const Session& session, const std::filesystem::path& bare,
                                         const Calibration& calibration, const RectifyFacts& rectified,
                                         int threads);

}  // namespace weft::material
