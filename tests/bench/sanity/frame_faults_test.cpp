// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "bench/sanity/frame_faults.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

constexpr std::uint32_t kFrameSeed = 8;  // every fault is drawn strong enough to matter

class FrameFaults : public testing::TestWithParam<std::string> {
 protected:
  // Twill of two colours, rendered once.
  static const test::SimulatedCloth& cloth() {
    static const test::SimulatedCloth made = [] {
      simulator::Scene scene = *simulator::read_scene(source_folder() / "testdata/scenes/dyed_twill.toml");
      return test::SimulatedCloth(test::seen_from_afar(std::move(scene), 320));
    }();
    return made;
  }
};

TEST_P(FrameFaults, AreNamedAndNothingIsSaidWithoutOne) {
  const Result<FrameOutcome> outcome = outcome_of_frames(GetParam(), cloth(), kFrameSeed);
  ASSERT_TRUE(outcome) << outcome.error().message();
  if (GetParam() == "none") {
    EXPECT_EQ(outcome->said, "");
  } else {
    ASSERT_TRUE(outcome->turned_deg > 0.1 || std::abs(outcome->albedo) > 0.01) << "it matters";
    EXPECT_TRUE(outcome->is_named) << GetParam() << " turns by " << outcome->turned_deg
                                   << " degrees, albedo by " << outcome->albedo << ": " << outcome->said;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FrameFaults, testing::ValuesIn(frame_faults()));

}  // namespace
}  // namespace weft::bench
