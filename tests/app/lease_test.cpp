// SPDX-License-Identifier: Apache-2.0
#include "bench/server/server_studies.h"

#include <gtest/gtest.h>

#include "tests/core/places.h"

namespace weft::bench {
namespace {

TEST(LightLease, EndsWithinTwoSecondsOfTheDeathOfClientAndDaemon) {
  StudyOptions options;
  options.programs = program_folder();
  options.scenes = in_sources("testdata/scenes");
  options.runs = 5;
  const auto rows = server_lease_table(options);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 2U);
  for (const Json& row : *rows) {
    EXPECT_EQ(row["late"], 0) << row["death"] << ": dark after " << row["worst_s"] << " s at worst";
    EXPECT_GT(row["median_s"], 0);
  }
}

}  // namespace
}  // namespace weft::bench
