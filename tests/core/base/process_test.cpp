// SPDX-License-Identifier: Apache-2.0
// Programs beside this one, by those that every system has.
#include "core/base/process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <thread>

#include "core/base/descriptor.h"
#include "core/base/files.h"
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

TEST(Process, StartedInASessionOfItsOwnIsHeardByNobodyAndGoesOn) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "written";
  const Result<pid_t> started =
      start_process({.command = {"sh", "-c",
                                 "echo unheard; ps -o sid= -p $$ > '" + file.string() + ".part'; mv '" +
                                     file.string() + ".part' '" + file.string() + "'"},
                     .group = ProcessGroup::kOwnSession});
  ASSERT_TRUE(started) << started.error().message();
  for (int i = 0; i < 1000 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const Result<std::string> session = read_text(file);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(std::stol(*session), *started);
  EXPECT_EQ(start_process({.command = {"weft-no-such-program"}}).error().kind, ErrorKind::kNoInput);
}

// What a shell that is started so prints.
std::string told_by_shell(const std::filesystem::path& log, ProcessStart start, const std::string& script) {
  start.command = {"/bin/sh", "-c", script};
  start.output = log;
  const auto process = ChildProcess::start(start);
  EXPECT_TRUE(process) << process.error().message();
  if (process) (*process)->wait(10);
  return process ? (*process)->said() : "";
}

TEST(Process, IsStartedWithWhatItIsToHave) {
  const ScratchFolder folder;
  const std::filesystem::path log = folder / "log";
  const std::string data = "prlimit --noheadings --output SOFT,HARD --data --pid $$", nice = "nice";
  EXPECT_EQ(std::stol(told_by_shell(log, {.memory_bytes = 123'000'000}, data)), 123'000'000);
  const int before = std::stoi(told_by_shell(log, {}, nice));
  EXPECT_EQ(std::stoi(told_by_shell(log, {.niceness = 3}, nice)), std::min(before + 3, 19));
  const std::string leads = "test $(ps -o pgid= -p $$) = $$ && echo leads || echo follows";
  EXPECT_EQ(told_by_shell(log, {.group = ProcessGroup::kOwn}, leads), "leads\n");
  EXPECT_EQ(told_by_shell(log, {}, leads), "follows\n");
}

TEST(Process, HasNoSignalBlockedOrIgnored) {
  const ScratchFolder folder;
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const auto pipe_before = std::signal(SIGPIPE, SIG_IGN);
  const std::string said =
      told_by_shell(folder / "log", {}, "sed -n 's/SigBlk:.//p; s/SigIgn:.//p' /proc/self/status");
  std::signal(SIGPIPE, pipe_before);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  std::size_t end = 0;
  EXPECT_EQ(std::stoull(said, &end, 16), 0U) << "blocked: " << said;
  std::uint64_t ending = 0;
  for (const int number : {SIGINT, SIGTERM, SIGPIPE}) ending |= std::uint64_t{1} << (number - 1);
  EXPECT_EQ(std::stoull(said.substr(end), nullptr, 16) & ending, 0U) << "ignored: " << said;
}

TEST(Process, HasTheStreamsAndTheDescriptorThatItIsGivenAndNoOther) {
  const ScratchFolder folder;
  const Descriptor in(folder / "in", O_RDWR | O_CREAT), kept(folder / "kept", O_RDWR | O_CREAT);
  ASSERT_EQ(::write(in.get(), "asked\n", 6), 6);
  ASSERT_EQ(::lseek(in.get(), 0, SEEK_SET), 0);
  const auto is_open = [](const Descriptor& file) {
    return "; test -e /proc/self/fd/" + std::to_string(file.get()) + " && echo open || echo closed";
  };
  EXPECT_EQ(told_by_shell(folder / "log", {.input = in.get(), .handed_on = kept.get()},
                          "read line; echo $line" + is_open(kept) + is_open(in)),
            "asked\nopen\nclosed\n");
}

TEST(Process, ThatEndsWithItsParentIsKilledWithIt) {
  const ScratchFolder folder;
  pid_t child = 0;
  std::thread([&child] {
    const Result<pid_t> started = start_process({.command = {"/bin/sleep", "60"}, .ends_with_parent = true});
    ASSERT_TRUE(started) << started.error().message();
    child = *started;
  }).join();
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
}

TEST(Process, FindsItsNeighboursBesideItself) {
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  EXPECT_EQ(program_beside(self.filename().string()), self);
}

}  // namespace
}  // namespace weft
