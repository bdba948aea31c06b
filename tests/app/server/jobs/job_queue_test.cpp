// SPDX-License-Identifier: Apache-2.0
// Jobs are shell scripts here: what a verb says on its two streams, as it says it.
#include "app/server/jobs/job_queue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "core/describe/field_json.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

class Jobs : public testing::Test {
 protected:
  Jobs() { open(); }
  void open(std::uint64_t memory_bytes = 0, std::size_t most_remembered = 200) {
    queue_.reset();
    JobQueueOptions options;
    options.folder = folder();
    options.program = "/bin/sh";
    options.memory_bytes = memory_bytes;
    options.most_remembered = most_remembered;
    Result<std::unique_ptr<JobQueue>> queue = JobQueue::open(std::move(options));
    ASSERT_TRUE(queue) << queue.error().message();
    queue_ = std::move(*queue);
  }
  fs::path folder() const { return work_.path() / "jobs"; }
  fs::path file(const std::string& name) const { return work_.path() / name; }

  std::string add(const std::string& script, const std::string& request = "") {
    const Result<JobStatus> job = queue_->add({"solve", "satin", {"-c", script}, "Ann", request});
    EXPECT_TRUE(job) << (job ? "" : job.error().message());
    return job->id;
  }
  // Waits until a job is so, and says how it is.
  JobStatus when(const std::string& id, const std::function<bool(const JobStatus&)>& is_so) {
    for (int i = 0; i < 2000; ++i) {
      const JobStatus job = *queue_->find(id);
      if (is_so(job)) return job;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "job " << id << " stays " << object_of(*queue_->find(id)).dump();
    return *queue_->find(id);
  }
  JobStatus ended(const std::string& id) {
    return when(id, [](const JobStatus& job) { return !job.ended.empty(); });
  }
  JobStatus running(const std::string& id) {
    return when(id, [](const JobStatus& job) { return job.phase == "solve"; });
  }

  static constexpr const char* kBegin =
      R"(echo '{"event":"progress","phase":"solve","share":0.25,"left_s":3}' >&2;)";
  TemporaryFolder work_;
  std::unique_ptr<JobQueue> queue_;
};

TEST_F(Jobs, TakeAsLongAsTheLastOneLikeThem) {
  const std::string script = std::string(kBegin) + " sleep 0.6";
  const std::string first = add(script);
  EXPECT_EQ(running(first).left_s, std::nullopt) << "nothing is known of such jobs, and a phase is not all";
  const JobStatus last = ended(first);
  EXPECT_EQ(last.state, JobState::kDone);
  const std::string second = add(script);
  const JobStatus now = running(second);
  const double left_s = now.left_s.value_or(0);  // as of when it was told, some time since it began
  EXPECT_GE(left_s, last.seconds - now.seconds);
  EXPECT_LE(left_s, last.seconds);
  EXPECT_EQ(ended(second).state, JobState::kDone);
  EXPECT_EQ(running(add(script + "; true")).left_s, std::nullopt) << "another job";
}

TEST_F(Jobs, LeaveFilesThatAreForgottenWithThem) {
  const std::vector<std::string> draw = {"-c", "echo drawn >\"$0\"", std::string(kJobFiles) + "/plan.svg"};
  const Result<JobStatus> job = queue_->add({"rig_plan", "north", draw, "", ""});
  ASSERT_TRUE(job) << job.error().message();
  EXPECT_EQ(ended(job->id).state, JobState::kDone);
  const fs::path drawn = queue_->files_of(job->id) / "plan.svg";
  const Result<std::string> text = read_text(drawn);
  ASSERT_TRUE(text) << text.error().message();
  EXPECT_EQ(*text, "drawn\n");
  EXPECT_TRUE(queue_->forget(job->id));
  EXPECT_FALSE(fs::exists(drawn.parent_path()));
}

TEST_F(Jobs, TakeAsLongAsTheirSessionWasPriced) {
  const auto price = [&](const char* of, const char* seconds) {
    const std::string levels = std::string(R"({"levels": [{"quality": "fast", "seconds": {"total": 2}},)") +
                               R"({"quality": "robust", "seconds": {"total": )" + seconds + "}}]}";
    return queue_->add({"price", of, {"-c", "echo '" + levels + "'"}, "", ""})->id;
  };
  ended(price("satin", "40"));
  ended(price("linen", "7"));
  const std::vector<std::string> robust = {"-c", std::string(kBegin) + " sleep 5"};
  const auto left_s = [&](const char* of, const Json& wants) {
    const std::string id = queue_->add({"solve", of, robust, "", "", {}, wants})->id;
    const std::optional<double> left = running(id).left_s;
    EXPECT_TRUE(queue_->cancel(id));
    ended(id);
    return left.value_or(0);
  };
  EXPECT_NEAR(left_s("satin", {{"quality", "robust"}}), 39.5, 0.5);
  EXPECT_NEAR(left_s("linen", {{"quality", "robust"}}), 6.5, 0.5);
  EXPECT_EQ(left_s("satin", {{"quality", "reference"}}), 0) << "its price has no such level";
  EXPECT_EQ(left_s("satin", {{"method", "lts"}}), 0);
}

TEST_F(Jobs, TellASolveWhatThePriceOfItsSessionSaid) {
  const std::string levels = R"({"levels": [{"quality": "fast", "predicted_deg": 0.5, "solved": 0.75,)"
                             R"( "seconds": {"sync": 1, "total": 4}}]})";
  ended(queue_->add({"price", "satin", {"-c", "echo '" + levels + "'"}, "", ""})->id);
  const auto told = [&](const char* of, const Json& wants) {
    const std::string script = R"(echo "{\"said\": \"$0 $1\"}")";
    return ended(queue_->add({"solve", of, {"-c", script}, "", "", {}, wants})->id).result["said"];
  };
  EXPECT_EQ(told("satin", {{"quality", "fast"}}), "--foretold 3,0.5,0.75") << "to the writing of solve.json";
  EXPECT_EQ(told("satin", {{"quality", "robust"}}), "--json --json-events") << "its price has no such level";
  EXPECT_EQ(told("satin", {{"quality", "fast"}, {"calibration", "may"}}), "--json --json-events")
      << "it was priced by another calibration";
  EXPECT_EQ(told("linen", {{"quality", "fast"}}), "--json --json-events");
}

TEST_F(Jobs, CountDownWithoutAWordAndNotWhileTheyAreHeld) {
  ended(queue_
            ->add({"price",
                   "satin",
                   {"-c", R"(echo '{"levels": [{"quality": "fast", "seconds": {"total": 60}}]}')"},
                   "",
                   ""})
            ->id);
  const std::string id = queue_
                             ->add({"solve",
                                    "satin",
                                    {"-c", std::string(kBegin) + " sleep 60"},
                                    "",
                                    "",
                                    {},
                                    {{"quality", "fast"}}})
                             ->id;
  running(id);
  when(id, [](const JobStatus& job) { return job.left_s && *job.left_s < 59; });
  queue_->hold(true);
  const double seconds = when(id, [](const JobStatus& job) { return job.is_held; }).seconds;
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  queue_->hold(false);
  EXPECT_LT(queue_->find(id)->seconds, seconds + 0.4) << "of 0.7 that it was held for";
  ASSERT_TRUE(queue_->cancel(id));
  ended(id);
}

TEST_F(Jobs, AreHeldWithTheProcessesThatTheyStarted) {
  const fs::path out = file("lines");
  const std::string id =
      add(std::string(kBegin) + "(while :; do echo . >>" + out.string() + "; sleep 0.01; done) & wait");
  running(id);
  const auto bytes = [&] {
    std::error_code none;
    const auto size = fs::file_size(out, none);
    return none ? std::uintmax_t{0} : size;
  };
  for (int i = 0; i < 500 && bytes() == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  queue_->hold(true);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // of a line that was on its way
  const std::uintmax_t held = bytes();
  EXPECT_GT(held, 0U);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(bytes(), held);
  queue_->hold(false);
  for (int i = 0; i < 500 && bytes() == held; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_GT(bytes(), held);
  ASSERT_TRUE(queue_->cancel(id));
  ended(id);
  const std::uintmax_t at_end = bytes();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(bytes(), at_end) << "what it started ends with it";
}

TEST_F(Jobs, ThatArePlannedTakeWhatTheirPaceSays) {
  JobSpec spec = {"batch_run", "night", {"-c", std::string(kBegin) + " sleep 1"}, "Ann", ""};
  spec.wants = {{kPlannedSeconds, 1000}};
  const Result<JobStatus> job = queue_->add(spec);
  ASSERT_TRUE(job) << job.error().message();
  const double left_s = running(job->id).left_s.value_or(-1);
  EXPECT_GE(left_s, 0);
  EXPECT_LT(left_s, 3) << "a quarter was done within a moment: 1000 s are not what the pace says";
  ended(job->id);
}

TEST_F(Jobs, SayWhatIsGoneThatTheyWorkOn) {
  std::filesystem::create_directories(file("satin.weft"));
  queue_->hold(true);
  const Result<JobStatus> asked =
      queue_->add({"solve", "satin", {"-c", "true"}, "", "", {file("satin.weft").string()}});
  ASSERT_TRUE(asked) << asked.error().message();
  std::filesystem::remove(file("satin.weft"));
  open();  // after a restart too
  const JobStatus job = ended(asked->id);
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.error["kind"], "no_input");
  EXPECT_EQ(job.error["where"], file("satin.weft").string());
  EXPECT_EQ(job.exit_code, std::nullopt) << "its verb was not begun";
}

TEST_F(Jobs, AreDoneWhereACheckFoundSomething) {
  const JobStatus answered = ended(add("echo '{\"holds\": false}'; exit 65"));
  EXPECT_EQ(answered.state, JobState::kDone);
  EXPECT_EQ(answered.result["holds"], false);
  EXPECT_EQ(ended(add("exit 65")).state, JobState::kFailed) << "without a document it is no answer";
}

TEST_F(Jobs, KeepWhatTheirVerbSaid) {
  const std::string id =
      add(std::string(kBegin) +
          R"(echo 'a line of some library' >&2; echo '{"event":"note","text":"a warning"}' >&2;
                                echo '{"folder": "/data/satin.weft"}')");
  const JobStatus job = ended(id);
  EXPECT_EQ(job.state, JobState::kDone);
  EXPECT_EQ(job.exit_code, 0);
  EXPECT_EQ(job.phase, "solve");
  EXPECT_EQ(job.share, 0.25);
  EXPECT_EQ(job.notes, (std::vector<std::string>{"a line of some library", "a warning"}));
  EXPECT_EQ(job.result["folder"], "/data/satin.weft");
  EXPECT_EQ(job.spec.by, "Ann");
  EXPECT_NE(queue_->log(id)->find("a warning"), std::string::npos);
}

TEST_F(Jobs, ThatFailKeepTheErrorOfTheirVerb) {
  const JobStatus job = ended(add(
      R"(echo '{"event":"error","kind":"bad_data","what":"frame is truncated","where":"a","why":"b","remedy":"c"}' >&2; exit 65)"));
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.exit_code, 65);
  EXPECT_EQ(job.error["what"], "frame is truncated");
  const JobStatus silent = ended(add("kill -SEGV $$"));
  EXPECT_EQ(silent.exit_code, 128 + 11);
  EXPECT_EQ(silent.error["what"], "job ended without a word");
  EXPECT_NE(silent.error["remedy"].get<std::string>().find("memory"), std::string::npos)
      << silent.error.dump();
  const JobStatus plain = ended(add("echo 'libfoo.so: cannot open shared object file' >&2; exit 127"));
  EXPECT_EQ(plain.error["why"], "exit code 127: libfoo.so: cannot open shared object file");
  EXPECT_EQ(plain.error["remedy"], "see its log");
}

TEST_F(Jobs, RunOneAfterAnotherInTheirOrderUnlessOneIsPutFirst) {
  const std::string out = file("order").string();
  queue_->hold(true);
  std::vector<std::string> ids;
  for (int i = 1; i <= 3; ++i)
    ids.push_back(add("echo " + std::to_string(i) + " >> " + out + "; sleep 0.05; echo . >> " + out));
  ASSERT_TRUE(queue_->first(ids[2]));
  queue_->hold(false);
  for (const std::string& id : ids) ended(id);
  EXPECT_EQ(*read_text(out), "3\n.\n1\n.\n2\n.\n");
  EXPECT_EQ(queue_->list().front().id, ids[2]) << "the newest first";
  EXPECT_FALSE(queue_->first(ids[0]));
}

TEST_F(Jobs, OfOneRequestAreOneJob) {
  const std::string id = add("true", "two clicks");
  EXPECT_EQ(add("true", "two clicks"), id);
  EXPECT_NE(add("true", "another"), id);
}

TEST_F(Jobs, AreCancelledWhereverTheyAre) {
  const std::string one =
      add(std::string("trap 'exit 130' TERM; ") + kBegin + "while :; do sleep 0.05; done");
  const std::string two = add("true");
  running(one);
  ASSERT_TRUE(queue_->cancel(two));
  EXPECT_EQ(ended(two).state, JobState::kCancelled);
  ASSERT_TRUE(queue_->cancel(one));
  EXPECT_EQ(ended(one).state, JobState::kCancelled);
  EXPECT_EQ(queue_->find(one)->exit_code, 130);
  EXPECT_FALSE(queue_->cancel(one));
  const Result<JobStatus> again = queue_->retry(two);
  ASSERT_TRUE(again);
  EXPECT_EQ(ended(again->id).state, JobState::kDone);
  EXPECT_EQ(queue_->cancel("000099").error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(queue_->retry("../../etc/passwd").error().kind, ErrorKind::kNoInput);
}

TEST_F(Jobs, ThatFinishBeforeTheyCouldBeStoppedAreDone) {
  const std::string id =
      add(std::string("trap 'echo {\\\"a\\\": 1}; exit 0' TERM; ") + kBegin + "while :; do sleep 0.05; done");
  running(id);
  ASSERT_TRUE(queue_->cancel(id));
  EXPECT_EQ(ended(id).state, JobState::kDone);
  EXPECT_EQ(queue_->find(id)->result["a"], 1);
}

TEST_F(Jobs, AreCancelledWhileTheyAreHeld) {
  const std::string id = add(std::string("trap 'exit 130' TERM; ") + kBegin + "while :; do sleep 0.05; done");
  running(id);
  queue_->hold(true);
  ASSERT_TRUE(queue_->cancel(id));
  EXPECT_EQ(ended(id).state, JobState::kCancelled);
  EXPECT_EQ(queue_->find(id)->exit_code, 130);
}

TEST_F(Jobs, StandStillWhileTheyAreHeld) {
  const std::string ticks = file("ticks").string();
  const std::string id = add(std::string(kBegin) + "while :; do echo . >> " + ticks + "; sleep 0.02; done");
  running(id);
  queue_->hold(true);
  EXPECT_TRUE(queue_->find(id)->is_held);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const auto before = fs::file_size(ticks);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(fs::file_size(ticks), before);
  queue_->hold(false);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_GT(fs::file_size(ticks), before);
  ASSERT_TRUE(queue_->cancel(id));
  EXPECT_EQ(ended(id).state, JobState::kCancelled);
}

TEST_F(Jobs, OutliveARestartAndTheRunningOneBeginsAgainFirst) {
  const std::string done = add("echo '{\"a\": 1}'");
  ended(done);
  const std::string one = add(std::string(kBegin) + "[ -e " + file("go").string() + " ] || sleep 60");
  const std::string two = add("true");
  running(one);
  open();
  std::ofstream(file("go")) << "";
  EXPECT_EQ(queue_->find(done)->result["a"], 1);
  EXPECT_EQ(ended(two).state, JobState::kDone);
  EXPECT_EQ(queue_->find(one)->state, JobState::kDone);
  EXPECT_EQ(add("true"), "000004");
}

TEST_F(Jobs, AreNotStoppedByFilesThatAreNone) {
  queue_.reset();
  std::ofstream(folder() / "000001.json") << "{";
  std::ofstream(folder() / "000002.json") << R"({"schema":"weft.job/1","id":"other"})";
  std::ofstream(folder() / "000003.json") << "1";
  std::ofstream(folder() / "notes.txt") << "x";
  open();
  EXPECT_TRUE(queue_->list().empty());
  EXPECT_EQ(ended(add("true")).state, JobState::kDone);
}

TEST_F(Jobs, MayNotTakeMoreMemoryThanTheyAreGiven) {
  open(std::uint64_t{30} << 20);
  EXPECT_EQ(ended(add("dd if=/dev/zero of=/dev/null bs=100M count=1")).state, JobState::kFailed);
  EXPECT_EQ(ended(add("true")).state, JobState::kDone);
}

TEST_F(Jobs, ThatEndedLongAgoAreForgotten) {
  open(0, 2);
  std::vector<std::string> ids;
  for (int i = 0; i < 4; ++i) ids.push_back(add("true"));
  when(ids[3], [&](const JobStatus& job) { return !job.ended.empty() && queue_->list().size() == 2; });
  EXPECT_FALSE(queue_->find(ids[1]));
  EXPECT_FALSE(fs::exists(folder() / (ids[1] + ".log")));
  EXPECT_TRUE(queue_->find(ids[2]));
}

}  // namespace
}  // namespace weft::app
