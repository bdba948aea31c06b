// SPDX-License-Identifier: Apache-2.0
#include "material/assets/runtime.h"

#include <array>
#include <utility>

#include "core/base/files.h"
#include "material/assets/build.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, kMostRuntimeLayers> kChannels = {"r", "g", "b"};

}  // namespace

Result<RuntimeStack> runtime_stack_of(const fs::path& built) {
  const fs::path file = built / kMaterialProduct.document;
  const Result<Json> document = read_json(file, kMaterialProduct.schema, 1);
  if (!document) return document.error();
  if (!document->contains("runtime")) return RuntimeStack{};
  JsonFields fields(*document, file.string());
  RuntimeStack stack;
  stack.layers.push_back({fields.text("name"), fields.text("id"), built, ""});
  JsonFields runtime(fields.object("runtime"), file.string() + ": runtime");
  stack.weights = runtime.text("weights");
  const Json& layers = runtime.list("layers");
  if (layers.size() > kChannels.size()) runtime.reject("layers", "must be three at most");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (Result<void> ok = runtime.status(); !ok) return std::move(ok).error();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    JsonFields layer(layers[i], file.string() + ": runtime: layers");
    RuntimeLayer each = {layer.text("name"), layer.text("id"), {}, kChannels[i]};
    if (Result<void> ok = layer.status(); !ok) return std::move(ok).error();
    each.folder = absolute_folder(built).parent_path() / each.id;
    if (!is_there(each.folder / kMaterialProduct.document)) {
      return Error{ErrorKind::kNoInput, "a layer is not built", each.folder.string(),
                   "it belongs to the layer " + each.name,
                   "build the material again with weft material build"};
    }
    stack.layers.push_back(std::move(each));
  }
  return stack;
}

Json layers_json(const RuntimeStack& stack, const std::map<std::string, std::vector<std::string>>& files) {
  Json layers = Json::array();
  for (const RuntimeLayer& layer : stack.layers) {
    const auto packed = files.find(layer.id);
    Json each = {{"name", layer.name}, {"material", layer.id}};
    if (!layer.channel.empty()) each["channel"] = layer.channel;
    each["files"] = packed == files.end() ? std::vector<std::string>() : packed->second;
    layers.push_back(std::move(each));
  }
  return {{"schema", "weft.layers/1"}, {"weights", stack.weights}, {"layers", std::move(layers)}};
}

}  // namespace weft::material
