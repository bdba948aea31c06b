// SPDX-License-Identifier: Apache-2.0
#include "core/solve.h"

#include <fmt/format.h>

#include <utility>

namespace weft {
namespace {

Result<SolveError> error_of(const Json& json, const std::string& where) {
  JsonFields fields(json, where + ": error");
  const SolveError error = {fields.number("mean_deg"), fields.number("median_deg"), fields.number("p95_deg"),
                            fields.number("max_deg")};
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return error;
}

Result<std::vector<SolveWarning>> warnings_of(const Json& list, const std::string& where) {
  std::vector<SolveWarning> warnings;
  for (const Json& json : list) {
    JsonFields fields(json, where + ": warnings");
    warnings.push_back({fields.text("name"), fields.text("text"), fields.text_or("remedy", "")});
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  }
  return warnings;
}

}  // namespace

Result<Product> find_solve(const std::filesystem::path& session, const std::string& id) {
  return find_product(kSolveProduct, session / "solve", id);
}

std::vector<Product> list_solves(const std::filesystem::path& session) {
  return list_products(kSolveProduct, session / "solve");
}

std::int64_t SolveFacts::with(StatusBit bit) const {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (kStatusNames[i].bit == bit) return status[i];
  }
  return 0;
}

Result<SolveFacts> solve_facts_of(const Json& document, const std::string& where) {
  JsonFields fields(document, where);
  SolveFacts facts;
  facts.id = fields.text("id");
  facts.solver_version = fields.integer("solver_version");
  facts.method = fields.text("method");
  facts.compression = fields.text("compression");
  facts.size = {fields.integer("width"), fields.integer("height")};
  facts.lights = fields.integer("lights");
  facts.albedo_scale = fields.text("albedo_scale");
  facts.color = fields.text_or("color", facts.color);
  facts.pixels = fields.integer("pixels");
  JsonFields status(fields.object("status"), where + ": status");
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (status.has(kStatusNames[i].name)) facts.status[i] = status.integer(kStatusNames[i].name);
  }
  if (fields.has("pictures")) {
    for (const Json& name : fields.list("pictures")) {
      if (name.is_string())
        facts.pictures.push_back(name.get<std::string>());
      else
        fields.reject("pictures", "must be names of files");
    }
  }
  if (fields.has("warnings")) {
    Result<std::vector<SolveWarning>> warnings = warnings_of(fields.list("warnings"), where);
    if (!warnings) return std::move(warnings).error();
    facts.warnings = std::move(*warnings);
  }
  if (fields.has("error")) {
    const Result<SolveError> error = error_of(document["error"], where);
    if (!error) return error.error();
    facts.error = *error;
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (Result<void> ok = status.status(); !ok) return std::move(ok).error();
  facts.document = document;
  return facts;
}

Json json_of(const SolveFacts& facts) {
  Json json = facts.document.is_object() ? facts.document : Json::object();
  if (!json.contains("schema")) json["schema"] = fmt::format("{}/1", kSolveProduct.schema);
  json["id"] = facts.id;
  json["solver_version"] = facts.solver_version;
  json["method"] = facts.method;
  json["compression"] = facts.compression;
  json["lights"] = facts.lights;
  json["width"] = facts.size.width;
  json["height"] = facts.size.height;
  json["albedo_scale"] = facts.albedo_scale;
  json["color"] = facts.color;
  json["pixels"] = facts.pixels;
  for (std::size_t i = 0; i < kStatusNames.size(); ++i)
    json["status"][kStatusNames[i].name] = facts.status[i];
  json["warnings"] = Json::array();
  for (const SolveWarning& w : facts.warnings) {
    json["warnings"].push_back({{"name", w.name}, {"text", w.text}, {"remedy", w.remedy}});
  }
  json["pictures"] = facts.pictures;
  json.erase("error");
  if (facts.error) {
    json["error"] = {{"mean_deg", facts.error->mean_deg},
                     {"median_deg", facts.error->median_deg},
                     {"p95_deg", facts.error->p95_deg},
                     {"max_deg", facts.error->max_deg}};
  }
  return json;
}

}  // namespace weft
