// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>

#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/base/partial_name.h"
#include "core/describe/field_json.h"
#include "core/rig/scan_verdict.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCapturing = "capturing";
constexpr const char* kComplete = "complete";

Result<void> make_session(const ScanRequest& request, const std::string& calibration_id, const ShotList& list,
                          const AfterStep& after_step) {
  remove_abandoned(fs::absolute(request.session));
  PartialFolder aside(request.session);
  if (Result<void> made = make_writable_folder(aside.path() / "raw"); !made) return made;
  after_step("raw made");
  if (!request.calibration.empty()) {
    std::error_code failed;
    fs::copy(request.calibration, aside.path() / "calibration", fs::copy_options::recursive, failed);
    if (failed) return cannot_write(aside.path() / "calibration", failed.value());
  }
  after_step("calibration copied");
  Session session;
  session.folder = aside.path();
  session.fabric = request.fabric;
  session.cloth_height_mm = request.cloth_height_mm;
  session.pose = request.pose;
  session.rig = request.rig;
  session.calibration_id = calibration_id;
  session.state = kCapturing;
  session.document = Json::object();
  session.document["schema"] = "weft.session/1.2";
  session.document["plan"] = to_json(list);
  if (!request.metadata.empty()) session.document["metadata"] = request.metadata;
  if (!request.calibrated.is_null()) session.document["calibrated"] = request.calibrated;
  if (!request.accepted_moved.is_null()) session.document["accepted_moved"] = request.accepted_moved;
  if (Result<void> written = write_session(session); !written) return written;
  after_step("session.json made");
  if (Result<void> published = aside.publish(); !published) return published;
  after_step("session published");
  return {};
}

Error cannot_resume(const Session& session, const std::string& why) {
  return {ErrorKind::kCannotCreate, "session was begun as another scan", session.folder.string(), why,
          "scan under another name, or ask for what the session was begun with"};
}

Result<void> check_same_scan(const Session& session, const ScanRequest& request,
                             const std::string& calibration_id, const ShotList& list) {
  if (session.rig != request.rig) {
    return cannot_resume(session,
                         fmt::format("it is of rig \"{}\", this is \"{}\"", session.rig, request.rig));
  }
  if (session.calibration_id != calibration_id) {
    return cannot_resume(session, fmt::format("its calibration is {:.12}, the rig's now {:.12}",
                                              session.calibration_id, calibration_id));
  }
  if (session.fabric != request.fabric || session.cloth_height_mm != request.cloth_height_mm) {
    return cannot_resume(session,
                         fmt::format("its cloth is \"{}\" at {} mm, this is \"{}\" at {} mm", session.fabric,
                                     session.cloth_height_mm, request.fabric, request.cloth_height_mm));
  }
  if (session.pose != request.pose) {
    return cannot_resume(session, fmt::format("its cloth lies tilted by {} degrees to {}, this by {} to {}",
                                              session.pose.tilt_deg, session.pose.downhill_deg,
                                              request.pose.tilt_deg, request.pose.downhill_deg));
  }
  if (!session.document.contains("plan") || session.document["plan"] != to_json(list)) {
    return cannot_resume(session, "its LEDs, repeat, brackets, polariser or light below are others");
  }
  const std::vector<DueShot> plan = plan_shots(list, {}, {});
  for (const Shot& shot : session.shots) {
    const bool is_planned = shot.index >= 0 && shot.index < static_cast<int>(plan.size()) &&
                            plan[static_cast<std::size_t>(shot.index)].led == shot.led &&
                            plan[static_cast<std::size_t>(shot.index)].role == shot.role &&
                            plan[static_cast<std::size_t>(shot.index)].polariser == shot.polariser;
    if (is_planned) continue;
    return Error{ErrorKind::kBadData, "session has a shot that its plan has not", session.folder.string(),
                 fmt::format("{}: index {}, LED {}", shot.file, shot.index, shot.led),
                 "scan under another name"};
  }
  return {};
}

/// The session, if it can be gone on with.
Result<Session> unfinished(const ScanRequest& request, const std::string& calibration_id,
                           const ShotList& list) {
  Result<Session> session = read_session(request.session);
  if (!session) return session;
  if (session->state == kComplete) {
    return Error{ErrorKind::kCannotCreate, "session is finished", request.session.string(),
                 "sessions are never overwritten", "scan under another name with -o"};
  }
  if (Result<void> ok = check_same_scan(*session, request, calibration_id, list); !ok) return ok.error();
  return session;
}

/// The folder, locked for as long as the descriptor lives.
Result<Descriptor> locked(const fs::path& folder) {
  Descriptor lock(folder, O_RDONLY | O_DIRECTORY);
  if (!lock) return cannot_write(folder, errno);
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) == 0) return lock;
  if (errno != EWOULDBLOCK) return cannot_write(folder, errno);
  return Error{ErrorKind::kTryAgain, "another scan writes this session", folder.string(),
               "its folder is locked by another process", "wait for that scan, or choose another name"};
}

