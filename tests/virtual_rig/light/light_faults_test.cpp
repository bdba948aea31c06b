// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/light_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace weft::virtual_rig {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

LightFaults after(const std::vector<std::string>& lines) {
  LightFaults faults;
  for (const std::string& line : lines) {
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    const Result<void> ok = change_faults(faults, words, 4);
    EXPECT_TRUE(ok) << ok.error().message();
  }
  return faults;
}

std::vector<double> lit(const std::vector<std::string>& lines, std::vector<double> pins) {
  return with_faults(after(lines), std::move(pins));
}

TEST(LightFaults, ChangeWhatTheirNameSays) {
  EXPECT_THAT(lit({}, {0, 1, 0.5, 0}), ElementsAre(0, 1, 0.5, 0));
  EXPECT_THAT(lit({"dead 2"}, {0, 1, 0.5, 0}), ElementsAre(0, 0, 0.5, 0));
  EXPECT_THAT(lit({"stuck 4"}, {0, 1, 0, 0}), ElementsAre(0, 1, 0, 1));
  EXPECT_THAT(lit({"swap 2 3"}, {0, 1, 0, 0}), ElementsAre(0, 0, 1, 0));
  EXPECT_THAT(lit({"dim 2 0.25"}, {0, 1, 0, 0}), ElementsAre(0, 0.25, 0, 0));
}

TEST(LightFaults, AddUpUntilALightIsNormal) {
  EXPECT_THAT(lit({"swap 1 2", "swap 2 3"}, {1, 0, 0, 0}), ElementsAre(0, 0, 1, 0));
  EXPECT_THAT(lit({"stuck 1", "stuck 2", "dead 2", "dim 1 0.5"}, {0, 0, 0, 0}), ElementsAre(0.5, 0, 0, 0));
  EXPECT_EQ(after({"dead 1", "ambient 0.1", "move 4 -6", "flicker 0.01", "pulses 500 1 0.6", "lamp 100 0.3",
                   "normal"}),
            LightFaults());
}

TEST(LightFaults, AreToldAsJson) {
  const Json told = json_of(after({"stuck 3", "ambient 0.1", "move 6 -4", "dim 2 0.5"}));
  EXPECT_EQ(told.at("stuck"), Json({3}));
  EXPECT_EQ(told.at("ambient"), 0.1);
  EXPECT_EQ(told.at("move_x"), 6);
  EXPECT_EQ(told.at("move_y"), -4);
  EXPECT_EQ(told.at("dimmed").at("2"), 0.5);
  EXPECT_EQ(told.at("pulses"), Json());
  const Json flickers = json_of(after({"pulses 500 1 0.6", "lamp 100 0.3"}));
  EXPECT_EQ(flickers.at("pulses"), Json({{"hertz", 500}, {"depth", 1}, {"duty", 0.6}}));
  EXPECT_EQ(flickers.at("lamp"), Json({{"hertz", 100}, {"depth", 0.3}}));
}

TEST(LightFaults, RefuseWhatNoRigHas) {
  const std::vector<std::vector<std::string>> wrong = {{},
                                                       {"bright"},
                                                       {"dead"},
                                                       {"dead", "5"},
                                                       {"dead", "0"},
                                                       {"dead", "1.5"},
                                                       {"dead", "1", "2"},
                                                       {"dead", "one"},
                                                       {"swap", "1"},
                                                       {"ambient", "-1"},
                                                       {"ambient", "nan"},
                                                       {"ambient", "1e300"},
                                                       {"move", "3", "2"},
                                                       {"move", "2", "1e9"},
                                                       {"flicker", "2"},
                                                       {"pulses", "500", "1"},
                                                       {"pulses", "0", "1", "0.5"},
                                                       {"pulses", "500", "1", "0"},
                                                       {"pulses", "500", "1.1", "0.5"},
                                                       {"lamp", "1e7", "0.3"},
                                                       {"lamp", "100", "-0.1"},
                                                       {"normal", "1"}};
  for (const std::vector<std::string>& words : wrong) {
    LightFaults faults;
    const Result<void> changed = change_faults(faults, words, 4);
    ASSERT_FALSE(changed) << testing::PrintToString(words);
    EXPECT_EQ(changed.error().kind, ErrorKind::kUsage);
    EXPECT_EQ(faults, LightFaults()) << testing::PrintToString(words);
  }
  LightFaults faults;
  EXPECT_THAT(change_faults(faults, {"dead", "9"}, 4).error().message(), HasSubstr("LEDs are 1 to 4"));
}

}  // namespace
}  // namespace weft::virtual_rig
