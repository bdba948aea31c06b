// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/server/library/looker.h"
#include "core/base/result.h"
#include "core/rig/session.h"
#include "library/catalogue/catalogue.h"
#include "library/catalogue/edits.h"

namespace weft::app {

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
