// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/presets/channels.h"
#include "exchange/presets/preset.h"

// The one packer: from the maps of a cloth to the channels of a file, for any preset.

namespace weft::exchange {

/// What the maps need to say for a file, before a pixel of it is packed. kBadData where one of its channels
/// asks for a map that is not there and has no other value: `where` is the preset and the file's name.
Result<void> check_file(const PresetFile& file, const SourcePlanes& planes, const std::string& preset);

/// Whether the file tells of a map that is there, and not only what every cloth is without one: no hole, no
/// metal, no sheen, no direction.
bool says_something(const PresetFile& file, const SourcePlanes& planes);

/// The channels' rows from y0 on, as values (Channel::least to most and beyond). `out` has a view a channel,
/// as wide as the maps. A plane that is missing has its other value, 0 where it has none.
void pack_values(const PresetFile& file, const SourcePlanes& planes, const ChannelFacts& facts, int y0,
                 std::span<const View<float>> out);

/// Turns values into samples as the file is to hold them, in place: integers 0 to 1 over the channel's range
/// (0.5 where the range is empty), colours of sRGB by its transfer function; floats stay what they are, but
/// for colours of sRGB. What is outside the range of an integer is cut later, by who rounds.
void to_samples(const PresetFile& file, const ChannelFacts& facts, std::span<const View<float>> values);
/// And back, of samples that were read from a file.
void to_values(const PresetFile& file, const ChannelFacts& facts, std::span<const View<float>> samples);

/// Names of a file's channels as an image file has them: "Y", "Y A", "R G B", "R G B A".
std::vector<std::string> channel_names(std::size_t channels);

}  // namespace weft::exchange
