// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/capture_studies.h"

#include <gtest/gtest.h>

#include "tests/core/places.h"

namespace weft::bench {
namespace {

TEST(EvidenceTable, HasNoUndisturbedSessionThatIsRefused) {
  const Result<Rows> rows = capture_evidence_table({.scenes = in_sources("testdata/scenes")});
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), evidence_scenes().size());
  for (const Json& row : *rows) EXPECT_FALSE(row["false_alarm"].get<bool>()) << row;
}

}  // namespace
}  // namespace weft::bench
