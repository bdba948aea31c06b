// SPDX-License-Identifier: Apache-2.0
// The commands of README.md and docs/http.md, word by word as they stand in the fences of these pages, from a
// folder of what they name, by relative paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/json_document.h"
#include "tests/core/places.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

struct Command {
  std::string text;
  std::string heading;  ///< it stands below
};

// In fences, each line is one; where any has a prompt, those that have, and what they go on with.
std::vector<Command> commands_of(const std::string& page) {
  std::istringstream lines(page);
  std::vector<Command> commands;
  std::string heading;
  bool is_inside = false, goes_on = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      is_inside = !is_inside;
    } else if (!is_inside) {
      if (line.starts_with("#")) heading = line;
    } else if (goes_on) {
      commands.back().text += "\n" + line;
    } else if (line.starts_with("$ ") || line.starts_with("# ")) {
      commands.push_back({line[0] == '$' ? line.substr(2) : line, heading});
    } else if (line.starts_with("weft ") || line.starts_with("./dev ")) {
      commands.push_back({line, heading});
    }
    goes_on = is_inside && line.ends_with("\\");
  }
  return commands;
}

constexpr int kNoBoard = 69;  // which weft doctor misses

// What cannot run in a scratch folder: how a command begins, or what it stands below.
using Apart = std::vector<std::pair<std::string, std::string>>;

// Those that run; why others do not is printed.
std::vector<std::string> runnable(const std::string& page, const Apart& apart) {
  std::vector<std::string> kept;
  for (const Command& command : commands_of(bytes_of(source_file(page)))) {
    const auto why = std::ranges::find_if(apart, [&](const auto& each) {
      return command.text.starts_with(each.first) || command.heading == each.first;
    });
    if (why == apart.end()) {
      kept.push_back(command.text);
    } else {
      std::cout << "not run, " << why->second << ": " << command.text << '\n';
    }
  }
  return kept;
}

std::string with(std::string text, const std::map<std::string, std::string>& instead) {
  for (const auto& [word, other] : instead) {
    for (std::size_t at = 0; (at = text.find(word, at)) != text.npos; at += other.size())
      text.replace(at, word.size(), other);
  }
  return text;
}

struct Ran {
  int exit_code = -1;
  std::string said;
};

class PageCommands : public testing::Test {
 protected:
  /// In one shell, one after the other, with no settings of whoever runs the tests.
  std::vector<Ran> run(const std::vector<std::string>& commands) const {
    const std::string programs = program_folder().string();
    std::string script = "cd '" + work_.path().string() + "' || exit 1\nexport PATH='" + programs +
                         "':$PATH HOME=\"$PWD/home\"; unset WEFT_RIG XDG_CONFIG_HOME XDG_STATE_HOME\n";
    for (const std::string& command : commands)
      script += "{ " + command + "\n} 2>&1 </dev/null; code=$?; echo; echo \"@@@ $code\"\n";
    put_bytes(work_ / "script.sh", script);
    std::vector<Ran> all(1);
    FILE* const out = popen(("/bin/bash '" + (work_ / "script.sh").string() + "'").c_str(), "re");
    std::array<char, 4096> line = {};
    while (out != nullptr && fgets(line.data(), static_cast<int>(line.size()), out) != nullptr) {
      if (std::sscanf(line.data(), "@@@ %d", &all.back().exit_code) == 1) {
        all.emplace_back();
      } else {
        all.back().said += line.data();
      }
    }
    if (out != nullptr) pclose(out);
    all.pop_back();
    EXPECT_EQ(all.size(), commands.size()) << "the shell ended early";
    all.resize(commands.size());
    return all;
  }

  /// A daemon of `arguments` in the folder, which ends with the shell; its address as $at, the page's for it.
  static std::vector<std::string> serving(const std::string& command, const std::string& state) {
    return {command + " >said.txt 2>&1 & daemon=$!; trap 'kill $daemon; wait $daemon' EXIT",
            "until [ -s " + state +
                "/address ]; do kill -0 $daemon || { cat said.txt; false; break; }; sleep 0.02; done; "
                "at=$(sed s,http://,, " +
                state + "/address)"};
  }

  Workspace work_;
};

