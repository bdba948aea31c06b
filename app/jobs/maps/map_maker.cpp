// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/map_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/jobs/pictures.h"
#include "core/image_io/image_io.h"
#include "report/downsampler.h"
#include "report/preview.h"
#include "solver/height/height.h"

namespace weft::app {

Json json_of(const MapFacts& facts) {
  Json json = {{"name", facts.name}};
  if (!facts.file.empty()) json["file"] = facts.file;
  if (!facts.unit.empty()) json["unit"] = facts.unit;
  if (!facts.channels.empty()) json["channels"] = facts.channels;
  json["source"] = kMapSourceNames[static_cast<std::size_t>(facts.source)];
  if (facts.constant) {
    json["constant"] = *facts.constant;
    json["why"] = facts.why;
  } else {
    json["least"] = facts.least;
    json["most"] = facts.most;
    json["mean"] = facts.mean;
  }
  if (!facts.picture.empty()) json["picture"] = facts.picture;
  json.update(facts.more);
  return json;
}

namespace {

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

}  // namespace

Result<void> MapMaker::make(MapName name) {
  if (context_.stop.stop_requested()) return interrupted();
  switch (name) {
    case MapName::kHeight:
      return make_height();
  }
  return {};
}

Result<void> MapMaker::find_height() {
  if (!height_mm_.empty()) return {};
  Image<float> normal(surface_.size(), 3);
  for (int y = 0; y < normal.height(); ++y) {
    for (int x = 0; x < normal.width(); ++x) {
      normal(x, y, 0) = -surface_.slope(x, y, 0);
      normal(x, y, 1) = -surface_.slope(x, y, 1);
      normal(x, y, 2) = 1;
    }
  }
  Result<solver::Height> height =
      solver::height_from_normals({normal.plane(0), normal.plane(1), normal.plane(2)}, {},
                                  {.mm_per_pixel = surface_.mm_per_pixel, .threads = context_.threads});
  if (!height) return std::move(height).error();
  height_mm_ = std::move(height->height_mm);
  return {};
}

Result<void> MapMaker::make_height() {
  if (Result<void> ok = find_height(); !ok) return ok;
  return write({.name = "height", .file = "height.exr", .unit = "mm", .channels = {"height"}},
               {height_mm_.plane()});
}

Result<void> MapMaker::write(MapFacts facts, const std::vector<View<const float>>& planes) {
  measure(facts, planes.front());
  const bool needs_float = facts.unit == "mm";
  const WriteOptions options = {.type = needs_float ? SampleType::kFloat : SampleType::kHalf,
                                .compression = compression_};
  if (Result<void> ok = write_image(folder_ / facts.file, planes, facts.channels, options); !ok) return ok;
  if (Result<void> ok = draw(facts, planes.front()); !ok) return ok;
  made_.push_back(std::move(facts));
  return {};
}

Result<void> MapMaker::draw(MapFacts& facts, View<const float> plane) const {
  report::Downsampler reduced(plane.size(), 1);
  reduced.add_rows(std::vector<View<const float>>{plane});
  Image<float> shown(reduced.averages().size());
  for (int y = 0; y < shown.height(); ++y) {
    for (int x = 0; x < shown.width(); ++x)
      shown(x, y) = reduced.averages()(x, y) - static_cast<float>(facts.least);
  }
  facts.picture = facts.name + ".png";
  const double span = facts.most > facts.least ? facts.most - facts.least : 1;
  return write_png(folder_ / facts.picture, report::heat_picture(shown.plane(), span, " " + facts.unit));
}

}  // namespace weft::app
