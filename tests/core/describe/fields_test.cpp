// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/describe/field_check.h"
#include "core/describe/field_json.h"

namespace weft {
namespace {

using testing::HasSubstr;

enum class Weave { kPlain, kTwill };
constexpr std::array<const char*, 2> kWeaves = {"plain", "twill"};

struct Yarn {
  double width_mm = 0.5;
  bool is_dyed = false;

  friend bool operator==(const Yarn&, const Yarn&) = default;
};

void describe(Fields& fields, Yarn& y) {
  fields.value({"width_mm", "How wide it is, mm", {0.01, 10}}, y.width_mm);
  fields.value({"is_dyed", "Whether it is dyed"}, y.is_dyed);
}

struct Cloth {
  std::string name = {};
  int threads = 1;
  double gain = 1;
  std::optional<double> weight = {};
  Weave weave = Weave::kPlain;
  Yarn warp = {};
  std::vector<Yarn> yarns = {};
  std::vector<double> corners_px = {};
  Json document = {};

  friend bool operator==(const Cloth&, const Cloth&) = default;
};

void describe(Fields& fields, Cloth& c) {
  fields.keep(c.document);
  fields.value({"name", "What it is called", kAnyNumber, Need::kMustSay}, c.name);
  fields.value({"threads", "Threads a mm", {1, 100}}, c.threads);
  fields.value({"gain", "Of its picture", kAboveZero}, c.gain);
  fields.value({"weight", "Grams a square metre", {0, 5000}}, c.weight);
  fields.choice({"weave", "How yarns cross", kAnyNumber, Need::kUnlessEmpty}, c.weave, kWeaves);
  fields.object({"warp", "The yarn along it", kAnyNumber, Need::kUnlessEmpty}, c.warp);
  fields.list({"yarns", "All of them"}, c.yarns);
  fields.value({.name = "corners_px",
                .says = "Of its picture",
                .range = {0, 1000},
                .need = Need::kUnlessEmpty,
                .fewest = 2,
                .most = 4},
               c.corners_px);
  fields.require(c.weave == Weave::kPlain || c.threads > 1, "threads", "must be above 1 for a twill");
}

std::string refusal_of(const char* text) {
  const Result<Cloth> read = read_fields<Cloth>(Json::parse(text), "cloth.json");
  return read ? "read" : read.error().message();
}

TEST(Describe, ReadsBackWhatItWrote) {
  Cloth cloth;
  cloth.name = "denim";
  cloth.threads = 3;
  cloth.weight = 400;
  cloth.weave = Weave::kTwill;
  cloth.warp.width_mm = 0.25;
  cloth.yarns = {Yarn{1, true}, Yarn{2, false}};
  cloth.corners_px = {1.5, 2, 3};
  Json written = Json::object();
  write_fields(written, cloth);
  Result<Cloth> read = read_fields<Cloth>(written, "cloth.json");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->document, written);
  read->document = cloth.document;
  EXPECT_EQ(*read, cloth);
}

TEST(Describe, LeavesOutWhatIsEmptyAndMayBe) {
  Json written = Json::object();
  write_fields(written, Cloth{.name = "voile"});
  EXPECT_EQ(written.dump(), R"({"name":"voile","threads":1,"gain":1.0,"yarns":[]})");
}

TEST(Describe, KeepsFieldsThatItDoesNotKnow) {
  const Json document = Json::parse(R"({"new": [1], "name": "voile", "threads": 2, "yarns": []})");
  Result<Cloth> read = read_fields<Cloth>(document, "cloth.json");
  ASSERT_TRUE(read);
  read->threads = 5;
  Json written;
  write_fields(written, *read);
  EXPECT_EQ(written.dump(), R"({"new":[1],"name":"voile","threads":5,"yarns":[],"gain":1.0})");
}

TEST(Describe, RefusesByFieldAndRule) {
  EXPECT_EQ(refusal_of(R"({"name": "a"})"), "read");
  EXPECT_THAT(refusal_of("{}"), HasSubstr("\"name\" is missing"));
  EXPECT_THAT(refusal_of("[]"), HasSubstr("\"name\" is missing"));
  EXPECT_THAT(refusal_of(R"({"name": 3})"), HasSubstr("\"name\" is 3; a text was expected"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "threads": 0})"),
              HasSubstr("\"threads\" must be a whole number from 1 to 100"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "threads": 1.5})"), HasSubstr("a whole number was expected"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "gain": 0})"), HasSubstr("\"gain\" must be a number above 0"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "weight": 5001})"),
              HasSubstr("\"weight\" must be a number from 0 to 5000"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "weave": "knit"})"),
              HasSubstr("\"weave\" is \"knit\"; plain or twill was expected"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "weave": "twill"})"),
              HasSubstr("\"threads\" must be above 1 for a twill"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "warp": 1})"), HasSubstr("\"warp\" is 1; an object was expected"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "yarns": [{}, {"width_mm": 11}]})"),
              HasSubstr("cloth.json: yarn 1: \"width_mm\" must be a number from 0.01 to 10"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "corners_px": [1, 2, 3, 4, 5]})"),
              HasSubstr("\"corners_px\" must be a list of 2 to 4"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "corners_px": [1, "b"]})"), HasSubstr("a number was expected"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "corners_px": [1, 2000]})"),
              HasSubstr("\"corners_px\" must be a number from 0 to 1000"));
  EXPECT_THAT(refusal_of(R"({"name": "a", "yarns": [{"is_dyed": "yes"}]})"),
              HasSubstr("\"is_dyed\" is \"yes\"; true or false was expected"));
}

