// SPDX-License-Identifier: Apache-2.0
// Whether the faces of a described field refuse the same values in the same words.
#include "app/cli/described_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/server/api/bodies/job_arguments.h"
#include "app/server/api/bodies/job_kinds.h"
#include "app/server/api/bodies/scan_body.h"
#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::Ne;
using testing::SizeIs;

constexpr const char* kHolds = "";

template <typename Request>
std::shared_ptr<void> walk_over(Fields& fields) {
  auto request = std::make_shared<Request>();
  describe(fields, *request);
  return request;
}

/// Jobs, and calls whose options a verb has too.
std::vector<JobKind> described_kinds() {
  std::vector<JobKind> all = job_kinds();
  all.push_back({"scan", "A scan", {}, {walk_over<ScanWish>}});
  return all;
}

/// One field of a kind of job, and how its verb calls it.
struct FieldFacts {
  std::string name, option;
  NumberRange range;
  bool is_whole = false, is_flag = false, is_list = false;
  std::string unit;
  std::vector<std::string> words;
};

/// What a kind's fields are.
class Names final : public Fields {
 public:
  std::vector<FieldFacts> all;

 private:
  void take(const Field& field, Value value) override {
    if (field.said != Said::kEverywhere) return;
    FieldFacts said = said_of(field);
    std::visit(
        [&]<typename T>(T*) {
          using Held = typename Inner<T>::Type;
          said.is_flag = std::is_same_v<T, bool>;
          said.is_list = kIsList<T>;
          said.is_whole = std::is_same_v<Held, int>;
          if (!std::is_same_v<Held, int> && !std::is_same_v<Held, double>) said.range = kAnyNumber;
        },
        value);
    const bool has_words = !field.words.empty() && field.path == PathTo::kAnything;
    if (has_words) said.words = field.words;
    all.push_back(said);
  }
  void choose(const Field& field, Words words, std::size_t,
              const std::function<void(std::size_t)>&) override {
    if (field.said != Said::kEverywhere) return;
    all.push_back(said_of(field));
    all.back().words = {words.begin(), words.end()};
  }
  static FieldFacts said_of(const Field& field) {
    std::string option = option_of(field);
    option.erase(0, option.find(',') + 1);
    return {.name = field.name,
            .option = option,
            .range = field.range,
            .unit = field.units.empty() ? "" : field.units.front().name,
            .words = {}};
  }
};

std::vector<FieldFacts> fields_of(const JobKind& kind) {
  Names names;
  for (const auto& walk : kind.fields) walk(names);
  return names.all;
}

/// Why the command line refuses these words; empty where it takes them. What else the verb needs is not
/// missed.
std::string why_not_said(const JobKind& kind, const std::vector<std::string>& words) {
  CLI::App app("", "weft");
  Options options(app);
  OptionFields fields(options);
  std::vector<std::shared_ptr<void>> read;
  for (const auto& walk : kind.fields) read.push_back(walk(fields));
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::RequiredError&) {
    return kHolds;
  } catch (const CLI::RequiresError&) {
    return kHolds;
  } catch (const CLI::ParseError& error) {
    return error.what();
  }
  return kHolds;
}

/// Why the body of a call is refused by this field.
std::string why_not_asked(const JobKind& kind, const std::string& field, const Json& value) {
  const Json body = {{"kind", kind.name}, {field, value}};
  JobSpec spec;
  spec.kind = kind.name;
  const JobPlaces places;
  JobArguments arguments(body, places, spec);
  for (const auto& walk : kind.fields) walk(arguments);
  const Result<void> status = arguments.status();
  return !status && status.error().where == field ? status.error().why : kHolds;
}

/// What a reader asks for besides.
Json least_document(const Json& schema) {
  Json document = Json::object();
  for (const Json& name : schema.value("required", Json::array())) {
    const std::string field = name.get<std::string>();
    const bool is_list = schema["properties"][field]["type"] == "array";
    document[field] = is_list ? Json::array({"x"}) : Json("x");
  }
  return document;
}

/// Why a document is refused that holds the field: of JSON, and of TOML.
std::vector<std::string> why_not_read(const JobKind& kind, const std::string& field, const Json& value) {
  std::vector<std::string> refusals;
  for (const auto& walk : kind.fields) {
    JsonSchema walked;
    walk(walked);
    const Json schema = walked.schema();
    if (!schema["properties"].contains(field)) continue;
    Json document = least_document(schema);
    document[field] = value;
    JsonReader reader(document, "request.json");
    walk(reader);
    const Result<void> json = reader.status();
    refusals.push_back(json ? kHolds : json.error().why);
    const Result<toml::table> table = parse_toml(toml_of(document), "request.toml");
    const Result<void> toml =
        table ? read_table(*table, "request.toml", "docs", schema, [&](Fields& fields) { walk(fields); })
              : Result<void>(table.error());
    refusals.push_back(toml ? kHolds : toml.error().why);
  }
  return refusals;
}

// As a person would type a number.
std::string typed(const FieldFacts& field, const Json& value) {
  return field.option + "=" + value.dump() + field.unit;
}

/// Each face's refusal of a number holds the rule of the field.
void expect_refused(const JobKind& kind, const FieldFacts& field, double number) {
  SCOPED_TRACE(std::string(kind.name) + ": " + field.name + " = " + std::to_string(number));
  const Json one = field.is_whole ? Json(static_cast<int>(number)) : Json(number);
  const Json value = field.is_list ? Json::array({one}) : one;
  const std::string rule = rule_of(field.range, field.is_whole);
  EXPECT_THAT(why_not_said(kind, {typed(field, one)}), HasSubstr(rule));
  if (!field.is_list) {
    EXPECT_THAT(why_not_asked(kind, field.name, value), HasSubstr(rule));
  } else {
    EXPECT_NE(why_not_asked(kind, field.name, value), kHolds);
  }
  EXPECT_THAT(why_not_read(kind, field.name, value), AllOf(SizeIs(2), Each(HasSubstr(rule))));
}

