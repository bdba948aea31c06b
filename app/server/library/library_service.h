// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/rig/session.h"
#include "library/catalogue/catalogue.h"
#include "library/catalogue/edits.h"

namespace weft::app {

/// Looks at a disk on a thread of its own whenever somebody asks, so that a disk that is slow or hangs delays
/// nobody for longer than he wants to wait. Safe from any thread.
class Looker {
 public:
  using Clock = std::chrono::steady_clock;
  /// One look. Calls `beat` as it goes on: without a beat for kStuck the disk hangs. What it works on must
  /// outlive it: it is held by the function, never by the caller, who may be gone before a look that hangs.
  using Look = std::function<void(const std::stop_token& stop, const std::function<void()>& beat)>;
  static constexpr auto kStuck = std::chrono::seconds(3);

  /// Begins with a look. Another is not begun before the last one is as old as `fresh`, and twenty times as
  /// old as it took: looking takes at most a twentieth of a thread. Where `fresh` is 0 each question looks.
  Looker(Look look, Clock::duration fresh);
  /// Waits a second for a look to end; one that hangs is left to itself.
  ~Looker();
  Looker(const Looker&) = delete;
  Looker& operator=(const Looker&) = delete;

  /// What is known is old: the next question looks.
  void expire();
  /// Has it look again where that is due; the number of the look that tells how things are now.
  std::uint64_t ask();
  /// Waits until that look has ended, but not past `until`.
  void wait(std::uint64_t look, Clock::time_point until);
  /// Whether no look has ended yet.
  bool is_first() const;
  /// Whether the disk hangs.
  bool is_stuck() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
  std::stop_source stop_;
};

/// The library of a server: the catalogue of its folders, each looked at by a thread of its own so that a
/// slow disk delays nobody who asks, and the changes that people make. Safe from any thread.
class LibraryService {
 public:
  /// Keeps a catalogue of its own for each `home`, and edits.json, in `state`. Sessions go by their names:
  /// one of `home`, the rig's folder, before one of the archives, which are looked at with all below them.
  /// Errors of Catalogue::open() and Edits::open().
  static Result<std::unique_ptr<LibraryService>> open(
      const std::filesystem::path& state, const std::filesystem::path& home,
      const std::vector<std::filesystem::path>& archives = {});
  ~LibraryService();

  /// As the folders were at most a second ago, or, where looking through them takes longer than a blink, as
  /// they were known. The first question waits up to five seconds for the first look at `home`.
  Result<library::CataloguePage> find(const library::Query& query);
  Result<std::vector<std::pair<std::string, int>>> tags();
  /// A session by its name, as its session.json is now. kUsage for what is no name and for one that several
  /// archives have, kNoInput where there is none, errors of read_session().
  Result<Session> session(const std::string& name);
  /// Its folder, whether or not its session.json can be read. The other errors of session().
  Result<std::filesystem::path> folder_of(const std::string& name);
  /// Archives whose disk does not answer: what was known of them stays.
  std::vector<std::filesystem::path> silent() const;
  /// The session that is written now: each question is answered as it is at that moment.
  void watch(const std::filesystem::path& session);

  /// Something was made in a session: the next question looks.
  void expire() { at_home_->expire(); }

  /// Changes what is said of a session (library/catalogue/metadata.h) and remembers it for undo().
  Result<library::MetadataChange> change(const std::filesystem::path& session, const Json& fields,
                                         const library::Provided& provided, const std::string& by);
  Result<library::MetadataChange> undo();
  Result<library::MetadataChange> redo();

 private:
  struct Watched;
  LibraryService(library::Catalogue asked, library::Catalogue edited, library::Edits edits,
                 std::filesystem::path home, std::vector<std::filesystem::path> archives);
  Result<void> begin_looking();
  void look_again();
  Result<library::MetadataChange> after(Result<library::MetadataChange> change);

  const std::filesystem::path home_;
  const std::vector<std::filesystem::path> archives_;
  std::mutex asked_mutex_;
  library::Catalogue asked_;
  std::mutex edits_mutex_;  ///< of its own: an edit waits for its disk
  library::Catalogue edited_;
  library::Edits edits_;
  std::shared_ptr<Watched> watched_;
  std::unique_ptr<Looker> at_home_, at_watched_;
  std::vector<std::unique_ptr<Looker>> at_archives_;  ///< in the order of archives_
};

}  // namespace weft::app
