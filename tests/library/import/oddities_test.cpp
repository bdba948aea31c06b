// SPDX-License-Identifier: Apache-2.0
#include "library/import/oddities.h"

#include <gtest/gtest.h>

namespace weft::library {
namespace {

ProposedSession session(const std::string& name, const std::string& refused, const std::string& doubt) {
  ProposedSession session;
  session.session.folder = "/archive/" + name + ".weft";
  if (!refused.empty())
    session.refusal = Error{ErrorKind::kBadData, refused, "", name + " says so", "mend it"};
  if (!doubt.empty()) session.warnings = {{doubt, doubt + " in " + name}};
  return session;
}

TEST(Oddities, AreCountedByKindHoweverManyThereAre) {
  ImportProposal plan;
  for (int i = 0; i < 10000; ++i) {
    plan.sessions.push_back(session("s" + std::to_string(i), i % 2 == 0 ? "frames are missing" : "",
                                    i % 2 == 0 ? "" : "a LED did not light"));
    plan.left_over.push_back({"/old/" + std::to_string(i) + ".jpg", "it is a JPEG"});
  }
  const std::vector<ImportOddity> oddities = oddities_of(plan);
  ASSERT_EQ(oddities.size(), 3U);
  EXPECT_EQ(words_of(oddities[0]),
            "5000 sessions are refused: frames are missing: s0.weft, s2.weft, s4.weft and 4997 more. "
            "To do: mend it.");
  EXPECT_EQ(
      words_of(oddities[1]),
      "5000 sessions are to be looked at: a LED did not light: s1.weft, s3.weft, s5.weft and 4997 more.");
  EXPECT_EQ(words_of(oddities[2]),
            "10000 files are left over: it is a JPEG: /old/0.jpg, /old/1.jpg, /old/2.jpg and 9997 more.");
}

TEST(Oddities, OfOneAreSaidInTheSingular) {
  ImportProposal plan;
  plan.sessions = {session("a", "frames are missing", "")};
  EXPECT_EQ(words_of(oddities_of(plan)[0]),
            "1 session is refused: frames are missing: a.weft. To do: mend it.");
}

}  // namespace
}  // namespace weft::library
