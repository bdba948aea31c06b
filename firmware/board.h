// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdint.h>

#include "firmware/lamps.h"
#include "firmware/protocol/protocol.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The board but for its hardware.
struct WeftBoard {
  struct WeftLamps lamps;
  uint8_t polariser;
  uint16_t bad_frames;
  uint16_t overruns;
  uint8_t reset_cause;
  uint8_t request[kWeftMostFrame];  ///< the last one answered
  uint8_t reply[kWeftMostFrame];    ///< to it
};

/// Does what a whole request asks for and puts the answer into `board->reply`; gives its size. The same bytes
/// once more get the same reply and do nothing, but that a host is alive.
uint8_t weft_board_answer(struct WeftBoard* board, const uint8_t* request);

#ifdef __cplusplus
}
#endif
