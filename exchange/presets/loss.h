// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/describe/fields.h"
#include "core/image/image.h"
#include "exchange/presets/channels.h"
#include "exchange/presets/mips.h"
#include "exchange/presets/preset.h"

namespace weft::exchange {

/// Angles between the normals of the maps and those of a file.
struct AngleLoss {
  double mean_deg = 0, p95_deg = 0, max_deg = 0;  ///< p95 to one percent of itself
};

/// The loss of reflectance: the mean of its absolute difference, and 10 log10 of 1 over the mean square
/// difference of the samples as the file holds them (of sRGB after its transfer function, of integers cut to
/// 0 to 1); none where nothing is lost.
struct ColorLoss {
  double mean_abs = 0;
  std::optional<double> psnr_db = {};
};

/// A channel's values, and by how much the file's differ.
struct ChannelLoss {
  std::string channel;
  double least = 0, most = 0, mean = 0;  ///< of the maps' values
  double mean_abs = 0, most_abs = 0;     ///< of the difference
  std::int64_t cut = 0;                  ///< pixels whose value is outside of what the file can hold
};

/// What becomes of a roughness with distance where an engine makes the mips: means of the file's values,
/// which know nothing of the spread of the normals beneath.
struct DistanceLoss {
  std::string channel;
  int level = 1;                ///< seen from 2 to its power times as far
  double mean = 0, engine = 0;  ///< of the cloth's own level, and of the engine's
  double mean_abs = 0;          ///< of the difference
};

/// What a file holds otherwise than the maps.
struct Loss {
  std::optional<AngleLoss> normal = {};  ///< of a file with normal.x and normal.y
  std::optional<ColorLoss> albedo = {};  ///< of a file with albedo.r, .g and .b
  std::vector<ChannelLoss> channels = {};
  std::vector<DistanceLoss> by_distance = {};  ///< of a file of one level
};

/// All but the channels.
void describe(Fields& fields, Loss& loss);

/// `samples` are those of the file as it was read back, a plane a channel, of the size of the maps. They are
/// used up.
Loss measure_loss(const PresetFile& file, const SourcePlanes& planes, const ChannelFacts& facts,
                  Image<float> samples);

/// The losses of each roughness of a file, level by level down to some 8 texels a side.
std::vector<DistanceLoss> loss_by_distance(const PresetFile& file, const SourcePlanes& planes,
                                           const ChannelFacts& facts, LobeLevels lobe, Size size,
                                           int threads);

/// The angle between two directions that need not be unit, to rounding also where it is small.
double angle_deg(const float* a, const float* b);

}  // namespace weft::exchange
