// SPDX-License-Identifier: Apache-2.0
// Which solve maps, exports and materials are made of, as a person meets it; and remedies that are followed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/rig/session.h"
#include "solve/report/solve_report.h"
#include "solver/method.h"
#include "tests/system/typed_session.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Solves : public TypedSession {
 protected:
  std::string solved(const std::string& level) const {
    return json_of("solve cloth.weft --no-previews --quality " + level)["id"];
  }
  void expect_refused(const std::string& line, int exit_code, const std::string& words) const {
    const Outcome outcome = weft(line + " -q");
    EXPECT_EQ(outcome.exit_code, exit_code) << line << outcome.output;
    EXPECT_THAT(outcome.error, HasSubstr(words)) << line;
  }
  Json exported() const {
    return Json::parse(bytes_of(session_ / "export" / "png16" / "export.json"))["from"];
  }
  // The command in an error or a verdict that begins so, without what follows it.
  static std::string command_in(const std::string& text, const std::string& begin) {
    const std::size_t from = text.find(begin);
    EXPECT_NE(from, std::string::npos) << begin << " is not in: " << text;
    if (from == std::string::npos) return "";
    const std::size_t end = std::min(text.find_first_of(";,\n", from), text.size());
    std::string command = text.substr(from, end - from);
    const std::size_t and_then = command.find(" and ");
    if (and_then != std::string::npos) command.resize(and_then);
    if (command.ends_with('.')) command.pop_back();
    return command.substr(std::string("weft ").size());
  }
};

TEST_F(Solves, OfAPreviewFeedNoMapUnlessItIsAskedForAndTheRemedyMakesOne) {
  solved("preview");
  const std::string maps = "maps cloth.weft --maps height";
  expect_refused("rectify cloth.weft", 66, "--quality standard");
  EXPECT_THAT(output_of(maps + " --draft"), HasSubstr("from the preview solve"));
  expect_refused("material new a.toml --scan cloth.weft", 64, "draft = true");
  EXPECT_THAT(output_of("export cloth.weft --preset png16 --draft"), HasSubstr("a draft"));
  EXPECT_EQ(exported()["draft"], true);
  EXPECT_THAT(output_of("material new a.toml --scan cloth.weft --draft"),
              HasSubstr("from the preview solve"));
  EXPECT_THAT(output_of("material resolve a.toml"), HasSubstr("from the preview solve"));
  const Json built = json_of("material build a.toml")["materials"][0];
  EXPECT_EQ(built["draft"], true);
  EXPECT_EQ(built["scans"][0]["level"], "preview");
  expect_refused("export a.toml --preset png16", 64, "--draft");

  output_of(command_in(weft("rectify cloth.weft").error, "weft solve"));
  EXPECT_THAT(output_of(maps), AllOf(HasSubstr("from the standard solve"), Not(HasSubstr("stale"))));
  EXPECT_THAT(output_of("export cloth.weft --preset png16"), HasSubstr("from the standard solve"));
  EXPECT_EQ(exported()["draft"], false);
  EXPECT_EQ(exported()["level"], "standard");
}

TEST_F(Solves, ThatAreBetterAreTakenAndWhatIsOlderIsCalledStale) {
  const std::string standard = solved("standard"), fast = solved("fast");
  const Json first = json_of("maps cloth.weft --maps height,occlusion,roughness,cavity");
  EXPECT_EQ(first["solve"], standard) << "the fast one is newer and worse";
  EXPECT_EQ(first["level"], "standard");
  EXPECT_EQ(Json::parse(bytes_of(fs::path(first["folder"].get<std::string>()) / "maps.json"))["level"],
            "standard");
  const std::string robust = solved("robust");
  EXPECT_THAT(output_of("export cloth.weft --preset png16"),
              HasSubstr("stale: the robust solve " + robust + " of "));
  EXPECT_THAT(exported()["stale"].dump(), HasSubstr(robust));
  EXPECT_EQ(json_of("maps cloth.weft --maps height,occlusion,roughness,cavity")["solve"], robust);
  EXPECT_THAT(output_of("export cloth.weft --preset png16"), Not(HasSubstr("stale")));
  EXPECT_EQ(exported()["solve"], robust);

  output_of("library tag cloth.weft --set current_solve=" + fast);
  EXPECT_THAT(output_of("maps cloth.weft --maps height"),
              AllOf(HasSubstr("from the fast solve " + fast), HasSubstr(robust), HasSubstr("is better")));
  photograph_again(3);
  expect_refused("rectify cloth.weft", 66, "LED 3 was photographed again since");
  EXPECT_THAT(output_of("export cloth.weft --preset png16"),
              HasSubstr("stale: LED 3 was photographed again"));
  EXPECT_THAT(output_of("maps cloth.weft --maps height --solve " + robust), HasSubstr("stale: LED 3"));
  output_of(command_in(weft("rectify cloth.weft").error, "weft solve"));
  EXPECT_THAT(output_of("maps cloth.weft --maps height"),
              AllOf(HasSubstr("from the robust solve"), Not(HasSubstr("stale"))));
}

