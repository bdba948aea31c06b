// SPDX-License-Identifier: Apache-2.0
// A rig that is not there, told through its daemon what is wrong with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bench/server/served_rig.h"
#include "core/base/json_document.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

constexpr const char* kVirtual = "/api/v1/rig/virtual";

class ToldRig : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(served_.start(program_folder(), in_sources("testdata/scenes/satin.toml"), 0.02));
    ASSERT_TRUE(served_.serve());
  }
  Result<Json> tell(const std::string& line) const {
    return served_.client().post(kVirtual, {{"line", line}});
  }
  Json virtual_rig() const { return served_.client().get(kVirtual).value(); }
  bool misses_its_board() const {
    const Json doctor = served_.client().get("/api/v1/doctor").value();
    return std::ranges::any_of(doctor["findings"], [](const Json& finding) {
      return finding["part"] == "board" && finding["verdict"] == "fault";
    });
  }

  ServedRig served_;
};

TEST_F(ToldRig, LosesItsBoardAndHasItBack) {
  EXPECT_EQ(served_.client().get("/api/v1/rig")->at("virtual"), true);
  EXPECT_FALSE(misses_its_board());
  ASSERT_TRUE(tell("board unplug"));
  EXPECT_TRUE(misses_its_board());
  ASSERT_TRUE(tell("board replug"));
  EXPECT_FALSE(misses_its_board());
}

TEST_F(ToldRig, TakesEveryExampleThatItGives) {
  const Json told = virtual_rig();
  for (const Json& words : told["lines"]) {
    const std::string example = words["example"];
    EXPECT_FALSE(words["does"].get<std::string>().empty()) << example;
    if (example == "end" || example == "table chart") continue;  // a rig of satin has none
    const Result<Json> said = tell(example);
    EXPECT_TRUE(said) << said.error().message();
  }
  const Json light = virtual_rig()["status"]["light"];
  EXPECT_EQ(light["dead"], Json::array({3}));
  EXPECT_EQ(light["ambient"], 0.1);
}

TEST_F(ToldRig, SaysWhatItDoesNotUnderstand) {
  const Result<Json> said = tell("light dead 77");
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(said.error().message(), testing::HasSubstr("LEDs are 1 to"));
}

}  // namespace
}  // namespace weft::bench
