// SPDX-License-Identifier: Apache-2.0
#include "core/base/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace weft {
namespace {

TEST(Text, CountsTheEditsBetweenWords) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("satin", "satin"), 0U);
  EXPECT_EQ(edit_distance("", "satin"), 5U);
  EXPECT_EQ(edit_distance("satin", ""), 5U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U) << "Levenshtein's example";
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3U);
  EXPECT_EQ(edit_distance("heigth", "height"), 2U) << "swapped letters are two substitutions";
}

TEST(PlainName, KeepsLettersOfEveryScriptAndNothingThatANameMayNotHold) {
  for (const char* kept :
       {"twill-2_1.b", "Grüner", "Gru\xcc\x88ner", "綿絹", "Ткань", "كتّان", "खादी", "ผ้าไหม", "천", "か゚"})
    EXPECT_EQ(plain_name(kept), kept) << kept;
  EXPECT_EQ(plain_name("a b/c\\d:e\n"), "a-b-c-d-e-");
  EXPECT_EQ(plain_name("Loden 🧶"), "Loden--");
  EXPECT_EQ(plain_name("a\xe2\x80\xae"
                       "b\xe2\x80\x8f"),
            "a-b-")
      << "directions of writing";
  EXPECT_EQ(plain_name("\xef\xbb\xbf"
                       "a\xc2\xa0"
                       "b\xc2\xad\xc2\x85"),
            "-a-b--")
      << "blanks and marks that nobody sees";
  EXPECT_EQ(plain_name("a\xff\xc3(\xed\xa0\x80\xc0\xafz"), "a--------z") << "no UTF-8, byte by byte";
}

TEST(FileNameOf, BeginsAndEndsWithALetterAndIsCutBetweenCharacters) {
  EXPECT_EQ(file_name_of("<b>Möbelstoff</b>", "cloth"), "b-Möbelstoff-b");
  EXPECT_EQ(file_name_of("../.hidden.", "cloth"), "hidden");
  EXPECT_EQ(file_name_of("🧶 ...", "cloth"), "cloth");
  EXPECT_EQ(file_name_of("綿綿綿", "cloth", 8), "綿綿");
}

TEST(EscapeMarkup, LeavesNothingThatAPageWouldTakeForItsOwn) {
  EXPECT_EQ(escape_markup("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
}

TEST(StandsBefore, CountsAsPeopleDo) {
  std::vector<std::string> names = {"b10", "a", "B9", "b", "b010x", "b9a", "10", "9", "b1"};
  std::ranges::sort(names, stands_before);
  EXPECT_THAT(names, testing::ElementsAre("9", "10", "a", "b", "b1", "B9", "b9a", "b10", "b010x"));
}

TEST(StandsBefore, OrdersStrictly) {
  const std::vector<std::string> names = {"a01", "a1", "A1", "a001", "a", "", "1", "01"};
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      EXPECT_EQ(stands_before(a, b) + stands_before(b, a), a == b ? 0 : 1) << a << " and " << b;
    }
  }
}

TEST(FirstFew, NamesThreeOfManyAndAllOfFour) {
  EXPECT_EQ(first_few({"a"}), "a");
  EXPECT_EQ(first_few({"a", "b"}), "a and b");
  EXPECT_EQ(first_few({"a", "b", "c", "d"}), "a, b, c and d");
  EXPECT_EQ(first_few({"a", "b", "c", "d", "e"}), "a, b, c and 2 more");
  EXPECT_EQ(first_few({"a", "b", "c", "d"}, 100), "a, b, c and 97 more");
}

}  // namespace
}  // namespace weft
