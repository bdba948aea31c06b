// SPDX-License-Identifier: Apache-2.0
#include "library/batch/farm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace weft::library {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

constexpr std::uint64_t kMB = 1 << 20;

// Tasks that hold so many megabytes each and last ten minutes with two threads.
BatchHeader header_of(const std::vector<std::uint64_t>& megabytes) {
  BatchHeader header;
  header.id = "0123456789abcdef";
  header.threads = 2;
  header.sampled = 1;
  for (const std::uint64_t each : megabytes) header.tasks.push_back({0, 0, 40, 600, each * kMB});
  header.sessions = 40 * static_cast<int>(megabytes.size());
  return header;
}

std::vector<int> all_of(const BatchHeader& header) {
  std::vector<int> tasks(header.tasks.size());
  std::iota(tasks.begin(), tasks.end(), 0);
  return tasks;
}

TEST(Farm, ReadsWhatAClusterTakesFromItsConfiguration) {
  const FarmLimits limits = limits_from(
      "Configuration data as of 2026-11-26T16:20:17\nMaxArraySize            = 5\nMaxDBDMsgs              = "
      "20008\nMaxJobCount             = 4000\nMaxJobId                = 67043328\n");
  EXPECT_EQ(limits, (FarmLimits{5, 4000}));
  EXPECT_EQ(limits_from("nothing of that"), FarmLimits{});
  EXPECT_EQ(limits_from("MaxArraySize = (null)\n"), FarmLimits{});
}

TEST(Farm, SplitsTasksSoThatNoIndexReachesTheLimit) {
  const BatchHeader header = header_of(std::vector<std::uint64_t>(12, 600));
  const std::vector<TaskArray> arrays = arrays_of(header, all_of(header), 2, {5, 10000});
  ASSERT_THAT(arrays, SizeIs(3));
  EXPECT_EQ(indices_of(arrays[0]), "0-4");
  EXPECT_EQ(arrays[1].first, 5);
  EXPECT_EQ(indices_of(arrays[1]), "0-4");
  EXPECT_EQ(arrays[2].first, 10);
  EXPECT_EQ(indices_of(arrays[2]), "0-1");
  EXPECT_THAT(arrays_of(header, all_of(header), 2, {1001, 4}), SizeIs(3))
      << "no array is larger than a queue";
}

TEST(Farm, SendsTasksThatAreAskedForAlone) {
  const BatchHeader header = header_of(std::vector<std::uint64_t>(12, 600));
  const std::vector<int> some = {0, 2, 3, 4, 6, 11};
  const std::vector<TaskArray> arrays = arrays_of(header, some, 2, {10, 10000});
  ASSERT_THAT(arrays, SizeIs(2));
  EXPECT_EQ(indices_of(arrays[0]), "0,2-4,6");
  EXPECT_EQ(indices_of(arrays[1]), "1");
  EXPECT_EQ(arrays[1].first, 10);
  EXPECT_THAT(arrays[1].tasks, ElementsAre(11));
}

TEST(Farm, AsksOfLargeSessionsAloneTheMemoryOfLargeSessions) {
  const BatchHeader header = header_of({600, 4200, 600, 4300});
  const std::vector<TaskArray> arrays = arrays_of(header, all_of(header), 2, {});
  ASSERT_THAT(arrays, SizeIs(2));
  EXPECT_THAT(arrays[0].tasks, ElementsAre(0, 2));
  EXPECT_EQ(arrays[0].memory_bytes, 600 * kMB) << "which has room already";
  EXPECT_THAT(arrays[1].tasks, ElementsAre(1, 3));
  EXPECT_EQ(arrays[1].memory_bytes, 4300 * kMB);
}

TEST(Farm, GivesATaskTwiceItsTimeByTheCoresThatItHas) {
  EXPECT_EQ(asked_minutes(600, 2, 2), 25);
  EXPECT_EQ(asked_minutes(600, 2, 1), 45) << "half the cores, twice the time";
  EXPECT_EQ(asked_minutes(600, 2, 16), 25) << "more cores promise nothing";
  EXPECT_EQ(asked_minutes(0, 0, 1), 5);
  EXPECT_EQ(asked_minutes(1e30, 1, 1), 365 * 24 * 60);
}

TEST(Farm, AsksForTheMinutesOfTheLongestTaskOfAnArray) {
  BatchHeader header = header_of({600, 600, 600});
  header.tasks[1].seconds = 1200;
  const std::vector<TaskArray> arrays = arrays_of(header, all_of(header), 2, {});
  ASSERT_THAT(arrays, SizeIs(1));
  EXPECT_EQ(arrays[0].minutes, asked_minutes(1200, 2, 2));
}

