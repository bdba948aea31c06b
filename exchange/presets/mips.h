// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image.h"
#include "exchange/presets/preset.h"

namespace weft::exchange {

/// The next coarser level of a file's values (pack_values()): sides halved and rounded down, never below 1.
/// Colours and data are averaged as values, colours so in linear light; the parts of a normal as slopes, and
/// are unit again, also where the file has x and y alone.
Image<float> next_level(const PresetFile& file, const Image<float>& values, int threads);

}  // namespace weft::exchange
