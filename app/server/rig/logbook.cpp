// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/logbook.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include <chrono>
#include <cstddef>
#include <deque>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "app/server/http/error_reply.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"

namespace weft::app {
namespace {

constexpr std::size_t kFileBytes = std::size_t{4} << 20;
constexpr std::size_t kOlderFiles = 4;

/// FOLDER/weft.jsonl, the one before it, and so on.
std::filesystem::path file_of(const std::filesystem::path& folder, std::size_t age) {
  return folder / (age == 0 ? std::string("weft.jsonl") : fmt::format("weft.{}.jsonl", age));
}

/// visit(line, number) for each line of a log, the newest first, until it returns false.
template <typename Visit>
void for_each_line(const std::filesystem::path& folder, const Visit& visit) {
  std::int64_t before = std::numeric_limits<std::int64_t>::max();  // a file may become another meanwhile
  for (std::size_t age = 0; age <= kOlderFiles; ++age) {
    const Result<std::string> text = read_text(file_of(folder, age), 2 * kFileBytes);
    std::string_view left = text ? std::string_view(*text) : std::string_view();
    while (!left.empty()) {
      left.remove_suffix(left.ends_with('\n') ? 1 : 0);
      const std::size_t begin = left.rfind('\n') + 1;
      Json line = Json::parse(left.substr(begin), nullptr, false);
      left = left.substr(0, begin);
      const Json number = line.is_object() ? line.value("number", Json()) : Json();
      if (!number.is_number_integer() || number.get<std::int64_t>() >= before) continue;
      before = number.get<std::int64_t>();
      if (!visit(std::move(line), before)) return;
    }
  }
}

std::string now() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return iso_time(std::chrono::duration<double>(since_1970).count());
}

}  // namespace

Logbook::Logbook(const std::filesystem::path& folder, Say say) : say_(std::move(say)) {
  try {
    file_ = std::make_shared<spdlog::logger>(
        "weft", std::make_shared<spdlog::sinks::rotating_file_sink_mt>((folder / "weft.jsonl").string(),
                                                                       kFileBytes, kOlderFiles));
  } catch (const spdlog::spdlog_ex& failed) {
    if (say_) say_(fmt::format("no log: {}", failed.what()));
    return;
  }
  for_each_line(folder, [this](const Json&, std::int64_t number) {
    newest_ = number;
    return false;
  });
  file_->set_pattern("%v");
  file_->flush_on(spdlog::level::info);
  file_->set_error_handler([](const std::string&) {});
}

Logbook::~Logbook() = default;

void Logbook::add(const char* event, const std::string& says, Json fields) {
  if (say_) say_(fmt::format("{}: {}", event, says));
  if (!file_) return;
  const std::lock_guard lock(mutex_);
  fields["number"] = ++newest_;
  fields["time"] = now();
  fields["event"] = event;
  fields["says"] = says;
  file_->info(spdlog::string_view_t(line_of(fields)));
}

LogPage read_log(const std::filesystem::path& folder, std::optional<std::int64_t> after, std::size_t limit) {
  std::deque<Json> lines;  // the oldest seen so far
  LogPage page;
  for_each_line(folder, [&](Json line, std::int64_t number) {
    if (after ? number <= *after : lines.size() == limit) return false;
    lines.push_front(std::move(line));
    if (lines.size() > limit) {
      lines.pop_back();
      page.more = true;
    }
    return true;
  });
  page.lines.assign(std::make_move_iterator(lines.begin()), std::make_move_iterator(lines.end()));
  return page;
}

}  // namespace weft::app
