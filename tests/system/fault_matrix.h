// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "bench/capture/fault_matrix.h"
#include "tests/core/places.h"

namespace weft::test {

/// Goes through so many runs of the matrix that `weft bench capture --part faults` prints; no frame may be
/// lost, mislabelled or half-written, and no scan may end without a sentence. No faults named: all.
inline void expect_no_run_goes_wrong(int runs, int rigs, const std::vector<std::string>& faults = {}) {
  const auto tallies = bench::fault_matrix({.programs = program_folder(),
                                            .scene = source_folder() / "testdata/scenes/satin.toml",
                                            .megapixels = 0.2,
                                            .runs = runs,
                                            .rigs = rigs,
                                            .faults = faults});
  ASSERT_TRUE(tallies) << tallies.error().message();
  int run = 0;
  for (const bench::FaultTally& tally : *tallies) {
    run += tally.runs;
    std::string wrong;
    for (const std::string& one : tally.wrong) wrong += "\n  " + one;
    EXPECT_EQ(tally.lost, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.mislabelled, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.half_written, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.differing, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.silent, 0) << tally.fault << wrong;
    EXPECT_EQ(tally.complete + tally.resumed, tally.runs) << tally.fault << wrong;
  }
  EXPECT_EQ(run, runs);
}

}  // namespace weft::test
