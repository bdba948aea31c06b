// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "capture/scan/light_assignment.h"
#include "capture/scan/light_fit.h"
#include "core/base/result.h"
#include "library/import/source_frame.h"

// Which frame of a session belongs to which LED.

namespace weft::library {

/// What decides.
enum class FrameOrder {
  kAuto,   ///< numbers in names; else times and names, or a counter in names; the light may object
  kTime,   ///< the order of times
  kName,   ///< numbers in names, else the order of names
  kLight,  ///< which LED explains a frame
};
inline constexpr std::array<const char*, 4> kFrameOrderNames = {"auto", "time", "name", "light"};

/// One opinion: LEDs by frame, 0 the dark one.
struct LedOpinion {
  std::string by;  ///< "numbers", "time", "names", "light", "light, second"
  std::vector<int> leds;
};

/// What a person should look at, of one session.
struct ImportDoubt {
  std::string kind;   ///< of all that are alike: "a LED did not light"
  std::string words;  ///< of this session
};

struct LedDecision {
  std::vector<int> leds;  ///< by frame; empty where none was reached
  std::string by;         ///< "numbers in names", "times and names", "times", "names", "light"
  std::optional<capture::LightAssignment> light;  ///< of the frames that are not the dark one, in their order
  /// By frame: how many times as much the light leaves at least where the frame has another LED. Nothing
  /// where the light was not asked, found otherwise, or of the dark frame.
  std::vector<std::optional<double>> sure;
  std::string light_says;            ///< a sentence
  std::vector<LedOpinion> opinions;  ///< of all that were asked, where not all agree
  /// Frames as they were captured, where that is neither the order of times nor was asked for; else empty.
  std::vector<std::size_t> order;
  std::vector<ImportDoubt> warnings;
  std::optional<Error> refusal;  ///< why there is no decision; `where` is empty
};

struct DecisionOptions {
  FrameOrder order = FrameOrder::kAuto;
  bool is_numbered = false;    ///< names hold LEDs: every frame's `said.led`
  bool takes_missing = false;  ///< a session may lack LEDs
  std::stop_token stop = {};   ///< the decision of one that is stopped means nothing
};

/// Decides. `light` is light_of() each frame on the model's grid. The dark frame is the one that names say
/// is, else the one whose level is a tenth of the others'. Everything else than options that fit the frames
/// is a `refusal` with the sentence for it.
LedDecision decide_leds(const std::vector<SourceFrame>& frames, const std::vector<std::vector<double>>& light,
                        const capture::PatchLights& model, const DecisionOptions& options);

}  // namespace weft::library
