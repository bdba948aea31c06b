// SPDX-License-Identifier: Apache-2.0
#include "torture/hard_case.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

namespace weft::torture {
namespace {

std::string words_of(const HardCase& hard) {
  const auto number = [](const std::optional<double>& error) {
    return error ? fmt::format("{:.3g}", *error) : std::string("no number");
  };
  return fmt::format("{}: {}: plain {}, ours {} of at most {:.3g} {}, says \"{}\", must say \"{}\"",
                     hard.stage, hard.what, number(hard.plain), number(hard.ours), hard.within, hard.unit,
                     hard.flag, hard.must_say);
}

const std::vector<HardCase>& cases() {
  static const std::vector<HardCase> all = hard_cases();
  return all;
}

TEST(HardCases, AreAnsweredWithinTheirBoundsOrRefusedByName) {
  for (const HardCase& hard : cases()) EXPECT_TRUE(hard.holds()) << words_of(hard);
}

TEST(HardCases, AreEachGotWrongByThePlainFormula) {
  for (const HardCase& hard : cases())
    EXPECT_TRUE(!hard.plain || *hard.plain > 2 * hard.within) << words_of(hard);
}

TEST(HardCases, AreOfEveryStageFromCaptureToExportAndEachIsThereOnce) {
  std::map<std::string, int> stages;
  std::set<std::string> names;
  for (const HardCase& hard : cases()) {
    ++stages[hard.stage];
    EXPECT_TRUE(names.insert(hard.what).second) << words_of(hard);
  }
  for (const char* stage : {"capture", "calibration", "solver", "gloss", "height", "maps", "export"})
    EXPECT_GE(stages[stage], 3) << stage;
  EXPECT_EQ(stages.size(), 7U);
}

TEST(HardCase, HoldsWithinItsBoundAndWithTheFlagThatItMustCarry) {
  const HardCase right = {.stage = "solver",
                          .what = "",
                          .unit = "",
                          .plain = 1,
                          .ours = 0.1,
                          .flag = "DARK",
                          .within = 0.1,
                          .must_say = "DARK"};
  EXPECT_TRUE(right.holds());
  HardCase far = right, silent = right, refused = right, mute = right, no_number = right;
  far.ours = 0.11;
  silent.flag = "SHADOWED";
  refused.ours.reset();
  mute.ours.reset();
  mute.flag = mute.must_say = "";
  no_number.ours = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(far.holds()) << "off its bound";
  EXPECT_FALSE(silent.holds()) << "another flag";
  EXPECT_TRUE(refused.holds()) << "no answer, by name";
  EXPECT_FALSE(mute.holds()) << "no answer and not a word";
  EXPECT_FALSE(no_number.holds());
}

}  // namespace
}  // namespace weft::torture
