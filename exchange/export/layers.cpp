// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/base/files.h"
#include "core/base/sha256.h"
#include "core/base/text.h"
#include "core/image_io/image_io.h"
#include "exchange/export/textured.h"
#include "exchange/materialx/materialx.h"
#include "material/assets/runtime.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWeightsFile = "layers/weights.png";

// The preset's textures of one layer, below a folder of its name.
Result<PlannedExport> plan_layer(const PlannedExport& plan, const RuntimeLayer& layer,
                                 const MapFolder& maps) {
  exchange::Preset preset = plan.preset;
  preset.documents.clear();
  const std::string name = file_name_of(layer.name, "layer");
  for (exchange::PresetFile& file : preset.files)
    file.name = fmt::format("layers/{}/{}", name, fs::path(file.name).filename().string());
  ExportOptions options = {.input = layer.folder, .name = name};
  options.presets = {preset.name};
  return plan_preset(options, maps, std::move(preset));
}

// Weights as 8 bits, which are what vertex colours have too.
Result<std::optional<exchange::Texture>> write_weights(const RuntimeStack& stack, const fs::path& folder) {
  if (stack.weights == "vertex-color") return std::optional<exchange::Texture>();
  const Result<LoadedImage> image = read_image(stack.layers.front().folder / stack.weights);
  if (!image) return image.error();
  const std::vector<View<const float>> planes = {image->channel("R"), image->channel("G"),
                                                 image->channel("B")};
  if (planes[0].empty() || planes[1].empty() || planes[2].empty()) {
    return Error{ErrorKind::kBadData, "the weights of layers cannot be exported", stack.weights,
                 "it has no R, G and B", "build the material again"};
  }
  if (Result<void> ok = make_writable_folder(folder / "layers"); !ok) return std::move(ok).error();
  const WriteOptions options = {.type = SampleType::kUint8, .compression = Compression::kZip};
  if (Result<void> ok = write_image(folder / kWeightsFile, planes, {"R", "G", "B"}, options); !ok)
    return std::move(ok).error();
  return std::optional<exchange::Texture>(
      {.file = kWeightsFile, .size = image->info.size, .bits = 8, .channels = "rgb"});
}

Result<WrittenDocument> written(const fs::path& folder, const std::string& name, const char* kind,
                                const std::string& bytes) {
  if (Result<void> ok = write_file(folder / name, bytes); !ok) return std::move(ok).error();
  return WrittenDocument{.name = name, .kind = kind, .sha256 = sha256_of(bytes), .bytes = bytes.size()};
}

bool is_plain(const std::vector<EncodedFile>& files) {
  return std::ranges::all_of(files, [](const EncodedFile& file) {
    return std::ranges::all_of(file.loss.channels, [](const exchange::ChannelLoss& channel) {
      return channel.least == channel.most;
    });
  });
}

std::vector<std::string> names_of(const std::vector<EncodedFile>& files) {
  std::vector<std::string> names;
  for (const EncodedFile& file : files) names.push_back(file.name);
  return names;
}

}  // namespace

Result<WrittenLayers> write_layers(const PlannedExport& plan, const PlannedDocument& document,
                                   const MapFolder& maps, const std::vector<EncodedFile>& files,
                                   const fs::path& folder, const JobContext& context) {
  const Result<RuntimeStack> stack = runtime_stack_of(maps.folder);
  if (!stack) return stack.error();
  WrittenLayers layers;
  std::vector<exchange::TexturedMaterial> materials = {textured_material(plan, maps, files)};
  std::map<std::string, std::vector<std::string>> packed = {{maps.id, names_of(files)}};
  for (std::size_t i = 1; i < stack->layers.size(); ++i) {
    const Result<MapFolder> layer = open_map_folder({.input = stack->layers[i].folder, .is_draft = true});
    if (!layer) return layer.error();
    const Result<PlannedExport> planned = plan_layer(plan, stack->layers[i], *layer);
    if (!planned) return planned.error();
    Result<std::vector<std::vector<EncodedFile>>> encoded =
        encode_files(*layer, {{&*planned, folder}}, false, context);
    if (!encoded) return std::move(encoded).error();
    materials.push_back(textured_material(*planned, *layer, encoded->front()));
    // What is the same everywhere covers any rectangle.
    if (!materials.back().size_mm && is_plain(encoded->front()))
      materials.back().size_mm = materials.front().size_mm;
    packed[layer->id] = names_of(encoded->front());
    for (EncodedFile& file : encoded->front()) layers.files.push_back(std::move(file));
  }
  const Result<std::optional<exchange::Texture>> weights = write_weights(*stack, folder);
  if (!weights) return weights.error();
  const Result<exchange::Document> mix = exchange::materialx_mix_of(plan.name, materials, {*weights}, {});
  if (!mix) return mix.error();
  Result<WrittenDocument> mixed = written(folder, plan.name + "_layers.mtlx", "mtlx", mix->bytes);
  if (!mixed) return std::move(mixed).error();
  mixed->files = mix->files;
  mixed->left_out = mix->left_out;
  layers.documents.push_back(std::move(*mixed));
  if (*weights) {
    const Result<std::string> bytes = read_text(folder / kWeightsFile);
    if (!bytes) return bytes.error();
    Result<WrittenDocument> image = written(folder, kWeightsFile, "weights", *bytes);
    if (!image) return std::move(image).error();
    layers.documents.push_back(std::move(*image));
  }
  RuntimeStack shown = *stack;
  if (*weights) shown.weights = kWeightsFile;
  Result<WrittenDocument> list =
      written(folder, document.name, "layers", layers_json(shown, packed).dump(2) + "\n");
  if (!list) return std::move(list).error();
  for (const auto& [id, names] : packed) list->files.insert(list->files.end(), names.begin(), names.end());
  layers.documents.push_back(std::move(*list));
  return layers;
}

}  // namespace weft::app
