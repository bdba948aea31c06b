// SPDX-License-Identifier: Apache-2.0
#include "core/left_out_facts.h"

#include <utility>

namespace weft {
namespace {

void write(const LeftOutShares& shares, Json& json) {
  json["median"] = shares.median;
  json["rms"] = shares.rms;
  if (shares.noise_median) json["noise_median"] = *shares.noise_median;
  if (shares.noise_rms) json["noise_rms"] = *shares.noise_rms;
  json["readings"] = shares.readings;
}

LeftOutShares shares_of(JsonFields& fields) {
  return {fields.number("median"), fields.number("rms"), fields.optional_number("noise_median"),
          fields.optional_number("noise_rms"), fields.integer("readings")};
}

}  // namespace

Json json_of(const LeftOutFacts& facts) {
  Json json = Json::object(), lights = Json::array();
  write(facts.all, json);
  for (const LeftOutLight& light : facts.lights) {
    Json& each = lights.emplace_back(Json{{"light", light.light}});
    write(light.shares, each);
  }
  json["lights"] = std::move(lights);
  return json;
}

Result<LeftOutFacts> left_out_facts_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  LeftOutFacts facts;
  facts.all = shares_of(fields);
  const Json& lights = fields.list("lights");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  for (const Json& light : lights) {
    JsonFields each(light, where + ": lights");
    const int number = each.integer("light");
    facts.lights.push_back({number, shares_of(each)});
    if (Result<void> ok = each.status(); !ok) return std::move(ok).error();
  }
  return facts;
}

}  // namespace weft