TEST(Farm, SubmitsAnArrayThatIsSignalledQueuedAgainAndFound) {
  const BatchHeader header = header_of({600, 600, 600});
  const std::vector<TaskArray> arrays = arrays_of(header, all_of(header), 1, {});
  ASSERT_THAT(arrays, SizeIs(1));
  const FarmPlaces places = {"/usr/bin/weft", "/n/a night.jsonl", "/n/50% of it.results"};
  const std::vector<std::string> after = {"7", "8"};
  const std::vector<std::string> words =
      array_command(header, arrays[0], {"long", "cloth", "low", 2, 1, {"--nice=100"}}, places, after);
  EXPECT_EQ(words.front(), "sbatch");
  for (const char* word :
       {"--parsable", "--job-name=weft-0123456789abcdef", "--array=0-2%2", "--requeue", "--open-mode=append",
        "--signal=B:TERM@60", "--mem=600M", "--cpus-per-task=1", "--time=45", "--dependency=afterany:7:8",
        "--partition=long", "--account=cloth", "--qos=low", "--nice=100", "--comment=tasks from 0",
        "--output=/n/50%% of it.results/log/%A_%a.txt"})
    EXPECT_THAT(words, Contains(word));
  EXPECT_EQ(words.back(),
            "--wrap=exec /usr/bin/weft batch run '/n/a night.jsonl' --array-from 0 --threads 1 -q");
}

TEST(Farm, MergesOnceAllHaveEnded) {
  const std::vector<std::string> after = {"7"};
  const std::vector<std::string> words =
      merge_command(header_of({600}), {}, {"/usr/bin/weft", "/n/p.jsonl", "/n/p.results"}, after);
  EXPECT_THAT(words, Contains("--dependency=afterany:7"));
  EXPECT_THAT(words, Contains("--job-name=weft-0123456789abcdef-merge"));
  EXPECT_THAT(words, Not(Contains(StartsWith("--partition"))));
  EXPECT_EQ(words.back(), "--wrap=exec /usr/bin/weft batch merge /n/p.jsonl -q");
}

TEST(Farm, FindsTheNumberOfAJob) {
  EXPECT_EQ(job_from("123\n").value(), "123");
  EXPECT_EQ(job_from("123;cluster\n").value(), "123");
  EXPECT_EQ(job_from("you have 3 TB left\n123\n").value(), "123");
  for (const char* bad : {"", "\n", "error", "12x"}) {
    const Result<std::string> job = job_from(bad);
    ASSERT_FALSE(job) << bad;
    EXPECT_EQ(job.error().kind, ErrorKind::kProtocol);
  }
}

TEST(Farm, KnowsWhatIsQueuedOfABatch) {
  // As squeue 22.05 prints it.
  const BatchHeader header = header_of(std::vector<std::uint64_t>(12, 600));
  const FarmQueue queue = queue_from(
      "1|1|PENDING|weft-0123456789abcdef|tasks from 5|BeginTime\n"
      "1|2|RUNNING|weft-0123456789abcdef|tasks from 5|None\n"
      "3|0|RUNNING|weft-0123456789abcdef|tasks from 0|None\n"
      "2|N/A|PENDING|weft-0123456789abcdef-merge|(null)|Dependency\n"
      "4|0|RUNNING|weft-fedcba9876543210|tasks from 0|None\n"
      "5|N/A|RUNNING|weft-0123456789abcdef|(null)|None\n"
      "cut sh",
      header);
  ASSERT_THAT(queue.tasks, SizeIs(3));
  EXPECT_EQ(queue.tasks[0].task, 6);
  EXPECT_EQ(queue.tasks[0].reason, "BeginTime");
  EXPECT_EQ(queue.tasks[1].task, 7);
  EXPECT_EQ(queue.tasks[2].task, 0);
  EXPECT_THAT(queue.jobs(), ElementsAre("1", "3"));
  EXPECT_THAT(queue.merges, ElementsAre("2"));
  EXPECT_EQ(queue.count("RUNNING"), 2);
  const std::vector<int> missing = {0, 1, 6, 7, 11};
  EXPECT_THAT(not_queued(missing, queue), ElementsAre(1, 11));
  EXPECT_THAT(queue_from("", header).tasks, IsEmpty());
  EXPECT_THAT(queue_command(header), Contains("--name=weft-0123456789abcdef,weft-0123456789abcdef-merge"));
}

TEST(Farm, QueuesATaskAgainThatWasStoppedAndNoneThatWasCancelled) {
  EXPECT_TRUE(is_to_be_requeued("RUNNING\n", 0));
  EXPECT_TRUE(is_to_be_requeued("RUNNING", 2));
  EXPECT_FALSE(is_to_be_requeued("RUNNING", 3)) << "three times at most";
  for (const char* state : {"CANCELLED", "COMPLETING", "PENDING", "PREEMPTED", ""})
    EXPECT_FALSE(is_to_be_requeued(state, 0)) << state;
}

TEST(Farm, QuotesWordsForAShell) {
  EXPECT_EQ(shell_word("/a/b-1.jsonl"), "/a/b-1.jsonl");
  EXPECT_EQ(shell_word("two words"), "'two words'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace weft::library
