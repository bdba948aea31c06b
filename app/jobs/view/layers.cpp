// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/view/layers.h"

#include <algorithm>

#include "core/files.h"
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
  std::vector<std::string> channels;
  for (const Layer& layer : known_layers()) {
    if (!is_there(folder / layer.file)) continue;
    if (file != layer.file) {
      const Result<ImageFileInfo> info = read_image_info(folder / layer.file);
      if (!info) return info.error();
      if (!layers.all.empty() && !(info->size == layers.size)) {
        return Error{ErrorKind::kBadData, "maps of one folder differ in size", (folder / layer.file).string(),
                     "", "solve the session again"};
      }
      layers.size = info->size;
      file = layer.file;
      channels = info->channels;
    }
    const bool has_all = std::ranges::all_of(layer.channels, [&](const std::string& channel) {
      return std::ranges::find(channels, channel) != channels.end();
    });
    if (has_all) layers.all.push_back(layer);
  }
  if (!layers.all.empty()) return layers;
  return Error{ErrorKind::kNoInput, "there are no maps", folder.string(), "", "solve the session first"};
}

}  // namespace weft::app
