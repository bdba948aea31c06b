// SPDX-License-Identifier: Apache-2.0
#include "app/cli/schemas/documents_page.h"

#include <fmt/format.h>

#include "app/cli/schemas/document_schemas.h"
#include "app/cli/schemas/field_rows.h"

namespace weft::app {

std::string documents_page() {
  std::string page =
      "# Documents\n\nMade by `weft schema --page` from what reads and writes them. `weft schema NAME` "
      "prints "
      "the same as JSON Schema, and `/usr/share/weft/schemas` has them all. [Formats](../formats.md) says "
      "where the documents lie and what files lie beside them. Readers keep fields that they do not know.\n";
  for (const DocumentSchema& document : document_schemas()) {
    page += fmt::format("\n## {}\n\n{}.\n\n{}", document.name, document.says,
                        field_table(schema_document(document)));
  }
  page.pop_back();
  return page;
}

}  // namespace weft::app
