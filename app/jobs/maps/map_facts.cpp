// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/map_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace weft::app {

Json json_of(const MapFacts& facts) {
  Json json = {{"name", facts.name}};
  if (!facts.file.empty()) json["file"] = facts.file;
  if (!facts.unit.empty()) json["unit"] = facts.unit;
  if (!facts.channels.empty()) json["channels"] = facts.channels;
  json["source"] = kMapSourceNames[static_cast<std::size_t>(facts.source)];
  if (facts.constant) {
    json["constant"] = *facts.constant;
  } else {
    json["least"] = facts.least;
    json["most"] = facts.most;
    json["mean"] = facts.mean;
  }
  if (!facts.why.empty()) json["why"] = facts.why;
  if (!facts.picture.empty()) json["picture"] = facts.picture;
  json.update(facts.more);
  return json;
}

ImageAttributes attributes_of(const MapFacts& facts, double mm_per_pixel) {
  ImageAttributes attributes = {
      {"weft.source", kMapSourceNames[static_cast<std::size_t>(facts.source)]},
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

}  // namespace weft::app
