// SPDX-License-Identifier: Apache-2.0
#include "core/error_json.h"

#include <optional>

#include "core/error_kind.h"

namespace weft {

Json json_of(const Error& error) {
  return {{"kind", name_of(error.kind)},
          {"what", error.what},
          {"where", error.where},
          {"why", error.why},
          {"remedy", error.remedy}};
}

Error error_of_json(const Json& document, const std::string& where) {
  const Error unknown = {ErrorKind::kProtocol, "what came is no error of weft", where,
                         document.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 200), ""};
  if (!document.is_object()) return unknown;
  JsonFields fields(document, where);
  const std::optional<ErrorKind> kind = error_kind_of(fields.text("kind"));
  const Error error = {kind.value_or(ErrorKind::kProtocol), fields.text("what"), fields.text("where"),
                       fields.text("why"), fields.text("remedy")};
  return kind && fields.status() ? error : unknown;
}

}  // namespace weft
