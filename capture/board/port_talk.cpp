// SPDX-License-Identifier: Apache-2.0
#include "capture/board/port_talk.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace weft::capture {
namespace {

constexpr std::size_t kShown = 16;  ///< bytes that are no text
constexpr std::size_t kLinesShown = 3;
constexpr double kTextShare = 0.9;  ///< of noise a third is printable
constexpr std::size_t kLeastText = 3;
constexpr const char* kNameThePort =
    "name the LED board's port in the rig file: `ls -l /dev/serial/by-id` lists those there are";

/// Boards as their USB numbers name them.
struct KnownUsb {
  std::string_view numbers, name;
  bool may_be_board;
};
constexpr std::array kKnownUsb = {
    KnownUsb{"2341:0043", "Arduino Uno", true},        KnownUsb{"2341:0001", "Arduino Uno", true},
    KnownUsb{"2341:0243", "Arduino Uno", true},        KnownUsb{"2a03:0043", "Arduino Uno", true},
    KnownUsb{"1a86:7523", "a CH340 bridge", true},     KnownUsb{"0403:6001", "an FT232 bridge", true},
    KnownUsb{"2341:0042", "Arduino Mega 2560", false}, KnownUsb{"2341:0010", "Arduino Mega 2560", false},
    KnownUsb{"10c4:ea60", "a CP210x bridge", false},   KnownUsb{"067b:2303", "a PL2303 bridge", false},
};

const KnownUsb* known_usb(const UsbDevice& usb) {
  const auto* const found = std::ranges::find(kKnownUsb, usb.numbers, &KnownUsb::numbers);
  return found == kKnownUsb.end() ? nullptr : found;
}

/// What devices that live at serial ports begin their lines with, or say alone on one (`whole`).
struct Banner {
  std::string_view begin, device;
  bool whole = false;
};
constexpr std::array kBanners = {
    Banner{"$G", "a GPS receiver"},
    Banner{"$BD", "a GPS receiver"},
    Banner{"$PMTK", "a GPS receiver"},
    Banner{"!AIVDM", "an AIS receiver"},
    Banner{"Grbl ", "a CNC or laser controller"},
    Banner{"echo:", "a 3D printer"},
    Banner{"busy: ", "a 3D printer"},
    Banner{"Marlin", "a 3D printer"},
    Banner{"// ", "a 3D printer, by Klipper"},
    Banner{"Klipper", "a 3D printer, by Klipper"},
    Banner{"Repetier", "a 3D printer"},
    Banner{"Smoothie", "a 3D printer or CNC controller"},
    Banner{"ok T:", "a 3D printer"},
    Banner{"T:", "a 3D printer"},
    Banner{"start", "a 3D printer", true},
    Banner{"ok", "a 3D printer or CNC controller", true},
    Banner{"Error:", "a 3D printer or CNC controller"},
    Banner{"error:", "a CNC or laser controller"},
    Banner{"ERROR", "a modem", true},
    Banner{"OK", "a modem", true},
    Banner{"+CME ERROR", "a modem"},
    Banner{"NO CARRIER", "a modem"},
    Banner{"RING", "a modem", true},
    Banner{"AT", "a modem"},
    Banner{"rst:0x", "an ESP board"},
    Banner{"ets ", "an ESP board"},
    Banner{"ESP-ROM", "an ESP board"},
    Banner{"MicroPython", "a board with MicroPython"},
    Banner{"CircuitPython", "a board with CircuitPython"},
    Banner{">>>", "a board with Python"},
};

bool is_printable(char byte) {
  return byte >= ' ' && byte <= '~';
}

bool is_text(std::string_view bytes) {
  const auto readable = std::ranges::count_if(
      bytes, [](char c) { return is_printable(c) || c == '\r' || c == '\n' || c == '\t'; });
  const bool has_word = std::ranges::any_of(bytes, is_printable);
  return bytes.size() >= kLeastText && has_word &&
         static_cast<double>(readable) >= kTextShare * static_cast<double>(bytes.size());
}

/// Optiboot's and its kin's: 14 10 where they are asked as they expect, 15 where not.
bool is_bootloader(std::string_view bytes) {
  return bytes.find("\x14\x10") != std::string_view::npos &&
         bytes.find_first_not_of("\x14\x10\x15") == std::string_view::npos;
}

/// A microcontroller of Klipper refuses what it does not understand: 05 1x, a checksum, 7E.
bool is_klipper(std::string_view bytes) {
  return bytes.size() >= 5 && bytes[0] == '\x05' && (bytes[1] & 0xF0) == 0x10 && bytes[4] == '\x7E';
}

bool is_ublox(std::string_view bytes) {
  return bytes.starts_with("\xB5\x62");
}

std::string escaped(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    if (is_printable(c) && c != '"' && c != '\\') {
      text += c;
    } else {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return text;
}

/// The lines of a text whose last may be cut off: it is left out where there are others.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  if (const std::size_t end = text.find_last_of("\r\n"); end != text.npos) {
    if (const std::string_view whole = text.substr(0, end); std::ranges::any_of(whole, is_printable))
      text = whole;
  }
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    if (end > 0) lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// The first lines, each once: "start", "busy: processing".
std::string words_of_lines(const std::vector<std::string_view>& lines) {
  std::vector<std::string_view> shown;
  for (const std::string_view line : lines) {
    if (shown.size() < kLinesShown && std::ranges::find(shown, line) == shown.end()) shown.push_back(line);
  }
  std::string words;
  for (const std::string_view line : shown)
    words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", escaped(line));
  return words;
}

/// Empty where nothing is known by these lines.
std::string_view device_of(const std::vector<std::string_view>& lines) {
  for (const Banner& banner : kBanners) {
    if (std::ranges::any_of(lines, [&](std::string_view line) {
          line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
          return banner.whole ? line == banner.begin : line.starts_with(banner.begin);
        }))
      return banner.device;
  }
  return {};
}

std::string_view device_of_bytes(std::string_view bytes) {
  if (is_klipper(bytes)) return "a 3D printer's board, by Klipper";
  if (is_ublox(bytes)) return "a GPS receiver";
  return {};
}

std::string hex_of(std::string_view bytes) {
  std::string text;
  for (const char c : bytes.substr(0, kShown))
    text += fmt::format("{}{:02X}", text.empty() ? "" : " ", static_cast<unsigned char>(c));
  return text + (bytes.size() > kShown ? " ..." : "");
}

/// "; it is Arduino Uno, USB 2341:0043".
std::string words_of(const UsbDevice& usb) {
  if (usb.numbers.empty()) return "; its USB identity is not known";
  const KnownUsb* known = known_usb(usb);
  std::string name = usb.name.empty() ? "" : fmt::format("\"{}\"", escaped(usb.name));
  if (known != nullptr && name.find(known->name) == std::string::npos)
    name += fmt::format("{}{}", name.empty() ? "" : ", ", known->name);
  return fmt::format("; it is {}{}USB {}", name, name.empty() ? "" : ", ", usb.numbers);
}

}  // namespace

