// SPDX-License-Identifier: Apache-2.0
// What a cloth is as a layer over another material, and where it has holes.
#include <fmt/format.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "material/filtering/detail.h"
#include "material/run/derived_maps.h"
#include "material/run/surface_files.h"

namespace weft::material {

Result<void> make_detail(MapWork& work) {
  if (Result<void> ok = find_height(work); !ok) return ok;
  DetailOptions options;
  options.threads = work.context.threads;
  const Result<DetailLayer> layer = detail_layer(work.surface, work.height_mm.plane(), options);
  if (!layer) return layer.error();
  const Image<float> normal = normals_of(layer->slope);
  MapFacts normals = {.name = "detail_normal", .file = "detail_normal.exr", .channels = {"X", "Y", "Z"}};
  normals.more = {{"slope_taken_out", {layer->facts.slope_x, layer->facts.slope_y}},
                  {"share_of_frame", layer->facts.share_of_frame}};
  if (Result<void> ok = write_map(work, std::move(normals), planes_of(normal)); !ok) return ok;
  MapFacts albedo = {.name = "detail_albedo", .file = "detail_albedo.exr", .channels = {"R", "G", "B"}};
  albedo.more = {{"mean_taken_out", layer->facts.albedo}};
  if (Result<void> ok = write_map(work, std::move(albedo), planes_of(layer->albedo)); !ok) return ok;
  MapFacts height = {
      .name = "detail_height", .file = "detail_height.exr", .unit = "mm", .channels = {"height"}};
  height.more = {{"mean_taken_out", layer->facts.height_mm}};
  return write_map(work, std::move(height), {layer->height_mm.plane()});
}

namespace {

// Levels for an alpha test: as much is cut out of each as of the finest.
Result<void> write_opacity_mips(MapWork& work, MapFacts& facts) {
  const Result<std::vector<OpacityMip>> levels =
      opacity_mips(work.surface.opacity.plane(), {.threads = work.context.threads});
  if (!levels) return levels.error();
  const std::filesystem::path folder = work.folder / "mips";
  if (Result<void> ok = make_writable_folder(folder); !ok) return ok;
  Json listed = Json::array();
  for (const OpacityMip& level : *levels) {
    const WriteOptions options = {.type = SampleType::kHalf,
                                  .compression = work.compression,
                                  .pitch_mm = pitch_of_level(work, level.map.size())};
    const std::filesystem::path file = folder / fmt::format("opacity_{:02}.exr", level.level);
    if (Result<void> ok = write_image(file, planes_of(level.map), {"opacity"}, options); !ok) return ok;
    listed.push_back({{"level", level.level}, {"scale", level.scale}, {"coverage", level.coverage}});
  }
  facts.more["levels"] = std::move(listed);
  return {};
}

}  // namespace

Result<void> make_opacity(MapWork& work) {
  MapFacts facts = {.name = "opacity", .unit = "share", .channels = {"opacity"}};
  if (work.surface.opacity.empty()) {
    write_constant(work, std::move(facts), 1, "no light came from below, and the solver saw no hole");
    return {};
  }
  const OpacityFacts& found = *work.opacity;
  facts.file = "opacity.exr";
  facts.source = found.way == OpacityFacts::Way::kMarkedHoles ? MapSource::kDerived : MapSource::kMeasured;
  facts.more = {{"way", name_of(found.way)},
                {"open", found.open},
                {"through_yarns", found.through_yarns},
                {"is_coverage", found.is_coverage()},
                {"clipped", found.clipped},
                {"unreadable", found.unreadable}};
  if (Result<void> ok = write_opacity_mips(work, facts); !ok) return ok;
  return draw_map(work, std::move(facts), {work.surface.opacity.plane()});
}

}  // namespace weft::material
