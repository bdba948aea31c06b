// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/logbook.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include <chrono>
#include <cstddef>
#include <utility>

#include "app/server/http/error_json.h"
#include "core/iso_time.h"

namespace weft::app {
namespace {

constexpr std::size_t kFileBytes = std::size_t{4} << 20;
constexpr std::size_t kOlderFiles = 4;

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
  file_->set_pattern("%v");
  file_->flush_on(spdlog::level::info);
  file_->set_error_handler([](const std::string&) {});
}

Logbook::~Logbook() = default;

void Logbook::add(const char* event, const std::string& says, Json fields) {
  if (say_) say_(fmt::format("{}: {}", event, says));
  if (!file_) return;
  fields["time"] = now();
  fields["event"] = event;
  fields["says"] = says;
  file_->info(spdlog::string_view_t(line_of(fields)));
}

}  // namespace weft::app
