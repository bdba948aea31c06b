// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "exchange/export/export_request.h"
#include "exchange/export/prepare.h"
#include "exchange/presets/loss.h"

namespace weft::exchange {

/// What one way to store some channels costs and loses on this cloth.
struct ExportPrice {
  std::string preset;  ///< empty: no preset's, but to be compared with
  std::string file;    ///< of the preset, or "normals", "albedo"
  Stored stored;
  double bytes = 0, seconds = 0;  ///< of the whole cloth, by one thread, from those of the piece
  Loss loss;
  bool is_chosen = false;  ///< by what the normals may lose, or writing may take
};

/// Bytes, seconds and losses of each file of the presets, and of normals and albedo in every format, on a
/// piece of 512 x 512 pixels from the middle of the maps, before anything is written but in the system's
/// temporary folder. With `to_deg` or `within_s` the files of normals are priced as they would be chosen.
/// Errors of export_maps().
Result<std::vector<ExportPrice>> price_exports(const ExportOptions& options, const JobContext& context);
Json json_of(const std::vector<ExportPrice>& prices);

/// Gives each file with normals the fewest bits of its own encoding with which they lose at most the `to_deg`
/// that is asked for in the mean, measured on that piece; or those by which they lose least together while
/// all textures are written in `within_s`. kBadData where its encoding has none so good, kUsage where none is
/// so quick, with the best that there is.
Result<void> choose_bits(PreparedExport& prepared, const JobContext& context);

}  // namespace weft::exchange
