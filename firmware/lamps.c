// SPDX-License-Identifier: Apache-2.0
#include "firmware/lamps.h"

enum { kMark0 = 0x57EF, kMark1 = 0x1A3E };

static const uint16_t kMostOn_ms = 10U * kWeftMostOn_cs;
static const uint8_t kCooling_ms = 16;

static void go_dark(struct WeftLamps* lamps, uint8_t cause) {
  if (lamps->lit) lamps->dark_cause = cause;
  lamps->lit = 0;
}

static void add_heat(struct WeftLamps* lamps, uint8_t cooled_ms) {
  uint16_t lit = lamps->lit, lately = lamps->lit_lately;
  for (uint8_t led = 0; led < kWeftBelow;
       ++led, lit = (uint16_t)(lit >> 1), lately = (uint16_t)(lately >> 1)) {
    uint16_t* heat = &lamps->heat->ms[led];
    if (lit & 1) {
      ++*heat;
    } else if (!(lately & 1)) {
      *heat = (uint16_t)(*heat > cooled_ms ? *heat - cooled_ms : 0);
    }
  }
}

void weft_lamps_start(struct WeftLamps* lamps, struct WeftHeat* heat) {
  uint8_t known = heat->mark[0] == kMark0 && heat->mark[1] == kMark1;
  for (int led = 0; led < kWeftBelow; ++led) known = known && heat->ms[led] <= kMostOn_ms;
  if (!known) *heat = (struct WeftHeat){{kMark0, kMark1}, {0}};
  *lamps = (struct WeftLamps){.heat = heat};
}

void weft_lamps_tick(struct WeftLamps* lamps) {
  ++lamps->uptime_ms;
  // Cooling comes in steps, so that with all dark nothing is to be done in most ticks; a step counts for LEDs
  // that were dark all through it.
  const uint8_t cooled_ms = lamps->uptime_ms % kCooling_ms == 0 ? kCooling_ms : 0;
  lamps->lit_lately |= lamps->lit;
  if (lamps->lit || cooled_ms) add_heat(lamps, cooled_ms);
  if (cooled_ms) lamps->lit_lately = lamps->lit;
  if (!lamps->lit) return;
  if (--lamps->left_ms == 0) go_dark(lamps, kWeftDarkByTime);
  if (++lamps->silent_ms >= kWeftDeadMan_ms) go_dark(lamps, kWeftDarkBySilence);
}

void weft_lamps_heard(struct WeftLamps* lamps) {
  lamps->silent_ms = 0;
}

uint16_t weft_lamps_rest_ms(const struct WeftLamps* lamps, uint16_t mask, uint16_t on_ms) {
  uint16_t rest_ms = 0;
  for (int led = 0; led < kWeftBelow; ++led, mask = (uint16_t)(mask >> 1)) {
    const uint16_t room_ms = (uint16_t)(kMostOn_ms - lamps->heat->ms[led]);
    if ((mask & 1) && on_ms > room_ms && on_ms - room_ms > rest_ms) rest_ms = (uint16_t)(on_ms - room_ms);
  }
  return rest_ms;
}

void weft_lamps_light(struct WeftLamps* lamps, uint16_t mask, uint16_t on_ms) {
  if (mask != lamps->lit) go_dark(lamps, kWeftDarkByCommand);
  lamps->lit = mask;
  lamps->left_ms = on_ms;
}
