// SPDX-License-Identifier: Apache-2.0
// What scripts rely on: JSON fields, exit codes, and help that says units and defaults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/base/process.h"
#include "tests/core/places.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

using CommandLine = SessionTest;

TEST_F(CommandLine, SolvePrintsOneJsonDocument) {
  // From another folder and by a relative path: the paths that come back are absolute.
  const Outcome run = run_weft({"solve", "cloth.weft", "--json"}, {.folder = work_.path()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = run.json();
  for (const char* map : {"normal", "albedo"}) {
    const fs::path file = json.at(map).get<std::string>();
    EXPECT_TRUE(file.is_absolute()) << file;
    EXPECT_TRUE(fs::exists(file)) << file;
  }
  double sum = 0;
  for (const char* part : {"read", "solve", "write", "sync"}) {
    EXPECT_GE(json.at("seconds").at(part).get<double>(), 0) << part;
    sum += json["seconds"][part].get<double>();
  }
  EXPECT_LE(sum, json.at("seconds").at("total").get<double>() + 1e-6) << json;
  EXPECT_GT(json.at("peak_bytes").get<std::int64_t>(), 1 << 20);
  EXPECT_EQ(json.at("pixels"), 48 * 32);
  for (const char* name : {"SATURATED", "SHADOWED", "ZERO_DOF", "DARK", "ILL_CONDITIONED", "NO_SOLUTION",
                           "SPECULAR", "INVALID_READING"}) {
    EXPECT_TRUE(json.at("status").at(name).is_number_integer()) << name;
  }
  EXPECT_THAT(run.error, testing::HasSubstr("solve"));  // progress keeps off standard output
}

TEST_F(CommandLine, TellsItsProgressItsErrorsAndItsEndAsLinesOfJson) {
  const auto events_of = [&](const Words& words) {
    std::vector<Json> events;
    std::istringstream lines(run_weft(words, {.folder = work_.path()}).error);
    for (std::string line; std::getline(lines, line);) events.push_back(Json::parse(line, nullptr, false));
    return events;
  };
  const std::vector<Json> solved = events_of({"solve", "cloth.weft", "--json-events"});
  ASSERT_GE(solved.size(), 2U);
  EXPECT_EQ(solved.front()["event"], "progress");
  EXPECT_EQ(solved.front()["phase"], "read");
  EXPECT_GE(solved.front()["share"], 0);
  EXPECT_EQ(solved.back(), Json({{"event", "end"}, {"exit_code", 0}}));

  const std::vector<Json> failed = events_of({"solve", "nothing.weft", "--json-events"});
  ASSERT_EQ(failed.size(), 2U);
  EXPECT_EQ(failed[0]["event"], "error");
  EXPECT_EQ(failed[0]["kind"], "no_input");
  EXPECT_NE(failed[0]["remedy"], "");
  EXPECT_EQ(failed[1]["exit_code"], 66);
}

TEST_F(CommandLine, ASolveHasAllItsFiles) {
  const Outcome run = run_weft({"solve", session_.string(), "-o", (work_ / "maps").string(), "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(run.error, "");
  for (const char* name : {"normal.exr", "albedo.exr", "sigma.exr", "residual.exr", "status.png",
                           "solve.json", "normal.png", "albedo.png", "sheet.png"}) {
    EXPECT_TRUE(fs::exists(work_ / "maps" / name)) << name;
  }
  EXPECT_EQ(Json::parse(bytes_of(work_ / "maps" / "solve.json")).at("schema"), "weft.solve/1.1");
}

TEST_F(CommandLine, CompareOfNormalsPrintsOneJsonDocument) {
  const std::string truth = (session_ / "truth" / "normal.exr").string();
  const Outcome run = run_weft({"compare", truth, truth, "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = run.json();
  EXPECT_EQ(json.at("pixels"), 48 * 32);
  for (const char* field : {"mean_deg", "median_deg", "p95_deg", "max_deg"})
    EXPECT_LT(json.at(field), 1e-4) << field;
}

TEST_F(CommandLine, CompareOfAlbedosPrintsOneJsonDocument) {
  const std::string truth = (session_ / "truth" / "albedo.exr").string();
  const Outcome run = run_weft({"compare", truth, truth, "--kind", "albedo", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = run.json();
  EXPECT_EQ(json.at("pixels"), 48 * 32);
  for (const char* field : {"mean_rel", "bias_rel"}) EXPECT_EQ(json.at(field), 0) << field;
}

TEST_F(CommandLine, OutputThatCannotBeWrittenIsAnError) {
  const std::string truth = (session_ / "truth" / "normal.exr").string();
  for (const char* form : {"--json", "--quiet"}) {
    const Outcome run = run_weft({"compare", truth, truth, form}, {.full_output = true});
    EXPECT_EQ(run.exit_code, 74) << form;
    EXPECT_THAT(run.error,
                testing::AllOf(testing::HasSubstr("cannot write"), testing::HasSubstr("standard output"),
                               testing::HasSubstr("No space left")));
  }
}

TEST_F(CommandLine, CompareOfMapsOfTwoSizesIsRefused) {
  PhotographSample().write(work_ / "photos");
  expect_refusal(work_,
                 {"compare", (session_ / "truth" / "normal.exr").string(),
                  (work_ / "photos" / "normal_gt.exr").string()},
                 65, {"differ in size", "normal_gt.exr", "40 x 30", "48 x 32", "same photographs"});
}

TEST_F(CommandLine, CompareOfAMissingMapIsRefused) {
  expect_refusal(work_,
                 {"compare", (work_ / "no.exr").string(), (session_ / "truth" / "normal.exr").string()}, 66,
                 {"cannot read", "no.exr", "No such file", "check the path"});
}

TEST_F(CommandLine, SimulatePrintsOneJsonDocument) {
  put_bytes(work_ / "scene.toml", simulator::to_toml(scene_named("golden", {48, 32})));
  const Outcome run =
      run_weft({"simulate", "scene.toml", "-o", "new.weft", "--json"}, {.folder = work_.path()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(run.json().at("frames"), 11);
  EXPECT_EQ(run.json().at("session"), (work_ / "new.weft").string());
}

TEST_F(CommandLine, ExplainListsThePassesAndWhatWasLeftOut) {
  put_bytes(work_ / "scene.toml", simulator::to_toml(scene_named("flat", {48, 32})));
  const Outcome run =
      run_weft({"simulate", "scene.toml", "-o", "new.weft", "--explain", "-q"}, {.folder = work_.path()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_THAT(run.output, testing::AllOf(testing::ContainsRegex("near light +the scene names near_light"),
                                         testing::ContainsRegex("near light +[0-9.]+ +[0-9.]+%"),
                                         testing::ContainsRegex("noise +no bound")));
}

TEST_F(CommandLine, SimulateLeavesOutWhatATolerancePermits) {
  const std::string rest = "[camera]\nwidth = 48\nheight = 32\n[geometry]\nfamily = \"smooth\"\n";
  put_bytes(work_ / "auto.toml", "effects = \"auto\"\nto = \"0.25 sigma\"\n" + rest);
  put_bytes(work_ / "named.toml", "effects = [\"near_light\"]\n" + rest);
  const auto left_out = [&](const std::string& to) {
    const Outcome run =
        run_weft({"simulate", "auto.toml", "-o", "to" + to + ".weft", "--to", to, "--json", "-q"},
                 {.folder = work_.path()});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.json().at("left_out").size();
  };
  EXPECT_LT(left_out("0.001"), left_out("100"));
  const Outcome named =
      run_weft({"simulate", "named.toml", "-o", "named.weft", "--to", "1"}, {.folder = work_.path()});
  EXPECT_EQ(named.exit_code, 64);
  EXPECT_THAT(named.error, testing::HasSubstr("it names them"));
}

TEST_F(CommandLine, SimulateLeavesOutWhatTheTimeAsksFor) {
  put_bytes(work_ / "auto.toml",
            "effects = \"auto\"\n[camera]\nwidth = 48\nheight = 32\n[geometry]\nfamily = \"smooth\"\n");
  const auto within = [&](double seconds, const std::string& name) {
    return run_weft({"simulate", "auto.toml", "-o", name, "--within", fmt::format("{}", seconds), "--json"},
                    {.folder = work_.path()});
  };
  const auto outcome = within(1000, "all.weft");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const Json all = outcome.json();
  const double seconds = all.at("foretold").at("seconds");
  EXPECT_EQ(all.at("foretold").at("to_sigma"), 0.001);
  const auto tight = within(seconds / 2, "half.weft");
  ASSERT_EQ(tight.exit_code, 0) << tight.error;
  const Json half = tight.json();
  EXPECT_LE(half.at("foretold").at("seconds"), seconds / 2);
  EXPECT_GT(half.at("foretold").at("to_sigma"), 0.001);
  EXPECT_GT(half.at("left_out").size(), all.at("left_out").size()) << tight.output;
  const auto none = within(1e-3, "none.weft");
  EXPECT_EQ(none.exit_code, 64);
  EXPECT_THAT(none.output, testing::AllOf(testing::HasSubstr("no scene is that quick"),
                                          testing::HasSubstr("fewer pixels")));
}

TEST_F(CommandLine, ExplainPricesWhatAutoLeavesOut) {
  put_bytes(work_ / "scene.toml",
            "effects = \"auto\"\nto = \"0.25 sigma\"\n[camera]\nwidth = 64\nheight = 64\n"
            "[geometry]\nfamily = \"smooth\"\n");
  const Outcome run =
      run_weft({"simulate", "scene.toml", "-o", "new.weft", "--explain", "-q"}, {.folder = work_.path()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_THAT(run.output, testing::AllOf(testing::ContainsRegex("noise +noise, "),
                                         testing::ContainsRegex("cast_shadows +0 +")));
}

TEST_F(CommandLine, SimulateRendersOneFrameAlone) {
  put_bytes(work_ / "scene.toml", simulator::to_toml(scene_named("golden", {48, 32})));
  ASSERT_EQ(run_weft({"simulate", "scene.toml", "-o", "a.weft", "-q"}, {.folder = work_.path()}).exit_code,
            0);
  const Outcome alone =
      run_weft({"simulate", "scene.toml", "--led", "3", "-o", "three.dng", "-q"}, {.folder = work_.path()});
  ASSERT_EQ(alone.exit_code, 0) << alone.error;
  EXPECT_EQ(*sha256_of_file(work_ / "three.dng"), *sha256_of_file(work_ / "a.weft/raw/02_led03.dng"));
  EXPECT_EQ(
      run_weft({"simulate", "scene.toml", "--led", "11", "-o", "x.dng"}, {.folder = work_.path()}).exit_code,
      64);
}

TEST_F(CommandLine, StrictEndsWith2WherePixelsHaveNoSolution) {
  PhotographSample().write(work_ / "photos");
  Image<float> mask({40, 30});
  for (int y = 0; y < 30; ++y) std::fill_n(mask.plane().row(y), 20, 1.0F);
  const std::array<View<const float>, 1> planes = {mask.plane()};
  ASSERT_TRUE(write_image(work_ / "photos" / "mask.png", planes, {"Y"}, {.type = SampleType::kUint8}));
  const Words arguments = {"solve", "--photos", "photos", "-q", "-o"};
  Words strict = arguments, lax = arguments;
  strict.insert(strict.end(), {"a", "--strict"});
  lax.emplace_back("b");
  EXPECT_EQ(run_weft(strict, {.folder = work_.path()}).exit_code, 2);
  EXPECT_EQ(run_weft(lax, {.folder = work_.path()}).exit_code, 0);
}

TEST_F(CommandLine, PhotographsSayAloudHowTheyAreTaken) {
  PhotographSample eight_bits;
  eight_bits.ending = ".png";
  eight_bits.type = SampleType::kUint8;
  eight_bits.write(work_ / "eight");
  PhotographSample().write(work_ / "float");
  EXPECT_THAT(run_weft({"solve", "--photos", "eight"}, {.folder = work_.path()}).output,
              testing::HasSubstr("taken as sRGB, as 8 bits are where nothing says otherwise"));
  EXPECT_THAT(run_weft({"solve", "--photos", "float"}, {.folder = work_.path()}).output,
              testing::HasSubstr("taken as linear, as floats are where nothing says otherwise"));
}

TEST(Bench, PrintsOneJsonDocument) {
  const Outcome run = run_weft({"bench", "solve", "--megapixels", "0.01", "--json", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = run.json();
  EXPECT_TRUE(json.contains("machine"));
  ASSERT_FALSE(json.at("rows").empty());
  for (const Json& row : json["rows"]) {
    EXPECT_TRUE(row.contains("quality") || row.contains("method") || row.contains("effect")) << row;
    EXPECT_GT(row.at("threads").get<int>(), 0) << row;
    // Whole levels: a line over two sizes, which on so few pixels may come out flat.
    if (row.contains("fixed_s")) {
      EXPECT_GE(row.at("ns_per_pixel").get<double>(), 0) << row;
      continue;
    }
    EXPECT_GT(row.at("ns_per_pixel").get<double>(), 0) << row;
    EXPECT_GT(row.at("ratio_to_copy").get<double>(), 0) << row;
  }
}

TEST(Bench, IsMissedBesideAWeftThatWasInstalledAlone) {
  const Workspace work;
  fs::copy(program_path("weft"), work / "weft");
  const auto weft = ChildProcess::start({(work / "weft").string(), "bench", "solve"}, {}, work / "bench.log");
  ASSERT_TRUE(weft) << weft.error().message();
  EXPECT_EQ((*weft)->wait(300), 66);
  EXPECT_THAT((*weft)->said(), testing::AllOf(testing::HasSubstr((work / "weft-bench").string()),
                                              testing::HasSubstr("build all of weft")));
}

TEST(Demo, LeavesASessionSolvedAtEveryLevelAndSaysWhatEachCosts) {
  const Workspace work;
  const Outcome run = run_weft({"demo", source_file("testdata/scenes/plain.toml").string(), "--megapixels",
                                "0.01", "-o", (work / "demo").string(), "-q", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = run.json();
  EXPECT_TRUE(fs::exists(json.at("sheet").get<std::string>())) << run.output;
  EXPECT_TRUE(fs::exists(json.at("ladder").get<std::string>())) << run.output;
  ASSERT_EQ(json.at("levels").size(), 5U) << "preview to reference";
  for (const Json& level : json["levels"]) {
    EXPECT_GT(level["foretold"]["mean_deg"], 0.0) << level;
    EXPECT_GT(level["taken"]["seconds"], 0.0) << level;
    EXPECT_EQ(level["true_deg"].is_number(), level["quality"] != "preview") << level;
  }
  EXPECT_THAT(json["levels"].dump(), testing::HasSubstr(json["recommended"].get<std::string>()));
  // plain.toml names near light and noise; a lens that spreads nothing else would change what is seen.
  std::map<std::string, double> left_out;
  for (const Json& effect : json.at("left_out"))
    left_out[effect["effect"]] = effect["bound_sigma"].is_null() ? 1e9 : effect["bound_sigma"].get<double>();
  EXPECT_FALSE(left_out.contains("noise")) << json["left_out"];
  ASSERT_TRUE(left_out.contains("translucency") && left_out.contains("veil")) << json["left_out"];
  EXPECT_EQ(left_out["translucency"], 0) << "no light enters these yarns";
  EXPECT_GT(left_out["veil"], 1) << "what the scene does not ask for is told all the same";
}

struct Verb {
  Words words;
  Words help;  ///< units and defaults that its help must name
};

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = {
      {{"simulate"}, {"units", "must not exist", "0 is all the machine has"}},
      {{"solve"},
       {"numbered from 1", "default all", "default the session's own", "default SESSION/solve/ID", "=none",
        "=auto", "Columns", "Rows", "x right, y up, z to the camera"}},
      {{"compare"}, {"degrees", "relative", "=auto"}},
      {{"bench", "solve"}, {"millions of pixels", "=4"}},
      {{"demo"}, {"millions of pixels", "=demo"}},
      {{"rig", "plan"}, {"seconds a shot", "=satin", "degrees; default 20", "default 0.04", "$WEFT_RIG"}},
      {{"torture"}, {"=torture.weft", "may be there already", "degrees, pixels or percent"}},
      {{"sample"}, {"=sample.weft", "may be there already"}}};
  return all;
}

TEST(Help, OfTheProgramNamesEveryVerbAndExitCode) {
  const Outcome run = run_weft({"--help"});
  EXPECT_EQ(run.exit_code, 0);
  for (const Verb& verb : verbs()) EXPECT_THAT(run.output, testing::HasSubstr(verb.words.front()));
  for (const char* code : {"64 usage", "65 bad data", "66 no input", "73 cannot create", "74 input/output",
                           "75 try again", "130 interrupted"}) {
    EXPECT_THAT(run.output, testing::HasSubstr(code));
  }
}

TEST(Help, OfEveryVerbNamesUnitsAndDefaults) {
  for (const Verb& verb : verbs()) {
    SCOPED_TRACE(joined(verb.words));
    Words arguments = verb.words;
    arguments.emplace_back("--help");
    const Outcome run = run_weft(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.error;
    for (const std::string& word : verb.help) EXPECT_THAT(run.output, testing::HasSubstr(word));
    EXPECT_EQ(run.error, "");
  }
}

TEST(Help, OfSolveNamesTheLevelThatIsTheDefault) {
  const std::string help = run_weft({"solve", "--help"}).output;
  const std::size_t from = help.find("--quality"), to = help.find("\n  --method");
  ASSERT_LT(from, to) << help;
  EXPECT_THAT(help.substr(from, to - from), testing::HasSubstr("default"));
}

TEST(Help, IsAlsoAVerb) {
  EXPECT_EQ(run_weft({"help"}).output, run_weft({"--help"}).output);
  const Outcome solve = run_weft({"help", "solve"});
  EXPECT_EQ(solve.exit_code, 0);
  EXPECT_EQ(solve.output, run_weft({"solve", "--help"}).output);
  EXPECT_EQ(run_weft({"help", "batch", "plan"}).output, run_weft({"batch", "plan", "--help"}).output);
}

TEST(Help, HasVerbsByTheDayAndNoLineOverAHundredColumns) {
  const std::string help = run_weft({"--help"}).output;
  std::size_t before = 0;
  for (const char* group : {"Scan:", "Calibrate:", "Solve:", "Material:", "Archive:", "Service:", "Try:"}) {
    const std::size_t at = help.find(std::string("\n") + group + "\n");
    ASSERT_NE(at, std::string::npos) << group;
    EXPECT_GT(at, before) << group;
    before = at;
  }
  EXPECT_EQ(help.find("Subcommands:"), std::string::npos) << "each verb has a group";
  for (const Words& words :
       {Words{"help"}, Words{"help", "solve"}, Words{"help", "maps"}, Words{"help", "export"}}) {
    std::istringstream lines(run_weft(words).output);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  }
}

TEST(Usage, ErrorsAreAnObjectForWhoAskedForJson) {
  const Outcome mistyped = run_weft({"solve", "x.weft", "--quality", "fst", "--json"});
  EXPECT_EQ(mistyped.exit_code, 64);
  EXPECT_EQ(mistyped.json()["error"]["kind"], "usage");
  EXPECT_THAT(mistyped.json()["error"]["why"], testing::HasSubstr("did you mean 'fast'"));
  const Outcome missing = run_weft({"solve", "/nowhere/x.weft", "--json"});
  EXPECT_EQ(missing.exit_code, 66);
  EXPECT_EQ(missing.json()["error"]["where"], "/nowhere/x.weft");
  EXPECT_THAT(missing.error, testing::HasSubstr("there is no such session")) << "people are told too";
}

TEST(Usage, AFolderThatIsNoSessionIsToldHowPhotographsAreSolved) {
  const Workspace work;
  const Outcome run = run_weft({"solve", work.path().string()});
  EXPECT_EQ(run.exit_code, 66);
  EXPECT_THAT(run.error, testing::AllOf(testing::HasSubstr("it holds no session.json"),
                                        testing::HasSubstr("weft solve --photos")));
}

TEST(Usage, AnUnknownOptionOfAnyVerbIsNamed) {
  const Workspace work;
  const Words commands[] = {{"simulate", "a.toml", "-o", "b"},
                            {"simulate"},
                            {"solve", "a.weft"},
                            {"compare", "a.exr", "b.exr"},
                            {"bench", "solve"},
                            {"demo", "a.toml"},
                            {}};
  for (Words arguments : commands) {
    SCOPED_TRACE(joined(arguments));
    arguments.emplace_back("--no-such-option");
    expect_refusal(work, arguments, 64, {"--no-such-option"}, {.folder = work.path()});
  }
}

TEST(Usage, AWordTooManyIsNamed) {
  const Workspace work;
  expect_refusal(work, {"solve", "a.weft", "b.weft"}, 64, {"b.weft"}, {.folder = work.path()});
  expect_refusal(work, {"compare", "a.exr", "b.exr", "c.exr"}, 64, {"c.exr"}, {.folder = work.path()});
}

TEST(Usage, ErrorsEndWith64AndLeaveNothing) {
  const Workspace work;
  const std::pair<Words, Words> wrong[] = {
      {{}, {"a verb is missing"}},
      {{"weave"}, {"weave"}},
      {{"simulate"}, {"scene"}},
      {{"simulate", "a.toml"}, {"--output"}},
      {{"solve"}, {"session, --photos or --lp is required"}},
      {{"solve", "a.weft", "--photos", "b"}, {"--photos"}},
      {{"solve", "a.weft", "--quality", "perfect"}, {"--quality", "perfect"}},
      {{"solve", "a.weft", "--method", "magic"}, {"--method", "magic"}},
      {{"solve", "a.weft", "--method", "seed", "--quality", "fast"}, {"--method"}},
      {{"solve", "a.weft", "--lights", "0,1,2"}, {"--lights"}},
      {{"solve", "a.weft", "--lights", "one"}, {"--lights"}},
      {{"solve", "a.weft", "--threads", "-1"}, {"--threads"}},
      {{"solve", "a.weft", "--threads", "many"}, {"--threads"}},
      {{"solve", "a.weft", "--tile-width", "0"}, {"--tile-width"}},
      {{"solve", "a.weft", "--compress", "rar"}, {"--compress"}},
      {{"solve", "--photos", "b", "--transfer", "log"}, {"--transfer"}},
      {{"solve", "--photos", "b", "--calibration", "c"}, {"--calibration"}},
      {{"compare", "a.exr"}, {"truth"}},
      {{"compare", "a.exr", "b.exr", "--kind", "height"}, {"--kind", "height"}},
      {{"bench"}, {"a verb is missing"}},
      {{"bench", "solve", "--megapixels", "0"}, {"--megapixels"}}};
  for (const auto& [arguments, words] : wrong) {
    SCOPED_TRACE("weft " + joined(arguments));
    expect_refusal(work, arguments, 64, words, {.folder = work.path()});
  }
}

}  // namespace
}  // namespace weft::test
