// SPDX-License-Identifier: Apache-2.0
#include "firmware/parser.h"

#include <string.h>

static void drop(struct WeftParser* parser, uint8_t count) {
  parser->count = (uint8_t)(parser->count - count);
  memmove(parser->bytes, parser->bytes + count, parser->count);
}

void weft_parser_forget(struct WeftParser* parser) {
  drop(parser, parser->taken);
  parser->taken = 0;
  if (parser->count > 0) ++parser->bad_frames;
  parser->count = 0;
}

bool weft_parser_take(struct WeftParser* parser, uint8_t byte, uint32_t now_ms) {
  if ((uint32_t)(now_ms - parser->last_byte_ms) > kWeftParser_ms) weft_parser_forget(parser);
  parser->last_byte_ms = now_ms;
  drop(parser, parser->taken);
  parser->taken = 0;
  parser->bytes[parser->count++] = byte;
  for (;;) {
    const int8_t look = weft_look_at(parser->bytes, parser->count, kWeftRequestStart);
    if (look >= 0) {
      parser->taken = (uint8_t)look;
      return look > 0;
    }
    if (parser->bytes[0] == kWeftRequestStart) ++parser->bad_frames;
    drop(parser, 1);
  }
}
