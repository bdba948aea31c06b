// SPDX-License-Identifier: Apache-2.0
#include "library/import/capture_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::library {
namespace {

using testing::ElementsAre;

SourceFrame frame(const std::string& label, std::optional<double> taken_s = {},
                  std::optional<std::uint32_t> image_number = {}) {
  SourceFrame frame;
  frame.label = label;
  frame.taken_s = taken_s;
  frame.image_number = image_number;
  return frame;
}

TEST(CountedOrder, FollowsNamesThatCountOnWhateverTimesSay) {
  const auto counted =
      counted_order({frame("DSC_10", 20), frame("DSC_8", 3600), frame("DSC_9", 3602), frame("DSC_12", 24)});
  ASSERT_TRUE(counted);
  EXPECT_THAT(counted->order, ElementsAre(1, 2, 0, 3));
  ASSERT_EQ(counted->steps.size(), 1U);
  EXPECT_EQ(counted->steps[0].before, 2U);
  EXPECT_EQ(counted->steps[0].after, 0U);
  EXPECT_EQ(counted->steps[0].back_s, 3582);
}

TEST(CountedOrder, IsNoneWhereNamesDoNotCountOn) {
  EXPECT_FALSE(counted_order({frame("DSC_1"), frame("IMG_2")})) << "two words";
  EXPECT_FALSE(counted_order({frame("a/DSC_1"), frame("b/DSC_1")})) << "two folders";
  EXPECT_FALSE(counted_order({frame("one"), frame("two")})) << "no numbers";
  EXPECT_FALSE(counted_order({frame("DSC_1.dng"), frame("DSC_9999.dng"), frame("DSC_9998.dng")}))
      << "the counter began again";
}

TEST(CountedOrder, IsNoneWhereTheCamerasOwnCountSaysAnother) {
  EXPECT_FALSE(counted_order({frame("DSC_1", 1, 8), frame("DSC_2", 2, 7)}));
  EXPECT_TRUE(counted_order({frame("DSC_1", 2, 7), frame("DSC_2", 1, 8)}));
  EXPECT_TRUE(counted_order({frame("DSC_1", 1, 8), frame("DSC_2", 2)})) << "one does not say";
}

TEST(CountedOrder, IsNoneWhereTimesRunBackMoreOftenThanAClockIsSet) {
  std::vector<SourceFrame> frames;
  for (int i = 0; i < 16; ++i) frames.push_back(frame("DSC_" + std::to_string(100 + i), 10 * (i % 4)));
  EXPECT_FALSE(counted_order(frames));
  for (int i = 0; i < 16; ++i) frames[static_cast<std::size_t>(i)].taken_s = 10 * (i % 8);
  EXPECT_TRUE(counted_order(frames));
}

TEST(CountOf, TakesTheNumberThatANameEndsWith) {
  const NameCount count = count_of("roll/DSC_0099.NEF");
  EXPECT_EQ(count.word, "roll/DSC_");
  EXPECT_EQ(count.number, 99U);
  EXPECT_EQ(count.end, 10000U);
}

}  // namespace
}  // namespace weft::library
