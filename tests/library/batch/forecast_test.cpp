// SPDX-License-Identifier: Apache-2.0
#include "library/batch/forecast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace weft::library {
namespace {

SessionTraits cloth(const std::string& fabric, double megapixels = 16, int frames = 11,
                    const std::string& before = "") {
  return {fabric, "c0ffee", before, megapixels, frames};
}

MeasuredSession measured(std::size_t session, double seconds, double degrees) {
  return {session, {{seconds, 0, degrees, 0, false, {}}}};
}

TEST(Sample, HasAsManyOfEachClassAsOfAnother) {
  std::vector<SessionTraits> sessions(90, cloth("twill"));
  sessions.resize(95, cloth("satin"));
  sessions.resize(100, cloth("satin", 36));
  const std::vector<std::size_t> sample = choose_sample(sessions, 12);
  std::map<std::size_t, int> of_class;
  for (const std::size_t each : sample) ++of_class[each < 90 ? 0 : each < 95 ? 1 : 2];
  EXPECT_EQ(of_class[0], 4);
  EXPECT_EQ(of_class[1], 4);
  EXPECT_EQ(of_class[2], 4);
  EXPECT_GT(sample[3] - sample[0], 60U) << "it is spread over the class";
}

TEST(Sample, IsAllWhereThereAreNoMore) {
  const std::vector<SessionTraits> sessions(7, cloth("twill"));
  EXPECT_THAT(choose_sample(sessions, 50), testing::ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(choose_sample({}, 50), testing::IsEmpty());
  EXPECT_THAT(choose_sample(sessions, 0), testing::IsEmpty());
}

TEST(Forecast, IsThatOfTheOwnClassWithItsSpread) {
  const std::vector<SessionTraits> sessions = {cloth("twill"), cloth("twill"), cloth("twill"),
                                               cloth("satin")};
  const std::vector<MeasuredSession> sample = {measured(0, 10, 0.6), measured(1, 14, 0.8),
                                               measured(3, 100, 3)};
  const auto forecasts = carry_over(sessions, sample);
  ASSERT_EQ(forecasts.size(), 4U);
  EXPECT_NEAR(forecasts[2][0].seconds, 12, 1e-9);
  EXPECT_NEAR(forecasts[2][0].seconds_spread, std::sqrt(8.0), 1e-9);
  EXPECT_NEAR(forecasts[2][0].degrees, 0.7, 1e-9);
  EXPECT_NEAR(forecasts[2][0].degrees_spread, std::sqrt(0.02), 1e-9);
  EXPECT_FALSE(forecasts[2][0].is_measured);
  EXPECT_TRUE(forecasts[0][0].is_measured);
  EXPECT_NEAR(forecasts[0][0].seconds, 10, 1e-9) << "what was measured stays";
}

TEST(Forecast, CarriesTheShareOfTheClothThatIsSolved) {
  const std::vector<SessionTraits> sessions(3, cloth("twill"));
  std::vector<MeasuredSession> sample = {measured(0, 10, 0.6), measured(1, 14, 0.2)};
  sample[1].levels[0].solved = 0.1;
  sample[1].levels[0].solve_seconds = 12;
  const auto forecasts = carry_over(sessions, sample);
  EXPECT_DOUBLE_EQ(forecasts[1][0].solved, 0.1) << "what was measured stays";
  EXPECT_DOUBLE_EQ(forecasts[2][0].solved, 0.55);
  EXPECT_DOUBLE_EQ(forecasts[2][0].solve_seconds, 6);
}

TEST(Forecast, GoesByPixelsAndFramesWhereNoSizeIsAlike) {
  const std::vector<SessionTraits> sessions = {cloth("twill", 16, 11), cloth("silk", 32, 22)};
  const std::vector<MeasuredSession> sample = {measured(0, 10, 0.6)};
  const auto forecasts = carry_over(sessions, sample);
  EXPECT_NEAR(forecasts[1][0].seconds, 40, 1e-9);
  EXPECT_NEAR(forecasts[1][0].degrees, 0.6, 1e-9);
}

TEST(Forecast, CarriesTurnsOnlyToSessionsSolvedAlikeSoFar) {
  const std::vector<SessionTraits> sessions = {
      cloth("twill", 16, 11, "fast 8"), cloth("twill", 16, 11, "fast 8"), cloth("satin", 16, 11, "fast 8"),
      cloth("twill", 16, 11, "fast 9"), cloth("twill")};
  std::vector<MeasuredSession> sample = {measured(0, 10, 0.6)};
  sample[0].levels[0].turn_deg = 0.3;
  const auto forecasts = carry_over(sessions, sample);
  EXPECT_EQ(forecasts[1][0].turn_deg, 0.3);
  EXPECT_EQ(forecasts[2][0].turn_deg, 0.3) << "another cloth, where its own was not measured";
  EXPECT_EQ(forecasts[3][0].turn_deg, std::nullopt) << "solved by another version";
  EXPECT_EQ(forecasts[4][0].turn_deg, std::nullopt) << "not solved at all";
}

TEST(Forecast, IsNoneWhereNothingWasMeasured) {
  const std::vector<SessionTraits> sessions = {cloth("twill")};
  EXPECT_TRUE(carry_over(sessions, {}).empty());
}

}  // namespace
}  // namespace weft::library
