// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/reply_schemas.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "app/server/http/error_reply.h"
#include "app/server/jobs/job.h"
#include "core/base/error_kind.h"
#include "core/describe/error_json.h"
#include "core/describe/field_json.h"

namespace weft::app {
namespace {

constexpr SchemaOf kWritten = SchemaOf::kWritten;

Json error_schema() {
  std::vector<std::string_view> codes = error_codes();
  std::ranges::sort(codes);
  codes.erase(std::ranges::unique(codes).begin(), codes.end());
  Json schema = schema_of<Error>(kWritten);
  schema["properties"]["kind"]["enum"] = error_kind_names();
  schema["properties"]["code"] = {
      {"type", "string"},
      {"enum", std::move(codes)},
      {"description",
       "What this server decided, by a word that stays; absent where another part of weft failed"}};
  return schema;
}

}  // namespace

Json reply_schemas() {
  return {{"Error", error_schema()}, {"Job", schema_of<JobStatus>(kWritten)}};
}

}  // namespace weft::app