/// The time of the session's other frames of this setting, else the one that the photograph says, else the
/// one that was set: cameras name 1/60 s in several ways, and a session has one.
double exposure_us_of(const DueShot& planned, const Photograph& photograph, const Session& session) {
  const auto setting = [](ShotRole role) {
    return role == ShotRole::kBracket || role == ShotRole::kBelow ? role : ShotRole::kLit;
  };
  for (const Shot& shot : session.shots) {
    if (setting(shot.role) == setting(planned.role)) return shot.exposure_us;
  }
  return photograph.exposure.exposure_us > 0 ? photograph.exposure.exposure_us : planned.exposure.exposure_us;
}

Error unseen(const fs::path& path, std::string why) {
  return {ErrorKind::kInputOutput, "frames of the session cannot be seen", path.string(), std::move(why),
          "bring back the disk they are on, then run the same command again; until then all stays as it is"};
}

}  // namespace

Result<int> Journal::check(const ScanRequest& request, const std::string& calibration_id,
                           const ShotList& list) {
  const Result<bool> there = look_for(request.session);
  if (!there) return there.error();
  if (!*there) return list.count();
  const Result<Session> session = unfinished(request, calibration_id, list);
  if (!session) return session.error();
  return list.count() - static_cast<int>(session->shots.size());
}

Result<Journal> Journal::open(const ScanRequest& request, const std::string& calibration_id,
                              const ShotList& list, AfterStep after_step) {
  const Result<bool> there = look_for(request.session);
  if (!there) return there.error();
  if (!*there) {
    if (Result<void> made = make_session(request, calibration_id, list, after_step); !made)
      return made.error();
  }
  Result<Descriptor> lock = locked(request.session);
  if (!lock) return lock.error();
  // Under the lock: another scan may have finished it meanwhile.
  Result<Session> session = unfinished(request, calibration_id, list);
  if (!session) return session.error();

  Journal journal(std::move(*session), std::move(*lock), std::move(after_step));
  if (Result<void> made = make_writable_folder(journal.incoming_); !made) return made.error();
  if (Result<void> cleared = journal.clear_incoming(); !cleared) return cleared.error();
  if (Result<void> forgotten = journal.forget_damaged(); !forgotten) return forgotten.error();
  if (Result<void> aside = journal.move_unnamed_aside(); !aside) return aside.error();
  return journal;
}

Result<Journal> Journal::reopen(const ScanRequest& request, const std::string& calibration_id,
                                AfterStep after_step) {
  Result<Descriptor> lock = locked(request.session);
  if (!lock) return lock.error();
  Result<Session> session = read_session(request.session);
  if (!session) return session.error();
  const auto refuse = [&](std::string why, std::string remedy) {
    return Error{ErrorKind::kCannotCreate, "no shot of the session can be taken again",
                 request.session.string(), std::move(why), std::move(remedy)};
  };
  if (session->state != kComplete) return refuse("it is not finished", "finish it first: scan it again");
  if (session->rig != request.rig) return refuse("it is of rig \"" + session->rig + "\"", "use that rig");
  if (session->calibration_id != calibration_id)
    return refuse("its calibration is not the one beside it", "bring the calibration back that it names");
  Journal journal(std::move(*session), std::move(*lock), std::move(after_step));
  if (Result<void> made = make_writable_folder(journal.incoming_); !made) return made.error();
  if (Result<void> cleared = journal.clear_incoming(); !cleared) return cleared.error();
  return journal;
}

Result<void> Journal::clear_incoming() const {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(incoming_, failed)) {
    fs::remove_all(entry.path(), failed);
    if (failed) break;
  }
  return failed ? Result<void>(cannot_write(incoming_, failed.value())) : Result<void>();
}

void Journal::forget_incoming() const {
  std::error_code ignored;
  fs::remove_all(incoming_, ignored);
}

Result<void> Journal::forget_damaged() {
  const fs::path raw = session_.folder / "raw";
  std::error_code failed;
  if (fs::directory_iterator(raw, failed); failed) return unseen(raw, failed.message());
  std::vector<int> damaged;
  for (const Shot& shot : session_.shots) {
    const fs::path file = session_.path_of(shot);
    const Result<bool> there = look_for(file);
    if (!there) return there.error();
    const Result<std::string> digest = *there ? sha256_of_file(file) : std::string();
    if (!digest) return unseen(file, digest.error().why);
    if (*digest != shot.sha256) damaged.push_back(shot.index);
  }
  return damaged.empty() ? Result<void>() : discard(damaged);
}

Result<void> Journal::move_unnamed_aside() const {
  const fs::path raw = session_.folder / "raw";
  std::vector<fs::path> unnamed;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(raw, failed)) {
    const bool is_named = std::any_of(session_.shots.begin(), session_.shots.end(), [&](const Shot& shot) {
      return session_.path_of(shot).filename() == entry.path().filename();
    });
    if (!is_named && entry.path() != dropped()) unnamed.push_back(entry.path());
  }
  if (failed) return unseen(raw, failed.message());
  for (const fs::path& file : unnamed) {
    if (Result<void> moved = move_aside(file); !moved) return moved;
  }
  return {};
}