TEST(Describe, HoldsAStructAgainstItsRangesAndRules) {
  EXPECT_TRUE(check_fields(Cloth{}));
  const auto why = [](const Cloth& cloth) {
    const Result<void> checked = check_fields(cloth);
    return checked ? "holds" : checked.error().where + " " + checked.error().why;
  };
  EXPECT_EQ(why(Cloth{.threads = 101}), "threads must be a whole number from 1 to 100, and is 101");
  EXPECT_EQ(why(Cloth{.weight = -1.0}), "weight must be a number from 0 to 5000, and is -1");
  EXPECT_EQ(why(Cloth{.warp = {.width_mm = 20}}), "width_mm must be a number from 0.01 to 10, and is 20");
  EXPECT_EQ(why(Cloth{.corners_px = {1}}), "corners_px must be 2 to 4 values, and is 1");
  EXPECT_EQ(why(Cloth{.weave = Weave::kTwill}), "threads must be above 1 for a twill");
}

TEST(Describe, SaysItsSchema) {
  const Json schema = schema_of<Cloth>();
  EXPECT_EQ(schema["required"], Json::parse(R"(["name"])"));
  EXPECT_EQ(schema["properties"]["threads"],
            Json::parse(R"({"type": "integer", "minimum": 1.0, "maximum": 100.0, "default": 1,
                            "description": "Threads a mm"})"));
  EXPECT_EQ(schema["properties"]["gain"]["exclusiveMinimum"], 0);
  EXPECT_EQ(schema["properties"]["weave"]["enum"], Json::parse(R"(["plain", "twill"])"));
  EXPECT_EQ(schema["properties"]["yarns"]["items"], schema_of<Yarn>());
}

// What documents have besides what people say.
struct Plate {
  Vec3 centre_mm = {1, 2, 3};
  std::array<std::array<double, 2>, 3> curves = {};
  std::vector<std::array<double, 2>> corners_px = {};
  std::uint64_t bytes = 5'000'000'000;
  std::optional<double> left_s;
  std::optional<Yarn> thread;
  Json rest;
  bool is_dyed = false;
  int colours = 3;
};

void describe(Fields& fields, Plate& p) {
  fields.value({"centre_mm", "Where it lies", {-10, 10}, kMustSay}, p.centre_mm);
  fields.value({"curves", "Three of two"}, p.curves);
  fields.value({"corners_px", "Pairs", {}, kUnlessEmpty}, p.corners_px);
  fields.value({"bytes", "Of memory", {}, kMustSay}, p.bytes);
  fields.value({"left_s", "Until its end", {}, kOrNull}, p.left_s);
  fields.object({"thread", "That it hangs on", {}, kOrNull}, p.thread);
  fields.value({"rest", "Whatever it is", {}, kUnlessEmpty}, p.rest);
  fields.value({"is_dyed", "With colour"}, p.is_dyed);
  fields.only_if(p.is_dyed, [&] { fields.value({"colours", "How many", {1, 9}, kMustSay}, p.colours); });
}

