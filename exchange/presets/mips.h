// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/image/image.h"
#include "exchange/presets/channels.h"
#include "exchange/presets/preset.h"

namespace weft::exchange {

/// The next coarser level of a file's values (pack_values()): sides halved and rounded down, never below 1.
/// Colours and data are averaged as values, colours so in linear light; the parts of a normal as slopes, and
/// are unit again, also where the file has x and y alone.
Image<float> next_level(const PresetFile& file, const Image<float>& values, int threads);

/// The lobe of a cloth on ever coarser grids, levels 1, 2 ...: planes alpha, alpha_along, yarn_deg, the
/// alphas widened by the spread of the normals beneath a texel, as no mean of a file's values can be.
using LobeLevels = std::span<const Image<float>>;

/// Whether a channel is of the lobe alone, so that coarser levels of it are those of the lobe.
bool is_of_lobe(const Channel& channel);

/// Gives the channels of a file's `level` (1 or above) that are of the lobe what `lobe` has there, as values.
/// Where a level is larger than the lobe's, as of padded textures, the last column and row go on; below the
/// last level of the lobe that one does.
void put_lobe(const PresetFile& file, const ChannelFacts& facts, LobeLevels lobe, int level,
              Image<float>& values);

}  // namespace weft::exchange
