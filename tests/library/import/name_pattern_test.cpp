// SPDX-License-Identifier: Apache-2.0
#include "library/import/name_pattern.h"

#include <gtest/gtest.h>

namespace weft::library {
namespace {

NamePattern pattern(const std::string& text) {
  Result<NamePattern> parsed = NamePattern::parse(text);
  EXPECT_TRUE(parsed) << parsed.error().message();
  return *std::move(parsed);
}

TEST(NamePattern, TakesTheLastNumberOfANameForItsLed) {
  const auto said = pattern("{session}/{fabric}_{led}.{ext}").match("/a/b/tray 7/red_satin_2_07.NEF");
  ASSERT_TRUE(said);
  EXPECT_EQ(said->session, "tray 7");
  EXPECT_EQ(said->fabric, "red_satin_2");
  EXPECT_EQ(said->led, 7);
  EXPECT_FALSE(said->index);
}

TEST(NamePattern, TakesAWholeNumberBehindAText) {
  const auto said = pattern("{fabric}{led}.{ext}").match("satin12.cr2");
  ASSERT_TRUE(said);
  EXPECT_EQ(said->fabric, "satin");
  EXPECT_EQ(said->led, 12);
}

TEST(NamePattern, KnowsTheDarkFrameByZeroAndByWord) {
  for (const char* name : {"satin_0.nef", "satin_00.nef", "satin_dark.nef", "satin_Dark.nef"}) {
    const auto said = pattern("{fabric}_{led:d}.{ext}").match(name);
    ASSERT_TRUE(said) << name;
    EXPECT_EQ(said->led, 0) << name;
  }
}

TEST(NamePattern, PassesOverWhatDoesNotFollowIt) {
  const NamePattern each = pattern("L{led}({any}).nef");
  EXPECT_TRUE(each.match("L3(+).nef"));
  EXPECT_TRUE(each.match("L3().nef"));
  for (const char* name :
       {"L3(+).nef.bak", "xL3(+).nef", "L3+.nef", "Lx(+).nef", "L3(+)xnef", "L12345().nef"})
    EXPECT_FALSE(each.match(name)) << name;
  EXPECT_FALSE(pattern("{session}/{led}.{ext}").match("3.nef")) << "there is no folder";
}

TEST(NamePattern, RefusesWordsThatItDoesNotHave) {
  for (const char* text : {"{who}.nef", "{led}_{led}.nef", "{led", "plain.nef", ""}) {
    const Result<NamePattern> parsed = NamePattern::parse(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().kind, ErrorKind::kUsage) << text;
  }
}

}  // namespace
}  // namespace weft::library
