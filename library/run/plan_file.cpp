// SPDX-License-Identifier: Apache-2.0
#include "library/run/plan_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "core/base/descriptor.h"
#include "core/base/files.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestPlan = std::size_t{8} << 30;
constexpr std::size_t kLargestHeader = std::size_t{64} << 20;

// So many bytes from `offset` on, or what is there of them.
Result<std::string> read_part(const fs::path& file, std::uint64_t offset, std::uint64_t bytes) {
  const Descriptor in(file, O_RDONLY);
  if (!in) return cannot_read(file, errno);
  const off_t size = ::lseek(in.get(), 0, SEEK_END);
  if (size < 0) return cannot_read(file, errno);
  const std::uint64_t there =
      static_cast<std::uint64_t>(size) - std::min(static_cast<std::uint64_t>(size), offset);
  bytes = std::min(bytes, there);
  std::string text(bytes, '\0');
  std::size_t read = 0;
  while (read < bytes) {
    const ssize_t n = ::pread(in.get(), text.data() + read, bytes - read, static_cast<off_t>(offset + read));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return cannot_read(file, errno);
    if (n == 0) break;
    read += static_cast<std::size_t>(n);
  }
  text.resize(read);
  return text;
}

Result<std::string> first_line(const fs::path& file) {
  for (std::size_t bytes = std::size_t{1} << 16;; bytes *= 8) {
    Result<std::string> text = read_part(file, 0, bytes);
    if (!text) return text;
    const std::size_t end = text->find('\n');
    if (end == std::string::npos && text->size() == bytes && bytes < kLargestHeader) continue;
    text->resize(std::min(end, text->size()));
    return text;
  }
}

}  // namespace

fs::path PlanFile::results() const {
  fs::path folder = file;
  return folder.replace_extension(".results");
}

fs::path PlanFile::results_of(int task) const {
  return results() / fmt::format("task-{}.jsonl", task);
}

Result<PlanFile> open_plan(const fs::path& file) {
  Result<std::string> line = first_line(file);
  if (!line) return std::move(line).error();
  Result<BatchHeader> header = header_from_line(*line, file.string());
  if (!header) return std::move(header).error();
  return PlanFile{absolute_folder(file), std::move(*header), line->size() + 1};
}

Result<std::vector<PlannedSolve>> read_task(const PlanFile& plan, int task) {
  const auto& tasks = plan.header.tasks;
  if (task < 0 || static_cast<std::size_t>(task) >= tasks.size()) {
    return Error{ErrorKind::kUsage, "no such task", fmt::format("--task {}", task),
                 tasks.empty() ? fmt::format("{} has none", plan.file.string())
                               : fmt::format("{} has 0 to {}", plan.file.string(), tasks.size() - 1),
                 "name one of them"};
  }
  const TaskPlace& place = tasks[static_cast<std::size_t>(task)];
  const Result<std::string> lines = read_part(plan.file, plan.lines_at + place.offset, place.bytes);
  if (!lines) return lines.error();
  Result<std::vector<PlannedSolve>> solves = solves_from_lines(*lines, plan.file.string());
  if (!solves) return solves;
  const bool fits =
      static_cast<int>(solves->size()) == place.sessions &&
      std::ranges::all_of(*solves, [&](const PlannedSolve& planned) { return planned.task == task; });
  if (fits) return solves;
  return Error{ErrorKind::kBadData, "plan cannot be used", plan.file.string(),
               fmt::format("its lines of task {} are not where its first line says", task),
               "make it again with weft batch plan"};
}

Result<BatchPlan> read_plan(const fs::path& file) {
  const Result<std::string> text = read_text(file, kLargestPlan);
  if (!text) return text.error();
  return plan_from_text(*text, file.string());
}

Result<void> write_plan(const fs::path& file, const std::string& text) {
  const Result<bool> there = look_for(file);
  if (!there) return there.error();
  if (*there) {
    const Result<std::string> before = read_text(file, kLargestPlan);
    if (before && *before == text) return {};
    return Error{ErrorKind::kCannotCreate, "there is a file of this name", file.string(),
                 "a plan never changes once it is written", "name another file with -o, or remove it"};
  }
  if (Result<void> made = make_writable_folder(absolute_folder(file).parent_path()); !made)
    return made.error();
  return write_file(file, text);
}

Result<std::map<std::string, TaskHistory>> read_histories(const PlanFile& plan,
                                                          const std::vector<int>& tasks) {
  std::vector<int> all = tasks;
  for (int task = 0; tasks.empty() && task < static_cast<int>(plan.header.tasks.size()); ++task)
    all.push_back(task);
  std::map<std::string, TaskHistory> histories;
  for (const int task : all) {
    const fs::path file = plan.results_of(task);
    const Result<bool> there = look_for(file);
    if (!there) return there.error();
    if (!*there) continue;
    const Result<std::string> lines = read_text(file, kLargestPlan);
    if (!lines) return lines.error();
    add_histories(*lines, plan.header.id, histories);
  }
  return histories;
}

Result<void> add_outcome(const PlanFile& plan, int task, const TaskOutcome& outcome) {
  const fs::path file = plan.results_of(task);
  const Descriptor out(file, O_RDWR | O_APPEND | O_CREAT);
  if (!out) return cannot_write(file, errno);
  const off_t end = ::lseek(out.get(), 0, SEEK_END);
  char last = '\n';
  if (end > 0 && ::pread(out.get(), &last, 1, end - 1) != 1) return cannot_write(file, errno);
  std::string line = last == '\n' ? "" : "\n";
  line += line_of(outcome);
  // One call, so that lines of two processes do not mix.
  const ssize_t written = ::write(out.get(), line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size())) return cannot_write(file, written < 0 ? errno : ENOSPC);
  if (::fsync(out.get()) != 0) return cannot_write(file, errno);
  return {};
}

}  // namespace weft::library
