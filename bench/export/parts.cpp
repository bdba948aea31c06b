// SPDX-License-Identifier: Apache-2.0
#include "bench/export/parts.h"

#include "bench/export/blocks.h"
#include "bench/export/presets.h"

namespace weft::bench {

std::span<const ExportPart> export_parts() {
  static constexpr ExportPart kParts[] = {
      {"blocks", "textures of blocks: what they lose of a solved cloth, and how fast", export_blocks},
      {"presets", "seconds and megabytes of each preset on a tile of 2048 x 2048", export_presets},
      {"losses", "what normals and albedo lose in every format", export_losses},
  };
  return kParts;
}

}  // namespace weft::bench
