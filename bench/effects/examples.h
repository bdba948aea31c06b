// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/effects/scenes.h"

namespace weft::bench {

/// A scene that shows one effect.
struct Example {
  std::string effect;  ///< its key
  std::string shows;   ///< a line below the title: what is on the table, and the effect's parameter
  simulator::Scene with, without;
  int led = 1;            ///< of the frame shown; 0: the dark one
  double brighten = 1;    ///< of light, before sRGB
  double difference = 0;  ///< how many times a third panel enlarges the change; 0: no such panel
};

/// One for every effect in the order of light, and last one for all together.
std::vector<Example> effect_examples();

}  // namespace weft::bench