TEST(Describe, WritesAndReadsNumbersInTheirShapeCountsAndNothing) {
  const Json written = object_of(Plate());
  EXPECT_EQ(written.dump(), R"({"centre_mm":[1.0,2.0,3.0],"curves":[[0.0,0.0],[0.0,0.0],[0.0,0.0]],)"
                            R"("bytes":5000000000,"left_s":null,"thread":null,"is_dyed":false})");
  const Result<Plate> read = read_fields<Plate>(written, "plate.json");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(object_of(*read), written);
  EXPECT_FALSE(read->left_s || read->thread);
  Plate dyed;
  dyed.is_dyed = true;
  dyed.corners_px = {{1, 2}, {3, 4}};
  EXPECT_EQ(object_of(dyed)["colours"], 3);
  EXPECT_EQ(object_of(dyed)["corners_px"], Json::parse("[[1.0, 2.0], [3.0, 4.0]]"));
}

TEST(Describe, RefusesNumbersThatAreNotInTheirShape) {
  const Json good = object_of(Plate());
  for (const auto& [path, value, said] :
       {std::tuple<const char*, Json, const char*>{
            "/centre_mm", {1, 2}, "\"centre_mm\" is [1,2]; 3 numbers were expected"},
        {"/centre_mm/1", "2", "3 numbers were expected"},
        {"/centre_mm/1", 11, "\"centre_mm\" must be a number from -10 to 10"},
        {"/curves/2", {1, 2, 3}, "3 lists of 2 numbers were expected"},
        {"/corners_px", {{1, 2}, {3}}, "\"corners_px\" is [[1,2],[3]]; lists of 2 numbers were expected"},
        {"/bytes", -1, "\"bytes\" must be a whole number from 0"},
        {"/bytes", 0.5, "\"bytes\" must be a whole number from 0"},
        {"/left_s", "soon", "\"left_s\" is \"soon\"; a number was expected"},
        {"/is_dyed", true, "\"colours\" is missing"}}) {
    Json json = good;
    json[Json::json_pointer(path)] = value;
    const Result<Plate> read = read_fields<Plate>(json, "plate.json");
    ASSERT_FALSE(read) << path << " " << value;
    EXPECT_THAT(read.error().message(), HasSubstr(said));
  }
}

TEST(Describe, SaysWhatAReaderTakesAndWhatAWriterMakes) {
  const Json taken = schema_of<Plate>(), made = schema_of<Plate>(SchemaOf::kWritten);
  EXPECT_EQ(taken["required"], Json::parse(R"(["centre_mm", "bytes"])"));
  EXPECT_EQ(made["required"],
            Json::parse(R"(["centre_mm", "curves", "bytes", "left_s", "thread", "is_dyed"])"));
  EXPECT_EQ(taken["properties"]["left_s"]["type"], Json::parse(R"(["number", "null"])"));
  EXPECT_EQ(taken["properties"]["curves"]["items"]["maxItems"], 2);
  EXPECT_EQ(taken["properties"]["curves"]["maxItems"], 3);
  EXPECT_FALSE(taken["properties"]["corners_px"].contains("maxItems"));
  EXPECT_EQ(taken["properties"]["bytes"]["type"], "integer");
}

TEST(Describe, CountsFromOneWherePeopleDo) {
  const auto of = [](Naming naming) {
    const Json cloth = Json::parse(R"({"name": "a", "yarns": [{}, {"width_mm": 11}]})");
    return read_fields<Cloth>(cloth, "cloth.json", naming).error().where;
  };
  EXPECT_EQ(of(Naming::kOfPrograms), "cloth.json: yarn 1");
  EXPECT_EQ(of(Naming::kFromOne), "cloth.json: yarn 2");
}

TEST(Describe, SaysARangeThatIsOpenAtZero) {
  EXPECT_EQ(rule_of({kAboveZero.least, 1}), "must be a number above 0, at most 1");
  EXPECT_EQ(rule_of(kAboveZero), "must be a number above 0");
  EXPECT_EQ(rule_of({0, 1}), "must be a number from 0 to 1");
}

TEST(Describe, NamesAnOptionWithoutItsUnit) {
  EXPECT_EQ(option_of({"tape_sigma_mm"}), "--tape-sigma");
  EXPECT_EQ(option_of({"accept_misfit"}), "--accept-misfit");
  EXPECT_EQ(option_of({.name = "square_mm", .option = "--square-mm"}), "--square-mm");
  EXPECT_EQ(option_of({.name = "input", .option = ""}), "");
}

}  // namespace
}  // namespace weft
