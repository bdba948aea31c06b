// SPDX-License-Identifier: Apache-2.0
#include "app/server/library/library_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "core/base/files.h"
#include "core/base/sha256.h"
#include "library/catalogue/session_name.h"

namespace weft::app {
namespace {

constexpr int kRest = 20;  // of the time that a look took
constexpr auto kPatience = std::chrono::seconds(1);

using Clock = Looker::Clock;

constexpr auto kFresh = std::chrono::seconds(1);
constexpr auto kBlink = std::chrono::milliseconds(20);
constexpr auto kFirst = std::chrono::seconds(5);

Error no_session(const std::string& name) {
  return {ErrorKind::kNoInput, "there is no such session", name, "",
          "see /api/v1/sessions for those there are"};
}

// What looks at a folder and writes what it finds.
Result<std::unique_ptr<Looker>> looker_at(const library::Catalogue& beside, std::filesystem::path folder) {
  Result<library::Catalogue> opened = beside.beside();
  if (!opened) return std::move(opened).error();
  auto catalogue = std::make_shared<library::Catalogue>(std::move(*opened));
  return std::make_unique<Looker>(
      [catalogue, folder = std::move(folder)](const std::stop_token& stop, const auto& beat) {
        JobContext context;
        context.threads = 1;
        context.stop = stop;
        context.progress = [&](std::string_view, double) { beat(); };
        (void)catalogue->refresh({folder}, context);
      },
      kFresh);
}

}  // namespace

struct Looker::State {
  State(Look its_look, Clock::duration its_fresh) : look(std::move(its_look)), fresh(its_fresh) {}

  const Look look;
  const Clock::duration fresh;
  mutable std::mutex mutex;
  std::condition_variable changed;
  bool is_wanted = true, is_expired = false, is_stopped = false, is_gone = false;
  std::uint64_t begun = 0, ended = 0;  // looks
  Clock::time_point beat, end;         // the last ones
  Clock::duration took = {};

  bool is_looking() const { return begun > ended; }
  bool is_due() const {
    return ended == 0 || is_expired || fresh == fresh.zero() ||
           Clock::now() - end >= std::max(fresh, took * kRest);
  }
  void run(const std::stop_token& stop);
};

void Looker::State::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [&] { return is_wanted || is_stopped; });
    if (is_stopped) break;
    is_wanted = is_expired = false;
    ++begun;
    const Clock::time_point began = beat = Clock::now();
    lock.unlock();
    look(stop, [&] {
      const std::lock_guard beat_lock(mutex);
      beat = Clock::now();
    });
    lock.lock();
    ended = begun;
    end = Clock::now();
    took = end - began;
    changed.notify_all();
  }
  is_gone = true;
  changed.notify_all();
}

Looker::Looker(Look look, Clock::duration fresh) : state_(std::make_shared<State>(std::move(look), fresh)) {
  // A thread that waits for a disk for ever cannot be joined. It holds all that it works on.
  std::thread([state = state_, stop = stop_.get_token()] { state->run(stop); }).detach();
}

Looker::~Looker() {
  stop_.request_stop();
  std::unique_lock lock(state_->mutex);
  state_->is_stopped = true;
  state_->changed.notify_all();
  state_->changed.wait_for(lock, kPatience, [&] { return state_->is_gone; });
}

void Looker::expire() {
  const std::lock_guard lock(state_->mutex);
  state_->is_expired = true;
}

std::uint64_t Looker::ask() {
  const std::lock_guard lock(state_->mutex);
  const bool is_anew = state_->fresh == state_->fresh.zero() || state_->is_expired;
  if (state_->is_looking() && !is_anew) return state_->begun;
  if (!state_->is_due()) return state_->ended;
  state_->is_wanted = true;
  state_->changed.notify_all();
  return state_->begun + 1;
}

void Looker::wait(std::uint64_t look, Clock::time_point until) {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait_until(lock, until, [&] { return state_->ended >= look; });
}

bool Looker::is_first() const {
  const std::lock_guard lock(state_->mutex);
  return state_->ended == 0;
}

bool Looker::is_stuck() const {
  const std::lock_guard lock(state_->mutex);
  return state_->is_looking() && Clock::now() - state_->beat > kStuck;
}

// Outlives the service where its disk hangs.
struct LibraryService::Watched {
  explicit Watched(library::Catalogue its_catalogue) : catalogue(std::move(its_catalogue)) {}

  library::Catalogue catalogue;
  std::mutex mutex;
  std::filesystem::path session;

  void look() {
    std::unique_lock lock(mutex);
    const std::filesystem::path now = session;
    lock.unlock();
    if (!now.empty()) (void)catalogue.refresh(now);
  }
};

