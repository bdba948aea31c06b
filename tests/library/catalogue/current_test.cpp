// SPDX-License-Identifier: Apache-2.0
// Which solve of a session others are made from, and what is said of the others.
#include "solve/session/current.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/solve/solve.h"
#include "library/catalogue/metadata.h"
#include "solver/method.h"
#include "tests/library/catalogue/shelf.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kA = "aaaaaaaaaaaaaaaa";
constexpr const char* kB = "bbbbbbbbbbbbbbbb";
constexpr const char* kC = "cccccccccccccccc";

Json shot(int index, int led, const std::string& role = "lit") {
  return {{"index", index},
          {"led", led},
          {"role", role},
          {"file", "raw/0" + std::to_string(index) + ".dng"},
          {"sha256", "digest" + std::to_string(index)},
          {"exposure_us", 10000},
          {"iso", 100},
          {"f_number", 8}};
}

// A session of three LEDs and a dark shot, with solves that say what they were made of.
class CurrentSolve : public testing::Test {
 protected:
  CurrentSolve() { put(Json::array({shot(0, 1), shot(1, 2), shot(2, 3), shot(3, 0, "dark")})); }

  void put(const Json& shots, const Json& more = Json::object()) {
    Json fields = {{"shots", shots}};
    fields.update(more);
    shelf_.put("a", fields);
  }
  // Each is a minute newer than the one before.
  void solve(const std::string& id, const std::string& level, const Json& shots,
             const Json& more = Json::object()) {
    Json used = Json::array();
    for (const Json& each : shots)
      used.push_back({{"led", each["led"]}, {"file", each["file"]}, {"sha256", each["sha256"]}});
    Json fields = {{"method", level}, {"input", {{"shots", used}}}};
    fields.update(more);
    shelf_.solve("a", id, fields);
    fs::last_write_time(folder_ / "solve" / id / "solve.json",
                        fs::file_time_type::clock::now() + std::chrono::minutes(++solved_ - 100));
  }
  Json shots() const { return read_session(folder_)->document["shots"]; }
  solve::SessionSolves solves() const { return solve::solves_of(*read_session(folder_)); }
  std::string current() const { return solve::current_solve(*read_session(folder_)); }
  void set(const Json& fields) const {
    const Result<MetadataChange> changed = change_metadata(folder_, fields);
    ASSERT_TRUE(changed) << changed.error().message();
  }

  const Shelf shelf_;
  const fs::path folder_ = shelf_.folder_of("a");
  int solved_ = 0;
};

TEST_F(CurrentSolve, IsTheHighestLevelAndOfTwoAlikeTheNewest) {
  EXPECT_EQ(current(), "");
  solve(kA, "standard", shots());
  solve(kB, "preview", shots());
  EXPECT_EQ(current(), kA) << "a preview that is newer is no better";
  solve(kC, "standard", shots());
  EXPECT_EQ(current(), kC);
  fs::remove_all(folder_ / "solve" / kC);
  EXPECT_EQ(current(), kA);
}

TEST_F(CurrentSolve, OrdersLevelsAsTheSolverDoesWithMethodsAboveThePreviewAlone) {
  std::vector<std::string_view> levels;
  for (const solver::MethodName& method : solver::method_names()) {
    if (method.level) levels.emplace_back(method.name);
  }
  EXPECT_TRUE(std::ranges::equal(levels, solve::kLevels));
  for (std::size_t i = levels.size(); i-- > 0;)
    solve("000000000000000" + std::to_string(i), std::string(levels[i]), shots());
  solve(kA, "lts", shots());
  for (const char* expected : {"0000000000000004", "0000000000000003", "0000000000000002", "0000000000000001",
                               kA, "0000000000000000"}) {
    EXPECT_EQ(current(), expected);
    fs::remove_all(folder_ / "solve" / expected);
  }
}

TEST_F(CurrentSolve, IsNoneOfAPhotographThatWasTakenAgain) {
  solve(kA, "reference", shots());
  Json again = shots();
  again[1]["superseded_by"] = 4;
  again.push_back(shot(4, 2));
  put(again);
  EXPECT_THAT(solves().all[0].outdated, HasSubstr("LED 2 was photographed again"));
  const Result<solve::ChoosableSolve> none = solve::solve_for_maps(solves(), "", false);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kNoInput);
  EXPECT_THAT(none.error().remedy, HasSubstr("--quality reference"));
  EXPECT_TRUE(solve::solve_for_maps(solves(), kA, false)) << "a person who names it gets it";
  Json now = again;
  now.erase(1);
  solve(kB, "fast", now);
  EXPECT_EQ(current(), kB) << "any level of today's photographs before the best of others";
  EXPECT_THAT(solve::why_stale(solves(), kA),
              ElementsAre(HasSubstr("LED 2"), HasSubstr("the fast solve bbbbbbbbbbbbbbbb")));
  EXPECT_THAT(solve::why_stale(solves(), kB), IsEmpty());
}

TEST_F(CurrentSolve, FollowsWhatAPersonLeavesOutAndTakesIn) {
  const Json all = shots();
  solve(kA, "standard", all);
  set({{"left_out", {2}}});
  EXPECT_THAT(solves().find(kA)->outdated, HasSubstr("left out now"));
  solve(kB, "standard", Json::array({all[0], all[1], all[3]}));
  EXPECT_EQ(current(), kB);
  set({{"left_out", nullptr}});
  EXPECT_EQ(current(), kA);
  EXPECT_THAT(solves().find(kB)->outdated, HasSubstr("without raw/02.dng"));
}

