// SPDX-License-Identifier: Apache-2.0
// weft-virtual-rig as a person or a script runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/json_document.h"
#include "tests/core/places.h"
#include "tests/virtual_rig/ptp/client_process.h"
#include "tests/virtual_rig/small_scene.h"
#include "virtual_rig/control_socket.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Program : public testing::Test {
 protected:
  Program() : folder_(fresh_folder()) { std::ofstream(folder_ / "scene.toml") << to_toml(small_scene()); }
  ProgramRun run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), program_path("weft-virtual-rig"));
    return run_program(arguments, {"XDG_CACHE_HOME=" + (folder_ / "cache").string()}, folder_.string(), 60);
  }
  std::string scene() const { return (folder_ / "scene.toml").string(); }

  fs::path folder_;
};

bool comes_true(double most_s, const std::function<bool()>& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

bool is_gone_within(const fs::path& path, double most_s) {
  return comes_true(most_s, [&] { return !fs::exists(path); });
}

/// A process that has ended and waits to be reaped has no command line any more.
bool has_ended_within(int process, double most_s) {
  return comes_true(most_s, [&] {
    std::ifstream command("/proc/" + std::to_string(process) + "/cmdline");
    return command.peek() == std::ifstream::traits_type::eof();
  });
}

TEST_F(Program, RunsACommandInsideTheRigAndEndsWithIt) {
  const ProgramRun ran =
      run({scene(), "--folder", "rig", "--", "/bin/sh", "-c",
           "test -e \"$WEFT_RIG\" && test -e rig/board && echo preloads $LD_PRELOAD && exit 7"});
  EXPECT_EQ(ran.exit_code, 7) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("libweft_terminal_shim"));
  EXPECT_FALSE(fs::exists(folder_ / "rig"));
}

TEST_F(Program, FillsTheDiskOfItsHosts) {
  const std::string inject = program_path("weft-virtual-rig") + " --folder rig --inject ";
  const ProgramRun ran = run({scene(), "--folder", "rig", "--", "/bin/sh", "-c",
                              inject + "'disk full' && ! cp scene.toml a && " + inject +
                                  "'disk room' && cp scene.toml b && cmp scene.toml b"});
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("No space left"));
}

TEST_F(Program, SaysThatACommandWasKilled) {
  EXPECT_EQ(run({scene(), "--folder", "rig", "--", "/bin/sh", "-c", "kill -TERM $$"}).exit_code, 128 + 15);
}

TEST_F(Program, LivesInTheBackgroundUntilItIsToldToEnd) {
  const ProgramRun ran = run({scene(), "--folder", "rig", "--megapixels", "0.005", "--no-wait", "--usb"});
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(ran.output, AllOf(HasSubstr("READY"), HasSubstr("82 x 62 pixels")));
  EXPECT_EQ(run({"--folder", "rig", "--inject", "light stuck 3"}).output, "ok\n");
  const Json status = Json::parse(run({"--folder", "rig", "--inject", "status"}).output);
  EXPECT_EQ(status.at("light").at("stuck"), Json({3}));
  const ProgramRun wrong = run({"--folder", "rig", "--inject", "light stuck 30"});
  EXPECT_EQ(wrong.exit_code, 64);
  EXPECT_THAT(wrong.output, HasSubstr("LEDs are 1 to 3"));
  EXPECT_EQ(run({scene(), "--folder", "rig"}).exit_code, 75) << "one rig a folder";
  EXPECT_EQ(run({"--folder", "rig", "--inject", "end"}).exit_code, 0);
  EXPECT_TRUE(is_gone_within(folder_ / "rig", 10));
  EXPECT_TRUE(has_ended_within(status.at("process").get<int>(), 10));
}

TEST_F(Program, EndsWithItsParent) {
  const ProgramRun ran = run({"--help"});
  ASSERT_EQ(ran.exit_code, 0);
  const std::string command = program_path("weft-virtual-rig") +
                              " scene.toml --folder rig >said 2>&1 & "
                              "while ! grep -q READY said; do sleep 0.02; done";
  const ProgramRun shell = run_program(
      {"/bin/sh", "-c", command}, {"XDG_CACHE_HOME=" + (folder_ / "cache").string()}, folder_.string(), 60);
  EXPECT_EQ(shell.exit_code, 0) << shell.output;
  EXPECT_TRUE(is_gone_within(folder_ / "rig", 10));
}

TEST_F(Program, ExplainsItselfAndWhatItRefuses) {
  EXPECT_THAT(run({"--help"}).output, AllOf(HasSubstr("light move"), HasSubstr("camera drop_in_exposure"),
                                            HasSubstr("board unplug")));
  EXPECT_EQ(run({}).exit_code, 64);
  EXPECT_EQ(run({"--inject", "status"}).exit_code, 64);
  EXPECT_EQ(run({"nothing.toml"}).exit_code, 66);
  EXPECT_EQ(run({"--folder", "nobody", "--inject", "status"}).exit_code, 69);
  EXPECT_EQ(run({scene(), "--megapixels", "0"}).exit_code, 64);
  EXPECT_EQ(run({scene(), "--no-wait", "--", "true"}).exit_code, 64);
  EXPECT_EQ(run({scene(), "--folder", folder_.string()}).exit_code, 73);
  EXPECT_EQ(run({scene(), "--folder", "rig", "--", "no-such-program"}).exit_code, 66);
}

}  // namespace
}  // namespace weft::virtual_rig