TEST_F(PageCommands, OfTheReadmeRunInAFolderOfWhatTheyName) {
  write_photographs(twill_with_ball(4000), work_ / "DIR", SampleType::kUint8, work_ / "truth.exr");
  simulate(scene_named("twill", {256, 192}), work_ / "NAME.weft");
  fs::create_directories(work_ / "archive");
  simulate(scene_named("twill", {48, 32}), work_ / "archive" / "wool.weft");
  put_bytes(work_ / "my.toml", "[[step]]\ndo = \"flatten\"\nalways = true\n");
  fs::create_directories(work_ / "testdata" / "scenes");
  put_bytes(work_ / "testdata" / "scenes" / "satin_sheen.toml",
            to_toml(scene_named("satin_sheen", {48, 32})));
  put_bytes(work_ / "rig.toml", "name = \"virtual rig\"\n[scan]\ncalibration = \"calibration\"\n");
  fs::copy(work_ / "NAME.weft" / "calibration", work_ / "calibration", fs::copy_options::recursive);

  std::vector<std::string> commands = {"weft solve NAME.weft -q"};
  for (const std::string& command : runnable("README.md", {{"./dev", "it builds"},
                                                           {"weft rig test", "it wants a rig"},
                                                           {"weft rig framing", "it wants a rig"},
                                                           {"weft capture", "it wants a rig and a person"},
                                                           {"weft focus", "it wants a rig"},
                                                           {"weft scan", "it wants a rig"},
                                                           {"weft batch submit", "it wants Slurm"}}))
    commands.push_back(with(command, {{"<id>", "*"}, {"/archive", "archive"}}));
  ASSERT_GT(commands.size(), 12U);
  const std::vector<Ran> ran = run(commands);
  for (std::size_t i = 0; i < commands.size(); ++i)
    EXPECT_EQ(ran[i].exit_code, commands[i].starts_with("weft doctor") ? kNoBoard : 0)
        << "$ " << commands[i] << '\n'
        << ran[i].said;
  // What "Your own photographs" made of a folder with a ball and without a light file.
  const auto glb = std::ranges::find_if(
      commands, [](const auto& c) { return c.find("DIR-solve/* --preset glb") != c.npos; });
  ASSERT_NE(glb, commands.end());
  const Ran named = run({"ls DIR-solve/*/export/glb/*.glb"}).front();
  EXPECT_EQ(named.exit_code, 0) << named.said;
  const Ran compared =
      run({"weft compare DIR-solve/*/normal.exr truth.exr --mask DIR/mask.png --json -q"}).front();
  EXPECT_LT(Json::parse(compared.said, nullptr, false).value("mean_deg", 180.0), 3) << compared.said;
}

TEST_F(PageCommands, OfTheServerAreAnsweredByOneOfARelativeRigFile) {
  put_bytes(work_ / "north.toml",
            "name = \"north\"\n[board]\nport = \"/dev/no-board\"\n[camera]\nport = \"ptpip:127.0.0.1:1:1\"\n"
            "[scan]\ncalibration = \"base\"\n[daemon]\nport = 0\n");
  simulate(scene_named("twill", {224, 160}), work_ / "scans" / "satin-3.weft");
  fs::copy(work_ / "scans" / "satin-3.weft" / "calibration", work_ / "base", fs::copy_options::recursive);

  const std::vector<std::string> of_page = runnable(
      "docs/http.md", {{"## A session with curl", "test_curl_session does"},
                       {"## Who may come in", "it wants a daemon with a token, as test_curl_session has it"},
                       {"# systemctl", "it wants a service manager"}});
  ASSERT_GT(of_page.size(), 4U);
  ASSERT_TRUE(of_page.front().starts_with("weft serve")) << of_page.front();
  std::vector<std::string> commands = serving(of_page.front(), "north.state");
  const std::size_t first = commands.size();
  for (std::size_t i = 1; i < of_page.size(); ++i) {
    std::string command = with(of_page[i], {{"127.0.0.1:8470", "$at"}});
    if (command.find("/events") != command.npos) command += " --max-time 1 || true";
    commands.push_back(command);
  }
  commands.emplace_back("curl -s http://$at/api/v1/jobs/000001");
  const std::vector<Ran> ran = run(commands);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    ASSERT_EQ(ran[i].exit_code, 0) << "$ " << commands[i] << '\n' << ran[i].said;
    if (i < first) continue;
    const std::string& said = ran[i].said;
    const Json answer = Json::parse(said, nullptr, false);
    EXPECT_TRUE(!answer.is_object() || !answer.contains("error") || answer["error"].is_null())
        << "$ " << commands[i] << '\n'
        << said;
    EXPECT_GT(said.size(), 2U) << "$ " << commands[i];
  }
  const Json job = Json::parse(ran.back().said, nullptr, false);
  EXPECT_EQ(job.value("of", ""), "satin-3") << ran.back().said;
  EXPECT_NE(job.value("state", ""), "failed") << ran.back().said;
}

