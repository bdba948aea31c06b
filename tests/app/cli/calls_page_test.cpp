// SPDX-License-Identifier: Apache-2.0
#include "app/cli/schemas/calls_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/server/api/api.h"
#include "core/base/files.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CallsPage, IsWhatTheDocsHave) {
  const Result<std::string> kept = read_text(source_folder() / "docs/reference/calls.md");
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_EQ(calls_page(api_description()) + "\n", *kept)
      << "weft schema --page calls >docs/reference/calls.md";
}

TEST(CallsPage, SaysOfACallWhatItAsksTakesAndAnswers) {
  const Json description = Json::parse(R"({
    "paths": {"/api/v1/lamps/{name}": {"post": {
      "tags": ["lamps"], "summary": "Light it",
      "parameters": [
        {"name": "name", "in": "path", "description": "Lamp"},
        {"name": "dim", "in": "query", "description": "0 to 1"},
        {"name": "If-Match", "in": "header"}],
      "requestBody": {"required": true, "content": {"application/json": {
        "schema": {"$ref": "#/components/schemas/LampRequest"}}}},
      "responses": {
        "409": {"$ref": "#/components/responses/Busy"},
        "401": {"$ref": "#/components/responses/NoToken"},
        "200": {"description": "As it is", "content": {"application/json": {
          "schema": {"type": "object", "properties": {"lit": {"type": "boolean"}}}}}}}}}},
    "components": {
      "responses": {
        "Busy": {"description": "Another is lit"}, "Unreadable": {"description": "u"},
        "NoToken": {"description": "t"}, "ForeignOrigin": {"description": "o"},
        "TooLong": {"description": "l"}, "NotJson": {"description": "j"}, "ForeignHost": {"description": "h"}},
      "schemas": {"LampRequest": {
        "type": "object", "required": ["led"], "properties": {
          "led": {"type": "integer", "minimum": 1, "maximum": 10, "description": "Its number"},
          "name": {"type": "string", "nullable": true, "description": "For people"}}}}}})");
  const std::string page = calls_page(description);
  EXPECT_THAT(page, HasSubstr("| 401 | t |\n"));
  EXPECT_THAT(page, HasSubstr("## lamps\n"));
  EXPECT_THAT(page, HasSubstr("| `POST lamps/{name}` | Light it | `dim`: 0 to 1; `If-Match` (header) | "
                              "`LampRequest` | 200 `{lit}`; 409 Another is lit |\n"));
  EXPECT_THAT(page, HasSubstr("| `name` | Lamp |\n"));
  EXPECT_THAT(page, HasSubstr("| `led` | whole number 1 to 10 | Its number |\n"));
  EXPECT_THAT(page, HasSubstr("| `name` | text or null | *may be absent.* For people |"));
  EXPECT_THAT(page, Not(HasSubstr("401 t")));
}

TEST(CallsPage, ShowsTheKindsOfABodyThatIsOneOfSeveral) {
  const std::string page = calls_page(api_description());
  EXPECT_THAT(page, HasSubstr("| `copy` | Second copy | `request_id`, **`session`** |\n"));
}

}  // namespace
}  // namespace weft::app
