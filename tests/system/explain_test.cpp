// SPDX-License-Identifier: Apache-2.0
// What a level is expected to give and cost, before it is paid.
#include "solve/run/explain.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/image_io/image_io.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kLevels = {"preview", "fast", "standard", "robust", "reference"};

class Explain : public testing::Test {
 protected:
  void SetUp() override { simulate(scene_named("smooth", {160, 128}), session_); }

  Json explain() const { return run_weft({"solve", session_.string(), "--explain", "--json", "-q"}).json(); }

  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

TEST_F(Explain, PricesEveryLevelAndLeavesNothingBehind) {
  const auto before = contents_of(work_.path());
  const Json document = explain();
  EXPECT_EQ(contents_of(work_.path()), before);
  ASSERT_EQ(document.at("levels").size(), kLevels.size()) << document;
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    const Json& level = document["levels"][i];
    EXPECT_EQ(level.at("quality"), kLevels[i]);
    EXPECT_GT(level.at("predicted_deg").get<double>(), 0) << level;
    double sum = 0;
    for (const char* part : {"read", "prepare", "solve", "write", "pictures", "report", "sync"}) {
      sum += level.at("seconds").at(part).get<double>();
    }
    const bool seeks_a_lobe = kLevels[i] == "robust" || kLevels[i] == "reference";
    const double fixed = level["seconds"].at("fixed").get<double>();
    if (seeks_a_lobe) {
      EXPECT_GT(fixed, 0) << level;
    }
    EXPECT_LE(fixed, level["seconds"].at("solve").get<double>()) << level;
    EXPECT_EQ(level.at("solved"), 1) << level;
    for (const char* paid : {"solve", "write", "pictures", "report", "sync"})
      EXPECT_GT(level["seconds"].at(paid).get<double>(), 0) << paid << ": " << level;
    EXPECT_NEAR(level["seconds"].at("total").get<double>(), sum, 1e-9) << level;
  }
  EXPECT_EQ(document.at("gates").size(), 4u);
  EXPECT_TRUE(document.at("chosen").is_null());
  EXPECT_NE(document["levels"].dump().find(document.at("recommended")), std::string::npos)
      << document["recommended"];
}

TEST_F(Explain, KeepsWhatEachLevelMadeOfItsCut) {
  const fs::path crops = work_ / "crops";
  const Outcome told =
      run_weft({"solve", session_.string(), "--explain", "--crops", crops.string(), "--json", "-q"});
  ASSERT_EQ(told.exit_code, 0) << told.error;
  for (const std::string& level : kLevels) {
    for (const char* picture : {"relit", "normal"}) {
      const Result<ImageFileInfo> info = read_image_info(crops / fmt::format("{}_{}.png", level, picture));
      ASSERT_TRUE(info) << info.error().message();
      const int shrunk = level == "preview" ? 2 : 1;
      EXPECT_EQ(info->size, (Size{160 / shrunk, 128 / shrunk})) << level;
    }
  }
  EXPECT_EQ(run_weft({"solve", session_.string(), "--crops", crops.string()}).exit_code, 64)
      << "no --explain";
}

TEST_F(Explain, ForecastsTheErrorOfASmoothClothWithinAFactorOfTwo) {
  const Json levels = explain().at("levels");
  for (std::size_t i = 1; i < kLevels.size(); ++i) {
    const fs::path maps = work_ / kLevels[i];
    const Outcome solved =
        run_weft({"solve", session_.string(), "--quality", kLevels[i], "-o", maps.string(), "-q"});
    ASSERT_EQ(solved.exit_code, 0) << solved.error;
    const double real = Json::parse(bytes_of(maps / "solve.json")).at("error").at("mean_deg").get<double>();
    const double predicted = levels[i].at("predicted_deg").get<double>();
    EXPECT_GT(predicted, real / 2) << kLevels[i] << ": " << predicted << " for " << real;
    EXPECT_LT(predicted, real * 2) << kLevels[i] << ": " << predicted << " for " << real;
  }
}

TEST_F(Explain, SaysWhereADearerLevelHasNothingToGain) {
  const Json reference = explain().at("levels").back();
  EXPECT_THAT(reference.at("note").get<std::string>(),
              testing::AllOf(testing::HasSubstr("nothing to gain over"), testing::HasSubstr("gates shut"),
                             testing::HasSubstr("slope")));
}

TEST_F(Explain, SaysOfTheLevelsThatLookForALobeWhatTheyFound) {
  const Json levels = explain().at("levels");
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    const bool looks = kLevels[i] == "robust" || kLevels[i] == "reference";
    const auto says = testing::HasSubstr("gloss of the middle: no lobe (lambert-fits)");
    EXPECT_EQ(testing::Value(levels[i].at("note").get<std::string>(), says), looks)
        << kLevels[i] << ": " << levels[i].at("note");
  }
}

