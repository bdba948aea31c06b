// SPDX-License-Identifier: Apache-2.0
// What a cloth is as a layer over another material, and where it has holes.
#include <cmath>
#include <utility>

#include "app/jobs/maps/map_work.h"
#include "core/image_io/image_io.h"
#include "core/vec.h"
#include "material/filtering/detail.h"

namespace weft::app {
namespace {

Image<float> normals_of(const Image<float>& slope) {
  Image<float> normal(slope.size(), 3);
  for (int y = 0; y < slope.height(); ++y) {
    for (int x = 0; x < slope.width(); ++x) {
      const Vec3 n = normalized(Vec3{-slope(x, y, 0), -slope(x, y, 1), 1});
      normal(x, y, 0) = static_cast<float>(n.x);
      normal(x, y, 1) = static_cast<float>(n.y);
      normal(x, y, 2) = static_cast<float>(n.z);
    }
  }
  return normal;
}

}  // namespace

Result<void> make_detail(MapWork& work) {
  if (Result<void> ok = find_height(work); !ok) return ok;
  material::DetailOptions options;
  options.threads = work.context.threads;
  const Result<material::DetailLayer> layer =
      material::detail_layer(work.surface, work.height_mm.plane(), options);
  if (!layer) return layer.error();
  const Image<float> normal = normals_of(layer->slope);
  MapFacts normals = {.name = "detail_normal", .file = "detail_normal.exr", .channels = {"X", "Y", "Z"}};
  normals.more = {{"slope_taken_out", {layer->facts.slope_x, layer->facts.slope_y}},
                  {"share_of_frame", layer->facts.share_of_frame}};
  if (Result<void> ok =
          write_map(work, std::move(normals), {normal.plane(0), normal.plane(1), normal.plane(2)});
      !ok)
    return ok;
  MapFacts albedo = {.name = "detail_albedo", .file = "detail_albedo.exr", .channels = {"R", "G", "B"}};
  albedo.more = {{"mean_taken_out", layer->facts.albedo}};
  if (Result<void> ok = write_map(work, std::move(albedo),
                                  {layer->albedo.plane(0), layer->albedo.plane(1), layer->albedo.plane(2)});
      !ok)
    return ok;
  MapFacts height = {
      .name = "detail_height", .file = "detail_height.exr", .unit = "mm", .channels = {"height"}};
  height.more = {{"mean_taken_out", layer->facts.height_mm}};
  return write_map(work, std::move(height), {layer->height_mm.plane()});
}

Result<void> make_opacity(MapWork& work) {
  MapFacts facts = {.name = "opacity", .unit = "share", .channels = {"opacity"}};
  if (work.surface.opacity.empty()) {
    write_constant(work, std::move(facts), 1, "no light came from below, and the solver saw no hole");
    return {};
  }
  const material::OpacityFacts& found = *work.opacity;
  facts.file = "opacity.exr";
  facts.source =
      found.way == material::OpacityFacts::Way::kMarkedHoles ? MapSource::kDerived : MapSource::kMeasured;
  facts.more = {{"way", material::name_of(found.way)},
                {"open", found.open},
                {"through_yarns", found.through_yarns},
                {"is_coverage", found.is_coverage()},
                {"clipped", found.clipped},
                {"unreadable", found.unreadable}};
  return draw_map(work, std::move(facts), work.surface.opacity.plane());
}

}  // namespace weft::app