Result<void> Journal::move_aside(const fs::path& file) const {
  if (Result<void> made = make_writable_folder(dropped()); !made) return made;
  fs::path place = dropped() / file.filename();
  for (int i = 2; is_there(place); ++i) place = dropped() / fmt::format("{}.{}", file.filename().string(), i);
  if (::rename(file.c_str(), place.c_str()) != 0) return cannot_write(place, errno);
  return {};
}

Result<void> Journal::replace(Session session) {
  if (Result<void> written = write_session(session); !written) return written;
  session_ = std::move(session);
  return {};
}

Result<void> Journal::set_exposure(const Json& exposure, double shutter_travel_s) {
  Session session = session_;
  session.document["exposure"] = exposure;
  session.shutter_travel_s = shutter_travel_s;
  Result<void> done = replace(std::move(session));
  after_step_("exposure written");
  return done;
}

Result<Shot> Journal::keep(const DueShot& planned, const Photograph& photograph, const Json& notes) {
  const Result<std::string> digest = sha256_of_file(photograph.file);
  if (!digest) return digest.error();
  if (*digest != photograph.sha256) {
    return Error{ErrorKind::kTryAgain, "photograph was damaged on its way", photograph.file.string(),
                 "its SHA-256 is not the one it was received with",
                 "scan again; check the disk if it comes again"};
  }
  after_step_("digest verified");

  Shot shot;
  shot.index = planned.index;
  shot.led = planned.led;
  shot.role = planned.role;
  shot.polariser = planned.polariser;
  shot.file = fmt::format("raw/{}.{}", file_stem(planned), photograph.ending);
  shot.sha256 = photograph.sha256;
  shot.exposure_us = exposure_us_of(planned, photograph, session_);
  shot.iso = planned.exposure.iso;
  shot.f_number = planned.exposure.f_number;
  shot.time = iso_time(photograph.taken_s.value_or(photograph.triggered_s));
  shot.document = notes;
  if (photograph.image_number) shot.document["image_number"] = *photograph.image_number;

  if (::chmod(photograph.file.c_str(), 0444) != 0) return cannot_write(photograph.file, errno);
  if (Result<void> synced = sync_path(photograph.file); !synced) return synced.error();
  after_step_("photograph synced");
  if (::rename(photograph.file.c_str(), session_.path_of(shot).c_str()) != 0) {
    return cannot_write(session_.path_of(shot), errno);
  }
  after_step_("photograph moved");
  if (Result<void> synced = sync_path(session_.folder / "raw"); !synced) return synced.error();
  after_step_("raw synced");

  Session session = session_;
  const auto place = std::find_if(session.shots.begin(), session.shots.end(),
                                  [&](const Shot& other) { return other.index > shot.index; });
  session.shots.insert(place, shot);
  if (planned.supersedes)
    std::ranges::find(session.shots, *planned.supersedes, &Shot::index)->superseded_by = shot.index;
  if (Result<void> written = replace(std::move(session)); !written) return written.error();
  after_step_("session.json replaced");
  return shot;
}

Result<void> Journal::discard(const std::vector<int>& indices) {
  Session session = session_;
  std::vector<fs::path> files;
  std::erase_if(session.shots, [&](const Shot& shot) {
    if (std::count(indices.begin(), indices.end(), shot.index) == 0) return false;
    files.push_back(session_.path_of(shot));
    return true;
  });
  if (Result<void> written = replace(std::move(session)); !written) return written;
  after_step_("frames forgotten");
  for (const fs::path& file : files) {
    if (is_there(file)) static_cast<void>(move_aside(file));  // the next open() moves what stays
  }
  return {};
}

Session Journal::finished(const std::vector<std::string>& warnings) const {
  Session session = session_;
  const bool was_finished = session.state == kComplete;
  session.state = kComplete;
  if (warnings.empty()) return session;
  Json& kept = session.document["warnings"];
  if (!was_finished || !kept.is_array()) kept = Json::array();
  for (const std::string& warning : warnings) kept.push_back(warning);
  return session;
}

Result<void> Journal::finish(const std::vector<std::string>& warnings, const Json& copy) {
  for (const fs::path& folder : {incoming_, dropped()}) {
    std::error_code failed;
    fs::remove_all(folder, failed);
    if (failed) return cannot_write(folder, failed.value());
  }
  after_step_("incoming removed");
  Session session = finished(warnings);
  if (!copy.is_null()) session.document["copy"] = copy;
  session.document["verdict"] = object_of(verdict_of_photographs(session));
  Result<void> done = replace(std::move(session));
  after_step_("session complete");
  return done;
}

void remove_abandoned(const fs::path& folder) {
  const std::string start = "." + folder.filename().string() + ".";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder.parent_path(), ignored)) {
    if (!entry.path().filename().string().starts_with(start)) continue;
    const std::optional<PartialMaker> maker = maker_of_partial(entry.path());
    if (maker && maker->is_of_this_machine && !maker->runs) fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace weft::capture
