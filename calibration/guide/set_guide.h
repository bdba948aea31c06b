// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calibration/guide/photograph_set.h"
#include "calibration/guide/sheet_lay.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

// What a set shows so far, and what a person does next.

namespace weft::calibration {

/// A photograph or a session of a set, as it is judged.
struct SetPhotograph {
  std::string name;
  bool is_used = true;
  bool is_left_out = false;  ///< a person said so
  std::string why;           ///< it is not used; without a full stop
  Json facts = Json::object();
  std::optional<SheetLay> lay = {};  ///< of a sheet that is seen
};

/// How the photographs of a step are taken.
enum class StepKind {
  kPhotograph,  ///< one, by the light of two LEDs
  kSeries,      ///< several, nobody doing anything in between
  kScan         ///< a session
};

/// What a person does, and what is photographed then.
struct SetStep {
  StepKind kind = StepKind::kPhotograph;
  std::string name;  ///< of the photograph without ending, of the session, or of the series
  std::string says;  ///< to the person: a sentence or two
  Json pose;         ///< numbers of it; null: there are none
};

struct SetStanding {
  std::vector<SetPhotograph> photographs;
  Json figures = Json::object();  ///< of the part: coverage, what is predicted, what is asked
  std::optional<SetStep> next;    ///< none: all is there
  std::optional<SheetAim> aim;    ///< of the next step, where a sheet is to be laid
  bool is_done = false;           ///< what is there suffices
};

/// Looks at a set again and again while it grows: what was looked at is kept. Not safe from several threads.
class SetGuide {
 public:
  explicit SetGuide(const PhotographSet& set) : part_(set.part) {}

  /// Errors: those of read_calibration() of the set's `from`, and of its description.
  Result<SetStanding> look(const PhotographSet& set);

 private:
  /// Each looked at once.
  Result<std::vector<const BoardPhotograph*>> read_boards(const PhotographSet& set,
                                                          const PrintedBoard& printed);
  Result<SetStanding> look_at_boards(const PhotographSet& set);
  Result<SetStanding> look_at_sheets(const PhotographSet& set);
  Result<SetStanding> look_at_chart(const PhotographSet& set);

  SetPart part_;
  std::map<std::string, BoardPhotograph> boards_;  ///< by name
  std::map<std::string, SetPhotograph> sessions_;  ///< by name, those that are complete
};

/// {"name", "kind", "says", "pose"}.
Json json_of(const SetStep& step);
/// {"photographs", "figures", "next", "done"}.
Json json_of(const SetStanding& standing);

}  // namespace weft::calibration