TEST_F(Solves, OfOneSessionHaveTheSetThatWasAskedForLast) {
  solved("fast");
  const Json all = json_of("maps cloth.weft --maps height,occlusion,roughness");
  const std::string tone = R"({"steps":[{"do":"color","exposure":-1}]})";
  const Json finished = json_of("finish cloth.weft --steps " + tone);
  ASSERT_NE(all["id"], finished["id"]);
  output_of("export cloth.weft --preset png16");
  EXPECT_EQ(exported()["maps"], finished["id"]) << "the newest that has what the preset needs";
  const Json scans = [&] {
    output_of("material new a.toml --scan cloth.weft --layer library:dirt/dust");
    return json_of("material build a.toml")["materials"][0]["scans"];
  }();
  EXPECT_EQ(scans[0]["maps"], all["id"]) << "dust follows a height, which the finished set lacks";
  json_of("maps cloth.weft --maps height,occlusion,roughness");
  output_of("export cloth.weft --preset png16");
  EXPECT_EQ(exported()["maps"], all["id"]) << "a set that is asked for again is the newest";
}

// The photographs of two LEDs lie in each other's place.
TEST_F(Solves, WithoutALedThatTheReportSaidToLeaveOutAreTheCurrentOnes) {
  fs::remove_all(session_);
  simulate(scene_named("twill", {240, 160}), session_);
  edit_json(session_ / "session.json", [](Json& json) {
    for (Json& shot : json["shots"]) {
      if (shot["led"] == 2 || shot["led"] == 6) shot["led"] = 8 - shot["led"].get<int>();
    }
  });
  // The remedy of the first warning that names a command; empty: none does.
  const auto remedy = [&] {
    const Json solve = json_of("solve cloth.weft");
    for (const Json& warning : solve["warnings"]) {
      const std::string words = warning["remedy"];
      if (words.find("weft library tag") != std::string::npos) return words;
    }
    return std::string();
  };
  const std::string before = remedy();
  ASSERT_NE(before, "");
  output_of(command_in(before, "weft library tag"));
  EXPECT_EQ(remedy(), "") << "what was said to be done has no effect";
  EXPECT_THAT(output_of("maps cloth.weft --maps height"), Not(HasSubstr("stale")));
}

// Ten LEDs, of which two are exchanged, one is dead and one is weak; a person left out the first shot.
solve::PhotographsSummary faulty(int leds) {
  solve::PhotographsSummary summary;
  for (int led = 1; led <= leds; ++led) {
    summary.numbers.push_back(led);
    summary.shot_of_led[led] = led + 1;
  }
  summary.session = "cloth.weft";
  summary.left_out = {0};
  const auto add = [&](solver::FaultKind kind, std::vector<std::size_t> lights) {
    solver::Fault fault;
    fault.kind = kind;
    fault.lights = std::move(lights);
    fault.moved_deg = 1;
    summary.diagnosis.faults.push_back(std::move(fault));
  };
  add(solver::FaultKind::kExchanged, {1, 3});
  add(solver::FaultKind::kDead, {2});
  add(solver::FaultKind::kGain, {0});
  summary.outshining = 1;
  return summary;
}

