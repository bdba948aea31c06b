// SPDX-License-Identifier: Apache-2.0
#include "tests/system/fault_matrix.h"

namespace weft {
namespace {

// Some faults of each kind, every one once, the fourth while films and the light below are photographed:
// all of them, a thousand runs, are the soak.
void expect_each_goes_right(const std::vector<std::string>& faults) {
  test::expect_no_run_goes_wrong(static_cast<int>(faults.size()), static_cast<int>(faults.size()), faults);
}

TEST(FaultMatrix, OfTheCameraLosesMislabelsAndHalvesNoFrame) {
  expect_each_goes_right({"transfer ends early", "camera off between exposures",
                          "USB cable pulled in the transfer", "camera does not answer"});
}

TEST(FaultMatrix, OfBoardAndLightLosesMislabelsAndHalvesNoFrame) {
  expect_each_goes_right(
      {"board unplugged and plugged in", "wires swapped", "room light goes on", "LED stays lit"});
}

TEST(FaultMatrix, OfTheCamerasClockLosesMislabelsAndHalvesNoFrame) {
  expect_each_goes_right(
      {"camera's clock set back", "camera's clock set ahead", "camera's clock begins anew"});
}

TEST(FaultMatrix, OfProgramsAndPowerLosesMislabelsAndHalvesNoFrame) {
  expect_each_goes_right(
      {"disk is full", "weft serve is killed", "power cut of camera and board", "weft is killed"});
}

}  // namespace
}  // namespace weft
