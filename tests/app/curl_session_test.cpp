// SPDX-License-Identifier: Apache-2.0
// "A session with curl" of docs/http.md, line by line, against weft serve and a virtual rig.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/places.h"
#include "tests/virtual_rig/ptp/client_process.h"
#include "tests/virtual_rig/small_scene.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct Step {
  std::string command;
  std::vector<std::string> says;  ///< lines that follow it on the page
};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The lines between the fences below the heading; what begins with "$ " is a command.
std::vector<Step> steps_of(const std::string& page, const std::string& heading) {
  std::istringstream lines(page.substr(page.find("\n" + heading + "\n")));
  std::vector<Step> steps;
  bool is_inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      if (is_inside) break;
      is_inside = true;
    } else if (is_inside && line.rfind("$ ", 0) == 0) {
      steps.push_back({line.substr(2), {}});
    } else if (is_inside && !steps.empty()) {
      steps.back().says.push_back(line);
    }
  }
  return steps;
}

// Whether `said` is the page's line, in which "..." is anything.
bool is_said(const std::string& line, const std::string& said) {
  const std::string literal = std::regex_replace(line, std::regex(R"([\^$.|?*+()\[\]{}\\])"), R"(\$&)");
  const std::string any = std::regex_replace(literal, std::regex(R"(\\\.\\\.\\\.)"), ".*");
  return std::regex_match(said, std::regex(any));
}

class CurlSession : public testing::Test {
 protected:
  CurlSession() : folder_(virtual_rig::fresh_folder()) {
    std::ofstream(folder_ / "scene.toml") << to_toml(virtual_rig::small_scene());
    std::ofstream(folder_ / "token") << "0123456789abcdef0123456789abcdef\n";
    fs::permissions(folder_ / "token", fs::perms::owner_read | fs::perms::owner_write);
  }
  ~CurlSession() override {
    shell("kill -9 $(cat pid)");
    rig({"--folder", "rig", "--inject", "end"});
  }

  virtual_rig::ProgramRun rig(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program_path("weft-virtual-rig"));
    return virtual_rig::run_program(arguments, {"XDG_CACHE_HOME=" + (folder_ / "cache").string()},
                                    folder_.string(), 60);
  }
  virtual_rig::ProgramRun shell(const std::string& script) const {
    return virtual_rig::run_program({"/bin/bash", "-c", script}, {}, folder_.string(), 120);
  }

  const fs::path folder_;
};

// A daemon of the rig as a service, under whatever port was free when it first began.
constexpr char kService[] = R"(
start() {
  env $(cat rig/environment) "$WEFT" serve --rig rig/rig.toml --port ${port:-0} -q >/dev/null 2>&1 &
  echo $! > pid
  until [ -s rig/*.state/address ]; do sleep 0.05; done
  port=$(sed 's/.*://' rig/*.state/address)
}
systemctl() { kill $(cat pid); wait $(cat pid) 2>/dev/null; rm -f rig/*.state/address; start; }
cp token rig/token && printf 'token = "token"\n' >> rig/rig.toml
start
)";

TEST_F(CurlSession, OfTheDocumentationIsWhatTheServerSays) {
  const std::vector<Step> steps =
      steps_of(text_of(source_folder() / "docs/http.md"), "## A session with curl");
  ASSERT_GT(steps.size(), 10U);
  ASSERT_EQ(rig({"scene.toml", "--folder", "rig", "--no-wait"}).exit_code, 0);
  std::string script = "WEFT=" + program_path("weft") + kService;
  for (const Step& step : steps) {
    const std::string command =
        std::regex_replace(step.command, std::regex("127\\.0\\.0\\.1:8470"), "127.0.0.1:$port");
    script +=
        "echo; echo @@@\n" + std::regex_replace(command, std::regex("'(Origin: [^']*)'"), "\"$1\"") + "\n";
  }
  const virtual_rig::ProgramRun ran = shell(script);
  std::istringstream lines(ran.output);
  std::vector<std::vector<std::string>> said;
  for (std::string line; std::getline(lines, line);) {
    if (line == "@@@") {
      said.emplace_back();
    } else if (!line.empty() && !said.empty()) {
      said.back().push_back(line);
    }
  }
  ASSERT_EQ(said.size(), steps.size()) << ran.output;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ASSERT_EQ(said[i].size(), steps[i].says.size()) << "$ " << steps[i].command << '\n' << ran.output;
    for (std::size_t j = 0; j < said[i].size(); ++j) {
      EXPECT_TRUE(is_said(steps[i].says[j], said[i][j]))
          << "$ " << steps[i].command << "\nthe page: " << steps[i].says[j] << "\nthe server: " << said[i][j];
    }
  }
}

}  // namespace
}  // namespace weft::app
