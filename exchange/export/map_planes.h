// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/export/map_folder.h"
#include "exchange/presets/channels.h"
#include "exchange/presets/mips.h"

namespace weft::exchange {

/// The lobe of a cloth on a grid and on coarser ones: planes alpha, alpha_along, yarn_deg. Alphas are widened
/// by the spread of the normals of all pixels beneath a texel, by the rule of the set's own mips
/// (material/filtering/roughness_mips). Pixels without a solution and holes count nowhere.
struct LobeOnGrid {
  Image<float> own;                   ///< of the grid itself; empty where that is the folder's
  std::vector<Image<float>> coarser;  ///< sides halved and rounded down, down to 1 x 1
};

/// The planes of a folder of maps, each file read when its planes are first asked for.
class MapPlanes {
 public:
  /// Everything is averaged down to `size`, which is at most the folder's: heights, colours and data as they
  /// are, normals as slopes; a lobe becomes as wide as the spread of normals beneath makes it.
  MapPlanes(const MapFolder& folder, Size size, int threads)
      : folder_(folder), size_(size), threads_(threads) {}

  /// Reads what `wanted` needs and lets go of the files that it does not need. kBadData with the file: it is
  /// of another size, lacks a channel, or holds a value that is no finite number.
  Result<void> load(const std::set<MapPlane>& wanted);

  /// What is loaded; of files that are not, an empty plane with a number, so that it counts as there.
  const SourcePlanes& planes() const { return planes_; }

  /// The lobe on ever coarser grids, once a plane of it was asked for; empty where there are no normals or no
  /// roughness, or one that is 1 everywhere.
  LobeLevels lobe() const { return lobe_.coarser; }

  /// The planes as check_file() and says_something() need them: those of files have a pixel without a
  /// meaning.
  static SourcePlanes outline_of(const MapFolder& folder);

 private:
  Result<void> read(const std::string& file, const std::vector<MapPlane>& planes);
  Result<void> find_lobe();

  const MapFolder& folder_;
  Size size_;
  int threads_;
  std::map<std::string, Image<float>> loaded_;  ///< by file, planes in the order of exchange::MapPlane
  SourcePlanes planes_;
  LobeOnGrid lobe_;
  bool has_lobe_ = false;
};

/// What channels need to know of the cloth beside its pixels, of planes that are loaded: the range of heights
/// by the document, the mean luminance and the mean slopes where albedo and normals are loaded.
ChannelFacts channel_facts(const MapFolder& folder, const SourcePlanes& planes);

}  // namespace weft::exchange
