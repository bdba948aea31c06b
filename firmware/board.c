// SPDX-License-Identifier: Apache-2.0
#include "firmware/board.h"

#include <stdbool.h>
#include <string.h>

/// An answer under way: a payload and its length, or an error code.
struct Answer {
  uint8_t* payload;
  uint8_t length;
  uint8_t error;
  uint16_t wait_ms;
};

static uint16_t bit_of(uint8_t led) {
  return (uint16_t)(led == 0 ? 0U : 1U << (led - 1U));
}

static void say_hello(const struct WeftBoard* board, struct Answer* answer) {
  uint8_t* to = answer->payload;
  *to++ = kWeftProtocolMajor;
  *to++ = kWeftProtocolMinor;
  *to++ = kWeftFirmwareMajor;
  *to++ = kWeftFirmwareMinor;
  *to++ = kWeftLeds;
  *to++ = board->reset_cause;
  weft_put_u16(to, kWeftDeadMan_ms);
  weft_put_u16(to + 2, kWeftMostOn_cs);
  answer->length = kWeftHelloReply;
}

static void say_status(const struct WeftBoard* board, struct Answer* answer) {
  weft_put_u16(answer->payload, board->lamps.lit);
  weft_put_u32(answer->payload + 2, board->lamps.uptime_ms);
  weft_put_u16(answer->payload + 6, board->bad_frames);
  weft_put_u16(answer->payload + 8, board->overruns);
  answer->payload[10] = board->lamps.dark_cause;
  answer->payload[11] = board->reset_cause;
  answer->length = kWeftStatusReply;
}

static void light(struct WeftLamps* lamps, uint16_t mask, uint16_t on_cs, struct Answer* answer) {
  if (mask != 0 && (on_cs == 0 || on_cs > kWeftMostOn_cs)) {
    answer->error = kWeftWrongTime;
    return;
  }
  const uint16_t on_ms = (uint16_t)(mask == 0 ? 0 : 10U * on_cs);
  answer->wait_ms = weft_lamps_rest_ms(lamps, mask, on_ms);
  if (answer->wait_ms > 0) {
    answer->error = kWeftResting;
    return;
  }
  weft_put_u16(answer->payload, lamps->lit);
  answer->length = kWeftLightReply;
  weft_lamps_light(lamps, mask, on_ms);
}

static void light_one(struct WeftLamps* lamps, const uint8_t* payload, struct Answer* answer) {
  if (payload[0] > kWeftBelow) {
    answer->error = kWeftNoSuchLed;
    return;
  }
  light(lamps, bit_of(payload[0]), weft_get_u16(payload + 1), answer);
}

static void light_pair(struct WeftLamps* lamps, const uint8_t* payload, struct Answer* answer) {
  const uint8_t a = payload[0], b = payload[1];
  if (a == 0 || b == 0 || a > kWeftLeds || b > kWeftLeds || a == b) {
    answer->error = kWeftNoSuchLed;
    return;
  }
  light(lamps, bit_of(a) | bit_of(b), weft_get_u16(payload + 2), answer);
}

static void polarise(struct WeftBoard* board, uint8_t state, struct Answer* answer) {
  if (state > kWeftCrossed) {
    answer->error = kWeftWrongState;
    return;
  }
  answer->payload[0] = board->polariser;
  answer->length = kWeftPolariserReply;
  board->polariser = state;
}

static void say_heat(const struct WeftHeat* heat, struct Answer* answer) {
  for (uint8_t led = 0; led < kWeftBelow; ++led)
    answer->payload[led] = (uint8_t)((heat->ms[led] + kWeftHeat_ms - 1) / kWeftHeat_ms);
  answer->length = kWeftHeatReply;
}

static void act(struct WeftBoard* board, const uint8_t* request, struct Answer* answer) {
  static const uint8_t kLengths[] = {[kWeftHello] = 0,  [kWeftLight] = 3,     [kWeftLightPair] = 4,
                                     [kWeftStatus] = 0, [kWeftPolariser] = 1, [kWeftHeat] = 0};
  const uint8_t command = weft_command(request);
  const uint8_t* payload = request + kWeftFrameHead;
  if (command < kWeftHello || command > kWeftHeat) {
    answer->error = kWeftUnknownCommand;
  } else if (weft_length(request) != kLengths[command]) {
    answer->error = kWeftWrongLength;
  } else if (command == kWeftHello) {
    say_hello(board, answer);
  } else if (command == kWeftLight) {
    light_one(&board->lamps, payload, answer);
  } else if (command == kWeftLightPair) {
    light_pair(&board->lamps, payload, answer);
  } else if (command == kWeftPolariser) {
    polarise(board, payload[0], answer);
  } else if (command == kWeftHeat) {
    say_heat(board->lamps.heat, answer);
  } else {
    say_status(board, answer);
  }
}

uint8_t weft_board_answer(struct WeftBoard* board, const uint8_t* request) {
  weft_lamps_heard(&board->lamps);
  const uint8_t size = weft_frame_size(weft_length(request));
  if (memcmp(board->request, request, size) == 0) return weft_frame_size(weft_length(board->reply));
  memcpy(board->request, request, size);

  struct Answer answer = {.payload = board->reply + kWeftFrameHead};
  act(board, request, &answer);
  uint8_t command = weft_command(request);
  if (answer.error) {
    answer.payload[0] = answer.error;
    answer.payload[1] = command;
    weft_put_u16(answer.payload + 2, answer.wait_ms);
    answer.length = kWeftErrorReply;
    command = kWeftError;
  }
  return weft_seal(board->reply, kWeftReplyStart, weft_sequence(request), (uint8_t)(command | kWeftReplyBit),
                   answer.length);
}
