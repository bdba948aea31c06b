// SPDX-License-Identifier: Apache-2.0
// weft-camera by its lines.
#include "capture/camera/worker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "capture/camera/worker_process.h"
#include "core/base/json_document.h"
#include "tests/capture/camera/link_bench.h"

namespace weft::capture {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

class Spoken {
 public:
  explicit Spoken(const std::filesystem::path& home) {
    auto started = WorkerProcess::start(weft_camera_program(), {{"HOME", home.string()}}, home / "log");
    if (!started) throw std::runtime_error(started.error().message());
    worker = std::move(*started);
  }
  Json ask(const std::string& line) {
    EXPECT_TRUE(worker->send(line));
    return hear();
  }
  Json hear() {
    const auto answer = worker->read_line(steady_clock::now() + seconds(10));
    return answer ? Json::parse(*answer, nullptr, false) : Json(answer.error().message());
  }
  std::unique_ptr<WorkerProcess> worker;
};

std::string open_line(LinkBench& bench) {
  return Json{
      {"id", 1}, {"do", "open"}, {"profile", "nikon-d5100"}, {"port", bench.options().port}, {"serial", ""}}
      .dump();
}

/// The answer, after the word that the drivers are loaded.
Json opened(Spoken& spoken, LinkBench& bench) {
  EXPECT_EQ(spoken.ask(open_line(bench)), (Json{{"id", 1}, {"event", "asking"}}));
  return spoken.hear();
}

TEST(Worker, AnswersEveryLineThatIsNoRequestByAnError) {
  LinkBench bench;
  Spoken spoken(bench.folder());
  for (const std::string& line : std::vector<std::string>{
           "", "{", "[]", "7", "{}", R"({"do": 3})", R"({"do": "dance"})", R"({"do": "take"})",
           R"({"do": "open"})", std::string(100000, 'x'), "\xff\xfe"}) {
    const Json answer = spoken.ask(line);
    ASSERT_TRUE(answer.contains("error")) << line.substr(0, 40) << " -> " << answer;
    EXPECT_EQ(answer["error"]["kind"], "usage");
  }
  EXPECT_EQ(spoken.ask(R"({"id": 5, "do": "close"})"), Json::parse(R"({"id": 5, "ok": {}})"));
}

TEST(Worker, TakesByHandWhatTheLinkAsksFor) {
  LinkBench bench;
  Spoken spoken(bench.folder());
  const Json answer = opened(spoken, bench);
  ASSERT_TRUE(answer.contains("ok")) << answer;
  EXPECT_EQ(answer["ok"]["dropped"], 0);
  const Json request = {{"id", "a"}, {"do", "take"}, {"file", bench.raw(1).string()}, {"deadline_s", 5}};
  EXPECT_EQ(spoken.ask(request.dump()), (Json{{"id", "a"}, {"event", "exposed"}}));
  const Json taken = spoken.hear();
  ASSERT_TRUE(taken.contains("ok")) << taken;
  EXPECT_EQ(std::filesystem::file_size(taken["ok"]["file"].get<std::string>()), taken["ok"]["bytes"]);
}

TEST(Worker, EndsWhenItsInputEnds) {
  LinkBench bench;
  Spoken spoken(bench.folder());
  ASSERT_TRUE(opened(spoken, bench).contains("ok"));
  const pid_t pid = spoken.worker->pid();
  const auto begin = steady_clock::now();
  spoken.worker->end(begin + seconds(5));
  EXPECT_LT(seconds_since(begin), 2) << "it was killed";
  EXPECT_EQ(::kill(pid, 0), -1);
}

TEST(Worker, EndsWithoutItsParentEvenWhereTheCameraBlocksIt) {
  LinkBench bench;
  ASSERT_TRUE(bench.camera().inject({"busy_for_ever", 1}));
  Spoken spoken(bench.folder());
  ASSERT_TRUE(opened(spoken, bench).contains("ok"));
  ASSERT_TRUE(
      spoken.worker->send(Json{{"do", "take"}, {"file", bench.raw(1).string()}, {"deadline_s", 5}}.dump()));
  const auto patience = steady_clock::now() + seconds(10);
  while (bench.camera().shots() == 0 && steady_clock::now() < patience) ::usleep(1000);
  ASSERT_EQ(bench.camera().shots(), 1);
  const auto begin = steady_clock::now();
  spoken.worker->end(begin + seconds(20));
  EXPECT_GT(seconds_since(begin), 2) << "it did not hang";
  EXPECT_LT(seconds_since(begin), 5) << "it was killed";
}

TEST(WorkerProcess, LeavesWhatTheOneBeforeSaidInItsLogUpToAMegabyte) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / ("weft_worker_log_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path program = folder / "speaker", log = folder / "log", before = folder / "log.1";
  std::ofstream(program) << "#!/bin/sh\necho 0123456 >&2\n";
  fs::permissions(program, fs::perms::owner_all);
  const auto speak = [&] {
    auto speaker = WorkerProcess::start(program, {}, log);
    ASSERT_TRUE(speaker) << speaker.error().message();
    EXPECT_FALSE((*speaker)->read_line(steady_clock::now() + seconds(5))) << "it has ended";
  };
  speak();
  speak();
  EXPECT_EQ(fs::file_size(log), 16U) << "what the first said is there";
  EXPECT_FALSE(fs::exists(before));
  fs::resize_file(log, (1U << 20) + 1);
  speak();
  EXPECT_EQ(fs::file_size(log), 8U);
  EXPECT_EQ(fs::file_size(before), (1U << 20) + 1);
  fs::remove_all(folder);
}

TEST(WorkerProcess, TellsACrashFromAHang) {
  auto sleeper = WorkerProcess::start("/bin/cat", {}, "/dev/null");
  ASSERT_TRUE(sleeper) << sleeper.error().message();
  const auto hung = (*sleeper)->read_line(steady_clock::now() + milliseconds(50));
  ASSERT_FALSE(hung);
  EXPECT_EQ(hung.error().what, "the camera hangs");
  ASSERT_TRUE((*sleeper)->send("echoed"));
  EXPECT_EQ(*(*sleeper)->read_line(steady_clock::now() + seconds(5)), "echoed");
  ::kill((*sleeper)->pid(), SIGSEGV);
  const auto crashed = (*sleeper)->read_line(steady_clock::now() + seconds(5));
  ASSERT_FALSE(crashed);
  EXPECT_THAT(crashed.error().why, testing::HasSubstr("signal 11"));
  EXPECT_FALSE((*sleeper)->send("more"));
}

}  // namespace
}  // namespace weft::capture
