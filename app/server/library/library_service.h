// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/result.h"
#include "library/catalogue.h"
#include "library/edits.h"

namespace weft::app {

/// The library of a server: its catalogue, kept fresh by a thread of its own so that a slow disk delays
/// nobody who asks, and the changes that people make. Safe from any thread.
class LibraryService {
 public:
  /// Keeps library.sqlite and edits.json in `state`. Errors of Catalogue::open() and Edits::open().
  static Result<std::unique_ptr<LibraryService>> open(const std::filesystem::path& state,
                                                      std::vector<std::filesystem::path> folders);
  ~LibraryService();

  /// As the folders were at most a second ago, or, where looking through them takes longer than a blink, as
  /// they were known.
  Result<library::Page> find(const library::Query& query);
  Result<std::vector<std::pair<std::string, int>>> tags();
  /// Changes what is said of a session (library/metadata.h) and remembers it for undo().
  Result<library::Change> change(const std::filesystem::path& session, const Json& fields,
                                 const library::Provided& provided, const std::string& by);
  Result<library::Change> undo();
  Result<library::Change> redo();

 private:
  LibraryService(library::Catalogue fresh, library::Catalogue asked, library::Edits edits,
                 std::vector<std::filesystem::path> folders);
  void refresh(const std::stop_token& stop);
  void look_again();
  Result<library::Change> after(Result<library::Change> change);

  library::Catalogue fresh_;  // of the thread
  std::vector<std::filesystem::path> folders_;
  std::mutex mutex_;  // of what follows
  library::Catalogue asked_;
  library::Edits edits_;
  std::condition_variable_any changed_;
  bool is_wanted_ = true;
  std::chrono::steady_clock::time_point looked_ = {};
  std::jthread thread_;
};

}  // namespace weft::app
