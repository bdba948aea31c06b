// SPDX-License-Identifier: Apache-2.0
// Documents of testdata by what describes them: read and written again they are the same, and what they lack
// or have of another kind is refused by its name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/guide/photograph_set.h"
#include "calibration/run/last_check.h"
#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "exchange/presets/export_facts.h"
#include "material/run/map_set_facts.h"
#include "material/run/rectify.h"
#include "solve/report/reflectance_facts.h"
#include "solve/report/report_facts.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

template <typename Described>
Result<Json> read_and_written(const Json& document) {
  Result<Described> read = read_fields<Described>(document, "here");
  if (!read) return std::move(read).error();
  Json written = {{"schema", document["schema"]}};
  write_fields(written, std::move(*read));
  return written;
}

struct Described {
  const char* schema;
  Result<Json> (*again)(const Json& document);
  Json (*fields)(SchemaOf documents);
};

template <typename T>
Described described(const char* schema) {
  return {schema, read_and_written<T>, schema_of<T>};
}

const std::vector<Described>& all_described() {
  static const std::vector<Described> all = {described<calibration::PhotographSet>("weft.set"),
                                             described<material::RectifyFacts>("weft.rectified"),
                                             described<material::MapSetFacts>("weft.maps"),
                                             described<exchange::ExportFacts>("weft.export"),
                                             described<SolveFacts>("weft.solve"),
                                             described<calibration::CheckResult>("weft.calibration-check"),
                                             described<solve::ReflectanceFacts>("weft.reflectance"),
                                             described<solve::SolveReportFacts>("weft.solve-report")};
  return all;
}

std::vector<Json> stored(const std::string& schema) {
  std::vector<Json> found;
  for (const char* folder : {"testdata/schemas", "testdata/golden"}) {
    for (const auto& entry : fs::recursive_directory_iterator(source_folder() / folder)) {
      if (entry.path().extension() != ".json") continue;
      const Result<std::string> text = read_text(entry.path());
      if (!text) continue;
      const Json document = Json::parse(*text);
      if (document.value("schema", "").starts_with(schema + "/")) found.push_back(document);
    }
  }
  return found;
}

// Fields that documents of early versions had not.
Json without_what_is_new(const Json& again, const Json& document) {
  if (again.is_array() && document.is_array() && again.size() == document.size()) {
    Json old = Json::array();
    for (std::size_t i = 0; i < again.size(); ++i) old.push_back(without_what_is_new(again[i], document[i]));
    return old;
  }
  if (!again.is_object() || !document.is_object()) return again;
  Json old = Json::object();
  for (const auto& [name, value] : again.items()) {
    if (document.contains(name)) old[name] = without_what_is_new(value, document[name]);
  }
  return old;
}

TEST(DescribedDocuments, AreWrittenAsTheyWereRead) {
  for (const Described& each : all_described()) {
    const std::vector<Json> documents = stored(each.schema);
    EXPECT_FALSE(documents.empty()) << each.schema;
    for (const Json& document : documents) {
      const Result<Json> again = each.again(document);
      ASSERT_TRUE(again) << each.schema << ": " << again.error().message();
      EXPECT_EQ(without_what_is_new(*again, document).dump(1), document.dump(1));
    }
  }
}

TEST(DescribedDocuments, ThatAreWrittenAgainKeepWhatTheyDoNotKnow) {
  for (const Described& each : all_described()) {
    const std::string name = each.schema;
    if (name != "weft.set" && name != "weft.maps" && name != "weft.rectified" && name != "weft.export")
      continue;
    for (Json document : stored(name)) {
      document["later"] = {{"than", "this program"}};
      const Result<Json> again = each.again(document);
      ASSERT_TRUE(again) << name << ": " << again.error().message();
      EXPECT_EQ(again->value("later", Json()), document["later"]) << name;
    }
  }
}

TEST(DescribedDocuments, AreRefusedByTheNameOfAField) {
  for (const Described& each : all_described()) {
    const Json schema = each.fields(SchemaOf::kRead);
    for (const Json& document : stored(each.schema)) {
      for (const Json& field : schema.value("required", Json::array())) {
        Json lacks = document;
        lacks.erase(field.get<std::string>());
        const Result<Json> read = each.again(lacks);
        ASSERT_FALSE(read) << each.schema << " without " << field;
        EXPECT_THAT(read.error().message(), testing::HasSubstr(field.dump() + " is missing"));
      }
      for (const auto& [name, value] : document.items()) {
        if (name == "schema" || !schema["properties"].contains(name)) continue;
        Json other = document;
        other[name] = value.is_string() ? Json(7) : Json("seven");
        const Result<Json> read = each.again(other);
        ASSERT_FALSE(read) << each.schema << ": " << name;
        EXPECT_THAT(read.error().message(), testing::HasSubstr(name));
      }
    }
  }
}

}  // namespace
}  // namespace weft::app