TEST(DescribedFields, RefuseANumberUnderOrOverTheirRangeOnEveryFace) {
  int refused = 0;
  for (const JobKind& kind : described_kinds()) {
    for (const FieldFacts& field : fields_of(kind)) {
      if (field.range.least > -kMostNumber) {
        const double under = field.range.least == kAboveZero.least ? 0 : field.range.least - 1;
        expect_refused(kind, field, under);
        ++refused;
      }
      if (field.range.most < 1e9) {
        expect_refused(kind, field, field.range.most + 1);
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 80);
}

TEST(DescribedFields, RefuseAnotherTypeOnEveryFace) {
  for (const JobKind& kind : described_kinds()) {
    for (const FieldFacts& field : fields_of(kind)) {
      SCOPED_TRACE(std::string(kind.name) + ": " + field.name);
      const bool is_number = field.range.least > -kMostNumber;
      if (is_number) {
        EXPECT_NE(why_not_said(kind, {field.option + "=many"}), kHolds);
      }
      EXPECT_NE(why_not_asked(kind, field.name, nullptr), kHolds);
      EXPECT_NE(why_not_asked(kind, field.name, Json::array({Json::array()})), kHolds);
      if (is_number || field.is_flag) {
        EXPECT_THAT(why_not_read(kind, field.name, "many"), Each(Ne(kHolds)));
      }
    }
  }
}

TEST(DescribedFields, NameTheNearestOfTheirWordsOnEveryFace) {
  int refused = 0;
  for (const JobKind& kind : described_kinds()) {
    for (const FieldFacts& field : fields_of(kind)) {
      if (field.words.empty() || field.is_list) continue;
      SCOPED_TRACE(std::string(kind.name) + ": " + field.name);
      const std::string misspelt = field.words.back() + "x";
      const std::string meant = "'" + nearest_word(field.words, misspelt) + "'";
      EXPECT_THAT(why_not_said(kind, {field.option + "=" + misspelt}), HasSubstr("did you mean " + meant));
      EXPECT_THAT(why_not_asked(kind, field.name, misspelt), HasSubstr("did you mean " + meant));
      EXPECT_THAT(why_not_read(kind, field.name, misspelt), Each(HasSubstr(misspelt)));
      ++refused;
    }
  }
  EXPECT_GT(refused, 15);
}

TEST(DescribedFields, NameTheNearestFieldOfOneThatIsMisspelt) {
  for (const JobKind& kind : described_kinds()) {
    for (const FieldFacts& field : fields_of(kind)) {
      const std::string misspelt = field.name + "q";
      EXPECT_THAT(why_not_asked(kind, misspelt, 1), HasSubstr("did you mean '" + field.name + "'"));
      const Result<toml::table> table = parse_toml(misspelt + " = 1", "request.toml");
      for (const auto& walk : kind.fields) {
        JsonSchema walked;
        walk(walked);
        if (!walked.schema()["properties"].contains(field.name)) continue;
        const Result<void> read = read_table(*table, "request.toml", "docs", walked.schema(), [](Fields&) {});
        EXPECT_TRUE(!read && read.error().why == "there is no such key; the nearest is " + field.name);
      }
    }
  }
}

TEST(DescribedFields, AreSaidOnce) {
  for (const JobKind& kind : described_kinds()) {
    for (const FieldFacts& field : fields_of(kind)) {
      if (field.range.least <= -kMostNumber || field.is_list) continue;
      const Json value = field.is_whole ? Json(static_cast<int>(std::max(1.0, field.range.least)))
                                        : Json(std::max(0.01, field.range.least));
      SCOPED_TRACE(std::string(kind.name) + ": " + typed(field, value));
      EXPECT_EQ(why_not_said(kind, {typed(field, value)}), kHolds);
      EXPECT_NE(why_not_said(kind, {typed(field, value), typed(field, value)}), kHolds);
    }
  }
  EXPECT_THAT(parse_json(R"({"kind": "solve", "to_deg": 1, "to_deg": 2})").why,
              HasSubstr("\"to_deg\" twice"));
  EXPECT_FALSE(parse_toml("to_deg = 1\nto_deg = 2", "request.toml"));
}

/// The options that no call can say.
class OptionsOfThisMachine final : public Fields {
 public:
  std::vector<std::string> all;

 private:
  void take(const Field& field, Value) override { note(field); }
  void choose(const Field& field, Words, std::size_t, const std::function<void(std::size_t)>&) override {
    note(field);
  }
  void note(const Field& field) {
    const std::string option = option_of(field);
    if (field.said == Said::kAtThisMachine && option.starts_with('-'))
      all.push_back(option.substr(option.find(',') + 1));
  }
};

TEST(DescribedFields, AreSaidByCallsButForThoseThatTheManualNames) {
  const Result<std::string> manual = read_text(in_sources("docs/http.md"));
  ASSERT_TRUE(manual);
  const std::size_t begin = manual->find("No call says:");
  ASSERT_NE(begin, manual->npos);
  const std::string named = manual->substr(begin, manual->find("\n\n", begin) - begin);
  for (const JobKind& kind : job_kinds()) {
    OptionsOfThisMachine options;
    for (const auto& walk : kind.fields) walk(options);
    for (const std::string& option : options.all) EXPECT_THAT(named, HasSubstr("`" + option)) << kind.name;
  }
}

}  // namespace
}  // namespace weft::app
