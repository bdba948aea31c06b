// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdint.h>

#include "firmware/protocol/protocol.h"

#ifdef __cplusplus
extern "C" {
#endif

/// How long each LED, and the light below, was lit lately: a ms lit adds one, a ms dark takes one away. A LED
/// is lit only for as long as this stays below the longest on-time, so that it is dark half of the time in
/// the long run, however it is switched. Kept through resets, which are no way to light it longer.
struct WeftHeat {
  uint16_t mark[2];
  uint16_t ms[kWeftBelow];
};

/// What is lit, and when that ends.
struct WeftLamps {
  struct WeftHeat* heat;
  uint16_t lit;         ///< bit 0 is LED 1, bit 10 the light below
  uint16_t lit_lately;  ///< at any time since LEDs last cooled
  uint16_t left_ms;     ///< of the on-time
  uint16_t silent_ms;   ///< since a whole frame came
  uint32_t uptime_ms;
  uint8_t dark_cause;
};

/// All off. `heat` is what a reset left in memory, or chance after power-on.
void weft_lamps_start(struct WeftLamps* lamps, struct WeftHeat* heat);
/// A millisecond has passed: switches off what has been lit for its time or has no host any more.
void weft_lamps_tick(struct WeftLamps* lamps);
/// A whole frame came.
void weft_lamps_heard(struct WeftLamps* lamps);
/// How long these LEDs must rest before they can be lit for `on_ms`; 0: they can.
uint16_t weft_lamps_rest_ms(const struct WeftLamps* lamps, uint16_t mask, uint16_t on_ms);
/// Lights these and no other; none: all off.
void weft_lamps_light(struct WeftLamps* lamps, uint16_t mask, uint16_t on_ms);

#ifdef __cplusplus
}
#endif
