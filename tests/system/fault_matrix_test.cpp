// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/fault_matrix.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace weft {
namespace {

namespace fs = std::filesystem;

// The first runs of the matrix that `weft bench capture --part faults` goes through.
TEST(FaultMatrix, SixtyRunsLoseMislabelAndHalveNoFrame) {
  const auto tallies = bench::fault_matrix({.programs = fs::path(WEFT_PROGRAM).parent_path(),
                                            .scene = fs::path(WEFT_SOURCE_DIR) / "testdata/scenes/satin.toml",
                                            .megapixels = 0.2,
                                            .runs = 60,
                                            .rigs = 8});
  ASSERT_TRUE(tallies) << tallies.error().message();
  int runs = 0;
  for (const bench::FaultTally& tally : *tallies) {
    runs += tally.runs;
    std::string wrong;
    for (const std::string& one : tally.wrong) wrong += "\n  " + one;
    EXPECT_EQ(tally.lost, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.mislabelled, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.half_written, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.silent, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.complete + tally.resumed, tally.runs) << tally.fault << wrong;
  }
  EXPECT_EQ(runs, 60);
}

}  // namespace
}  // namespace weft
