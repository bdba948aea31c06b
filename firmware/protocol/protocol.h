// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdint.h>

// The wire between a host and the LED board, C99 and C++: docs/protocol.md describes it byte by byte.
//
//   request: A5 length sequence command payload[length] crc_low crc_high
//   reply:   5A length sequence command|80 payload[length] crc_low crc_high
//
// 115200 baud, 8 data bits, no parity, 1 stop bit. Numbers of two and four bytes begin with the low byte. The
// CRC covers everything between the start byte and itself.

// What a host and a board must share, and what came later: a test builds boards with others.
#ifndef WEFT_PROTOCOL_MAJOR
#define WEFT_PROTOCOL_MAJOR 1
#endif
#ifndef WEFT_PROTOCOL_MINOR
#define WEFT_PROTOCOL_MINOR 1
#endif

// One enumeration, for C++ dislikes arithmetic across two.
enum {
  kWeftProtocolMajor = WEFT_PROTOCOL_MAJOR,
  kWeftProtocolMinor = WEFT_PROTOCOL_MINOR,
  kWeftFirmwareMajor = 1,
  kWeftFirmwareMinor = 1,

  kWeftLeds = 10,
  kWeftBelow = 11,        // the light below the cloth, where a LED's number stands
  kWeftDeadMan_ms = 500,  // lights go off after so long without a whole frame
  kWeftParser_ms = 20,    // a frame with a longer pause inside is forgotten
  kWeftMostOn_cs = 4000,  // the longest a LED is lit, in units of 10 ms

  kWeftRequestStart = 0xA5,
  kWeftReplyStart = 0x5A,
  kWeftReplyBit = 0x80,
  kWeftFrameHead = 4,
  kWeftFrameCrc = 2,
  kWeftMostPayload = 16,
  kWeftMostFrame = kWeftFrameHead + kWeftMostPayload + kWeftFrameCrc,

  // Commands, with their payload -> that of the reply. Numbers in brackets are sizes in bytes.
  // -> protocol major, minor, firmware major, minor, LEDs, reset cause, dead-man ms (2), longest on-time in
  // 10 ms (2). The first two bytes mean the same in every version.
  kWeftHello = 0x01,
  // LED (0: all off), on-time in 10 ms (2) -> LEDs that were lit until then (2)
  kWeftLight = 0x02,
  // LED, another LED, on-time in 10 ms (2) -> LEDs that were lit until then (2)
  kWeftLightPair = 0x03,
  // -> LEDs lit (2), uptime ms (4), bad frames (2), overruns (2), why they last went dark, reset cause
  kWeftStatus = 0x04,
  // state to turn the polariser to -> the state until then (1)
  kWeftPolariser = 0x05,
  // -> how long each LED and the light below was lit lately, in units of 200 ms, rounded up (11)
  kWeftHeat = 0x06,
  // Only as a reply: error code, the command refused, ms to wait (2). A command that is refused changes
  // nothing.
  kWeftError = 0x7F,

  kWeftHelloReply = 10,
  kWeftLightReply = 2,
  kWeftStatusReply = 12,
  kWeftPolariserReply = 1,
  kWeftHeatReply = 11,
  kWeftHeat_ms = 200,  // the unit of that
  kWeftErrorReply = 4,

  // Error codes.
  kWeftUnknownCommand = 1,
  kWeftWrongLength = 2,
  kWeftNoSuchLed = 3,
  kWeftWrongTime = 4,  // 0, or above the longest on-time
  kWeftResting = 5,    // the LED must cool first; the reply says how long
  kWeftWrongState = 6,

  // States of the polariser; the first is that of every start.
  kWeftParallel = 0,
  kWeftCrossed = 1,

  // Why the lights last went dark.
  kWeftNeverLit = 0,
  kWeftDarkByCommand = 1,
  kWeftDarkByTime = 2,
  kWeftDarkBySilence = 3,

  // Reset causes: the bits of the ATmega328P's MCUSR. 0 where a bootloader keeps it to itself.
  kWeftResetPower = 1,
  kWeftResetExternal = 2,
  kWeftResetBrownOut = 4,
  kWeftResetWatchdog = 8
};

// CRC-16/CCITT-FALSE: polynomial 1021, from FFFF; of the nine characters "123456789" it is 29B1.
static inline uint16_t weft_crc(uint16_t crc, uint8_t byte) {
  crc = (uint16_t)((crc >> 8 | crc << 8) & 0xFFFF);
  crc = (uint16_t)(crc ^ byte);
  crc = (uint16_t)(crc ^ (crc & 0xFF) >> 4);
  crc = (uint16_t)((crc ^ (uint16_t)(crc << 12)) & 0xFFFF);
  crc = (uint16_t)(crc ^ (crc & 0xFF) << 5);
  return crc;
}

static inline uint16_t weft_crc_of(const uint8_t* bytes, uint8_t count) {
  uint16_t crc = 0xFFFF;
  for (uint8_t i = 0; i < count; ++i) crc = weft_crc(crc, bytes[i]);
  return crc;
}

static inline void weft_put_u16(uint8_t* bytes, uint16_t value) {
  bytes[0] = (uint8_t)(value & 0xFF);
  bytes[1] = (uint8_t)(value >> 8);
}

static inline uint16_t weft_get_u16(const uint8_t* bytes) {
  return (uint16_t)(bytes[0] | (uint16_t)((uint16_t)bytes[1] << 8));
}

static inline void weft_put_u32(uint8_t* bytes, uint32_t value) {
  weft_put_u16(bytes, (uint16_t)(value & 0xFFFF));
  weft_put_u16(bytes + 2, (uint16_t)(value >> 16));
}

static inline uint32_t weft_get_u32(const uint8_t* bytes) {
  return weft_get_u16(bytes) | (uint32_t)weft_get_u16(bytes + 2) << 16;
}

// Where a frame has what.
static inline uint8_t weft_length(const uint8_t* frame) {
  return frame[1];
}
static inline uint8_t weft_sequence(const uint8_t* frame) {
  return frame[2];
}
static inline uint8_t weft_command(const uint8_t* frame) {
  return frame[3];
}
static inline uint8_t weft_frame_size(uint8_t length) {
  return (uint8_t)(kWeftFrameHead + length + kWeftFrameCrc);
}

// Completes a frame whose payload is in place, `frame` having room for weft_frame_size(length). Gives that
// size.
static inline uint8_t weft_seal(uint8_t* frame, uint8_t start, uint8_t sequence, uint8_t command,
                                uint8_t length) {
  frame[0] = start;
  frame[1] = length;
  frame[2] = sequence;
  frame[3] = command;
  weft_put_u16(frame + kWeftFrameHead + length,
               weft_crc_of(frame + 1, (uint8_t)(kWeftFrameHead - 1 + length)));
  return weft_frame_size(length);
}

// What `count` bytes of a stream begin with: the size of a whole frame, 0 if more bytes must come to tell, -1
// if no frame begins at the first of them.
static inline int8_t weft_look_at(const uint8_t* bytes, uint8_t count, uint8_t start) {
  if (count > 0 && bytes[0] != start) return -1;
  if (count < 2) return 0;
  if (weft_length(bytes) > kWeftMostPayload) return -1;
  const uint8_t size = weft_frame_size(weft_length(bytes));
  if (count < size) return 0;
  const uint8_t covered = (uint8_t)(size - 1 - kWeftFrameCrc);
  return weft_get_u16(bytes + size - kWeftFrameCrc) == weft_crc_of(bytes + 1, covered) ? (int8_t)size : -1;
}
