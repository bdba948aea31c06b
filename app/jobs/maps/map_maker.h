// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/compression.h"
#include "core/image.h"
#include "core/job.h"
#include "core/json_document.h"
#include "core/result.h"
#include "material/surface.h"

namespace weft::app {

/// What can be derived from a surface.
enum class MapName { kHeight };
inline constexpr std::array<const char*, 1> kMapNames = {"height"};

/// How a map came to be.
enum class MapSource {
  kMeasured,  ///< solved from photographs
  kDerived,   ///< computed from measured maps
  kAssumed    ///< typed, since the photographs do not tell it
};
inline constexpr std::array<const char*, 3> kMapSourceNames = {"measured", "derived", "assumed"};

/// What maps.json says of a map.
struct MapFacts {
  std::string name = {}, file = {};   ///< of a map that is one number there is no file
  std::string unit = {};              ///< "mm", "share"; empty: none
  std::vector<std::string> channels = {};  ///< of the file
  MapSource source = MapSource::kDerived;
  double least = 0, most = 0, mean = 0;  ///< of the first channel
  std::optional<double> constant = {};   ///< the map is this number
  std::string why = {};                  ///< it is one number
  std::string picture = {};              ///< a file beside it; empty: none
  Json more = Json::object();            ///< what is particular to this map
};
Json json_of(const MapFacts& facts);

/// Derives maps of a surface, each once, with what they need themselves, and writes them.
class MapMaker {
 public:
  /// The surface must outlive it.
  MapMaker(const material::Surface& surface, std::filesystem::path folder, Compression compression,
           const JobContext& context)
      : surface_(surface), folder_(std::move(folder)), compression_(compression), context_(context) {}

  Result<void> make(MapName name);
  const std::vector<MapFacts>& made() const { return made_; }

 private:
  Result<void> find_height();
  Result<void> make_height();
  Result<void> write(MapFacts facts, const std::vector<View<const float>>& planes);
  Result<void> draw(MapFacts& facts, View<const float> plane) const;

  const material::Surface& surface_;
  std::filesystem::path folder_;
  Compression compression_;
  const JobContext& context_;
  std::vector<MapFacts> made_;
  Image<float> height_mm_;  // once it is needed
};

}  // namespace weft::app
