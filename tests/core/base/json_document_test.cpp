// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/child.h"
#include "tests/core/image_io/scratch_folder.h"

namespace weft {
namespace {

using testing::HasSubstr;

// Why a text is refused as a weft.session/1, or what it was read as.
std::string verdict(const std::string& text) {
  const ScratchFolder folder;
  put_bytes(folder / "a.json", text);
  const Result<Json> document = read_json(folder / "a.json", "weft.session", 1);
  if (!document) {
    EXPECT_EQ(document.error().kind, ErrorKind::kBadData);
    return document.error().message();
  }
  return "read: " + document->dump();
}

TEST(ReadJson, AcceptsItsSchemaAndNewerMinorVersionsWithTheirFields) {
  EXPECT_EQ(verdict(R"({"schema": "weft.session/1"})"), R"(read: {"schema":"weft.session/1"})");
  EXPECT_EQ(verdict(R"({"schema": "weft.session/1.7", "new": [1]})"),
            R"(read: {"schema":"weft.session/1.7","new":[1]})");
}

TEST(ReadJson, NamesTheVersionThatANewerMajorOneNeeds) {
  for (const char* version : {"2", "2.1", "17"}) {
    const std::string said = verdict(std::string(R"({"schema": "weft.session/)") + version + "\"}");
    EXPECT_THAT(said, HasSubstr("document is newer than this program"));
    EXPECT_THAT(said, HasSubstr("this program reads weft.session/1"));
    const std::string major = version == std::string("17") ? "17" : "2";
    EXPECT_THAT(said, HasSubstr("use a version of weft that reads weft.session/" + major + "."));
  }
}

TEST(ReadJson, RefusesAMissingOrWrongSchema) {
  for (const char* text : {"{}", "[]", "3", "null", R"({"schema": 1})", R"({"Schema": "weft.session/1"})"}) {
    EXPECT_THAT(verdict(text), HasSubstr("it has no \"schema\"; \"weft.session/1\" was expected")) << text;
  }
  for (const char* schema :
       {"weft.solve/1", "weft.session", "weft.session/", "weft.session/x", "weft.session/0",
        "weft.session/-1", "weft.session/1x", "weft.session/99999999999999", "weft.sessions/1", ""}) {
    EXPECT_THAT(verdict(std::string(R"({"schema": ")") + schema + "\"}"),
                HasSubstr(std::string("its schema is \"") + schema + "\"; \"weft.session/1\" was expected"));
  }
}

TEST(ReadJson, RefusesWhatIsNotJson) {
  for (const char* text :
       {"", "{", R"({"schema": "weft.session/1"} x)", R"({"schema": "weft.session/1", "a": NaN})",
        R"({"schema": "weft.session/1", "a": 1e999})", "{\"schema\": \"\xff\"}", "\x89PNG"}) {
    EXPECT_THAT(verdict(text), HasSubstr("it is not valid JSON")) << text;
  }
}

TEST(ReadJson, SurvivesAnyDepthOfLists) {
  const ScratchFolder folder;
  constexpr std::size_t kDepth = 200'000;
  put_bytes(folder / "a.json", R"({"schema": "weft.session/1", "a": )" + std::string(kDepth, '[') +
                                   std::string(kDepth, ']') + "}");
  const std::string said = said_by_child([&] {
    const Result<Json> document = read_json(folder / "a.json", "weft.session", 1);
    return std::string(document ? "read" : "refused");
  });
  EXPECT_TRUE(said == "read" || said == "refused") << said;
}

TEST(ReadJson, RefusesAKeyThatStandsTwiceInOneObjectAndNamesIt) {
  EXPECT_EQ(parse_json(R"({"led": 1, "shots": [{"led": 1}, {"led": 2}], "of": {"led": 3}})").why, "");
  EXPECT_EQ(parse_json(R"({"led": 1, "shots": [{"led": 1, "x": {"led": 1}, "led": 2}]})").why,
            "it says \"led\" twice");
  EXPECT_EQ(parse_json(R"({"a": 1, "a": 1})").why, "it says \"a\" twice");
  EXPECT_EQ(parse_json(R"({"a": 1, "a": )").why, "it is not valid JSON");
}

TEST(WriteJson, KeepsTheOrderOfKeysAndEveryBitOfANumber) {
  const ScratchFolder folder;
  const Json document = {{"schema", "a/1"}, {"z", 0.1},  {"b", 1.0 / 3},
                         {"a", 5e-324},     {"c", -0.0}, {"d", 1.7976931348623157e308}};
  ASSERT_TRUE(write_json(folder / "a.json", document));
  const Result<Json> read = read_json(folder / "a.json", "a", 1);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->dump(), document.dump());
  EXPECT_EQ((*read)["b"].get<double>(), 1.0 / 3);
  EXPECT_TRUE(std::signbit((*read)["c"].get<double>()));
}

TEST(WriteJson, MendsATextThatIsNotUtf8) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_json(folder / "a.json", {{"schema", "a/1"}, {"name", "caf\xe9"}}));
  const Result<Json> read = read_json(folder / "a.json", "a", 1);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ((*read)["name"], "caf\xef\xbf\xbd");
}

const Json kObject = {
    {"text", "twill"},        {"number", 2.5},      {"whole", -7},
    {"vector", {1, 2.5, -3}}, {"list", {1, "two"}}, {"object", {{"a", 1}}},
    {"nothing", nullptr},     {"color", "green"},   {"matrix", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9.5}}}};