TEST_F(Explain, RefusesWhatNoLevelCanDoAndSaysWhatOneCan) {
  expect_refusal(work_, {"solve", session_.string(), "-q", "--within", "0.000001"}, 64,
                 {"no level is that quick", "--within 1e-06", "the quickest", " s at "});
  expect_refusal(work_, {"solve", session_.string(), "-q", "--to", "0.0001"}, 64,
                 {"no level is that good", "--to 0.0001", "the closest", "degrees"});
  expect_refusal(work_, {"solve", session_.string(), "-q", "--to", "1", "--quality", "fast"}, 64,
                 {"--to", "--quality"});
}

TEST_F(Explain, SolvesByTheLevelThatItChose) {
  const Outcome run = run_weft({"solve", session_.string(), "--to", "1.5", "-o", (work_ / "maps").string()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const std::string method = Json::parse(bytes_of(work_ / "maps" / "solve.json")).at("method");
  EXPECT_NE(method, "preview");
  EXPECT_THAT(run.error, testing::AllOf(testing::HasSubstr("chose " + method),
                                        testing::HasSubstr("degrees on 100 % of the cloth")));
  const Json solve = Json::parse(bytes_of(work_ / "maps" / "solve.json"));
  for (const char* price : {"foretold", "taken"}) {
    EXPECT_GT(solve.at(price).at("seconds").get<double>(), 0) << solve[price];
    EXPECT_GT(solve[price].at("mean_deg").get<double>(), 0) << solve[price];
    EXPECT_EQ(solve[price].at("solved"), 1) << solve[price];
    EXPECT_TRUE(solve[price].at("parts_s").contains("solve")) << solve[price];
  }
  EXPECT_THAT(run.output, testing::HasSubstr("foretold"));
}

TEST_F(Explain, IsKeptByASolveThatIsToldOfIt) {
  const fs::path maps = work_ / "maps";
  const Outcome run = run_weft({"solve", session_.string(), "--quality", "fast", "--foretold",
                                "2.5,0.75,0.99", "-o", maps.string(), "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(Json::parse(bytes_of(maps / "solve.json")).at("foretold"),
            Json({{"seconds", 2.5}, {"mean_deg", 0.75}, {"solved", 0.99}}));
  for (const char* wrong : {"2.5,0.75", "2.5,0.75,1.5", "-1,0.75,1"})
    expect_refusal(work_, {"solve", session_.string(), "-q", "--foretold", wrong}, 64, {"foretold"});
}

TEST_F(Explain, DrawsTheSameCropAtEveryLevel) {
  const fs::path picture = work_ / "ladder.png";
  const std::vector<std::string> command = {"solve",          session_.string(), "--ladder",
                                            picture.string(), "--json",          "-q"};
  const Json first = run_weft(command).json();
  ASSERT_EQ(first.at("levels").size(), kLevels.size()) << first;
  for (const Json& level : first["levels"]) {
    EXPECT_TRUE(fs::exists(fs::path(level.at("folder").get<std::string>()) / "normal.exr")) << level;
  }
  // A preview cannot show what lies between its pixels.
  EXPECT_GT(first["levels"][0].at("error_deg").get<double>(),
            first["levels"][2].at("error_deg").get<double>());
  const Result<ImageFileInfo> info = read_image_info(picture);
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_GE(info->size.width, 6 * 256) << "five levels and the truth, twice enlarged";
  EXPECT_EQ(run_weft(command).json(), first);
}

TEST(ExplainPhotographs, UnderDistantLightsHavePricesToo) {
  const Workspace work;
  PhotographSample().write(work / "photos");
  const Json document =
      run_weft({"solve", "--photos", (work / "photos").string(), "--explain", "--json", "-q"}).json();
  ASSERT_EQ(document.at("levels").size(), kLevels.size()) << document;
  for (const Json& level : document["levels"]) {
    EXPECT_TRUE(level.at("predicted_deg").is_number()) << level;
  }
}

// Degrees and seconds of preview, fast, standard, robust, reference, and the share of the cloth they solve.
solve::Ladder ladder_of(const std::vector<std::pair<double, double>>& levels, double solved = 1) {
  solve::Ladder ladder;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    solve::LevelPrice level;
    level.level = *solver::method_names()[i].level;
    level.error.total_deg = levels[i].first;
    level.error.solved = solved;
    level.seconds.solve = levels[i].second;
    ladder.levels.push_back(level);
  }
  return ladder;
}

std::string chosen(const solve::Ladder& ladder, const solve::LevelWish& wish) {
  const Result<std::size_t> choice = solve::choose_level(ladder, wish);
  return choice ? ladder.levels[*choice].name() : choice.error().message();
}

TEST(ChooseLevel, TakesTheCheapestThatMeetsAllWishes) {
  const solve::Ladder ladder = ladder_of({{3, 1}, {1, 2}, {0.9, 4}, {0.89, 8}, {0.4, 100}});
  EXPECT_EQ(chosen(ladder, {.to_deg = 1}), "fast");
  EXPECT_EQ(chosen(ladder, {.to_deg = 0.5}), "reference");
  EXPECT_EQ(chosen(ladder, {.within_seconds = 1}), "preview");
  EXPECT_EQ(chosen(ladder, {.within_seconds = 1000}), "reference");
  EXPECT_EQ(chosen(ladder, {.within_seconds = 10}), "standard") << "robust is dearer for a hundredth";
  EXPECT_EQ(chosen(ladder, {.within_seconds = 10, .to_deg = 2}), "fast");
}

TEST(ChooseLevel, SaysBothLimitsWhereBothWishesCannotBeMet) {
  const solve::Ladder ladder = ladder_of({{3, 1}, {1, 2}, {0.9, 4}, {0.89, 8}, {0.4, 100}});
  EXPECT_THAT(
      chosen(ladder, {.within_seconds = 10, .to_deg = 0.5}),
      testing::AllOf(testing::HasSubstr("preview, takes 1 s at 3 degrees on 100 % of the cloth"),
                     testing::HasSubstr(
                         "reference, is expected to be off by 0.4 degrees on 100 % of the cloth in 100 s")));
}

TEST(ChooseLevel, CountsClothWithoutANormalAsOffByARadian) {
  solve::Ladder ladder = ladder_of({{3, 1}, {1, 2}, {0.9, 4}, {0.89, 8}, {0.4, 100}});
  ladder.levels[4].error.solved = 0.9;  // 0.36 + 5.73 degrees
  EXPECT_EQ(chosen(ladder, {.within_seconds = 1000}), "standard");
  EXPECT_THAT(chosen(ladder, {.to_deg = 0.5}), testing::HasSubstr("no level is that good"));
  ladder.levels[4].error.solved = 0.999;  // 0.3996 + 0.0573 degrees
  EXPECT_EQ(chosen(ladder, {.to_deg = 0.5}), "reference");
}

TEST(ChooseLevel, TakesNoneWhereMostOfTheClothHasNoNormal) {
  // What an overexposed scan gives: an error of what little is left, or of nothing.
  solve::Ladder ladder = ladder_of({{0, 1}, {0.3, 2}, {0.25, 4}, {0.25, 8}, {0.25, 100}}, 0.11);
  ladder.levels[0].error.solved = 0;
  for (const solve::LevelWish& wish : {solve::LevelWish{.to_deg = 1}, solve::LevelWish{.to_deg = 60},
                                       solve::LevelWish{.within_seconds = 10}}) {
    const Result<std::size_t> choice = solve::choose_level(ladder, wish);
    ASSERT_FALSE(choice) << ladder.levels[*choice].name();
    EXPECT_EQ(choice.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(choice.error().message(),
                testing::AllOf(testing::HasSubstr("no level solves this cloth"), testing::HasSubstr("11 %"),
                               testing::HasSubstr("scan it again")));
  }
}

TEST(ExplainPhotographs, ThatAreMostlyOverexposedSayHowLittleOfTheClothIsSolved) {
  const Workspace work;
  PhotographSample sample;
  sample.size = {96, 64};
  sample.ending = ".png";
  sample.type = SampleType::kUint16;
  for (DistantLight& light : sample.lights) {
    for (double& channel : light.irradiance_rgb) channel *= 4;
  }
  sample.write(work / "photos");
  const Outcome told =
      run_weft({"solve", "--photos", (work / "photos").string(), "--explain", "--json", "-q"});
  ASSERT_EQ(told.exit_code, 0) << told.error;
  const Json document = told.json();
  for (const Json& level : document.at("levels")) {
    EXPECT_LT(level.at("solved").get<double>(), 0.4) << level;
    EXPECT_THAT(level.at("note").get<std::string>(), testing::HasSubstr("most of the cloth has no normal"));
  }
  expect_refusal(work, {"solve", "--photos", (work / "photos").string(), "-q", "--to", "60"}, 65,
                 {"no level solves this cloth"});
}

}  // namespace
}  // namespace weft::test
