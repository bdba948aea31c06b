// SPDX-License-Identifier: Apache-2.0
#include "material/run/map_work.h"

#include <cmath>
#include <utility>

#include "core/image_io/image_io.h"
#include "report/downsampler.h"
#include "report/preview.h"
#include "solve/files/pictures.h"

namespace weft::material {
namespace {

// Normals and colours as such, anything else as heat from its least to its largest value.
report::Picture picture_of(const MapFacts& facts, const Image<float>& reduced) {
  if (reduced.planes() >= 3 && facts.channels.front() == "X") return report::normal_picture(reduced);
  if (reduced.planes() >= 3 && facts.channels.front() == "R")
    return report::albedo_picture(reduced, report::display_scale(reduced));
  Image<float> shown(reduced.size());
  for (int y = 0; y < shown.height(); ++y) {
    for (int x = 0; x < shown.width(); ++x) shown(x, y) = reduced(x, y) - static_cast<float>(facts.least);
  }
  const double span = facts.most > facts.least ? facts.most - facts.least : 1;
  return report::heat_picture(shown.plane(), span, " " + facts.unit);
}

}  // namespace

Result<void> write_map(MapWork& work, MapFacts facts, const std::vector<View<const float>>& planes) {
  const WriteOptions options = {.type = facts.unit == "mm" ? SampleType::kFloat : SampleType::kHalf,
                                .compression = work.compression,
                                .attributes = attributes_of(facts, stated_mm(work)),
                                .pitch_mm = {stated_mm(work), stated_mm(work)}};
  if (Result<void> ok = write_image(work.folder / facts.file, planes, facts.channels, options); !ok)
    return ok;
  return draw_map(work, std::move(facts), planes);
}

double stated_mm(const MapWork& work) {
  return work.is_size_known ? work.surface.mm_per_pixel : 0;
}

PixelPitch pitch_of_level(const MapWork& work, Size level) {
  const Size size = work.surface.size();
  return {stated_mm(work) * size.width / level.width, stated_mm(work) * size.height / level.height};
}

Result<void> draw_map(MapWork& work, MapFacts facts, const std::vector<View<const float>>& planes) {
  measure(facts, planes.front());
  report::Downsampler reduced(planes.front().size(), static_cast<int>(planes.size()));
  reduced.add_rows(planes);
  facts.picture = facts.name + ".png";
  const report::Picture picture = picture_of(facts, reduced.averages());
  if (Result<void> ok = solve::write_png(work.folder / facts.picture, picture); !ok) return ok;
  work.made.push_back(std::move(facts));
  return {};
}

void write_constant(MapWork& work, MapFacts facts, double value, std::string why) {
  facts.constant = value;
  facts.why = std::move(why);
  work.made.push_back(std::move(facts));
}

}  // namespace weft::material
