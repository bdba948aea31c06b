// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"

namespace spdlog {
class logger;
}

namespace weft::app {

/// What happened on a rig, for whoever asks later: a JSON line an event, {"number", "time", "event", "says",
/// ...}, in FOLDER/weft.jsonl. Numbers rise by one, across restarts too. At 4 MB the file becomes
/// weft.1.jsonl and so on; five are kept. Each line is on the disk's way before add() returns. What the disk
/// does not take is lost: no scan ends for its log. Safe from any thread.
class Logbook {
 public:
  using Say = std::function<void(const std::string& line)>;

  /// `say` hears each event as one line for people; empty: nobody does.
  Logbook(const std::filesystem::path& folder, Say say);
  ~Logbook();
  Logbook(const Logbook&) = delete;
  Logbook& operator=(const Logbook&) = delete;

  /// `event`: "scan_began"; `says`: one sentence; `fields`: an object of what else is known.
  void add(const char* event, const std::string& says, Json fields = Json::object());

 private:
  Say say_;
  std::mutex mutex_;
  std::int64_t newest_ = 0;               ///< number of a line
  std::shared_ptr<spdlog::logger> file_;  ///< null where there can be none
};

/// Some lines of a log.
struct LogPage {
  std::vector<Json> lines;  ///< the newest last
  bool more = false;        ///< newer ones follow
};
/// The first `limit` lines after the one of this number, as far as they are still kept; without a number the
/// newest. What is no line of a log is left out. From any thread or process, while it is written.
LogPage read_log(const std::filesystem::path& folder, std::optional<std::int64_t> after, std::size_t limit);

}  // namespace weft::app
