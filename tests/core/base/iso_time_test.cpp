// SPDX-License-Identifier: Apache-2.0
#include "core/base/iso_time.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

TEST(IsoTime, WritesATimeAsPeopleAndProgramsReadIt) {
  EXPECT_EQ(iso_time(1795271101.25), "2026-11-21T14:25:01.250Z");
  EXPECT_EQ(iso_time(0), "1970-01-01T00:00:00.000Z");
}

TEST(IsoTime, ReadsBackWhatItWrote) {
  for (const double seconds : {0.0, 951782400.0, 1795271101.25, -86400.5}) {
    EXPECT_EQ(seconds_of_iso_time(iso_time(seconds)), seconds) << iso_time(seconds);
  }
}

TEST(IsoTime, KnowsZones) {
  EXPECT_EQ(seconds_of_iso_time("1970-01-02T00:00:00Z"), 86400.0);
  EXPECT_EQ(seconds_of_iso_time("1970-01-02T00:00:00"), 86400.0) << "without a zone it is UTC";
  EXPECT_EQ(seconds_of_iso_time("1970-01-01T02:00:00+02:00"), 0.0);
  EXPECT_EQ(seconds_of_iso_time("1969-12-31T22:30:00-01:30"), 0.0);
  EXPECT_EQ(seconds_of_iso_time("1970-01-01T00:00:00.5Z"), 0.5);
}

TEST(IsoTime, RefusesWhatIsNoTime) {
  for (const char* wrong : {"", "yesterday", "2026-13-01T00:00:00Z", "2026-01-01", "2026-01-01T00:00:00 UTC"})
    EXPECT_FALSE(seconds_of_iso_time(wrong)) << wrong;
}

}  // namespace
}  // namespace weft