enum class Color { kRed, kGreen };
constexpr std::array<const char*, 2> kColorNames = {"red", "green"};

TEST(JsonFields, ReadsEveryKind) {
  JsonFields fields(kObject, "a.json");
  EXPECT_EQ(fields.text("text"), "twill");
  EXPECT_EQ(fields.number("number"), 2.5);
  EXPECT_EQ(fields.number("whole"), -7);
  EXPECT_EQ(fields.integer("whole"), -7);
  EXPECT_EQ(fields.vec3("vector"), (Vec3{1, 2.5, -3}));
  EXPECT_EQ(fields.rgb("vector"), (std::array<double, 3>{1, 2.5, -3}));
  EXPECT_EQ(fields.mat3("matrix"), (Mat3{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9.5}}}));
  EXPECT_EQ(fields.one_of<Color>("color", kColorNames), Color::kGreen);
  EXPECT_EQ(fields.list("list").size(), 2U);
  EXPECT_EQ(fields.object("object")["a"], 1);
  EXPECT_EQ(fields.optional_number("number"), 2.5);
  EXPECT_EQ(fields.optional_number("absent"), std::nullopt);
  EXPECT_EQ(fields.text_or("text", "else"), "twill");
  EXPECT_EQ(fields.text_or("absent", "else"), "else");
  EXPECT_TRUE(fields.has("nothing"));
  EXPECT_FALSE(fields.has("absent"));
  EXPECT_TRUE(fields.status()) << fields.status().error().message();
}

TEST(JsonFields, RemembersTheFirstErrorWithItsPathAndReturnsDefaultsAfterIt) {
  JsonFields fields(kObject, "a.json: shot 3");
  EXPECT_EQ(fields.number("number"), 2.5);
  EXPECT_EQ(fields.number("absent"), 0);
  EXPECT_EQ(fields.text("text"), "") << "after an error there are only defaults";
  EXPECT_EQ(fields.integer("text"), 0);
  EXPECT_EQ(fields.vec3("vector"), Vec3());
  EXPECT_EQ(fields.mat3("matrix"), Mat3());
  EXPECT_EQ(fields.one_of<Color>("color", kColorNames), Color::kRed);
  EXPECT_TRUE(fields.list("list").empty());
  EXPECT_TRUE(fields.object("object").empty());
  fields.reject("number", "must be odd");
  ASSERT_FALSE(fields.status());
  EXPECT_EQ(fields.status().error().kind, ErrorKind::kBadData);
  EXPECT_EQ(fields.status().error().where, "a.json: shot 3");
  EXPECT_EQ(fields.status().error().why, "\"absent\" is missing");
}

std::string why(const std::function<void(JsonFields&)>& read, const Json& object = kObject) {
  JsonFields fields(object, "a.json");
  read(fields);
  return fields.status() ? "fine" : fields.status().error().why;
}

TEST(JsonFields, NamesAWrongKindAndTheOneExpected) {
  EXPECT_EQ(why([](JsonFields& f) { f.text("whole"); }), "\"whole\" is -7; a text was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.text_or("whole", ""); }), "\"whole\" is -7; a text was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.number("text"); }), "\"text\" is \"twill\"; a number was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.number("nothing"); }), "\"nothing\" is null; a number was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.optional_number("text"); }),
            "\"text\" is \"twill\"; a number was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.integer("number"); }),
            "\"number\" is 2.5; a whole number was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.vec3("list"); }),
            "\"list\" is [1,\"two\"]; a list of three numbers was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.mat3("vector"); }),
            "\"vector\" is [1,2.5,-3]; a list of three rows of three numbers was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.mat3("matrix"); }, {{"matrix", {{1, 0, 0}, {0, 1, 0}}}}),
            "\"matrix\" is [[1,0,0],[0,1,0]]; a list of three rows of three numbers was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.one_of<Color>("text", kColorNames); }),
            "\"text\" is \"twill\"; red or green was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.one_of<Color>("whole", kColorNames); }),
            "\"whole\" is -7; a text was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.list("object"); }), "\"object\" is {\"a\":1}; a list was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.object("list"); }), "\"list\" is [1,\"two\"]; an object was expected");
  EXPECT_EQ(why([](JsonFields& f) { f.number("a"); }, Json::array({1})), "\"a\" is missing");
  EXPECT_EQ(why([](JsonFields& f) { f.reject("whole", "must be above 0"); }), "\"whole\" must be above 0");
}

TEST(JsonFields, AWholeNumberHasThirtyTwoBits) {
  for (const char* text :
       {"2147483648", "-2147483649", "9223372036854775808", "18446744073709551615", "1e3"}) {
    const Json object = {{"n", Json::parse(text)}};
    EXPECT_THAT(why([](JsonFields& f) { f.integer("n"); }, object), HasSubstr("a whole number was expected"))
        << text;
  }
  const Json object = {{"n", 2147483647}};
  EXPECT_EQ(why([](JsonFields& f) { f.integer("n"); }, object), "fine");
}

TEST(JsonFields, QuotesOnlyTheBeginningOfALongValueAndNoHalfCharacters) {
  std::string polish;
  for (int i = 0; i < 100; ++i) polish += "\xc5\x82";
  for (const std::string& text : {polish, "." + polish}) {
    const std::string said = why([](JsonFields& f) { f.number("n"); }, Json{{"n", text}});
    EXPECT_LT(said.size(), 100U) << said;
    EXPECT_NO_THROW(Json(said).dump()) << "not UTF-8: " << testing::PrintToString(said);
  }
}

}  // namespace
}  // namespace weft
