// SPDX-License-Identifier: Apache-2.0
#include "material/run/map_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "core/describe/field_json.h"

namespace weft::material {

const char* name_of(MapSource source) {
  return kMapSourceNames[static_cast<std::size_t>(source)];
}

MapSource map_source_named(std::string_view name) {
  const auto* const found = std::ranges::find(kMapSourceNames, name);
  return found == kMapSourceNames.end() ? MapSource::kAssumed
                                        : static_cast<MapSource>(found - kMapSourceNames.begin());
}

void describe(Fields& fields, MapFacts& f) {
  fields.keep(f.document);
  fields.value({"name", "Which map", {}, kMustSay}, f.name);
  fields.value({"file", "Beside it; a map that is one number has none", {}, kUnlessEmpty}, f.file);
  fields.value({"unit", "Of its values", {}, kUnlessEmpty}, f.unit);
  fields.value({"channels", "Of the file", {}, kUnlessEmpty}, f.channels);
  fields.choice({"source", "Solved, computed from what was, or typed", {}, kMustSay}, f.source,
                kMapSourceNames);
  fields.value({"constant", "The whole map is this number"}, f.constant);
  fields.only_if(!f.constant, [&] {
    fields.value({"least", "Value of the first channel", {}, kOrNull}, f.least);
    fields.value({"most", "Value of the first channel", {}, kOrNull}, f.most);
    fields.value({"mean", "Of the first channel", {}, kOrNull}, f.mean);
  });
  fields.value({"why", "It is one number, or what it is good for", {}, kUnlessEmpty}, f.why);
  fields.value({"picture", "A file beside it, for people", {}, kUnlessEmpty}, f.picture);
}

Json json_of(const MapFacts& facts) {
  Json json = object_of(facts);
  json.update(facts.more);
  return json;
}

ImageAttributes attributes_of(const MapFacts& facts, double mm_per_pixel) {
  ImageAttributes attributes = {
      {"weft.source", name_of(facts.source)},
  };
  if (mm_per_pixel > 0) attributes["weft.mm_per_pixel"] = fmt::format("{:.9g}", mm_per_pixel);
  if (!facts.unit.empty()) attributes["weft.unit"] = facts.unit;
  return attributes;
}

void measure(MapFacts& facts, View<const float> plane) {
  double sum = 0;
  facts.least = facts.most = static_cast<double>(plane(0, 0));
  for (int y = 0; y < plane.height(); ++y) {
    const float* row = plane.row(y);
    for (int x = 0; x < plane.width(); ++x) {
      const double value = static_cast<double>(row[x]);
      facts.least = std::min(facts.least, value);
      facts.most = std::max(facts.most, value);
      sum += value;
    }
  }
  facts.mean = sum / static_cast<double>(plane.size().pixels());
}

}  // namespace weft::material
