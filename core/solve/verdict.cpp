// SPDX-License-Identifier: Apache-2.0
#include "core/solve/verdict.h"

#include "core/describe/field_json.h"

namespace weft {

void describe(Fields& fields, Verdict& v) {
  fields.value({"name", "For programs", {}, kMustSay}, v.name);
  fields.value({"text", "One sentence with its numbers", {}, kMustSay}, v.text);
  fields.value({"remedy", "What to do; may be empty"}, v.remedy);
}

Json json_of(const std::vector<Verdict>& verdicts) {
  return list_of(verdicts);
}

}  // namespace weft
