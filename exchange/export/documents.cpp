// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/documents.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/sha256.h"
#include "exchange/document.h"
#include "exchange/export/textured.h"
#include "exchange/gltf/glb.h"
#include "exchange/materialx/materialx.h"
#include "exchange/u3m/u3m.h"
#include "exchange/usd/usd.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using exchange::Document;
using exchange::DocumentKind;

constexpr std::size_t kMostTextureBytes = std::size_t{1} << 32;

// What the documents of one plan are made of.
struct DocumentInput {
  const PlannedExport& plan;
  const MapFolder& maps;
  const fs::path& folder;
  exchange::TexturedMaterial material;
  exchange::FileBytes bytes;  ///< of textures, where a document holds them
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
exchange::U3mOptions u3m_options(const DocumentInput& input) {
  exchange::U3mOptions options;
  options.description = "Scanned with weft";
  options.digest = sha256_of(input.plan.inputs.dump());
  options.created = options.modified = "1970-01-01T00:00:00Z";
  if (!input.maps.session) return options;
  const Json& session = input.maps.session->document;
  if (const std::string created = text_in(session, "created"); !created.empty())
    options.created = options.modified = created;
  if (!session.contains("metadata") || !session["metadata"].is_object()) return options;
  const Json& metadata = session["metadata"];
  options.physics.thickness_mm = number_in(metadata, "thickness_mm");
  options.physics.weight_g_m2 = number_in(metadata, "weight_g_m2");
  options.physics.construction = text_in(metadata, "construction");
  if (auto fibres = exchange::fibres_of(text_in(metadata, "composition")))
    options.physics.composition = std::move(*fibres);
  return options;
}

Result<Document> materialx(const DocumentInput& input) {
  using enum exchange::SurfaceModel;
  return exchange::materialx_of(input.material, {.models = {kOpenPbr, kStandardSurface, kGltfPbr}});
}

Result<Document> usda(const DocumentInput& input) {
  exchange::UsdOptions options;
  for (const PlannedDocument& each : input.plan.documents) {
    if (each.kind == DocumentKind::kMaterialX) options.materialx_file = each.name;
  }
  return exchange::usda_of(input.material, options);
}

// An archive of a document and its textures.
Result<Document> packed(Result<Document> inner, const DocumentInput& input, const std::string& name) {
  if (!inner) return inner;
  const bool is_usdz = name.ends_with(".usdz");
  Result<std::string> archive = is_usdz ? exchange::usdz_of(with_ending(name, ".usda"), *inner, input.bytes)
                                        : exchange::u3ma_of(with_ending(name, ".u3m"), *inner, input.bytes);
  if (!archive) return std::move(archive).error();
  inner->bytes = std::move(*archive);
  return inner;
}

Result<Document> document_bytes(const PlannedDocument& planned, const DocumentInput& input) {
  switch (planned.kind) {
    case DocumentKind::kGlb:
      return exchange::glb_of(input.material, input.bytes);
    case DocumentKind::kMaterialX:
      return materialx(input);
    case DocumentKind::kUsda:
      return usda(input);
    case DocumentKind::kUsdz:
      return packed(exchange::usda_of(input.material), input, planned.name);
    case DocumentKind::kU3m:
      return exchange::u3m_of(input.material, u3m_options(input));
    case DocumentKind::kU3ma:
      return packed(exchange::u3m_of(input.material, u3m_options(input)), input, planned.name);
    case DocumentKind::kLayers:
      break;
  }
  return Error{ErrorKind::kInternal, "a document has no writer", planned.name, "", ""};
}

Result<WrittenDocument> write_document(const PlannedDocument& planned, const DocumentInput& input) {
  Result<Document> document = document_bytes(planned, input);
  if (!document) {
    Error error = std::move(document).error();
    error.where = fmt::format("preset {}: {}: {}", input.plan.preset.name, planned.name, error.where);
    return error;
  }
  if (Result<void> ok = write_file(input.folder / planned.name, document->bytes); !ok)
    return std::move(ok).error();
  return WrittenDocument{.name = planned.name,
                         .kind = exchange::kDocumentKindNames[static_cast<std::size_t>(planned.kind)],
                         .sha256 = sha256_of(document->bytes),
                         .bytes = document->bytes.size(),
                         .files = std::move(document->files),
                         .left_out = std::move(document->left_out)};
}

// Textures that stand inside of documents alone, and the folders that they leave empty.
void remove_textures(const std::vector<EncodedFile>& files, const fs::path& folder) {
  std::error_code ignored;
  for (const EncodedFile& file : files) fs::remove(folder / file.name, ignored);
  for (const EncodedFile& file : files) {
    const fs::path parent = (folder / file.name).parent_path();
    if (parent != folder && fs::is_empty(parent, ignored)) fs::remove(parent, ignored);
  }
}

}  // namespace

Result<std::vector<WrittenDocument>> write_documents(const PlannedExport& plan, const MapFolder& maps,
                                                     const std::vector<EncodedFile>& files,
                                                     const fs::path& folder) {
  std::vector<WrittenDocument> written;
  if (plan.documents.empty()) return written;
  DocumentInput input = {plan, maps, folder, textured_material(plan, maps, files), {}};
  std::map<std::string, std::string> held;
  const bool holds = std::ranges::any_of(
      plan.documents, [](const PlannedDocument& each) { return exchange::holds_its_files(each.kind); });
  for (const EncodedFile& file : files) {
    if (!holds) break;
    Result<std::string> bytes = read_text(folder / file.name, kMostTextureBytes);
    if (!bytes) return std::move(bytes).error();
    held[file.name] = std::move(*bytes);
  }
  for (const auto& [name, bytes] : held) input.bytes.emplace(name, bytes);
  for (const PlannedDocument& planned : plan.documents) {
    if (planned.kind == DocumentKind::kLayers) continue;
    Result<WrittenDocument> document = write_document(planned, input);
    if (!document) return std::move(document).error();
    written.push_back(std::move(*document));
  }
  if (plan.preset.keeps_no_files()) remove_textures(files, folder);
  return written;
}

}  // namespace weft::app
