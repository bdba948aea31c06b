// SPDX-License-Identifier: Apache-2.0
#include "core/describe/error_json.h"

#include <optional>

#include "core/base/error_kind.h"
#include "core/describe/field_json.h"

namespace weft {

void describe(Fields& fields, Error& e) {
  std::string kind = name_of(e.kind);
  fields.value({"kind", "For programs", {}, kMustSay}, kind);
  e.kind = error_kind_of(kind).value_or(ErrorKind::kProtocol);
  fields.value({"what", "What happened", {}, kMustSay}, e.what);
  fields.value({"where", "File, key or device", {}, kMustSay}, e.where);
  fields.value({"why", "With its numbers", {}, kMustSay}, e.why);
  fields.value({"remedy", "What to do", {}, kMustSay}, e.remedy);
}

Json json_of(const Error& error) {
  return object_of(error);
}

Error error_of_json(const Json& document, const std::string& where) {
  Error error;
  JsonReader reader(document, where);
  describe(reader, error);
  if (reader.status() && error_kind_of(document["kind"].get<std::string>())) return error;
  return {ErrorKind::kProtocol, "what came is no error of weft", where,
          document.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 200), ""};
}

}  // namespace weft
