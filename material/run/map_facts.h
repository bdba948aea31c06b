// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/describe/fields.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"

namespace weft::material {

/// How a map came to be.
enum class MapSource {
  kMeasured,  ///< solved from photographs
  kDerived,   ///< computed from measured maps
  kAssumed    ///< typed, since the photographs do not tell it
};
inline constexpr std::array<const char*, 3> kMapSourceNames = {"measured", "derived", "assumed"};
const char* name_of(MapSource source);
/// What has another name is assumed.
MapSource map_source_named(std::string_view name);

/// What maps.json says of a map.
struct MapFacts {
  std::string name = {};
  std::string file = {};                   ///< a map that is one number has none
  std::string unit = {};                   ///< "mm", "deg", "share"; empty: none
  std::vector<std::string> channels = {};  ///< of the file
  MapSource source = MapSource::kDerived;
  double least = 0, most = 0, mean = 0;  ///< of the first channel
  std::optional<double> constant = {};   ///< the map is this number
  std::string why = {};                  ///< it is one number, or what it is good for
  std::string picture = {};              ///< a file beside it; empty: none
  Json more = Json::object();            ///< what is particular to this map, until it is listed
  Json document = {};                    ///< all that a list says of it
};
void describe(Fields& fields, MapFacts& facts);
/// With `more`.
Json json_of(const MapFacts& facts);

/// What its file says of itself: weft.source, weft.unit and, above 0, weft.mm_per_pixel.
ImageAttributes attributes_of(const MapFacts& facts, double mm_per_pixel);

/// Fills the least, the largest and the mean value.
void measure(MapFacts& facts, View<const float> plane);

}  // namespace weft::material
