// SPDX-License-Identifier: Apache-2.0
#include "app/cli/schemas/calls_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cli/schemas/field_rows.h"

namespace weft::app {
namespace {

/// How every call, or every one with a body, may be refused before it is looked at: said once.
constexpr std::array<std::pair<const char*, const char*>, 6> kOfEveryCall = {{{"400", "Unreadable"},
                                                                              {"401", "NoToken"},
                                                                              {"403", "ForeignOrigin"},
                                                                              {"413", "TooLong"},
                                                                              {"415", "NotJson"},
                                                                              {"421", "ForeignHost"}}};

std::string last_part(const Json& ref) {
  const std::string path = ref.get<std::string>();
  return path.substr(path.rfind('/') + 1);
}

/// The name of a schema, or the fields of one that has none.
std::string schema_words(const Json& schema) {
  if (schema.contains("$ref")) return "`" + last_part(schema["$ref"]) + "`";
  if (schema.contains("allOf"))
    return schema_words(schema["allOf"][0]) + (schema.value("nullable", false) ? " or null" : "");
  std::vector<std::string> names;
  const Json fields = schema.value("properties", Json::object());
  for (const auto& field : fields.items()) names.push_back(field.key());
  return names.empty() ? "" : fmt::format("`{{{}}}`", fmt::join(names, ", "));
}

/// The schemas of a body or an answer, or its media types.
std::string content_words(const Json& holder) {
  std::vector<std::string> words;
  const Json content = holder.value("content", Json::object());
  for (const auto& [type, of_type] : content.items()) {
    const std::string schema = type == "application/json" ? schema_words(of_type["schema"]) : "";
    words.push_back(schema.empty() ? type.substr(0, type.find(';')) : schema);
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// What the address and the headers may say; what stands in the path is the same for all calls.
std::string parameter_words(const Json& operation) {
  std::vector<std::string> words;
  for (const Json& each : operation.value("parameters", Json::array())) {
    if (each["in"] == "path") continue;
    const std::string says = each.value("description", "");
    words.push_back(fmt::format("`{}`{}{}{}", each["name"].get<std::string>(),
                                each["in"] == "header" ? " (header)" : "", says.empty() ? "" : ": ", says));
  }
  return fmt::format("{}", fmt::join(words, "; "));
}

/// By status, without those of every call.
std::string answer_words(const Json& operation, const Json& shared) {
  std::vector<std::string> answers;
  for (const auto& [status, response] : operation["responses"].items()) {
    const std::string name = response.contains("$ref") ? last_part(response["$ref"]) : "";
    if (std::ranges::any_of(kOfEveryCall, [&](const auto& each) { return name == each.second; })) continue;
    const Json& whole = name.empty() ? response : shared[name];
    const bool is_error = status >= "400";
    std::vector<std::string> words = {is_error ? "" : content_words(whole), whole["description"]};
    if (words[1].starts_with("As it is") || words[1].starts_with("As they are")) words[1].clear();
    std::erase(words, "");
    answers.push_back(fmt::format("{} {}", status, fmt::join(words, ": ")));
  }
  std::ranges::sort(answers);
  return fmt::format("{}", fmt::join(answers, "; "));
}

/// A body that may be left out says nothing.
std::string body_words(const Json& operation) {
  const Json body = operation.value("requestBody", Json::object());
  return body.value("required", false) ? content_words(body) : "";
}

std::string row_of(std::string method, std::string_view path, const Json& operation, const Json& shared) {
  constexpr std::string_view kBase = "/api/v1/";
  path.remove_prefix(kBase.size());
  std::ranges::transform(method, method.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return fmt::format("| `{} {}` | {} | {} | {} | {} |\n", method, path,
                     operation["summary"].get<std::string>(), parameter_words(operation),
                     body_words(operation), answer_words(operation, shared));
}

/// A table a tag, in the order of the description.
std::string tables_of_calls(const Json& description) {
  std::vector<std::pair<std::string, std::string>> tables;
  for (const auto& [path, item] : description["paths"].items()) {
    for (const auto& [method, operation] : item.items()) {
      const std::string tag = operation["tags"][0];
      auto table = std::ranges::find(tables, tag, &std::pair<std::string, std::string>::first);
      if (table == tables.end()) table = tables.insert(table, {tag, ""});
      table->second += row_of(method, path, operation, description["components"]["responses"]);
    }
  }
  std::string page;
  for (const auto& [tag, rows] : tables)
    page += fmt::format(
        "\n## {}\n\n| call | what it does | asks | body | answers |\n|---|---|---|---|---|\n{}", tag, rows);
  return page;
}

/// What stands in braces in a path, each meaning once.
std::string table_of_path_words(const Json& description) {
  std::vector<std::string> rows;
  for (const Json& item : description["paths"]) {
    for (const Json& operation : item) {
      for (const Json& each : operation.value("parameters", Json::array())) {
        if (each["in"] != "path" || !each.contains("description")) continue;
        const std::string row = fmt::format("| `{}` | {} |\n", each["name"].get<std::string>(),
                                            each["description"].get<std::string>());
        if (std::ranges::find(rows, row) == rows.end()) rows.push_back(row);
      }
    }
  }
  std::ranges::sort(rows);
  return fmt::format("\n## Words in paths\n\n| in braces | what it is |\n|---|---|\n{}", fmt::join(rows, ""));
}

/// The fields of each kind that a body may be, by name; those that must be said are bold.
std::string table_of_kinds(const Json& body, const Json& schemas) {
  std::string table =
      "One of these kinds, by its `kind`; what is bold must be said. `GET forms` has each as JSON Schema.\n\n"
      "| kind | for people | fields |\n|---|---|---|\n";
  for (const Json& each : body["oneOf"]) {
    const Json& kind = schemas[last_part(each["$ref"])];
    std::vector<std::string> fields;
    for (const auto& field : kind["properties"].items()) {
      const bool is_needed = std::ranges::count(kind["required"], Json(field.key())) > 0;
      if (field.key() != "kind")
        fields.push_back(is_needed ? "**`" + field.key() + "`**" : "`" + field.key() + "`");
    }
    table += fmt::format("| `{}` | {} | {} |\n", kind["properties"]["kind"]["enum"][0].get<std::string>(),
                         kind.value("title", ""), fmt::join(fields, ", "));
  }
  return table;
}

/// The fields of each body that has a name.
std::string tables_of_bodies(const Json& description) {
  std::vector<std::string> names;
  for (const Json& item : description["paths"]) {
    for (const Json& operation : item) {
      if (!operation.contains("requestBody")) continue;
      const Json& schema = operation["requestBody"]["content"]["application/json"]["schema"];
      const std::string name = schema.contains("$ref") ? last_part(schema["$ref"]) : "";
      if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  std::ranges::sort(names);
  const Json& schemas = description["components"]["schemas"];
  std::string page = "\n## Bodies\n";
  for (const std::string& name : names) {
    const Json& schema = schemas[name];
    page += fmt::format("\n### {}\n\n", name);
    page += schema.contains("properties") ? field_table(schema) : table_of_kinds(schema, schemas);
  }
  return page;
}

}  // namespace

std::string calls_page(const Json& description) {
  std::string page =
      "# Calls\n\nMade by `weft schema --page calls` from the OpenAPI document of the server, which "
      "`weft serve --describe` prints and `GET openapi.json` answers. [The daemon](../http.md) says how to "
      "log in, how jobs live and what the codes of errors mean. Paths are below `/api/v1`. Names such as "
      "`Job` are schemas of the OpenAPI document.\n\n"
      "Every call may be refused so, with an `ErrorDocument`; a row has what its call answers besides:\n\n"
      "| status | when |\n|---|---|\n";
  for (const auto& [status, name] : kOfEveryCall)
    page += fmt::format("| {} | {} |\n", status,
                        description["components"]["responses"][name]["description"].get<std::string>());
  page += tables_of_calls(description) + table_of_path_words(description) + tables_of_bodies(description);
  page.pop_back();
  return page;
}

}  // namespace weft::app
