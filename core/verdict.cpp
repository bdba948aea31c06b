// SPDX-License-Identifier: Apache-2.0
#include "core/verdict.h"

#include <utility>

namespace weft {

Json json_of(const std::vector<Verdict>& verdicts) {
  Json all = Json::array();
  for (const Verdict& v : verdicts) all.push_back({{"name", v.name}, {"text", v.text}, {"remedy", v.remedy}});
  return all;
}

Result<std::vector<Verdict>> verdicts_from_json(const Json& list, const std::string& where) {
  std::vector<Verdict> verdicts;
  for (const Json& json : list) {
    JsonFields fields(json, where);
    verdicts.push_back({fields.text("name"), fields.text("text"), fields.text_or("remedy", "")});
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  }
  return verdicts;
}

}  // namespace weft
