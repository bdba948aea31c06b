// SPDX-License-Identifier: Apache-2.0
// Ctrl-C half-way through work of several megapixels.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

class Interrupt : public testing::Test {
 protected:
  static simulator::Scene large_scene() {
    simulator::Scene scene = scene_named("flat", {2000, 2000});
    scene.lights.rings = {{.count = 4, .zenith_deg = 40}};
    return scene;
  }
  Workspace work_;
};

TEST_F(Interrupt, ASimulationLeavesNothing) {
  put_bytes(work_ / "scene.toml", simulator::to_toml(large_scene()));
  expect_refusal(work_, {"simulate", (work_ / "scene.toml").string(), "-o", (work_ / "new.weft").string()},
                 130, {"interrupted"}, {.interrupt_at = "simulate"});
}

TEST_F(Interrupt, ASolveLeavesNothingAndCanBeRunAgain) {
  const std::string session = (work_ / "cloth.weft").string();
  simulate(large_scene(), session);
  for (const char* phase : {"read", "solve"}) {
    SCOPED_TRACE(phase);
    // The paper's method takes long enough to be caught at it.
    expect_refusal(work_, {"solve", session, "--method", "seed"}, 130, {"interrupted"},
                   {.interrupt_at = phase});
  }
  EXPECT_EQ(run_weft({"solve", session, "--quality", "fast", "--no-previews", "-q"}).exit_code, 0);
}

}  // namespace
}  // namespace weft::test
