// SPDX-License-Identifier: Apache-2.0
// From photographs to exports: what weft status says of a session, and what weft make makes of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/rig/session.h"
#include "core/solve/solve_record.h"
#include "tests/system/typed_session.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Chain : public TypedSession {
 protected:
  Json links() const { return json_of("status cloth.weft")["sessions"][0]["links"]; }
  static std::vector<std::string> freshness_of(const Json& links) {
    std::vector<std::string> all;
    for (const Json& link : links) all.push_back(link["freshness"]);
    return all;
  }
  std::vector<std::string> freshness() const { return freshness_of(links()); }
  std::string why(std::size_t link) const { return links()[link].value("why", Json::array()).dump(); }
  static std::vector<std::string> names_of(const Json& report) {
    std::vector<std::string> all;
    for (const Json& made : report["made"]) all.push_back(made["name"]);
    return all;
  }
};

TEST_F(Chain, IsMadeToItsEndAndNothingTwice) {
  EXPECT_THAT(freshness(), ElementsAre("fresh", "missing", "missing", "missing"));
  ASSERT_EQ(weft("solve cloth.weft --quality preview --no-previews -q").exit_code, 0);
  EXPECT_THAT(freshness(), ElementsAre("fresh", "draft", "missing", "missing"));
  EXPECT_EQ(weft("status cloth.weft --strict").exit_code, 2);

  const Json foretold = json_of("make cloth.weft --preset png16 --explain");
  EXPECT_EQ(foretold["steps"].size(), 3U) << foretold["steps"];
  EXPECT_THAT(foretold["made"], IsEmpty());
  EXPECT_FALSE(fs::exists(session_ / "maps"));

  const Json made = json_of("make cloth.weft --preset png16");
  EXPECT_THAT(names_of(made), ElementsAre("solve", "maps", "export"));
  EXPECT_THAT(freshness_of(made["chain"]["links"]), ElementsAre("fresh", "fresh", "fresh", "fresh"));
  EXPECT_NE(made["chain"]["links"][1]["level"], "preview");
  EXPECT_GT(made["chain"]["links"][3]["mean_deg"], 0.0) << "the error of the solve that the files are of";
  EXPECT_TRUE(fs::exists(session_ / "export/png16/export.json"));
  EXPECT_EQ(weft("status cloth.weft --strict").exit_code, 0);

  const Json again = json_of("make cloth.weft");
  EXPECT_THAT(again["steps"], IsEmpty());
  EXPECT_EQ(again["chain"], made["chain"]);
  EXPECT_THAT(weft("make cloth.weft").output, HasSubstr("nothing to make"));
}

TEST_F(Chain, IsStaleFromTheFirstThingThatChangedAndMadeAgainFromThere) {
  json_of("make cloth.weft --preset png16");
  photograph_again(3);
  EXPECT_THAT(freshness(), ElementsAre("fresh", "stale", "stale", "stale"));
  for (const std::size_t link : {1U, 2U, 3U})
    EXPECT_THAT(why(link), HasSubstr("was photographed again since"));
  EXPECT_THAT(names_of(json_of("make cloth.weft")), ElementsAre("solve", "maps", "export"));
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "fresh", "fresh"));

  fs::remove_all(session_ / "maps");
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "missing", "stale"));
  EXPECT_THAT(names_of(json_of("make cloth.weft")), ElementsAre("maps"))
      << "the same maps have the same id, and the export is of them";
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "fresh", "fresh"));
}

TEST_F(Chain, SaysThatTheSolverOrTheCalibrationIsAnotherSince) {
  json_of("make cloth.weft");
  const fs::path solve = fs::path(links()[1]["folder"].get<std::string>()) / "solve.json";
  edit_json(solve, [](Json& json) { json["solver_version"] = kSolverVersion - 1; });
  EXPECT_THAT(freshness(), ElementsAre("fresh", "stale", "stale", "missing"));
  EXPECT_THAT(why(1), HasSubstr("version " + std::to_string(kSolverVersion - 1) + " of the solver made it"));
  edit_json(solve, [](Json& json) {
    json["solver_version"] = kSolverVersion;
    json["input"]["calibration"] = std::string(64, 'a');
  });
  fs::last_write_time(session_ / "calibration/calibration.json",
                      fs::last_write_time(solve) + std::chrono::seconds(1));
  EXPECT_THAT(freshness(), ElementsAre("fresh", "stale", "stale", "missing"));
  EXPECT_THAT(why(1), HasSubstr("and it was made with aaaaaaaaaaaa"));
}

