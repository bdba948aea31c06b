// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/documents.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/sha256.h"
#include "core/image_io/image_io.h"
#include "exchange/document.h"
#include "exchange/gltf/glb.h"
#include "exchange/materialx/materialx.h"
#include "exchange/u3m/u3m.h"
#include "exchange/usd/usd.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTextureBytes = std::size_t{1} << 32;
constexpr const char* kWeightsFile = "layers/weights.png";

// What the documents of one preset are made of.
struct DocumentInput {
  const ClothTextures& cloth;
  const fs::path& folder;
  TexturedMaterial material;
  FileBytes bytes;  ///< of textures, where a document holds them
};

std::string with_ending(const std::string& name, const std::string& ending) {
  return fs::path(name).stem().string() + ending;
}

std::optional<double> number_in(const Json& metadata, const char* key) {
  if (!metadata.contains(key) || !metadata[key].is_number()) return std::nullopt;
  return metadata[key].get<double>();
}

std::string text_in(const Json& metadata, const char* key) {
  return metadata.contains(key) && metadata[key].is_string() ? metadata[key].get<std::string>() : "";
}

// What the session says of the cloth. Without one the times are those of nothing.
U3mOptions u3m_options(const DocumentInput& input) {
  U3mOptions options;
  options.description = "Scanned with weft";
  if (!input.material.is_size_known) options.description += "; its size is not known, and assumed";
  options.digest = sha256_of(input.cloth.preset.inputs.dump());
  options.created = options.modified = "1970-01-01T00:00:00Z";
  if (!input.cloth.maps.session) return options;
  const Json& session = input.cloth.maps.session->document;
  if (const std::string created = text_in(session, "created"); !created.empty())
    options.created = options.modified = created;
  if (!session.contains("metadata") || !session["metadata"].is_object()) return options;
  const Json& metadata = session["metadata"];
  options.physics.thickness_mm = number_in(metadata, "thickness_mm");
  options.physics.weight_g_m2 = number_in(metadata, "weight_g_m2");
  options.physics.construction = text_in(metadata, "construction");
  if (auto fibres = fibres_of(text_in(metadata, "composition")))
    options.physics.composition = std::move(*fibres);
  return options;
}

Result<Document> materialx(const DocumentInput& input) {
  using enum SurfaceModel;
  return materialx_of(input.material, {.models = {kOpenPbr, kStandardSurface, kGltfPbr}});
}

Result<Document> usda(const DocumentInput& input) {
  UsdOptions options;
  for (const PresetDocument& each : input.cloth.preset.documents) {
    if (each.kind == DocumentKind::kMaterialX) options.materialx_file = each.name;
  }
  return usda_of(input.material, options);
}

// An archive of a document and its textures.
Result<Document> packed(Result<Document> inner, const DocumentInput& input, const std::string& name) {
  if (!inner) return inner;
  const bool is_usdz = name.ends_with(".usdz");
  Result<std::string> archive = is_usdz ? usdz_of(with_ending(name, ".usda"), *inner, input.bytes)
                                        : u3ma_of(with_ending(name, ".u3m"), *inner, input.bytes);
  if (!archive) return std::move(archive).error();
  inner->bytes = std::move(*archive);
  return inner;
}

Result<Document> document_bytes(const PresetDocument& asked, const DocumentInput& input) {
  switch (asked.kind) {
    case DocumentKind::kGlb:
      return glb_of(input.material, input.bytes);
    case DocumentKind::kMaterialX:
      return materialx(input);
    case DocumentKind::kUsda:
      return usda(input);
    case DocumentKind::kUsdz:
      return packed(usda_of(input.material), input, asked.name);
    case DocumentKind::kU3m:
      return u3m_of(input.material, u3m_options(input));
    case DocumentKind::kU3ma:
      return packed(u3m_of(input.material, u3m_options(input)), input, asked.name);
    case DocumentKind::kLayers:
      break;
  }
  return Error{ErrorKind::kInternal, "a document has no writer", asked.name, "", ""};
}

// `document` as a file of the folder, and what export.json says of it.
Result<ExportedDocument> written(const fs::path& folder, const std::string& name, const char* kind,
                                 Document document) {
  if (Result<void> ok = write_file(folder / name, document.bytes); !ok) return std::move(ok).error();
  return ExportedDocument{.name = name,
                          .kind = kind,
                          .sha256 = sha256_of(document.bytes),
                          .bytes = document.bytes.size(),
                          .files = std::move(document.files),
                          .left_out = std::move(document.left_out)};
}

Result<ExportedDocument> write_document(const PresetDocument& asked, const DocumentInput& input) {
  Result<Document> document = document_bytes(asked, input);
  if (!document) {
    Error error = std::move(document).error();
    error.where = fmt::format("preset {}: {}: {}", input.cloth.preset.preset.name, asked.name, error.where);
    return error;
  }
  return written(input.folder, asked.name, kDocumentKindNames[static_cast<std::size_t>(asked.kind)],
                 std::move(*document));
}

// Textures that stand inside of documents alone, and the folders that they leave empty.
void remove_textures(const std::vector<ExportedTexture>& textures, const fs::path& folder) {
  std::error_code ignored;
  for (const ExportedTexture& each : textures) fs::remove(folder / each.file, ignored);
  for (const ExportedTexture& each : textures) {
    const fs::path parent = (folder / each.file).parent_path();
    if (parent != folder && fs::is_empty(parent, ignored)) fs::remove(parent, ignored);
  }
}

