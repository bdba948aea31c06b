// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "firmware/protocol/protocol.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Finds requests in a stream of bytes that may hold anything. All zero is a parser that has heard nothing.
struct WeftParser {
  uint8_t bytes[kWeftMostFrame];
  uint8_t count;
  uint8_t taken;        ///< bytes of a frame that the caller has seen
  uint16_t bad_frames;  ///< that began and were not whole
  uint32_t last_byte_ms;
};

/// Takes the next byte. True where it completes a frame, which is then at `parser->bytes` until the next
/// call. A frame that was broken off is searched for another one inside it.
bool weft_parser_take(struct WeftParser* parser, uint8_t byte, uint32_t now_ms);

/// Forgets a frame that was begun.
void weft_parser_forget(struct WeftParser* parser);

#ifdef __cplusplus
}
#endif
