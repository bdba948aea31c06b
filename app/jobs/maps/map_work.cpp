// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/map_work.h"

#include <cmath>
#include <utility>

#include "app/jobs/pictures.h"
#include "core/image_io/image_io.h"
#include "report/downsampler.h"
#include "report/preview.h"

namespace weft::app {
namespace {

// Heat from the least to the largest value.
Result<void> draw(MapFacts& facts, const std::filesystem::path& folder, View<const float> plane) {
  report::Downsampler reduced(plane.size(), 1);
  reduced.add_rows(std::vector<View<const float>>{plane});
  Image<float> shown(reduced.averages().size());
  for (int y = 0; y < shown.height(); ++y) {
    for (int x = 0; x < shown.width(); ++x)
      shown(x, y) = reduced.averages()(x, y) - static_cast<float>(facts.least);
  }
  facts.picture = facts.name + ".png";
  const double span = facts.most > facts.least ? facts.most - facts.least : 1;
  return write_png(folder / facts.picture, report::heat_picture(shown.plane(), span, " " + facts.unit));
}

}  // namespace

Result<void> write_map(MapWork& work, MapFacts facts, const std::vector<View<const float>>& planes) {
  const WriteOptions options = {.type = facts.unit == "mm" ? SampleType::kFloat : SampleType::kHalf,
                                .compression = work.compression};
  if (Result<void> ok = write_image(work.folder / facts.file, planes, facts.channels, options); !ok)
    return ok;
  return draw_map(work, std::move(facts), planes.front());
}

Result<void> draw_map(MapWork& work, MapFacts facts, View<const float> plane) {
  measure(facts, plane);
  if (Result<void> ok = draw(facts, work.folder, plane); !ok) return ok;
  work.made.push_back(std::move(facts));
  return {};
}

void write_constant(MapWork& work, MapFacts facts, double value, std::string why) {
  facts.constant = value;
  facts.why = std::move(why);
  work.made.push_back(std::move(facts));
}

const std::vector<DerivedMap>& derived_maps() {
  static const std::vector<DerivedMap> maps = {
      {"height", "millimetres towards the camera", make_height},
      {"curl", "how far slopes are from those of any surface", make_curl},
      {"occlusion", "share of the sky that a point sees, bounces with it, and the bent normal",
       make_occlusion},
      {"cavity", "0 deep, 0.5 flat, 1 high, within --cavity", make_cavity},
      {"roughness", "alpha and f0 of the lobe, measured or that of --cloth", make_roughness},
      {"gloss", "the lobe on the scales of other engines", make_gloss},
      {"mips", "normals and roughness of coarser levels, as bright as the finest", make_mips},
      {"detail", "a layer for other materials: slopes of mean 0, albedo over its mean", make_detail},
      {"opacity", "0 a hole, 1 cloth: by the light below and --bare, else the holes that the solver saw",
       make_opacity}};
  return maps;
}

}  // namespace weft::app
