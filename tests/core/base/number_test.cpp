// SPDX-License-Identifier: Apache-2.0
#include "core/base/number.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstdint>

namespace weft {
namespace {

TEST(Number, IsAllOfItsTextOrNone) {
  EXPECT_EQ(as_number("2.23"), 2.23);
  EXPECT_EQ(as_number("-1.5e3"), -1500);
  EXPECT_EQ(as_number("+.5"), 0.5);
  EXPECT_EQ(as_number("1e+09"), 1e9);
  for (const char* none :
       {"",    " ",  "2,23", "1.5abc", "0x10", "nan", "-nan", "inf",   "infinity", "1e400", "-1e400",
        "1 2", " 1", "1 ",   "+-1",    "++1",  "1e",  "--1",  "1.2.3", "1_000",    "½",     "1\n"})
    EXPECT_EQ(as_number(none), std::nullopt) << none;
}

TEST(Number, IsWholeWhereThatIsAskedAndNeverTurnsAround) {
  EXPECT_EQ(as_whole_number<int>("-12"), -12);
  EXPECT_EQ(as_whole_number<std::size_t>("12"), 12U);
  for (const char* none : {"", "-1", "1.0", "1e3", "0x10", "12a", "18446744073709551616", "+1", " 1"})
    EXPECT_EQ(as_whole_number<std::size_t>(none), std::nullopt) << none;
  EXPECT_EQ(as_whole_number<int>("2147483648"), std::nullopt);
}

TEST(Number, IsThatOfAPointInALocaleOfCommas) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr) GTEST_SKIP() << "there is no locale de_DE.UTF-8";
  EXPECT_EQ(as_number("2.23"), 2.23);
  EXPECT_EQ(as_number("2,23"), std::nullopt);
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(Number, SaysWhyThereIsNone) {
  EXPECT_EQ(why_no_number("2,23"), "\"2,23\" has a decimal comma and is no number: write 2.23");
  EXPECT_EQ(why_no_number("nan"), "\"nan\" is no finite number");
  EXPECT_EQ(why_no_number("1e400"), "\"1e400\" is beyond what a number here can be");
  EXPECT_EQ(why_no_number("1.5abc"), "\"1.5abc\" is no number");
}

TEST(Number, WordsOfALineLieBetweenItsBlanks) {
  const std::vector<std::string_view> words = words_of_line(" \ta b.png  1\t2\r");
  ASSERT_EQ(words.size(), 4U);
  EXPECT_EQ(words[1], "b.png");
  EXPECT_EQ(words[3], "2");
  EXPECT_TRUE(words_of_line(" \t\r").empty());
}

}  // namespace
}  // namespace weft
