// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/json_document.h"

namespace spdlog {
class logger;
}

namespace weft::app {

/// What happened on a rig, for whoever asks later: a JSON line an event, {"time", "event", "says", ...}, in
/// FOLDER/weft.jsonl. At 4 MB it becomes weft.1.jsonl and so on; five files are kept. Each line is on the
/// disk's way before add() returns. What the disk does not take is lost: no scan ends for its log. Safe from
/// any thread.
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
  std::shared_ptr<spdlog::logger> file_;  ///< null where there can be none
};

}  // namespace weft::app
