// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/set_keeper.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "calibration/guide/set_work.h"
#include "core/base/files.h"
#include "core/describe/error_json.h"
#include "core/rig/calibration.h"

namespace weft::app {
namespace {

constexpr std::size_t kLongestSetName = 100;

Result<std::filesystem::path> folder_of(const capture::Rig& rig, const std::string& name) {
  const bool is_plain = !name.empty() && name.size() <= kLongestSetName && name.front() != '.' &&
                        std::ranges::all_of(name, [](const char c) {
                          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                                 c == '-' || c == '_' || c == '.';
                        });
  if (is_plain) return rig.folder() / "sets" / name;
  return Error{ErrorKind::kUsage, "this is no name of a set", name,
               "it has letters, digits, -, _ and . and does not begin with a dot", "give it another one"};
}

Error is_photographing(const std::string& rig) {
  return {ErrorKind::kTryAgain, "the set is being photographed", rig, "",
          "wait for the end of that, or cancel it"};
}

Error no_set(const std::string& rig) {
  return {ErrorKind::kNoInput, "no set is worked on", rig, "", "begin one: POST calibrations/work"};
}

}  // namespace

Result<Json> SetKeeper::begin(const Wish& wish) {
  Result<std::filesystem::path> folder =
      folder_of(rig_, wish.name.empty() ? std::string(name_of(wish.part)) : wish.name);
  if (!folder) return std::move(folder).error();
  const std::lock_guard lock(mutex_);
  if (is_busy_) return is_photographing(rig_.name);
  calibration::SetRequest request;
  request.folder = std::move(*folder);
  request.part = wish.part;
  request.rig = rig_.name;
  request.from = wish.from.empty() ? capture::calibration_now(rig_) : wish.from;
  request.description = wish.description;
  Result<calibration::PhotographSet> set = calibration::begin_set(request);
  if (!set) return std::move(set).error();
  if (Result<void> told = tell_tape(*set); !told) return std::move(told).error();
  Work work = {*set, calibration::SetGuide(*set), {}, {}};
  Result<calibration::SetStanding> standing = work.guide.look(work.set);
  if (!standing) return std::move(standing).error();
  work.standing = std::move(*standing);
  work_ = std::move(work);
  tell_locked();
  return document_locked();
}

/// Where nobody has calibrated the LEDs, calibrate lights begins where the rig file's tape has them.
Result<void> SetKeeper::tell_tape(const calibration::PhotographSet& set) const {
  const std::filesystem::path file = set.folder / "rig.toml";
  if (set.part != calibration::SetPart::kSheet || !rig_.lights || is_there(file)) return {};
  const Result<Calibration> before = read_calibration(set.from);
  if (before && before->lights) return {};
  const Result<std::string> text = read_text(rig_.file);
  return text ? write_file(file, *text) : text.error();
}

Result<Json> SetKeeper::photograph(const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (!work_) return no_set(rig_.name);
  if (is_busy_) return is_photographing(rig_.name);
  if (!work_->standing.next) {
    return Error{ErrorKind::kTryAgain, "the set has all that is needed", work_->set.folder.string(), "",
                 "run its step of weft calibrate, or leave a photograph out to take another one"};
  }
  capture::ScanRequest request;
  request.session = work_->set.folder;
  request.fabric = name_of(work_->set.part);
  const calibration::SetStep step = *work_->standing.next;
  const Result<void> begun = keeper_.begin_work(
      std::move(request), by,
      [this, step](const capture::ScanRequest&, capture::Lamps& lamps, capture::Camera& camera,
                   const capture::ScanEvents& events, const capture::ScanControl& control) {
        return take(step, lamps, camera, events, control);
      },
      [this] { on_end(); });
  if (!begun) return begun.error();
  is_busy_ = true;
  work_->error.reset();
  tell_locked();
  return document_locked();
}

Result<capture::ScanOutcome> SetKeeper::take(const calibration::SetStep& step, capture::Lamps& lamps,
                                             capture::Camera& camera, const capture::ScanEvents& events,
                                             const capture::ScanControl& control) {
  Work* work = nullptr;
  {
    const std::lock_guard lock(mutex_);
    work = &*work_;
  }
  Result<void> taken = calibration::take_step(work->set, step, rig_, lamps, camera, events, control);
  if (taken) taken = adopt(*work, step);
  Result<calibration::SetStanding> standing = work->guide.look(work->set);
  if (standing && taken && step.kind == calibration::StepKind::kScan)
    standing = without_useless(*work, step, *standing);
  const std::lock_guard lock(mutex_);
  if (standing) work->standing = std::move(*standing);
  if (!taken) {
    work->error = taken.error();
  } else if (!standing) {
    work->error = standing.error();
  }
  if (work->error) return *work->error;
  return capture::ScanOutcome();
}

/// The first photograph of a set tells which of the rig's targets lies there.
Result<void> SetKeeper::adopt(Work& work, const calibration::SetStep& step) {
  const auto is_used = [](const calibration::SetPhotograph& photograph) { return photograph.is_used; };
  if (std::ranges::any_of(work.standing.photographs, is_used)) return {};
  const Result<bool> adopted = calibration::adopt_target(work.set, step.name);
  if (!adopted) return adopted.error();
  if (*adopted) work.guide = calibration::SetGuide(work.set);
  return {};
}

void SetKeeper::on_end() {
  const std::lock_guard lock(mutex_);
  is_busy_ = false;
  tell_locked();
}

/// A step of weft calibrate reads every session of its folder: one that is of no use goes to left_out/.
Result<calibration::SetStanding> SetKeeper::without_useless(Work& work, const calibration::SetStep& step,
                                                            const calibration::SetStanding& standing) {
  const auto scanned = std::ranges::find(standing.photographs, step.name, &calibration::SetPhotograph::name);
  if (scanned == standing.photographs.end() || scanned->is_used) return standing;
  work.set.why[step.name] = scanned->why;
  if (Result<void> written = calibration::write_set(work.set); !written) return written.error();
  if (Result<void> moved = calibration::leave_out(work.set, step.name, true); !moved) return moved.error();
  return work.guide.look(work.set);
}

Result<Json> SetKeeper::leave_out(const std::string& name, bool out) {
  const std::lock_guard lock(mutex_);
  if (!work_) return no_set(rig_.name);
  if (is_busy_) return is_photographing(rig_.name);
  if (Result<void> moved = calibration::leave_out(work_->set, name, out); !moved)
    return std::move(moved).error();
  Result<calibration::SetStanding> standing = work_->guide.look(work_->set);
  if (!standing) return std::move(standing).error();
  work_->standing = std::move(*standing);
  tell_locked();
  return document_locked();
}

Json SetKeeper::document() const {
  const std::lock_guard lock(mutex_);
  return work_ ? document_locked() : Json();
}

calibration::AimedThing SetKeeper::aim() const {
  std::filesystem::path file;
  {
    const std::lock_guard lock(mutex_);
    if (!work_) return {};
    if (work_->set.part != calibration::SetPart::kBoard)
      return {{}, work_->standing.aim, calibration::owned_targets(rig_.folder())};
    file = work_->set.board_file();
  }
  const Result<calibration::PrintedBoard> board = calibration::read_board_file(file, {});
  return {board ? std::optional(*board) : std::nullopt, {}, calibration::owned_targets(rig_.folder())};
}

void SetKeeper::close() {
  const std::lock_guard lock(mutex_);
  if (!is_busy_) work_.reset();
}

Json SetKeeper::document_locked() const {
  const calibration::PhotographSet& set = work_->set;
  Json document = {{"name", set.folder.filename().string()},
                   {"part", name_of(set.part)},
                   {"folder", set.folder.string()},
                   {"from", set.from.string()},
                   {"busy", is_busy_},
                   {"error", work_->error ? weft::json_of(*work_->error) : Json()}};
  document.update(json_of(work_->standing));
  return document;
}

}  // namespace weft::app
