// SPDX-License-Identifier: Apache-2.0
// A lens that is turned while weft looks through the camera, as a person does it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "bench/server/served_rig.h"
#include "core/base/json_document.h"
#include "core/base/temporary_folder.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

using testing::HasSubstr;

class FocusAtTheRig : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(served_.start(program_folder(), in_sources("testdata/scenes/twill.toml"), 0.05));
    ASSERT_TRUE(served_.serve());
  }

  /// What a test shot says of its focus.
  Json shot(const char* blur_px, double exposure_us = 20000) {
    const auto turned = served_.rig().say(std::string("focus ") + blur_px);
    EXPECT_TRUE(turned) << turned.error().message();
    const Result<Json> begun =
        served_.client().post("/api/v1/rig/test-shot", {{"led", 2}, {"exposure_us", exposure_us}});
    if (!begun) return begun.error().message();
    const std::string path = "/api/v1/rig/test-shots/" + begun->at("id").dump();
    for (;; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
      const Result<Json> taken = served_.client().get(path);
      if (!taken) return taken.error().message();
      if (taken->at("state") != "taking") return taken->at("focus");
    }
  }

  ServedRig served_;
};

TEST_F(FocusAtTheRig, IsBestWhereTheLensIsSharpest) {
  ASSERT_TRUE(served_.client().post("/api/v1/rig/devices", {{"open", true}}));
  Json focus;
  for (const char* blur_px : {"6", "4", "2", "0", "3"}) focus = shot(blur_px);
  ASSERT_TRUE(focus.is_object()) << focus;
  EXPECT_EQ(focus["best"], 3) << focus;
  const auto scores = focus["scores"].get<std::vector<double>>();
  ASSERT_EQ(scores.size(), 5u);
  EXPECT_LT(scores[0], scores[1]);
  EXPECT_LT(scores[1], scores[2]);
  EXPECT_LT(scores[2], scores[3]);
  EXPECT_LT(scores[4], scores[2]);
  EXPECT_EQ(focus["relative"].size(), 48u);
  EXPECT_LT(std::abs(focus["more_right"].get<double>()), 0.2) << "the camera looks straight down";
  EXPECT_EQ(shot("0", 10000)["scores"].size(), 1u) << "another exposure begins anew";
}

TEST_F(FocusAtTheRig, IsToldOnATerminalThroughTheDaemon) {
  const auto weft = served_.rig().weft({"focus", "--shots", "2", "--exposure", "20000"}, "focus.log");
  ASSERT_TRUE(weft) << weft.error().message();
  EXPECT_EQ((*weft)->wait(300), 0) << (*weft)->said();
  EXPECT_THAT((*weft)->said(), HasSubstr("sharpest"));
  EXPECT_THAT((*weft)->said(), HasSubstr("each part of the picture"));
}

TEST_F(FocusAtTheRig, IsLitByOneLedAfterAnother) {
  ASSERT_TRUE(served_.client().post("/api/v1/rig/devices", {{"open", true}}));
  std::vector<int> turns;
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(6500);
  while (std::chrono::steady_clock::now() < end) {
    const Result<Json> lit = served_.client().post("/api/v1/rig/light", {{"round", true}});
    ASSERT_TRUE(lit) << lit.error().message();
    ASSERT_EQ(lit->at("lit").size(), 1u) << *lit;
    const int led = lit->at("lit")[0];
    if (turns.empty() || turns.back() != led) turns.push_back(led);
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
  }
  EXPECT_THAT(turns, testing::ElementsAre(1, 2, 3)) << "each for three seconds, all of them cool";
  const Result<Json> both = served_.client().post("/api/v1/rig/light", {{"round", true}, {"leds", {1}}});
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace weft::bench
