// SPDX-License-Identifier: Apache-2.0
// Exposures as people ask for them, and those that the camera has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/server/served_rig.h"
#include "core/base/json_document.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

using testing::HasSubstr;

class ExposureAtTheRig : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(served_.start(program_folder(), in_sources("testdata/scenes/twill.toml"), 0.05));
    ASSERT_TRUE(served_.serve());
  }

  Json get(const std::string& path) const {
    const Result<Json> said = served_.client().get(path);
    return said ? *said : Json(said.error().message());
  }
  /// What is at a path once it is so.
  template <typename IsSo>
  Json once(const std::string& path, const IsSo& is_so) const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(300);
    Json said = get(path);
    for (; !is_so(said) && std::chrono::steady_clock::now() < until; said = get(path))
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return said;
  }
  Json shot(double exposure_us) const {
    const Result<Json> begun =
        served_.client().post("/api/v1/rig/test-shot", {{"led", 2}, {"exposure_us", exposure_us}});
    if (!begun) return begun.error().message();
    return once("/api/v1/rig/test-shots/" + begun->at("id").dump(),
                [](const Json& said) { return said.value("state", "") != "taking"; });
  }
  /// The exit code of a scan of one LED, and what it said.
  std::pair<int, std::string> scan(const std::string& exposure) const {
    const auto weft = served_.rig().weft(
        {"scan", "--fabric", "twill", "--leds", "1", "--no-repeat", "--no-preview", "--exposure", exposure},
        "scan.log");
    if (!weft) return {-1, weft.error().message()};
    const int code = (*weft)->wait(300).value_or(-1);
    return {code, (*weft)->said()};
  }

  ServedRig served_;
};

TEST_F(ExposureAtTheRig, OfAScanIsWhatTheMeterOfATestShotSaid) {
  ASSERT_TRUE(served_.client().post("/api/v1/rig/devices", {{"open", true}}));
  const Json full = shot(1e6);
  ASSERT_TRUE(full.value("suggested_us", Json()).is_number()) << full;
  const double suggested_us = full["suggested_us"];
  ASSERT_TRUE(served_.client().post("/api/v1/scan", {{"fabric", "twill"}}));
  const Json status =
      once("/api/v1/rig", [](const Json& said) { return said.value("phase", Json()) == "complete"; });
  EXPECT_EQ(status["exposure_us"], suggested_us) << status;
  EXPECT_EQ(shot(suggested_us)["suggested_us"], suggested_us) << "a shot that can be read says the same";
}

TEST_F(ExposureAtTheRig, IsTheCamerasOwnHoweverItIsTyped) {
  for (const auto& [typed, exposure_us] : std::vector<std::pair<std::string, double>>{
           {"1/60", 1e6 / 60}, {"16.2ms", 1e6 / 60}, {"20000", 20000}}) {
    const auto [code, said] = scan(typed);
    ASSERT_EQ(code, 0) << typed << ": " << said;
    EXPECT_NEAR(get("/api/v1/rig")["exposure_us"].get<double>(), exposure_us, 50) << typed;
    EXPECT_EQ(said.find("nearest to 16.2 ms") != std::string::npos, typed == "16.2ms") << said;
  }
}

TEST_F(ExposureAtTheRig, ThatTheCameraDoesNotHaveMakesNoSession) {
  for (const auto& [typed, why] : std::vector<std::pair<std::string, const char*>>{
           {"16.2", "to 30 s"}, {"100s", "to 30 s"}, {"soon", "such as 20us"}, {"1/0", "to 1000000000 us"}}) {
    const auto [code, said] = scan(typed);
    EXPECT_EQ(code, 64) << typed << ": " << said;
    EXPECT_THAT(said, HasSubstr(why)) << typed;
  }
  EXPECT_EQ(get("/api/v1/sessions")["sessions"].size(), 0u);
}

}  // namespace
}  // namespace weft::bench
