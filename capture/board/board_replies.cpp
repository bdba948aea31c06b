// SPDX-License-Identifier: Apache-2.0
#include "capture/board/board_replies.h"

#include <fmt/format.h>

namespace weft::capture {
namespace {

BoardReset reset_of(std::uint8_t bits) {
  // Power-on also raises the brown-out bit, so it is asked first.
  if ((bits & kWeftResetWatchdog) != 0) return BoardReset::kWatchdog;
  if ((bits & kWeftResetPower) != 0) return BoardReset::kPower;
  if ((bits & kWeftResetBrownOut) != 0) return BoardReset::kBrownOut;
  if ((bits & kWeftResetExternal) != 0) return BoardReset::kExternal;
  return BoardReset::kUnknown;
}

WentDark dark_of(std::uint8_t code) {
  if (code == kWeftDarkByCommand) return WentDark::kByCommand;
  if (code == kWeftDarkByTime) return WentDark::kByTime;
  if (code == kWeftDarkBySilence) return WentDark::kBySilence;
  return WentDark::kNeverLit;
}

Error unlike_protocol(const BoardReply& reply, const std::string& port) {
  const bool refused = reply.command == kWeftError && reply.length == kWeftErrorReply;
  return {ErrorKind::kProtocol, "the LED board answers against its protocol", port,
          refused ? fmt::format("it refused command {} with code {}", reply.payload[1], reply.payload[0])
                  : fmt::format("{} bytes in reply to command {}", reply.length, reply.command),
          "flash its firmware: weft rig flash " + port};
}

/// Nothing where this board can be used, and what to do where not.
Result<void> check_version(const BoardReply& hello, const std::string& port) {
  const int major = hello.payload[0], minor = hello.payload[1];
  if (major == kWeftProtocolMajor) return {};
  const bool newer = major > kWeftProtocolMajor;
  const std::string flash = "weft rig flash " + port;
  return Error{
      ErrorKind::kBadData,
      newer ? "the LED board's firmware is newer than this weft" : "the LED board's firmware is too old",
      port,
      fmt::format("it speaks protocol {}.{}, this weft {}.{}", major, minor, int{kWeftProtocolMajor},
                  int{kWeftProtocolMinor}),
      newer ? "update weft, or flash the firmware that came with this one: " + flash
            : "flash the firmware that came with this weft: " + flash};
}

}  // namespace

const char* name_of(BoardReset reset) {
  switch (reset) {
    case BoardReset::kPower:
      return "power-on";
    case BoardReset::kExternal:
      return "its button or DTR";
    case BoardReset::kBrownOut:
      return "low voltage";
    case BoardReset::kWatchdog:
      return "watchdog";
    case BoardReset::kUnknown:
      break;
  }
  return "unknown cause";
}

const char* name_of(WentDark cause) {
  switch (cause) {
    case WentDark::kByCommand:
      return "by command";
    case WentDark::kByTime:
      return "at the end of their time";
    case WentDark::kBySilence:
      return "by the dead-man timer";
    case WentDark::kNeverLit:
      break;
  }
  return "before they were lit";
}

std::string firmware_advice(const BoardFacts& facts, const std::string& port) {
  if (facts.protocol_minor >= kWeftProtocolMinor) return {};
  return fmt::format(
      "it speaks protocol {}.{}, this weft {}.{}: what came with that it lacks until it is flashed: "
      "weft rig flash {}",
      facts.protocol_major, facts.protocol_minor, int{kWeftProtocolMajor}, int{kWeftProtocolMinor}, port);
}

Result<BoardFacts> facts_in(const BoardReply& hello, const std::string& port) {
  if (hello.command != kWeftHello || hello.length < 2) return unlike_protocol(hello, port);
  if (auto usable = check_version(hello, port); !usable) return std::move(usable).error();
  const auto& said = hello.payload;
  if (hello.length < kWeftHelloReply || said[4] < 1 || said[4] > 16) return unlike_protocol(hello, port);
  BoardFacts facts;
  facts.protocol_major = said[0];
  facts.protocol_minor = said[1];
  facts.firmware_major = said[2];
  facts.firmware_minor = said[3];
  facts.leds = said[4];
  facts.reset = reset_of(said[5]);
  facts.dead_man_s = weft_get_u16(&said[6]) / 1000.0;
  facts.longest_on_s = weft_get_u16(&said[8]) / 100.0;
  return facts;
}

Result<LightAnswer> light_answer_in(const BoardReply& reply, const std::string& port) {
  if (reply.command == kWeftError && reply.length == kWeftErrorReply && reply.payload[0] == kWeftResting) {
    return LightAnswer{0, std::chrono::milliseconds(weft_get_u16(&reply.payload[2]))};
  }
  if (reply.command == kWeftError || reply.length < kWeftLightReply) return unlike_protocol(reply, port);
  return LightAnswer{weft_get_u16(reply.payload.data()), {}};
}

Result<BoardStatus> status_in(const BoardReply& reply, const std::string& port) {
  if (reply.command != kWeftStatus || reply.length < kWeftStatusReply) return unlike_protocol(reply, port);
  const auto& said = reply.payload;
  BoardStatus status;
  for (int led = 1; led <= 16; ++led) {
    if ((weft_get_u16(said.data()) >> (led - 1) & 1) != 0) status.lit.push_back(led);
  }
  status.uptime_s = weft_get_u32(&said[2]) / 1000.0;
  status.bad_frames = weft_get_u16(&said[6]);
  status.overruns = weft_get_u16(&said[8]);
  status.dark = dark_of(said[10]);
  status.reset = reset_of(said[11]);
  return status;
}

Result<std::vector<double>> heat_in(const BoardReply& reply, const std::string& port) {
  if (reply.command != kWeftHeat || reply.length < kWeftHeatReply) return unlike_protocol(reply, port);
  std::vector<double> lately_s;
  for (std::size_t i = 0; i < kWeftHeatReply; ++i)
    lately_s.push_back(reply.payload[i] * (int{kWeftHeat_ms} / 1000.0));
  return lately_s;
}

Result<void> polariser_answer_in(const BoardReply& reply, const std::string& port) {
  if (reply.command != kWeftPolariser || reply.length < kWeftPolariserReply)
    return unlike_protocol(reply, port);
  return {};
}

std::uint16_t mask_of(const std::vector<int>& leds) {
  unsigned mask = 0;
  for (const int led : leds) mask |= 1U << (led - 1);
  return static_cast<std::uint16_t>(mask);
}

}  // namespace weft::capture