TEST_F(Chain, SaysInOneLineWhatTheScanIsWorthAndWhatToDo) {
  const auto verdict = [&] { return json_of("status cloth.weft")["sessions"][0]["verdict"]; };
  EXPECT_EQ(verdict()["grade"], "good") << verdict();
  EXPECT_EQ(verdict()["says"], "nothing is wrong with its photographs");
  json_of("make cloth.weft");
  EXPECT_EQ(verdict()["grade"], "good") << verdict();
  EXPECT_THAT(verdict()["says"].get<std::string>(), HasSubstr("degrees on 100 % of the cloth"));
  EXPECT_EQ(verdict()["action"], "");

  // As a scan writes it down of LEDs that are over, of a little of one that is, and of a scan that is dark.
  const auto expose = [&](double clipped, double room, int led) {
    edit_json(session_ / "session.json", [&](Json& json) {
      for (Json& shot : json["shots"]) {
        if (shot["role"] != "lit") continue;
        const bool is_it = led == 0 || shot["led"] == led;
        shot["exposed"] = {{"clipped", is_it ? clipped : 0.0}, {"room", is_it ? room : 1.0}};
      }
    });
  };
  expose(0.001, 0.9, 3);
  EXPECT_EQ(verdict()["grade"], "usable") << verdict();
  EXPECT_THAT(verdict()["says"].get<std::string>(),
              HasSubstr("LED 3 has up to 0.1 percent of a channel full"));
  EXPECT_THAT(verdict()["action"].get<std::string>(), HasSubstr("scan again with a shorter exposure"));
  expose(0.9, 0.1, 0);
  EXPECT_EQ(verdict()["grade"], "take it again") << verdict();
  EXPECT_THAT(verdict()["says"].get<std::string>(), HasSubstr("All 10 LEDs are over"));
  EXPECT_EQ(verdict()["action"], "scan again with a metered exposure");
  expose(0, 32, 0);
  EXPECT_EQ(verdict()["grade"], "take it again") << verdict();
  EXPECT_THAT(weft("status cloth.weft").output, HasSubstr("take it again: All 10 LEDs are dark"));
  edit_json(session_ / "session.json", [](Json& json) { json["state"] = "capturing"; });
  EXPECT_EQ(verdict()["grade"], "unfinished") << verdict();
}

TEST_F(Chain, KeepsWhatAPersonChoseAndWhatIsBetterThanAskedFor) {
  const std::string fast = json_of("solve cloth.weft --quality fast")["id"];
  json_of("make cloth.weft --preset png16");
  ASSERT_EQ(json_of("solve cloth.weft --quality robust")["was_there"], false);
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "stale", "stale")) << "a better solve is current";
  EXPECT_EQ(weft("library tag cloth.weft --set current_solve=" + fast).exit_code, 0);
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "fresh", "fresh")) << "a person chose the other";
  EXPECT_THAT(json_of("make cloth.weft")["steps"], IsEmpty());

  json_of("solve cloth.weft --quality reference");
  edit_json(session_ / "session.json", [](Json& json) { json.erase("current_solve"); });
  json_of("make cloth.weft");
  EXPECT_EQ(links()[1]["level"], "reference");
  EXPECT_THAT(json_of("make cloth.weft --within 100")["made"], IsEmpty()) << "nothing that quick is better";
}

TEST_F(Chain, MakesAgainWhatABatchExportedInItsPlace) {
  json_of("make cloth.weft");
  const std::string maps = links()[2]["folder"], id = links()[2]["id"];
  ASSERT_EQ(weft("export " + maps + " --preset png16 -o cloth.weft/export/png16/" + id).exit_code, 0);
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "fresh", "fresh"));
  photograph_again(3);
  EXPECT_THAT(freshness(), ElementsAre("fresh", "stale", "stale", "stale"));
  EXPECT_THAT(names_of(json_of("make cloth.weft")), ElementsAre("solve", "maps", "export"));
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "fresh", "fresh"));
  EXPECT_TRUE(fs::exists(session_ / "export/png16" / links()[2]["id"].get<std::string>() / "export.json"));
}

TEST_F(Chain, IsRefusedBeforeAnythingIsMade) {
  const Outcome no_preset = weft("make cloth.weft --preset png61");
  EXPECT_EQ(no_preset.exit_code, 66);
  EXPECT_THAT(no_preset.error, HasSubstr("png16"));
  const Outcome too_good = weft("make cloth.weft --to 0.0001");
  EXPECT_EQ(too_good.exit_code, 64);
  EXPECT_THAT(too_good.error, HasSubstr("no level is that good"));
  EXPECT_EQ(weft("make nowhere.weft").exit_code, 66);
  EXPECT_FALSE(fs::exists(session_ / "solve"));
  EXPECT_THAT(freshness(), ElementsAre("fresh", "missing", "missing", "missing"));
}

TEST_F(Chain, IsMadeAsFarAsMapsAndExportsNeedIt) {
  const Outcome exported = weft("export cloth.weft --preset png16");
  EXPECT_EQ(exported.exit_code, 0) << exported.error;
  EXPECT_THAT(exported.error, HasSubstr("solve it at "));
  EXPECT_THAT(exported.error, HasSubstr("make its maps"));
  EXPECT_THAT(freshness(), ElementsAre("fresh", "fresh", "fresh", "fresh"));

  fs::remove_all(session_ / "solve");
  fs::remove_all(session_ / "maps");
  const Outcome maps = weft("maps cloth.weft --maps height");
  EXPECT_EQ(maps.exit_code, 0) << maps.error;
  EXPECT_THAT(maps.error, HasSubstr("solve it at "));
  EXPECT_THAT(weft("maps cloth.weft --maps height").error, Not(HasSubstr("solve it at ")));
}

}  // namespace
}  // namespace weft::test
