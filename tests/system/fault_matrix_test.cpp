// SPDX-License-Identifier: Apache-2.0
#include "tests/system/fault_matrix.h"

namespace weft {
namespace {

TEST(FaultMatrix, SixtyRunsLoseMislabelAndHalveNoFrame) {
  test::expect_no_run_goes_wrong(60, 8);
}

}  // namespace
}  // namespace weft
