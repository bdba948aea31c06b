// SPDX-License-Identifier: Apache-2.0
#include "core/solve/solve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "tests/core/places.h"

namespace weft {
namespace {

using testing::HasSubstr;

SolveFacts some_facts() {
  SolveFacts facts;
  facts.id = "0123456789abcdef";
  facts.solver_version = 3;
  facts.method = "reference";
  facts.compression = Compression::kZip;
  facts.size = {6, 4};
  facts.lights = 10;
  facts.albedo_scale = AlbedoScale::kAbsolute;
  facts.is_rec709 = true;
  facts.pixels = 23;
  std::iota(facts.status.pixels.begin(), facts.status.pixels.end(), 11);
  facts.warnings = {{"LED_DEAD", "LED 3 is dead", "check its cable"},
                    {"CONDITIONS", "a frame was left out", ""}};
  facts.pictures = {"sheet.png"};
  facts.check = LeftOutFacts{{0.02, 0.03, 0.01, 0.015, 90}, {{4, {0.04, 0.06, {}, {}, 12}}}};
  facts.error = SolveError{0.5, 0.25, 1.5, 8};
  facts.input = SolveInput{.session = "twill"};
  facts.gates = {{.name = "slope", .unit = "degrees", .value = 3, .limit = 2, .is_over = true}};
  return facts;
}

TEST(SolveFacts, AreReadAsTheyWereWritten) {
  const SolveFacts written = some_facts();
  const Json json = json_of(written);
  EXPECT_EQ(json["schema"], "weft.solve/1");
  EXPECT_EQ(json["status"]["SATURATED"], 11);
  EXPECT_EQ(json["error"]["p95_deg"], 1.5);
  const Result<SolveFacts> read = solve_facts_from_json(json);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->id, written.id);
  EXPECT_EQ(read->solver_version, 3);
  EXPECT_EQ(read->method, "reference");
  EXPECT_EQ(read->compression, Compression::kZip);
  EXPECT_EQ(read->size, (Size{6, 4}));
  EXPECT_EQ(read->lights, 10);
  EXPECT_EQ(read->albedo_scale, AlbedoScale::kAbsolute);
  EXPECT_TRUE(read->is_rec709);
  EXPECT_EQ(read->pixels, 23);
  EXPECT_EQ(read->status, written.status);
  EXPECT_EQ(read->status.with(kShadowed), 12);
  EXPECT_EQ(read->status.with(kInvalidReading), 18);
  EXPECT_EQ(read->warnings, written.warnings);
  EXPECT_EQ(read->pictures, written.pictures);
  EXPECT_EQ(read->error, written.error);
  EXPECT_EQ(read->check, written.check);
  EXPECT_EQ(json_of(*read).dump(), json.dump());
}

TEST(SolveFacts, LeaveOutWhatThereIsNot) {
  SolveFacts facts = some_facts();
  facts.error.reset();
  const Json json = json_of(facts);
  EXPECT_TRUE(json.contains("gates") && json.contains("input")) << json;
  for (const char* field : {"error", "reference", "solved_by", "conditions", "registration"})
    EXPECT_FALSE(json.contains(field)) << field;
}

TEST(SolveFacts, OfAnEarlyVersionHaveNoColorWarningsOrPictures) {
  Json json = json_of(some_facts());
  for (const char* field : {"color", "warnings", "pictures", "error"}) json.erase(field);
  json["status"].erase("INVALID_READING");
  const Result<SolveFacts> facts = solve_facts_from_json(json);
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_FALSE(facts->is_rec709);
  EXPECT_TRUE(facts->warnings.empty() && facts->pictures.empty() && !facts->error);
  EXPECT_EQ(facts->status.with(kInvalidReading), 0);
}

TEST(SolveFacts, WithAFieldOfTheWrongKindAreRefusedByItsName) {
  const Json good = json_of(some_facts());
  for (const auto& [path, value, said] : {std::tuple<const char*, Json, const char*>{"/id", 3, "\"id\""},
                                          {"/width", "wide", "\"width\""},
                                          {"/check/rms", "small", "check: \"rms\""},
                                          {"/check/lights/0/light", 0.5, "check: light 0: \"light\""},
                                          {"/status/DARK", 0.5, "status: \"DARK\""},
                                          {"/compression", "rar", "none, zip or piz was expected"},
                                          {"/albedo_scale", "big", "relative or absolute was expected"},
                                          {"/color", "sepia", "camera or rec709 was expected"},
                                          {"/warnings/1/text", Json(), "warning 1: \"text\""},
                                          {"/pictures/0", 7, "\"pictures\" is 7; a text was expected"},
                                          {"/error/max_deg", "8", "error: \"max_deg\""}}) {
    Json json = good;
    json[Json::json_pointer(path)] = value;
    const Result<SolveFacts> facts = solve_facts_from_json(json);
    ASSERT_FALSE(facts) << path;
    EXPECT_EQ(facts.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(facts.error().message(), HasSubstr(said));
  }
  for (const char* field : {"id", "method", "lights", "width", "albedo_scale", "pixels", "status"}) {
    Json json = good;
    json.erase(field);
    const Result<SolveFacts> facts = solve_facts_from_json(json);
    ASSERT_FALSE(facts) << field;
    EXPECT_THAT(facts.error().message(), HasSubstr(field));
  }
}

TEST(SolveFacts, KeepWhatWasForetoldBesideWhatWasTaken) {
  const std::filesystem::path file = source_folder() / "testdata/schemas/weft.solve-1.1/solve.json";
  const Result<Json> document = read_json(file, "weft.solve", 1);
  ASSERT_TRUE(document) << document.error().message();
  const Result<SolveFacts> facts = solve_facts_from_json(*document);
  ASSERT_TRUE(facts) << facts.error().message();
  ASSERT_TRUE(facts->foretold && facts->taken);
  EXPECT_EQ(facts->foretold->seconds, 1.25);
  EXPECT_EQ(facts->taken->solved, 1);
  EXPECT_EQ(json_of(*facts), *document);
  Json wrong = *document;
  wrong["foretold"].erase("solved");
  const Result<SolveFacts> refused = solve_facts_from_json(wrong);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("foretold"));
}

TEST(SolveFacts, OfAClothThatIsPartlySolvedCountARadianWhereThereIsNoNormal) {
  EXPECT_DOUBLE_EQ(deg_of_whole(0.77, 1), 0.77);
  EXPECT_NEAR(deg_of_whole(0.248, 0.1), 0.0248 + 0.9 * 57.29578, 1e-5);
  EXPECT_NEAR(deg_of_whole(0, 0), 57.29578, 1e-5) << "an error of nothing is none";
}

TEST(SolveFacts, OfStoredSolvesAreRead) {
  const std::filesystem::path data = source_folder() / "testdata";
  const Result<Json> first = read_json(data / "schemas/weft.solve-1/solve.json", "weft.solve", 1);
  ASSERT_TRUE(first) << first.error().message();
  const Result<SolveFacts> early = solve_facts_from_json(*first);
  ASSERT_TRUE(early) << early.error().message();
  EXPECT_EQ(early->lights, 10);
  EXPECT_FALSE(early->is_rec709);
  EXPECT_TRUE(early->error);

  const Result<Product> solve = find_solve(data / "golden/satin.weft", "7cf91e8f08f74f49");
  ASSERT_TRUE(solve) << solve.error().message();
  const Result<Json> document = read_json(solve->folder / solve->kind.document, solve->kind.schema, 1);
  ASSERT_TRUE(document) << document.error().message();
  const Result<SolveFacts> facts = solve_facts_from_json(*document);
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(facts->id, solve->id);
  EXPECT_EQ(facts->method, "reference");
  EXPECT_EQ(facts->size, (Size{38, 26}));
  EXPECT_EQ(facts->warnings.size(), 4U);
  ASSERT_TRUE(facts->reference);
  EXPECT_EQ(facts->reference->stages, std::vector<std::string>{"shadows"});
  EXPECT_EQ(facts->reference->rounds.size(), 2U);
  Json again = json_of(*facts);
  again["reference"] = (*document)["reference"];  // which said less then
  EXPECT_EQ(again, *document);
}

}  // namespace
}  // namespace weft
