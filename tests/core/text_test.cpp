// SPDX-License-Identifier: Apache-2.0
#include "core/text.h"

#include <gtest/gtest.h>

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

TEST(EscapeMarkup, LeavesNothingThatAPageWouldTakeForItsOwn) {
  EXPECT_EQ(escape_markup("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
}

}  // namespace
}  // namespace weft
