// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "app/server/http/event_log.h"
#include "app/server/rig/rig_keeper.h"
#include "calibration/guide/framing.h"
#include "calibration/guide/photograph_set.h"
#include "calibration/guide/set_guide.h"
#include "capture/rig.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// The set of photographs for a calibration that is worked on at a rig: one at a time. Sets lie in sets/
/// beside the rig file, and whatever ends this process or the machine, a set goes on where it was. Safe from
/// any thread.
class SetKeeper {
 public:
  SetKeeper(const capture::Rig& rig, RigKeeper& keeper, EventLog& events)
      : rig_(rig), keeper_(keeper), events_(events) {}

  /// What a client asks for.
  struct Wish {
    std::string name;  ///< of its folder; empty: the part's
    calibration::SetPart part = calibration::SetPart::kBoard;
    std::string description;     ///< text of board.toml, sheet.toml, chart.toml
    std::filesystem::path from;  ///< calibration; empty: the rig's
  };
  /// Begins a set or takes one up, and looks at what it has. Errors: those of begin_set() and
  /// SetGuide::look(); kTryAgain while one is photographed.
  Result<Json> begin(const Wish& wish);
  /// Photographs what comes next. kTryAgain where nothing does, and while the rig is busy.
  Result<Json> photograph(const std::string& by);
  /// Leaves a photograph out, or takes it back. Errors: those of leave_out().
  Result<Json> leave_out(const std::string& name, bool out);
  /// {"name", "part", "folder", "from", "busy", "error", "photographs", "figures", "next", "done"}.
  /// Null where none is worked on.
  Json document() const;
  /// What the next step of the set that is worked on asks to be laid.
  calibration::AimedThing aim() const;
  void close();

 private:
  struct Work {
    calibration::PhotographSet set;
    calibration::SetGuide guide;
    calibration::SetStanding standing;
    std::optional<Error> error;  ///< of the last step
  };
  Result<capture::ScanOutcome> take(const calibration::SetStep& step, capture::Lamps& lamps,
                                    capture::Camera& camera, const capture::ScanEvents& events,
                                    const capture::ScanControl& control);
  static Result<calibration::SetStanding> without_useless(Work& work, const calibration::SetStep& step,
                                                          const calibration::SetStanding& standing);
  static Result<void> adopt(Work& work, const calibration::SetStep& step);
  Result<void> tell_tape(const calibration::PhotographSet& set) const;
  void on_end();
  Json document_locked() const;
  void tell_locked() { events_.add("calibration", document_locked()); }

  const capture::Rig& rig_;
  RigKeeper& keeper_;
  EventLog& events_;
  mutable std::mutex mutex_;
  std::optional<Work> work_;
  bool is_busy_ = false;  ///< work_ is the photographing thread's but for standing and error
};

}  // namespace weft::app