TEST_F(PageCommands, AFolderIsCalledByItsNameHoweverItIsWritten) {
  for (const Ran& ran : run({"weft torture -o t.weft/ -q --json", "cd t.weft; weft torture -o . -q --json",
                             "cd raw; weft torture -o .. -q --json"}))
    EXPECT_EQ(Json::parse(ran.said, nullptr, false).value("session", ""), "t") << ran.said;
}

// Without gloss and light between yarns the solve is off by 0.40 degrees on average.
TEST_F(PageCommands, ASampleClothIsSolvedNearItsTruthAndMadeOnce) {
  const std::vector<Ran> ran =
      run({"weft sample -o s.weft -q --json", "weft sample -o s.weft -q --json",
           "weft compare s.weft/solve/*/normal.exr s.weft/truth/normal.exr -q --json"});
  const Json made = Json::parse(ran[0].said, nullptr, false),
             again = Json::parse(ran[1].said, nullptr, false);
  EXPECT_EQ(made.value("session", ""), "s") << ran[0].said;
  EXPECT_EQ(made, again);
  EXPECT_TRUE(fs::exists(work_ / "s.weft" / "maps" / made.value("maps", "none") / "normal.exr")) << made;
  EXPECT_EQ(std::distance(fs::directory_iterator(work_ / "s.weft" / "solve"), {}), 1);
  const Json compared = Json::parse(ran[2].said, nullptr, false);
  EXPECT_LT(compared.value("mean_deg", 180.0), 0.6) << ran[2].said;
}

// However its rig is named, what lies beside the rig file is found, and a job may be asked for it.
TEST_F(PageCommands, ServeFindsWhatLiesBesideItsRigHoweverThatIsNamed) {
  simulate(scene_named("twill", {48, 32}), work_ / "session.weft");
  for (const std::string folder : {"named", "here", "none/home/weft"}) {
    fs::create_directories(work_ / folder / "sheets");
    fs::copy(work_ / "session.weft" / "calibration", work_ / folder / "calib1", fs::copy_options::recursive);
  }
  const std::string rig = "name = \"north\"\n[scan]\ncalibration = \"calib1\"\n[daemon]\nport = 0\n";
  put_bytes(work_ / "named" / "north.toml", rig);
  put_bytes(work_ / "here" / "rig.toml", rig);
  struct Way {
    std::string folder, command, state;
  };
  for (const Way& way :
       {Way{"named", "weft serve --rig north.toml", "north.state"}, Way{"here", "weft serve", "north.state"},
        Way{"none", "weft serve --port 0", "home/.local/state/weft/archive"}}) {
    std::vector<std::string> commands = {"cd " + way.folder + "; export HOME=$PWD/home"};
    for (const std::string& each : serving(way.command, way.state)) commands.push_back(each);
    commands.emplace_back("curl -s http://$at/api/v1/calibrations");
    commands.emplace_back(
        R"(curl -s http://$at/api/v1/jobs -H 'Content-Type: application/json' -d '{"kind": "check", "input": "sheets", "from": "calib1"}')");
    const std::vector<Ran> ran = run(commands);
    ASSERT_EQ(ran[2].exit_code, 0) << way.command << '\n' << ran[2].said;
    const Json list = Json::parse(ran[3].said, nullptr, false);
    ASSERT_TRUE(list.is_object() && list.contains("calibrations")) << way.command << '\n' << ran[3].said;
    ASSERT_EQ(list["calibrations"].size(), 1U) << way.command << '\n' << ran[3].said;
    EXPECT_EQ(list["calibrations"][0]["folder"], "calib1") << way.command;
    const Json job = Json::parse(ran[4].said, nullptr, false);
    EXPECT_TRUE(job.is_object() && job.value("state", "") == "queued") << way.command << '\n' << ran[4].said;
  }
}

}  // namespace
}  // namespace weft::test