// Weights as 8 bits, which are what vertex colours have too; nothing where those are the weights.
Result<std::optional<Texture>> write_weights(const material::RuntimeStack& stack, const fs::path& folder) {
  if (stack.weights == "vertex-color") return std::optional<Texture>();
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
  return std::optional<Texture>(
      {.file = kWeightsFile, .size = image->info.size, .bits = 8, .channels = "rgb"});
}

// What is one number everywhere.
bool is_plain(const std::vector<ExportedTexture>& textures) {
  return std::ranges::all_of(textures, [](const ExportedTexture& texture) {
    return std::ranges::all_of(texture.channels,
                               [](const ExportedChannel& channel) { return channel.least == channel.most; });
  });
}

// All layers, bottom to top.
std::vector<TexturedMaterial> materials_of(const TexturedMaterial& lowest, const ClothLayers& layers) {
  std::vector<TexturedMaterial> materials = {lowest};
  for (const ClothTextures& layer : layers.above) {
    materials.push_back(textured_material(layer));
    // What is the same everywhere covers any rectangle.
    if (!materials.back().size_mm && is_plain(layer.textures)) materials.back().size_mm = lowest.size_mm;
  }
  return materials;
}

std::map<std::string, std::vector<std::string>> files_by_id(const ClothTextures& cloth,
                                                            const ClothLayers& layers) {
  std::map<std::string, std::vector<std::string>> files;
  const auto add = [&](const ClothTextures& each) {
    std::vector<std::string>& names = files[each.maps.id];
    names.clear();
    for (const ExportedTexture& texture : each.textures) names.push_back(texture.file);
  };
  add(cloth);
  for (const ClothTextures& layer : layers.above) add(layer);
  return files;
}

// What engines and MaterialX need to mix the layers.
Result<std::vector<ExportedDocument>> write_layers(const std::string& list_name, const ClothLayers& layers,
                                                   const DocumentInput& input) {
  const std::string& name = input.cloth.preset.name;
  std::vector<ExportedDocument> documents;
  const auto write = [&](const std::string& file, const char* kind, Document document) {
    Result<ExportedDocument> done = written(input.folder, file, kind, std::move(document));
    if (done) documents.push_back(std::move(*done));
    return done ? Result<void>() : Result<void>(std::move(done).error());
  };
  const Result<std::optional<Texture>> weights = write_weights(layers.stack, input.folder);
  if (!weights) return weights.error();
  Result<Document> mix = materialx_mix_of(name, materials_of(input.material, layers), {*weights}, {});
  if (!mix) return std::move(mix).error();
  if (Result<void> ok = write(name + "_layers.mtlx", "mtlx", std::move(*mix)); !ok)
    return std::move(ok).error();
  material::RuntimeStack shown = layers.stack;
  if (*weights) {
    Result<std::string> bytes = read_text(input.folder / kWeightsFile);
    if (!bytes) return std::move(bytes).error();
    if (Result<void> ok = write(kWeightsFile, "weights", {.bytes = std::move(*bytes)}); !ok)
      return std::move(ok).error();
    shown.weights = kWeightsFile;
  }
  const std::map<std::string, std::vector<std::string>> files = files_by_id(input.cloth, layers);
  Document list = {.bytes = material::layers_json(shown, files).dump(2) + "\n"};
  for (const auto& [id, names] : files) list.files.insert(list.files.end(), names.begin(), names.end());
  if (Result<void> ok = write(list_name, "layers", std::move(list)); !ok) return std::move(ok).error();
  return documents;
}

// The textures' bytes, where a document holds them.
Result<std::map<std::string, std::string>> held_bytes(const ClothTextures& cloth, const fs::path& folder) {
  std::map<std::string, std::string> held;
  const bool holds = std::ranges::any_of(
      cloth.preset.documents, [](const PresetDocument& each) { return holds_its_files(each.kind); });
  if (!holds) return held;
  for (const ExportedTexture& texture : cloth.textures) {
    Result<std::string> bytes = read_text(folder / texture.file, kMostTextureBytes);
    if (!bytes) return std::move(bytes).error();
    held[texture.file] = std::move(*bytes);
  }
  return held;
}

}  // namespace

Result<std::vector<ExportedDocument>> write_documents(const ClothTextures& cloth, const ClothLayers& layers,
                                                      const fs::path& folder) {
  std::vector<ExportedDocument> documents;
  const FilledPreset& preset = cloth.preset;
  if (preset.documents.empty()) return documents;
  const Result<std::map<std::string, std::string>> held = held_bytes(cloth, folder);
  if (!held) return held.error();
  const DocumentInput input = {cloth, folder, textured_material(cloth), {held->begin(), held->end()}};
  for (const PresetDocument& asked : preset.documents) {
    if (asked.kind == DocumentKind::kLayers) continue;
    Result<ExportedDocument> document = write_document(asked, input);
    if (!document) return std::move(document).error();
    documents.push_back(std::move(*document));
  }
  if (preset.preset.keeps_no_files()) remove_textures(cloth.textures, folder);
  for (const PresetDocument& asked : preset.documents) {
    if (asked.kind != DocumentKind::kLayers) continue;
    Result<std::vector<ExportedDocument>> mixed = write_layers(asked.name, layers, input);
    if (!mixed) return mixed;
    std::ranges::move(*mixed, std::back_inserter(documents));
  }
  return documents;
}

}  // namespace weft::exchange
