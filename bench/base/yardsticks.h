// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/light_field.h"
#include "solve/photographs/photographs.h"

// What speed is measured against, in the same run.

namespace weft::bench {

/// Seconds to move `bytes`, half of them read and half written, in blocks that no cache holds.
double copy_seconds(double bytes, int threads);

/// A mosaic session in memory: every light of the field on a flat cloth of middle grey, as counts, and the
/// dark shot.
solve::Photographs grey_mosaics(const LightField& field, Size size, int threads);

/// Seconds that LibRaw alone takes to unpack all frames of a session, from DNG files written for it, by
/// pixel.
Result<double> unpack_seconds_a_pixel(const solve::Photographs& photographs, int threads);

struct Yardsticks {
  double copy_seconds_a_byte = 0;     ///< read or written
  double unpack_seconds_a_pixel = 0;  ///< of ten lit frames and the dark one together
};
/// Both, of 4 megapixels.
Result<Yardsticks> measure_yardsticks(int threads);

/// LibRaw alone: least wall seconds of three runs to open and unpack every file, the files shared out among
/// the threads.
Result<double> unpack_seconds(const std::vector<std::filesystem::path>& files, int threads);

}  // namespace weft::bench
