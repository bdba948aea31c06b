// SPDX-License-Identifier: Apache-2.0
#include "core/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>
#include <utility>

namespace weft {
namespace {

constexpr const char* kCamera = "camera";
constexpr const char* kRec709 = "rec709";

Result<SolveError> error_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  const SolveError error = {fields.number("mean_deg"), fields.number("median_deg"), fields.number("p95_deg"),
                            fields.number("max_deg")};
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return error;
}

Result<SolvePrice> price_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  SolvePrice price = {fields.number("seconds"), fields.number("mean_deg"), fields.number("solved"), {}};
  if (fields.has("parts_s")) price.parts_s = json["parts_s"];
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return price;
}

// Documents of early versions do not have every bit.
Result<StatusCounts> status_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  StatusCounts counts;
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (fields.has(kStatusNames[i].name)) counts.pixels[i] = fields.integer(kStatusNames[i].name);
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return counts;
}

// What not every solve has.
Result<void> read_optional(const Json& document, const std::string& where, SolveFacts& facts) {
  const JsonFields fields(document, where);
  if (fields.has("error")) {
    const Result<SolveError> error = error_from_json(document["error"], where + ": error");
    if (!error) return error.error();
    facts.error = *error;
  }
  for (const auto& [price, name] :
       {std::pair{&facts.foretold, "foretold"}, std::pair{&facts.taken, "taken"}}) {
    if (!fields.has(name)) continue;
    Result<SolvePrice> read = price_from_json(document[name], where + ": " + name);
    if (!read) return std::move(read).error();
    *price = std::move(*read);
  }
  if (fields.has("check")) {
    Result<LeftOutFacts> check = left_out_facts_from_json(document["check"], where + ": check");
    if (!check) return std::move(check).error();
    facts.check = std::move(*check);
  }
  return {};
}

std::vector<std::string> pictures_of(JsonFields& fields) {
  std::vector<std::string> names;
  if (!fields.has("pictures")) return names;
  for (const Json& name : fields.list("pictures")) {
    if (name.is_string()) {
      names.push_back(name.get<std::string>());
    } else {
      fields.reject("pictures", "must be names of files");
    }
  }
  return names;
}

}  // namespace

Result<Product> find_solve(const std::filesystem::path& session, const std::string& id) {
  return find_product(kSolveProduct, session / "solve", id);
}

std::vector<Product> list_solves(const std::filesystem::path& session) {
  return list_products(kSolveProduct, session / "solve");
}

std::int64_t StatusCounts::with(StatusBit bit) const {
  const auto named = std::ranges::find(kStatusNames, bit, &StatusName::bit);
  return pixels.at(static_cast<std::size_t>(named - kStatusNames.begin()));
}

Json json_of(const StatusCounts& counts) {
  Json json = Json::object();
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    const bool is_said = (kStatusNames[i].bit & kHowSolved) == 0 || counts.pixels[i] > 0;
    if (is_said) json[kStatusNames[i].name] = counts.pixels[i];
  }
  return json;
}

Json json_of(const SolveError& error) {
  return {{"mean_deg", error.mean_deg},
          {"median_deg", error.median_deg},
          {"p95_deg", error.p95_deg},
          {"max_deg", error.max_deg}};
}

Json json_of(const SolvePrice& price) {
  Json json = {{"seconds", price.seconds}, {"mean_deg", price.mean_deg}, {"solved", price.solved}};
  if (!price.parts_s.is_null()) json["parts_s"] = price.parts_s;
  return json;
}

double deg_of_whole(double mean_deg, double solved) {
  return solved * mean_deg + (1 - solved) * (180 / std::numbers::pi);
}

Result<SolveFacts> solve_facts_from_json(const Json& document, const std::string& where) {
  JsonFields fields(document, where);
  SolveFacts facts;
  facts.id = fields.text("id");
  facts.solver_version = fields.integer("solver_version");
  facts.method = fields.text("method");
  facts.compression = fields.one_of<Compression>("compression", kCompressionNames);
  facts.lights = fields.integer("lights");
  facts.size = {fields.integer("width"), fields.integer("height")};
  facts.albedo_scale = fields.one_of<AlbedoScale>("albedo_scale", kAlbedoScaleNames);
  const std::string color = fields.text_or("color", kCamera);
  if (color != kCamera && color != kRec709) fields.reject("color", "must be \"camera\" or \"rec709\"");
  facts.is_rec709 = color == kRec709;
  facts.pixels = fields.integer("pixels");
  facts.pictures = pictures_of(fields);
  const Json& status = fields.object("status");
  const Json none = Json::array();
  const Json& warnings = fields.has("warnings") ? fields.list("warnings") : none;
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();

  Result<StatusCounts> counts = status_from_json(status, where + ": status");
  if (!counts) return std::move(counts).error();
  facts.status = *counts;
  Result<std::vector<Verdict>> verdicts = verdicts_from_json(warnings, where + ": warnings");
  if (!verdicts) return std::move(verdicts).error();
  facts.warnings = std::move(*verdicts);
  if (Result<void> ok = read_optional(document, where, facts); !ok) return std::move(ok).error();
  for (const auto& [part, name] : {std::pair{&facts.input, "input"},
                                   {&facts.solved_by, "solved_by"},
                                   {&facts.conditions, "conditions"},
                                   {&facts.registration, "registration"},
                                   {&facts.sigma_normal_deg, "sigma_normal_deg"},
                                   {&facts.sharpening, "sharpening"},
                                   {&facts.lateral_color, "lateral_color"},
                                   {&facts.gates, "gates"},
                                   {&facts.reference, "reference"},
                                   {&facts.reflectance, "reflectance"}}) {
    if (fields.has(name)) *part = document[name];
  }
  return facts;
}

Json json_of(const SolveFacts& facts) {
  Json json = {{"schema", fmt::format("{}/{}", kSolveProduct.schema, facts.taken ? "1.1" : "1")},
               {"id", facts.id},
               {"solver_version", facts.solver_version},
               {"method", facts.method},
               {"compression", name_of(facts.compression)},
               {"input", facts.input},
               {"lights", facts.lights},
               {"width", facts.size.width},
               {"height", facts.size.height},
               {"albedo_scale", name_of(facts.albedo_scale)},
               {"color", facts.is_rec709 ? kRec709 : kCamera},
               {"pixels", facts.pixels},
               {"status", json_of(facts.status)},
               {"solved_by", facts.solved_by},
               {"conditions", facts.conditions},
               {"registration", facts.registration},
               {"sigma_normal_deg", facts.sigma_normal_deg},
               {"check", facts.check ? json_of(*facts.check) : Json()},
               {"sharpening", facts.sharpening},
               {"lateral_color", facts.lateral_color},
               {"warnings", json_of(facts.warnings)},
               {"pictures", facts.pictures},
               {"gates", facts.gates},
               {"reference", facts.reference},
               {"reflectance", facts.reflectance},
               {"error", facts.error ? json_of(*facts.error) : Json()},
               {"foretold", facts.foretold ? json_of(*facts.foretold) : Json()},
               {"taken", facts.taken ? json_of(*facts.taken) : Json()}};
  for (auto field = json.begin(); field != json.end();) {
    field = field->is_null() ? json.erase(field) : std::next(field);
  }
  return json;
}

}  // namespace weft