TEST(RemediesOfAReport, LeaveShotsOutForGoodWhereThreeLightsStay) {
  const std::vector<Verdict> verdicts = solve::verdicts_of(faulty(10), 0, {}, {});
  ASSERT_EQ(verdicts.size(), 3U);
  EXPECT_THAT(verdicts[0].remedy, HasSubstr("weft library tag cloth.weft --set left_out=0,3,5"));
  EXPECT_THAT(verdicts[1].remedy, HasSubstr("--set left_out=0,4 "));
  EXPECT_THAT(verdicts[2].remedy, HasSubstr("--set left_out=0,2 "));
  for (const Verdict& verdict : solve::verdicts_of(faulty(4), 0, {}, {})) {
    const bool is_of_two = verdict.name == "LEDS_EXCHANGED";
    EXPECT_EQ(verdict.remedy.find("left_out") == std::string::npos, is_of_two) << verdict.remedy;
  }
}

TEST(RemediesOfAReport, NameNoLevelThatRan) {
  const LeftOutFacts unfit = {{.median = 0.3, .rms = 0.3, .readings = 100}, {}};
  for (const solver::MethodName& method : solver::method_names()) {
    if (!method.level) continue;
    solve::PhotographsSummary summary = faulty(10);
    for (const bool has_faults : {true, false}) {
      if (!has_faults) summary.diagnosis.faults.clear();
      for (const Verdict& verdict : solve::verdicts_of(summary, 0.5, unfit, method.level))
        EXPECT_THAT(verdict.remedy, Not(HasSubstr(fmt::format("--quality {}", method.name)))) << verdict.name;
    }
  }
}

// Names of verdicts of maps with their remedies.
class RemediesOfMaps : public Solves {
 protected:
  std::string remedy(const std::string& name, const std::string& steps, const std::string& more = "") const {
    const std::string recipe = steps.empty() ? "" : " --steps " + steps;
    const Json maps = json_of("maps cloth.weft --maps height,occlusion" + recipe + more);
    for (const Json& verdict : maps["verdicts"]) {
      if (verdict["name"] == name) return verdict["remedy"];
    }
    return "";
  }
};

TEST_F(RemediesOfMaps, AreFollowedAndTheVerdictIsAnother) {
  solved("fast");
  const std::string bright = R"({"steps":[{"do":"color","exposure":6}]})";
  const std::string dimmer = R"({"steps":[{"do":"color","exposure":0}]})";
  EXPECT_THAT(remedy("ALBEDO_ABOVE_WHITE", bright), HasSubstr("smaller exposure"));
  EXPECT_THAT(remedy("ALBEDO_BRIGHT", bright), HasSubstr("smaller exposure"));
  for (const char* name : {"ALBEDO_ABOVE_WHITE", "ALBEDO_BRIGHT", "ENERGY"})
    EXPECT_EQ(remedy(name, dimmer), "") << name;

  const std::string coarse = " --mm-per-pixel 1.5", fine = " --mm-per-pixel 0.3";
  EXPECT_THAT(remedy("TEXEL_DENSITY", "", coarse), HasSubstr("--mm-per-pixel"));
  EXPECT_EQ(remedy("TEXEL_DENSITY", "", fine), "");

  const std::string cut = R"({"steps":[{"do":"tile"}]})";
  EXPECT_THAT(remedy("NOT_STRAIGHTENED", cut), HasSubstr("put the step straighten before the step tile"));
  const std::string straight = R"({"steps":[{"do":"straighten"},{"do":"tile"}]})";
  EXPECT_THAT(remedy("NOT_STRAIGHTENED", straight), Not(HasSubstr("put the step straighten")));
}

// What is said of each level: none names itself or one below.
TEST_F(RemediesOfMaps, NameNoLevelThatWasSolved) {
  for (const char* level : {"fast", "reference"}) {
    solved(level);
    const Json maps = json_of("maps cloth.weft");
    ASSERT_FALSE(maps["verdicts"].empty()) << "nothing to be held";
    for (const Json& verdict : maps["verdicts"]) {
      const std::string remedy = verdict["remedy"];
      SCOPED_TRACE(level + (": " + remedy));
      EXPECT_THAT(remedy, Not(HasSubstr(fmt::format("--quality {}", level))));
      if (std::string(level) == "reference") {
        EXPECT_THAT(remedy, Not(HasSubstr("--quality")));
      }
    }
  }
}

}  // namespace
}  // namespace weft::test
