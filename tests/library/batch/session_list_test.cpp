// SPDX-License-Identifier: Apache-2.0
#include "library/batch/session_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::library {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(SessionList, IsAFolderALine) {
  EXPECT_THAT(
      sessions_of_text("/a/one.weft\n\n  two cloths.weft/\r\n/archive/2025\n./here\nwords for people\n"),
      ElementsAre("/a/one.weft", "two cloths.weft", "/archive/2025", "./here"));
}

TEST(SessionList, IsTheFirstColumnOfATable) {
  EXPECT_THAT(sessions_of_text("  2 calibrations and 1 check\n\nAffected sessions\n"
                               "  session           taken                 after the move\n"
                               "  /a/twill 1.weft   2026-01-31T10:00:00Z  yes\n"
                               "  /a/x.wefted.weft  2026-01-31T10:00:00Z  perhaps\n"),
              ElementsAre("/a/twill 1.weft", "/a/x.wefted.weft"));
}

TEST(SessionList, IsReadFromTheJsonOfOtherVerbs) {
  EXPECT_THAT(sessions_of_text(R"({"part": "history", "numbers": {"affected": [{"session": "/a.weft"}]}})"),
              ElementsAre("/a.weft"));
  EXPECT_THAT(sessions_of_text(R"({"sessions": [{"folder": "/b.weft"}, {"folder": 7}], "total": 2})"),
              ElementsAre("/b.weft"));
  EXPECT_THAT(sessions_of_text(R"(["/c.weft", "/d.weft"])"), ElementsAre("/c.weft", "/d.weft"));
}

TEST(SessionList, OfNothingIsEmpty) {
  EXPECT_THAT(sessions_of_text(""), IsEmpty());
  EXPECT_THAT(sessions_of_text("{}"), IsEmpty());
  EXPECT_THAT(sessions_of_text("no session here\n"), IsEmpty());
}

}  // namespace
}  // namespace weft::library
