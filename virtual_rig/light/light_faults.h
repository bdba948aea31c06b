// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "virtual_rig/commands/command_words.h"
#include "virtual_rig/light/light_wave.h"

namespace weft::virtual_rig {

/// What is wrong between the board's pins and the light on the cloth. LEDs count from 1.
struct LightFaults {
  std::set<int> dead;                        ///< never shine
  std::set<int> stuck;                       ///< shine whatever their pin does
  std::vector<std::pair<int, int>> swapped;  ///< wires that changed places, in this order
  std::map<int, double> dimmed;              ///< what a LED gives, of its light; above 1 it gives more
  double flicker = 0;  ///< standard deviation of a LED's brightness from exposure to exposure, relative
  std::optional<LightWave> pulses;  ///< of the LEDs' driver
  double ambient = 0;               ///< light of the room beyond the scene's, in its unit (lights.ambient)
  std::optional<LightWave> lamp;    ///< how the room's light comes and goes
  int move_x = 0;  ///< the picture moves right by this many pixels, even: filters keep their colours
  int move_y = 0;  ///< down

  bool operator==(const LightFaults&) const = default;
};

/// What change_faults() takes.
std::vector<CommandWords> light_fault_words();

/// Changes `faults` as a command says, "dead 3", "ambient 0.1", "normal" (no fault). kUsage with what is
/// allowed where it says anything else.
Result<void> change_faults(LightFaults& faults, const std::vector<std::string>& words, int leds);

Json json_of(const LightFaults& faults);

/// Share of an exposure that each LED shines for, and how brightly, from the share that its pin was on for.
std::vector<double> with_faults(const LightFaults& faults, std::vector<double> pins);

}  // namespace weft::virtual_rig
