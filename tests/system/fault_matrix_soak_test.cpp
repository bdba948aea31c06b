// SPDX-License-Identifier: Apache-2.0
#include "tests/system/fault_matrix.h"

namespace weft {
namespace {

TEST(FaultMatrixSoak, AThousandRunsLoseMislabelAndHalveNoFrame) {
  test::expect_no_run_goes_wrong(1000, 16);
}

TEST(FaultMatrixSoak, TwoHundredKillsAtRandomMomentsLeaveASessionThatIsFinished) {
  test::expect_no_run_goes_wrong(
      200, 16,
      {"weft is killed", "weft serve is killed", "weft-camera is killed", "power cut of camera and board"});
}

}  // namespace
}  // namespace weft