TEST_F(CurrentSolve, NoticesAnotherFileAnotherLedARepeatAndADarkShot) {
  const Json all = shots();
  solve(kA, "standard", all);
  const auto outdated = [&](const Json& today) {
    put(today);
    return solves().all[0].outdated;
  };
  EXPECT_EQ(outdated(all), "");
  Json other = all;
  other[0]["sha256"] = "other";
  EXPECT_THAT(outdated(other), HasSubstr("raw/00.dng is another file"));
  other = all;
  std::swap(other[0]["led"], other[1]["led"]);
  EXPECT_THAT(outdated(other), HasSubstr("is of LED 2 now"));
  other = all;
  other.push_back(shot(4, 1, "repeat"));
  EXPECT_THAT(outdated(other), HasSubstr("without raw/04.dng"));
  other.back()["exposure_us"] = 20000;
  EXPECT_EQ(outdated(other), "") << "no solve uses a repeat at another exposure";
  other = all;
  other.push_back(shot(4, 0, "below"));
  EXPECT_EQ(outdated(other), "") << "nothing is solved from the light below";
  other = all;
  other[3]["superseded_by"] = 4;
  other.push_back(shot(4, 0, "dark"));
  EXPECT_THAT(outdated(other), HasSubstr("the dark photograph was photographed again"));
}

TEST_F(CurrentSolve, ThatAPersonChoseStandsUntilPhotographsChange) {
  const Json all = shots();
  solve(kA, "fast", all);
  set({{"current_solve", kA}});
  solve(kB, "robust", all);
  EXPECT_EQ(current(), kA) << "a better one does not take its place by itself";
  EXPECT_TRUE(solves().is_chosen);
  EXPECT_THAT(solve::why_stale(solves(), kA), ElementsAre(HasSubstr("robust solve bbbbbbbbbbbbbbbb")));
  set({{"notes", "for the coat"}});
  EXPECT_EQ(current(), kA) << "what is said of a cloth is no photograph";
  set({{"left_out", {2}}});
  const Json some = Json::array({all[0], all[1], all[3]});
  solve(kC, "preview", some);
  EXPECT_EQ(current(), kC);
  set({{"current_solve", kA}});
  EXPECT_EQ(current(), kA) << "chosen again, with these photographs in sight";
  set({{"left_out", nullptr}});
  EXPECT_EQ(current(), kB);
  set({{"current_solve", nullptr}});
  EXPECT_FALSE(read_session(folder_)->document.contains("current_solve_for"));
}

TEST_F(CurrentSolve, ChosenByAnOlderWeftStandsWhileItIsOfTodaysPhotographs) {
  const Json all = shots();
  solve(kA, "fast", all);
  solve(kB, "standard", all);
  put(all, {{"current_solve", kA}});
  EXPECT_EQ(current(), kA);
  Json again = all;
  again[0]["superseded_by"] = 4;
  again.push_back(shot(4, 1));
  put(again, {{"current_solve", kA}});
  EXPECT_EQ(current(), kB) << "both are outdated, and the choice fell with its photographs";
}

TEST_F(CurrentSolve, OfABatchWaitsUntilItIsAccepted) {
  solve(kA, "preview", shots());
  solve(kB, "robust", shots(), {{"plan", "0123"}});
  EXPECT_EQ(current(), kB) << "anything is better than a preview";
  solve(kC, "fast", shots());
  EXPECT_EQ(current(), kC) << "nothing that a person made is replaced by itself";
  set({{"current_solve", kB}});
  EXPECT_EQ(current(), kB);
}

TEST_F(CurrentSolve, ThatIsAPreviewFeedsNothingUnlessItIsAskedFor) {
  const auto refused = [&](const std::string& id) {
    const Result<solve::ChoosableSolve> solve = solve::solve_for_maps(solves(), id, false);
    EXPECT_FALSE(solve);
    return solve ? Error() : solve.error();
  };
  EXPECT_THAT(refused("").remedy, HasSubstr("weft solve " + folder_.string() + " --quality standard"));
  solve(kA, "preview", shots());
  EXPECT_EQ(refused("").kind, ErrorKind::kNoInput);
  EXPECT_THAT(refused("").remedy, HasSubstr("weft solve " + folder_.string() + " --quality standard"));
  EXPECT_EQ(refused(kA).kind, ErrorKind::kUsage);
  EXPECT_TRUE(solve::solve_for_maps(solves(), "", true));
  EXPECT_TRUE(solve::solve_for_maps(solves(), kA, true));
  EXPECT_THAT(refused(kC).what, HasSubstr("no complete solve"));
  solve(kB, "standard", shots());
  EXPECT_EQ(solve::solve_for_maps(solves(), "", true)->id, kB)
      << "a draft is taken where there is nothing better";
  EXPECT_THAT(refused(kA).remedy, HasSubstr("--solve bbbbbbbbbbbbbbbb"));
  set({{"current_solve", kA}});
  EXPECT_THAT(refused("").remedy, HasSubstr("--solve bbbbbbbbbbbbbbbb"));
}

TEST_F(CurrentSolve, KeepsNoMapsOfASolveThatIsNotWhole) {
  solve(kA, "standard", shots(), {{"kept", {"albedo", "normal"}}});
  const Result<solve::ChoosableSolve> lean = solve::solve_for_maps(solves(), "", false);
  ASSERT_FALSE(lean);
  EXPECT_THAT(lean.error().remedy, HasSubstr("--quality standard"));
  solve(kB, "fast", shots());
  EXPECT_EQ(current(), kB);
}

}  // namespace
}  // namespace weft::library
