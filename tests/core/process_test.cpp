// SPDX-License-Identifier: Apache-2.0
// Programs beside this one, by those that every system has.
#include "core/process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "core/files.h"
#include "tests/core/image_io/scratch_folder.h"

namespace weft {
namespace {

std::unique_ptr<ChildProcess> shell(const std::string& script, const std::filesystem::path& log,
                                    const std::vector<std::string>& environment = {}) {
  auto process = ChildProcess::start({"/bin/sh", "-c", script}, environment, log);
  EXPECT_TRUE(process) << process.error().message();
  return process ? std::move(*process) : nullptr;
}

TEST(Process, TellsTheExitCodeAndWhatWasPrinted) {
  const ScratchFolder folder;
  const auto process = shell("echo out; echo error >&2; exit 7", folder / "log");
  EXPECT_EQ(process->wait(10), 7);
  EXPECT_EQ(process->said(), "out\nerror\n");
  EXPECT_FALSE(process->runs());
}

TEST(Process, ThatWasKilledTells128AndTheSignal) {
  const ScratchFolder folder;
  const auto process = shell("sleep 60", folder / "log");
  EXPECT_FALSE(process->wait(0.01));
  process->signal(SIGTERM);
  EXPECT_EQ(process->wait(10), 128 + SIGTERM);
}

TEST(Process, EndsWithItsObject) {
  const ScratchFolder folder;
  pid_t pid = 0;
  {
    const auto process = shell("sleep 60", folder / "log");
    pid = process->pid();
    EXPECT_EQ(::kill(pid, 0), 0);
  }
  EXPECT_NE(::kill(pid, 0), 0);
}

TEST(Process, AddsItsVariablesToThisOnes) {
  const ScratchFolder folder;
  ::setenv("WEFT_TEST_KEPT", "kept", 1);
  ::setenv("WEFT_TEST_CHANGED", "old", 1);
  const auto process =
      shell("echo $WEFT_TEST_KEPT $WEFT_TEST_CHANGED", folder / "log", {"WEFT_TEST_CHANGED=new"});
  EXPECT_EQ(process->wait(10), 0);
  EXPECT_EQ(process->said(), "kept new\n");
}

TEST(Process, ThatIsNotThereIsNamed) {
  const ScratchFolder folder;
  const auto process = ChildProcess::start({(folder / "nothing").string()}, {}, folder / "log");
  ASSERT_FALSE(process);
  EXPECT_EQ(process.error().kind, ErrorKind::kNoInput);
  const Error error = become(folder / "nothing", {"word"});
  EXPECT_EQ(error.kind, ErrorKind::kNoInput);
  EXPECT_THAT(error.message(),
              testing::AllOf(testing::HasSubstr("nothing"), testing::HasSubstr("No such file"),
                             testing::HasSubstr("build all of weft")));
}

TEST(Process, StartedApartIsHeardByNobodyAndGoesOn) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "written";
  const Result<void> started =
      start_apart({"sh", "-c",
                   "echo unheard; ps -o sid= -p $$ > '" + file.string() + ".part'; mv '" + file.string() +
                       ".part' '" + file.string() + "'"});
  ASSERT_TRUE(started) << started.error().message();
  for (int i = 0; i < 1000 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const Result<std::string> session = read_text(file);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_NE(std::stol(*session), ::getsid(0));
  EXPECT_EQ(start_apart({"weft-no-such-program"}).error().kind, ErrorKind::kNoInput);
}

TEST(Process, FindsItsNeighboursBesideItself) {
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  EXPECT_EQ(program_beside(self.filename().string()), self);
}

}  // namespace
}  // namespace weft
