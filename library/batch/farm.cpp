// SPDX-License-Identifier: Apache-2.0
#include "library/batch/farm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace weft::library {
namespace {

constexpr std::uint64_t kMegabyte = 1 << 20;
constexpr std::uint64_t kSmallestClass = 512 * kMegabyte;
constexpr const char* kFormat = "%F|%K|%T|%j|%k|%r";  // array, index, state, name, comment, reason
constexpr std::size_t kFields = 6;
constexpr const char* kComment = "tasks from ";

std::string job_name_of(const BatchHeader& header) {
  return "weft-" + header.id;
}

std::string merge_name_of(const BatchHeader& header) {
  return job_name_of(header) + "-merge";
}

std::optional<int> number_from(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

std::string_view bare(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  text.remove_prefix(begin);
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  return text.substr(0, end == std::string_view::npos ? 0 : end + 1);
}

std::vector<std::string_view> parts_of(std::string_view text, char between) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = std::min(text.find(between), text.size());
    parts.push_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

// A path in a pattern of sbatch, where % begins a field.
std::string without_fields(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text;
}

std::vector<std::string> common_arguments(const FarmOptions& options, const std::string& name,
                                          std::uint64_t memory_bytes, std::span<const std::string> after) {
  std::vector<std::string> words = {"sbatch",
                                    "--parsable",
                                    "--job-name=" + name,
                                    "--requeue",
                                    "--open-mode=append",
                                    fmt::format("--mem={}M", (memory_bytes + kMegabyte - 1) / kMegabyte)};
  if (!after.empty()) words.push_back(fmt::format("--dependency=afterany:{}", fmt::join(after, ":")));
  if (!options.partition.empty()) words.push_back("--partition=" + options.partition);
  if (!options.account.empty()) words.push_back("--account=" + options.account);
  if (!options.qos.empty()) words.push_back("--qos=" + options.qos);
  return words;
}

void add_own(const FarmOptions& options, const std::string& wrapped, std::vector<std::string>& words) {
  words.insert(words.end(), options.more.begin(), options.more.end());
  words.push_back("--wrap=" + wrapped);
}

}  // namespace

std::string shell_word(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+=:,@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

FarmLimits limits_from(std::string_view config) {
  FarmLimits limits;
  for (const std::string_view line : parts_of(config, '\n')) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const std::optional<int> value = number_from(bare(line.substr(equals + 1)));
    if (!value || *value <= 0) continue;
    const std::string_view key = bare(line.substr(0, equals));
    if (key == "MaxArraySize") limits.array_size = *value;
    if (key == "MaxJobCount") limits.jobs = *value;
  }
  return limits;
}

int asked_minutes(double expected_s, int expected_threads, int cores) {
  const double slower = std::max(1.0, static_cast<double>(expected_threads) / std::max(1, cores));
  const double most_minutes = 365.0 * 24 * 60;
  return static_cast<int>(std::ceil(std::min(most_minutes, (2 * expected_s * slower + 300) / 60)));
}

std::vector<TaskArray> arrays_of(const BatchHeader& header, std::span<const int> tasks, int cores,
                                 const FarmLimits& limits) {
  const int most = std::max(1, std::min(limits.array_size, limits.jobs));
  std::map<std::pair<int, std::uint64_t>, TaskArray> arrays;  // by chunk and class of memory
  for (const int task : tasks) {
    const TaskPlace& place = header.tasks[static_cast<std::size_t>(task)];
    const std::uint64_t memory = place.memory_bytes;
    const int chunk = task / most;
    TaskArray& array = arrays[{chunk, std::bit_ceil(std::max(memory, kSmallestClass))}];
    array.first = chunk * most;
    array.tasks.push_back(task);
    array.memory_bytes = std::max(array.memory_bytes, memory);
    array.minutes = std::max(array.minutes, asked_minutes(place.seconds, header.threads, cores));
  }
  std::vector<TaskArray> all;
  for (auto& [key, array] : arrays) all.push_back(std::move(array));
  return all;
}

std::string indices_of(const TaskArray& array) {
  std::string text;
  for (std::size_t i = 0; i < array.tasks.size();) {
    std::size_t last = i;
    while (last + 1 < array.tasks.size() && array.tasks[last + 1] == array.tasks[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(array.tasks[i] - array.first);
    if (last > i) text += fmt::format("-{}", array.tasks[last] - array.first);
    i = last + 1;
  }
  return text;
}

std::vector<std::string> array_command(const BatchHeader& header, const TaskArray& array,
                                       const FarmOptions& options, const FarmPlaces& places,
                                       std::span<const std::string> after) {
  std::vector<std::string> words = common_arguments(options, job_name_of(header), array.memory_bytes, after);
  const std::string at_once = options.at_once > 0 ? fmt::format("%{}", options.at_once) : "";
  words.push_back("--array=" + indices_of(array) + at_once);
  words.push_back(fmt::format("--comment={}{}", kComment, array.first));
  words.push_back("--signal=B:TERM@60");
  words.push_back(fmt::format("--cpus-per-task={}", options.cores));
  // Where nothing was measured the partition's own limit holds.
  if (header.sampled > 0) words.push_back(fmt::format("--time={}", array.minutes));
  words.push_back("--output=" + without_fields(places.results) + "/log/%A_%a.txt");
  // `exec`: the signal goes to weft, and not to a shell that waits for it.
  add_own(options,
          fmt::format("exec {} batch run {} --array-from {} --threads {} -q", shell_word(places.program),
                      shell_word(places.plan), array.first, options.cores),
          words);
  return words;
}

std::vector<std::string> merge_command(const BatchHeader& header, const FarmOptions& options,
                                       const FarmPlaces& places, std::span<const std::string> after) {
  const std::uint64_t memory_bytes =
      400 * kMegabyte + static_cast<std::uint64_t>(header.sessions + header.left_out) * 20'000;
  std::vector<std::string> words = common_arguments(options, merge_name_of(header), memory_bytes, after);
  words.push_back("--output=" + without_fields(places.results) + "/log/merge_%j.txt");
  add_own(options,
          fmt::format("exec {} batch merge {} -q", shell_word(places.program), shell_word(places.plan)),
          words);
  return words;
}

Result<std::string> job_from(std::string_view said) {
  const std::vector<std::string_view> lines = parts_of(bare(said), '\n');
  // Above it a site's own plugins may have printed something.
  const std::string_view job = bare(parts_of(lines.back(), ';').front());
  if (number_from(job)) return std::string(job);
  return Error{ErrorKind::kProtocol, "sbatch says no number of a job", "sbatch --parsable",
               fmt::format("it printed \"{}\"", bare(said)), "look at squeue before it is submitted again"};
}

std::vector<std::string> queue_command(const BatchHeader& header) {
  return {"squeue", "--noheader", "--array", "--name=" + job_name_of(header) + "," + merge_name_of(header),
          std::string("--format=") + kFormat};
}

int FarmQueue::count(std::string_view state) const {
  return static_cast<int>(std::ranges::count(tasks, state, &QueuedTask::state));
}

std::vector<std::string> FarmQueue::jobs() const {
  std::vector<std::string> all;
  for (const QueuedTask& task : tasks) {
    if (std::ranges::find(all, task.job) == all.end()) all.push_back(task.job);
  }
  return all;
}

FarmQueue queue_from(std::string_view said, const BatchHeader& header) {
  FarmQueue queue;
  for (const std::string_view line : parts_of(said, '\n')) {
    const std::vector<std::string_view> fields = parts_of(bare(line), '|');
    if (fields.size() < kFields) continue;
    if (fields[3] == merge_name_of(header)) queue.merges.emplace_back(fields[0]);
    if (fields[3] != job_name_of(header) || !fields[4].starts_with(kComment)) continue;
    const std::optional<int> index = number_from(fields[1]);
    const std::optional<int> first = number_from(fields[4].substr(std::string_view(kComment).size()));
    if (!index || !first) continue;
    queue.tasks.push_back(
        {*first + *index, std::string(fields[0]), std::string(fields[2]), std::string(fields[5])});
  }
  return queue;
}

std::vector<int> not_queued(std::span<const int> missing, const FarmQueue& queue) {
  std::vector<int> there;
  for (const QueuedTask& task : queue.tasks) there.push_back(task.task);
  std::ranges::sort(there);
  std::vector<int> left;
  std::ranges::copy_if(missing, std::back_inserter(left),
                       [&](int task) { return !std::ranges::binary_search(there, task); });
  return left;
}

bool is_to_be_requeued(std::string_view state, int restarts) {
  return bare(state) == "RUNNING" && restarts < kMostRequeues;
}

}  // namespace weft::library
