// SPDX-License-Identifier: Apache-2.0
#include "app/cli/schemas/documents_page.h"

#include <gtest/gtest.h>

#include "app/cli/schemas/document_schemas.h"
#include "core/base/files.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

TEST(DocumentsPage, IsWhatTheDocsHave) {
  const Result<std::string> kept = read_text(source_folder() / "docs/reference/documents.md");
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_EQ(documents_page() + "\n", *kept) << "weft schema --page >docs/reference/documents.md";
}

TEST(DocumentSchemas, NameTheirVersionAndSayEveryField) {
  for (const DocumentSchema& each : document_schemas()) {
    const Json schema = schema_document(each);
    if (each.is_versioned) {
      EXPECT_EQ(schema["properties"]["schema"]["pattern"], std::string("^") + each.name + "/1(\\.[0-9]+)?$");
    }
    for (const auto& [name, field] : schema["properties"].items()) {
      EXPECT_TRUE(name == "schema" || field.contains("description")) << each.name << ": " << name;
    }
  }
}

}  // namespace
}  // namespace weft::app
