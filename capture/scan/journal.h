// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "capture/devices.h"
#include "capture/scan/scan.h"
#include "capture/scan/scan_plan.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"
#include "core/rig/session.h"

namespace weft::capture {

/// Called after each step of the journal by its name, so that a test can end the process there.
using AfterStep = std::function<void(const char* step)>;

/// The session folder of a scan. Whenever the process or the machine ends, the folder holds whole frames that
/// session.json names, and perhaps files that it does not, which the next open() moves into raw/.dropped.
/// What is there goes when the session is finished. One process at a time writes it (flock on the folder).
class Journal {
 public:
  /// Makes the session, or takes up one that is not finished: frames that are missing or whose bytes changed
  /// are forgotten, so that they are taken again. Missing is only what is not in a raw/ that can be listed.
  /// Errors: those of check(), kTryAgain (another scan writes it), kInputOutput (raw/ or a frame cannot be
  /// seen: nothing is forgotten).
  static Result<Journal> open(
      const ScanRequest& request, const std::string& calibration_id, const ShotList& list,
      AfterStep after_step = [](const char*) {});
  /// Takes up one that is finished, to add a frame: it stays finished throughout. kCannotCreate where it is
  /// unfinished or of another rig or calibration; kTryAgain, kInputOutput as open().
  static Result<Journal> reopen(
      const ScanRequest& request, const std::string& calibration_id,
      AfterStep after_step = [](const char*) {});
  /// How many frames the session lacks, all where it is not there: worth asking before a device is.
  /// kCannotCreate where it is finished, or of another rig, calibration, cloth or plan; kBadData where it is
  /// no session of a scan.
  static Result<int> check(const ScanRequest& request, const std::string& calibration_id,
                           const ShotList& list);

  const Session& session() const { return session_; }
  /// A file for the camera to write to, in a folder that lasts as long as the scan.
  std::filesystem::path incoming(const std::string& stem) const { return incoming_ / stem; }
  /// Removes what landed there and was not kept.
  Result<void> clear_incoming() const;
  /// The folder too: a finished session has none.
  void forget_incoming() const;

  /// Exposure of the lit shots and where it comes from, and what is known of the shutter.
  Result<void> set_exposure(const Json& exposure, double shutter_travel_s);
  /// Puts a photograph in its place, read-only, its digest verified (kTryAgain where it is another), and then
  /// into session.json, together with the word that the shot it supersedes is superseded. `notes` are further
  /// fields of the shot.
  Result<Shot> keep(const DueShot& planned, const Photograph& photograph, const Json& notes);
  /// Takes frames out again; their files go to raw/.dropped.
  Result<void> discard(const std::vector<int>& indices);
  /// The session as finish() will leave it; one that was finished before keeps its warnings.
  Session finished(const std::vector<std::string>& warnings) const;
  /// `copy`: what became of the second copy, as record_of_copy() has it; null: none was asked for.
  Result<void> finish(const std::vector<std::string>& warnings, const Json& copy = {});

 private:
  Journal(Session session, Descriptor lock, AfterStep after_step)
      : session_(std::move(session)),
        incoming_(session_.folder / "incoming"),
        lock_(std::move(lock)),
        after_step_(std::move(after_step)) {}
  Result<void> forget_damaged();
  Result<void> move_unnamed_aside() const;
  Result<void> move_aside(const std::filesystem::path& file) const;
  std::filesystem::path dropped() const { return session_.folder / "raw" / ".dropped"; }
  Result<void> replace(Session session);

  Session session_;
  std::filesystem::path incoming_;
  Descriptor lock_;
  AfterStep after_step_;
};

/// Removes what processes that are no more left of a folder that they were making aside.
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace weft::capture
