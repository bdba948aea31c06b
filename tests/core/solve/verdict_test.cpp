// SPDX-License-Identifier: Apache-2.0
#include "core/solve/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/describe/field_json.h"

namespace weft {
namespace {

TEST(Verdict, AsJsonHasItsThreeFields) {
  EXPECT_EQ(json_of({{"LED_DEAD", "LED 3 looks dead", "check it"}}),
            Json::parse(R"([{"name": "LED_DEAD", "text": "LED 3 looks dead", "remedy": "check it"}])"));
  EXPECT_EQ(json_of(std::vector<Verdict>{}), Json::array());
}

TEST(Verdict, IsReadAsItWasWritten) {
  const std::vector<Verdict> written = {{"LED_DEAD", "LED 3 looks dead", "check it"},
                                        {"CONDITIONS", "a frame was left out", ""}};
  const Result<std::vector<Verdict>> read = read_list<Verdict>(json_of(written), "solve.json");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(*read, written);
}

TEST(Verdict, WithoutATextIsRefusedByTheNameOfItsFile) {
  const auto read = read_list<Verdict>(Json::parse(R"([{"name": "LED_DEAD"}])"), "solve.json: warnings");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(read.error().message(), testing::HasSubstr("solve.json: warnings: \"text\" is missing"));
}

}  // namespace
}  // namespace weft