bool may_be_led_board(const UsbDevice& usb) {
  const KnownUsb* known = known_usb(usb);
  return known != nullptr && known->may_be_board;
}

void PortTalk::begin(std::span<const std::uint8_t> sent) {
  *this = {};
  sent_.assign(sent.begin(), sent.end());
}

void PortTalk::hear(std::span<const std::uint8_t> bytes, bool unasked) {
  const std::size_t kept = std::min(bytes.size(), kKept - first_.size());
  first_.append(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(kept));
  bytes_ += bytes.size();
  if (unasked) unasked_ += bytes.size();
}

/// The first bytes without whole requests that came back; nor one that is cut off at their end.
std::string PortTalk::without_echo() const {
  std::string rest = first_;
  bool echoes = false;
  for (std::size_t at = 0; !sent_.empty() && (at = rest.find(sent_, at)) != std::string::npos; echoes = true)
    rest.erase(at, sent_.size());
  for (std::size_t cut = sent_.size(); echoes && cut-- > 1;)
    if (rest.ends_with(sent_.substr(0, cut))) rest.resize(rest.size() - cut);
  return rest;
}

bool PortTalk::is_foreign() const {
  const std::string rest = without_echo();
  return bytes_ > 0 && replies_ == 0 &&
         (rest.empty() || is_text(rest) || (!is_bootloader(rest) && !device_of_bytes(rest).empty()));
}

Error PortTalk::no_board(const std::string& port, const UsbDevice& usb, double waited_s) const {
  const std::string identity = words_of(usb);
  if (is_silent()) {
    return {ErrorKind::kTryAgain, "the LED board does not answer", port,
            fmt::format("the port was silent for {:.1f} s{}", waited_s, identity),
            may_be_led_board(usb)
                ? "check that it is the LED board and flash its firmware: weft rig flash " + port
                : "check that it is the LED board's port, and that the board has power: "
                  "`ls -l /dev/serial/by-id` lists those there are"};
  }
  const std::string rest = without_echo();
  const std::string amount = fmt::format("{} byte{} in {:.1f} s", bytes_, bytes_ == 1 ? "" : "s", waited_s);
  const char* const how = unasked_ > 0 ? "sends of its own accord" : "answers";
  const auto foreign = [&](std::string_view device, const std::string& said) {
    return Error{ErrorKind::kBadData, "another device is at the LED board's port", port,
                 fmt::format("{} {}: {} ({}){}", device.empty() ? "another firmware" : device, how, said,
                             amount, identity),
                 kNameThePort};
  };
  if (replies_ > 0) {
    return {ErrorKind::kTryAgain, "the LED board does not answer what it is asked", port,
            fmt::format("{} whole replies to other requests ({}){}", replies_, amount, identity),
            "end other programs that speak to it, and plug it out and in"};
  }
  if (rest.empty()) return foreign("a device that echoes, or a cable's loop,", "what it was sent");
  if (is_bootloader(rest)) {
    return {ErrorKind::kTryAgain, "the LED board's firmware does not start", port,
            fmt::format("a bootloader answers: {} ({}){}", hex_of(rest), amount, identity),
            "end the program that flashes it, or plug it out and in"};
  }
  if (is_text(rest)) {
    const std::vector<std::string_view> lines = lines_of(rest);
    return foreign(device_of(lines), words_of_lines(lines));
  }
  if (const std::string_view device = device_of_bytes(rest); !device.empty())
    return foreign(device, hex_of(rest));
  return {ErrorKind::kTryAgain, "what comes from the LED board's port cannot be read", port,
          fmt::format("{}{}, neither a reply nor text: {}; a device of another speed than 115200 baud, or "
                      "noise on the line{}",
                      amount, unasked_ > 0 ? " of its own accord" : "", hex_of(rest), identity),
          std::string("plug it out and in; if that does not help, ") + kNameThePort};
}

}  // namespace weft::capture
