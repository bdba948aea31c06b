// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "tests/system/program.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {

/// A small twill in cloth.weft, and commands in its folder as a person types them.
class TypedSession : public testing::Test {
 protected:
  TypedSession() {
    setenv("XDG_CACHE_HOME", (work_ / "cache").c_str(), 1);
    setenv("XDG_STATE_HOME", (work_ / "state").c_str(), 1);
  }
  ~TypedSession() override {
    for (const char* name : {"XDG_CACHE_HOME", "XDG_STATE_HOME"}) unsetenv(name);
  }
  void SetUp() override { simulate(scene_named("twill", {192, 128}), session_); }

  Outcome weft(const std::string& line) const {
    std::istringstream words(line);
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) arguments.push_back(word);
    return run_weft(arguments, {.folder = work_.path()});
  }
  std::string output_of(const std::string& line) const {
    const Outcome outcome = weft(line + " -q");
    EXPECT_EQ(outcome.exit_code, 0) << line << ": " << outcome.error;
    return outcome.output;
  }
  Json json_of(const std::string& line) const {
    return Json::parse(output_of(line + " --json"), nullptr, false);
  }
  // Another photograph stands for that of the LED.
  void photograph_again(int led) const {
    edit_json(session_ / "session.json", [&](Json& json) {
      const int index = static_cast<int>(json["shots"].size());
      for (Json& shot : json["shots"]) {
        if (shot["led"] != led || shot["role"] != "lit") continue;
        Json again = shot;
        shot["superseded_by"] = index;
        again["index"] = index;
        again["file"] = fmt::format("raw/{:02}_led{:02}.dng", index, led);
        std::filesystem::copy(session_ / shot["file"].get<std::string>(),
                              session_ / again["file"].get<std::string>());
        json["shots"].push_back(again);
        return;
      }
    });
  }

  Workspace work_;
  const std::filesystem::path session_ = work_ / "cloth.weft";
};

}  // namespace weft::test
