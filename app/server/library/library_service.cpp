// SPDX-License-Identifier: Apache-2.0
#include "app/server/library/library_service.h"

#include <utility>

namespace weft::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kFresh = std::chrono::seconds(1);
constexpr auto kBlink = std::chrono::milliseconds(30);
constexpr auto kAtLeast = std::chrono::seconds(60);  // without being asked

}  // namespace

Result<std::unique_ptr<LibraryService>> LibraryService::open(const std::filesystem::path& state,
                                                             std::vector<std::filesystem::path> folders) {
  Result<library::Catalogue> fresh = library::Catalogue::open(state / "library.sqlite");
  if (!fresh) return std::move(fresh).error();
  Result<library::Catalogue> asked = library::Catalogue::open(state / "library.sqlite");
  if (!asked) return std::move(asked).error();
  Result<library::Edits> edits = library::Edits::open(state / "edits.json");
  if (!edits) return std::move(edits).error();
  return std::unique_ptr<LibraryService>(
      new LibraryService(std::move(*fresh), std::move(*asked), std::move(*edits), std::move(folders)));
}

LibraryService::LibraryService(library::Catalogue fresh, library::Catalogue asked, library::Edits edits,
                               std::vector<std::filesystem::path> folders)
    : fresh_(std::move(fresh)),
      folders_(std::move(folders)),
      asked_(std::move(asked)),
      edits_(std::move(edits)),
      thread_([this](const std::stop_token& stop) { refresh(stop); }) {}

LibraryService::~LibraryService() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void LibraryService::refresh(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, stop, kAtLeast, [&] { return is_wanted_; });
      if (stop.stop_requested()) return;
      is_wanted_ = false;
    }
    JobContext context;
    context.threads = 1;
    context.stop = stop;
    (void)fresh_.refresh(folders_, context);
    const std::lock_guard lock(mutex_);
    looked_ = Clock::now();
    changed_.notify_all();
  }
}

void LibraryService::look_again() {
  std::unique_lock lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now - looked_ < kFresh) return;
  is_wanted_ = true;
  changed_.notify_all();
  changed_.wait_for(lock, kBlink, [&] { return looked_ > now; });
}

Result<library::Page> LibraryService::find(const library::Query& query) {
  look_again();
  const std::lock_guard lock(mutex_);
  return asked_.find(query);
}

Result<std::vector<std::pair<std::string, int>>> LibraryService::tags() {
  look_again();
  const std::lock_guard lock(mutex_);
  return asked_.tags();
}

Result<library::Change> LibraryService::change(const std::filesystem::path& session, const Json& fields,
                                               const library::Provided& provided, const std::string& by) {
  const std::lock_guard lock(mutex_);
  Result<library::Change> change = library::change_metadata(session, fields, provided);
  if (!change || change->after.empty()) return change;
  if (Result<void> ok = edits_.add(*change, by); !ok) return std::move(ok).error();
  return after(std::move(change));
}

Result<library::Change> LibraryService::undo() {
  const std::lock_guard lock(mutex_);
  return after(edits_.undo());
}

Result<library::Change> LibraryService::redo() {
  const std::lock_guard lock(mutex_);
  return after(edits_.redo());
}

// The catalogue knows of a change at once.
Result<library::Change> LibraryService::after(Result<library::Change> change) {
  if (change) (void)asked_.refresh(change->folder);
  return change;
}

}  // namespace weft::app
