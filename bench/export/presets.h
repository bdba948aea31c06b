// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/export/parts.h"

namespace weft::bench {

/// Each preset of weft's own on a tile of 2048 x 2048: files, megabytes and wall seconds, and the same of all
/// at once, where files that are alike are encoded once. Errors of the scene and of export_maps().
Result<Rows> export_presets(const ExportBenchOptions& options);

/// What normals and albedo of the scene lose in every format: degrees and decibels, with megabytes and
/// seconds of 4 megapixels by one thread.
Result<Rows> export_losses(const ExportBenchOptions& options);

}  // namespace weft::bench