Result<std::unique_ptr<LibraryService>> LibraryService::open(
    const std::filesystem::path& state, const std::filesystem::path& home,
    const std::vector<std::filesystem::path>& archives) {
  // A scan in another folder does not throw away what is known of this one.
  const std::string of_home = sha256_of(absolute_folder(home).string()).substr(0, 16);
  Result<library::Catalogue> asked =
      library::Catalogue::open(state / fmt::format("library-{}.sqlite", of_home));
  if (!asked) return std::move(asked).error();
  std::vector<std::filesystem::path> all = archives;
  all.push_back(home);
  if (Result<void> ok = asked->keep_only(all); !ok) return std::move(ok).error();
  Result<library::Catalogue> edited = asked->beside();
  if (!edited) return std::move(edited).error();
  Result<library::Edits> edits = library::Edits::open(state / "edits.json");
  if (!edits) return std::move(edits).error();
  std::unique_ptr<LibraryService> service(
      new LibraryService(std::move(*asked), std::move(*edited), std::move(*edits), home, archives));
  if (Result<void> ok = service->begin_looking(); !ok) return std::move(ok).error();
  return service;
}

LibraryService::LibraryService(library::Catalogue asked, library::Catalogue edited, library::Edits edits,
                               std::filesystem::path home, std::vector<std::filesystem::path> archives)
    : home_(absolute_folder(home)),
      archives_(std::move(archives)),
      asked_(std::move(asked)),
      edited_(std::move(edited)),
      edits_(std::move(edits)) {}

LibraryService::~LibraryService() = default;

Result<void> LibraryService::begin_looking() {
  Result<library::Catalogue> catalogue = asked_.beside();
  if (!catalogue) return std::move(catalogue).error();
  watched_ = std::make_shared<Watched>(std::move(*catalogue));
  at_watched_ =
      std::make_unique<Looker>([watched = watched_](const std::stop_token&, const auto&) { watched->look(); },
                               Clock::duration::zero());
  Result<std::unique_ptr<Looker>> looker = looker_at(asked_, home_);
  if (!looker) return std::move(looker).error();
  at_home_ = std::move(*looker);
  for (const std::filesystem::path& archive : archives_) {
    Result<std::unique_ptr<Looker>> at_archive = looker_at(asked_, absolute_folder(archive));
    if (!at_archive) return std::move(at_archive).error();
    at_archives_.push_back(std::move(*at_archive));
  }
  return {};
}

void LibraryService::look_again() {
  const Clock::time_point now = Clock::now();
  const auto until = now + (at_home_->is_first() ? Clock::duration(kFirst) : kBlink);
  const std::uint64_t home = at_home_->ask(), watched = at_watched_->ask();
  at_watched_->wait(watched, until);
  at_home_->wait(home, until);
  // Their disks may be slow: a question has them look again and waits for a blink at most.
  for (const auto& archive : at_archives_) archive->wait(archive->ask(), until);
}

Result<library::CataloguePage> LibraryService::find(const library::Query& query) {
  look_again();
  const std::lock_guard lock(asked_mutex_);
  return asked_.find(query);
}

Result<std::vector<std::pair<std::string, int>>> LibraryService::tags() {
  look_again();
  const std::lock_guard lock(asked_mutex_);
  return asked_.tags();
}

Result<Session> LibraryService::session(const std::string& name) {
  const Result<std::filesystem::path> folder = folder_of(name);
  if (!folder) return folder.error();
  return read_session(*folder);
}

Result<std::filesystem::path> LibraryService::folder_of(const std::string& name) {
  Result<std::filesystem::path> folder = library::session_folder(home_, name);
  if (!folder || is_there(*folder / "session.json")) return folder;
  const std::lock_guard lock(asked_mutex_);
  const Result<library::Entry> entry = asked_.find_one(name);
  if (!entry) return entry.error().kind == ErrorKind::kNoInput ? no_session(name) : entry.error();
  return entry->folder;
}

std::vector<std::filesystem::path> LibraryService::silent() const {
  std::vector<std::filesystem::path> folders;
  for (std::size_t i = 0; i < archives_.size(); ++i) {
    if (at_archives_[i]->is_stuck()) folders.push_back(archives_[i]);
  }
  return folders;
}

void LibraryService::watch(const std::filesystem::path& session) {
  const std::lock_guard lock(watched_->mutex);
  watched_->session = session;
}

Result<library::MetadataChange> LibraryService::change(const std::filesystem::path& session,
                                                       const Json& fields, const library::Provided& provided,
                                                       const std::string& by) {
  const std::lock_guard lock(edits_mutex_);
  Result<library::MetadataChange> change = library::change_metadata(session, fields, provided);
  if (!change || change->after.empty()) return change;
  if (Result<void> ok = edits_.add(*change, by); !ok) return std::move(ok).error();
  return after(std::move(change));
}

Result<library::MetadataChange> LibraryService::undo() {
  const std::lock_guard lock(edits_mutex_);
  return after(edits_.undo());
}

Result<library::MetadataChange> LibraryService::redo() {
  const std::lock_guard lock(edits_mutex_);
  return after(edits_.redo());
}

// The catalogue knows of a change at once.
Result<library::MetadataChange> LibraryService::after(Result<library::MetadataChange> change) {
  if (change) (void)edited_.refresh(change->folder);
  return change;
}

}  // namespace weft::app
