// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/schemas/calls_page.h"
#include "app/cli/schemas/document_schemas.h"
#include "app/cli/schemas/documents_page.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "app/server/api/api.h"
#include "core/base/files.h"
#include "core/describe/fields.h"
#include "simulator/scene/scene_page.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct SchemaArguments {
  std::string document;
  fs::path folder;
  bool page = false;
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const DocumentSchema& each : document_schemas()) all.emplace_back(each.name);
  return all;
}

Result<int> write_all(const fs::path& folder) {
  if (Result<void> made = make_writable_folder(folder); !made) return std::move(made).error();
  for (const DocumentSchema& each : document_schemas()) {
    const fs::path file = folder / fmt::format("{}.schema.json", each.name);
    if (Result<void> ok = write_json(file, schema_document(each)); !ok) return std::move(ok).error();
  }
  print(folder.string());
  return kDone;
}

Result<int> print_page(const std::string& subject) {
  if (subject == "scenes") {
    print(simulator::scene_page());
  } else if (subject == "calls") {
    print(calls_page(api_description()));
  } else if (subject.empty() || subject == "documents") {
    print(documents_page());
  } else {
    return Error{ErrorKind::kUsage, "there is no such page", "--page",
                 rule_of_words({"documents", "scenes", "calls"}, subject), "name one of them"};
  }
  return kDone;
}

Result<int> print_schemas(const SchemaArguments& a) {
  if (!a.folder.empty()) return write_all(a.folder);
  if (a.page) return print_page(a.document);
  const std::vector<DocumentSchema>& all = document_schemas();
  if (a.document.empty()) {
    for (const DocumentSchema& each : all) print(fmt::format("{:<20} {}", each.name, each.says));
    return kDone;
  }
  const auto found = std::ranges::find(all, a.document, &DocumentSchema::name);
  if (found == all.end()) {
    return Error{ErrorKind::kUsage, "there is no such document", "DOCUMENT",
                 rule_of_words(names(), a.document), "weft schema lists them"};
  }
  print(schema_document(*found).dump(2));
  return kDone;
}

Run add_schema(Options& options) {
  const auto a = std::make_shared<SchemaArguments>();
  options.add("DOCUMENT", &a->document, "Of this document, such as weft.solve; absent: lists all");
  options.add("--output", &a->folder, "Write all of them into this folder instead");
  options.add_flag(
      "--page", &a->page,
      "Print a page of Markdown instead: of the fields of all of them, with the word scenes of the "
      "keys of scenes, with the word calls of what the server answers");
  return [a](const CommonArguments&) { return print_schemas(*a); };
}

}  // namespace

Verb schema_verb() {
  return {"schema", "Print what a document that weft writes may hold, as JSON Schema", add_schema};
}

}  // namespace weft::app
