// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/scan/light_fit.h"
#include "capture/scan/scan_plan.h"

namespace weft::capture {

/// Lit frames from which on exchanged LEDs are looked for: four of one ring may be its mirror image as well.
constexpr std::size_t kEnoughForPatterns = 5;

// Is this the photograph of this LED? Patches of the frames of a session are held against the lights of its
// calibration. The albedo of the cloth cancels between frames, its normals once there are four, and what then
// is left of the readings tells which LEDs were lit: every likely mix-up is tried, and one that leaves far
// less than the planned order is what happened. docs/measured/reliability.md has how often it is wrong.

/// What the light of a frame says of the LEDs.
enum class LightFinding {
  kAgrees,
  kDark,       ///< the LED did not light
  kDim,        ///< it gave far less light than it should
  kOther,      ///< another LED lit in its place
  kStaysLit,   ///< another LED lit as well
  kRoomLight,  ///< light beside the LEDs
  kChanged,    ///< not the same cloth or light as at first
};

/// "dark", "dim", "swapped", "stays_lit", "room_light", "changed"; "" where it agrees.
const char* code_of(LightFinding finding);

/// What a frame says against the plan and the frames before it.
struct ShotVerdict {
  LightFinding finding = LightFinding::kAgrees;
  std::string sentence;      ///< names the LED
  std::vector<int> accused;  ///< indices of shots that are not what they should be, this one or before
  std::vector<std::string> warnings;  ///< of a frame that is kept
  /// A lit frame's brightness over what the frames before let expect; a repeat's over its first.
  std::optional<double> level;
  std::optional<double> misfit;                ///< of LightFit, as planned
  LightFinding doubt = LightFinding::kAgrees;  ///< what a frame that is kept is warned of
  /// Every frame since the dark shot, of whatever role and the newest as well: light that may come and go is
  /// no better known than that.
  bool accuses_all = false;
  bool is_over = false;  ///< the newest frame has the right light again

  /// Whether the same shots once more may come out right.
  bool may_pass() const {
    return is_over || finding == LightFinding::kDark || finding == LightFinding::kDim ||
           finding == LightFinding::kChanged;
  }
};

/// The evidence of one scan, frame by frame in the order of the plan:
///
///   glance() at the frame, then judge() what was seen;
///   where that agrees, accept() it: now it is evidence for the frames after it;
///   where it does not, forget() every shot that the verdict accuses.
///
/// The dark shot is taken off what comes after it. Repeats and brackets are held against the lit frame of
/// their LED, of which a blade hides a part, the dark shot at the end against the first. Frames that are full
/// are held against what those that are not let expect of them. Where there is nothing to hold a frame
/// against, it agrees.
class ScanEvidence {
 public:
  /// Without a model only darkness, the repeat and the brackets are looked at. `solved`: the polariser's
  /// state in the lit shots that are held against the model. A LED's shot in the other state is held against
  /// its own in this one, and against those of the others.
  ScanEvidence(PatchGrid grid, std::optional<PatchLights> model, Polariser solved = Polariser::kNone);

  /// The light of a frame by patch, which judge() and accept() take.
  std::vector<double> glance(const RawFrame& frame) const;
  ShotVerdict judge(const DueShot& shot, const std::vector<double>& light) const;
  void accept(const DueShot& shot, std::vector<double> light);
  /// Takes a lit frame out again, so that its shot can be judged anew; nothing where it was not accepted.
  void forget(int index);

 private:
  struct Seen {
    DueShot shot;
    std::vector<double> light;
  };
  const Seen* of_led(int led) const;
  std::vector<double> without_dark(const std::vector<double>& light) const;
  /// Whether a frame is full where the others let expect far less. Dark shots are taken off.
  bool is_one_too_full(const std::vector<Seen>& full, const std::vector<Seen>& others) const;
  ShotVerdict judge_dark(const DueShot& shot, const std::vector<double>& light) const;
  ShotVerdict judge_dark_again(const std::vector<double>& light) const;
  ShotVerdict judge_lit(const DueShot& shot, const std::vector<double>& light) const;
  ShotVerdict judge_other_state(const DueShot& shot, const std::vector<double>& light) const;
  ShotVerdict judge_below(const std::vector<double>& light) const;
  ShotVerdict judge_blade(const DueShot& shot, const std::vector<double>& light) const;
  ShotVerdict judge_again(const DueShot& shot, const std::vector<double>& light) const;
  double level_of(const DueShot& shot, const std::vector<double>& light) const;
  ShotVerdict judge_full(const DueShot& shot, const std::vector<double>& light) const;
  ShotVerdict judge_pattern(const DueShot& shot, const std::vector<double>& light) const;

  PatchGrid grid_;
  std::optional<PatchLights> model_;
  Polariser solved_;
  std::optional<std::vector<double>> dark_;
  std::map<int, Seen> lit_;   ///< kept frames of role lit by index, the dark shot taken off
  std::map<int, int> other_;  ///< by LED, the index of its kept frame in the other state
};

}  // namespace weft::capture
