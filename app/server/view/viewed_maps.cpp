// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/viewed_maps.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/base/files.h"
#include "core/image_io/image_io.h"

namespace weft::app {
namespace {

const std::vector<Layer>& known_layers() {
  static const std::vector<Layer> layers = {
      {"normal", LayerKind::kNormal, "", "normal.exr", {"X", "Y", "Z"}},
      {"albedo", LayerKind::kColor, "share", "albedo.exr", {"R", "G", "B"}},
      {"height", LayerKind::kScalar, "mm", "height.exr", {"Y"}},
      {"sigma", LayerKind::kScalar, "deg", "sigma.exr", {"normal_deg"}, true},
      {"sigma_noise", LayerKind::kScalar, "deg", "sigma.exr", {"normal_deg.noise"}, true},
      {"sigma_model", LayerKind::kScalar, "deg", "sigma.exr", {"normal_deg.model"}, true},
      {"sigma_calibration", LayerKind::kScalar, "deg", "sigma.exr", {"normal_deg.calibration"}, true},
      {"residual", LayerKind::kScalar, "share", "residual.exr", {"residual"}, true},
      {"roughness", LayerKind::kScalar, "", "roughness.exr", {"roughness"}},
      {"condition", LayerKind::kScalar, "decades", "condition.exr", {"condition"}},
      {"status", LayerKind::kFlags, "share", "status.png", {"Y"}}};
  return layers;
}

// Whether they begin so; what follows is not looked at.
bool begin_with(const std::vector<std::string>& channels, const std::array<const char*, 3>& names) {
  return channels.size() >= names.size() &&
         std::ranges::equal(std::span(channels).first(names.size()), names);
}

LayerKind kind_of(const std::vector<std::string>& channels) {
  if (begin_with(channels, {"X", "Y", "Z"})) return LayerKind::kNormal;
  if (begin_with(channels, {"R", "G", "B"})) return LayerKind::kColor;
  return LayerKind::kScalar;
}

// A map of maps.json as a layer: of a scalar its first channel, else three. None where it is a number, or
// lies elsewhere.
std::optional<Layer> layer_of(const Json& map) {
  if (!map.is_object() || !map.contains("file")) return {};
  JsonFields fields(map, "maps");
  Layer layer;
  layer.name = fields.text("name");
  layer.file = fields.text("file");
  layer.unit = fields.text_or("unit", "");
  for (const Json& channel : fields.list("channels")) {
    if (channel.is_string()) layer.channels.push_back(channel.get<std::string>());
  }
  layer.kind = kind_of(layer.channels);
  const std::size_t shown = layer.kind == LayerKind::kScalar ? 1 : 3;
  layer.channels.resize(std::min(shown, layer.channels.size()));
  const bool is_inside = layer.file.find('/') == std::string::npos;
  return fields.status() && is_inside && !layer.channels.empty() ? std::optional(layer) : std::nullopt;
}

bool has_all(const ImageFileInfo& info, const Layer& layer) {
  return std::ranges::all_of(layer.channels, [&](const std::string& channel) {
    return std::ranges::find(info.channels, channel) != info.channels.end();
  });
}

}  // namespace

const char* name_of(LayerKind kind) {
  switch (kind) {
    case LayerKind::kNormal:
      return "normal";
    case LayerKind::kColor:
    case LayerKind::kMosaic:
      return "color";
    case LayerKind::kScalar:
      return "scalar";
    case LayerKind::kFlags:
      return "flags";
  }
  return "";
}

const Layer* Layers::find(const std::string& name) const {
  const auto found = std::ranges::find(all, name, &Layer::name);
  return found == all.end() ? nullptr : &*found;
}

Result<Layers> layers_of(const std::filesystem::path& folder) {
  Layers layers;
  std::string file;
  ImageFileInfo known;
  for (const Layer& layer : known_layers()) {
    if (!is_there(folder / layer.file)) continue;
    if (file != layer.file) {
      Result<ImageFileInfo> info = read_image_info(folder / layer.file);
      if (!info) return std::move(info).error();
      if (!layers.all.empty() && !(info->size == layers.size)) {
        return Error{ErrorKind::kBadData, "maps of one folder differ in size", (folder / layer.file).string(),
                     "", "solve the session again"};
      }
      layers.size = info->size;
      file = layer.file;
      known = std::move(*info);
    }
    if (has_all(known, layer)) layers.all.push_back(layer);
  }
  if (!layers.all.empty()) return layers;
  return Error{ErrorKind::kNoInput, "there are no maps", folder.string(), "", "solve the session first"};
}

Result<Layers> layers_of_set(const std::filesystem::path& folder, const Json& document) {
  Result<Layers> layers = layers_of(folder);
  if (!layers) return layers;
  JsonFields fields(document, "maps.json");
  for (const Json& map : fields.list("maps")) {
    const std::optional<Layer> layer = layer_of(map);
    if (!layer || layers->find(layer->name) != nullptr) continue;
    const Result<ImageFileInfo> info = read_image_info(folder / layer->file);
    if (info && info->size == layers->size && has_all(*info, *layer)) layers->all.push_back(*layer);
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return layers;
}

}  // namespace weft::app
