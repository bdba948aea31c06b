// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/light_faults.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

namespace weft::virtual_rig {
namespace {

constexpr double kMostLight = 100;
constexpr int kFarthestMove = 1000;
constexpr double kFastest_hz = 1e6;

/// The numbers after a command's name.
struct Arguments {
  std::vector<double> values;
  int leds;

  std::size_t count() const { return values.size(); }
  bool is_led(std::size_t i) const {
    return values[i] >= 1 && values[i] <= leds && values[i] == std::floor(values[i]);
  }
  int whole(std::size_t i) const { return static_cast<int>(values[i]); }
  bool is_light(std::size_t i) const { return values[i] >= 0 && values[i] <= kMostLight; }
  bool is_frequency(std::size_t i) const { return values[i] > 0 && values[i] <= kFastest_hz; }
  bool is_share(std::size_t i) const { return values[i] >= 0 && values[i] <= 1; }
  bool is_step(std::size_t i) const {
    return std::abs(values[i]) <= kFarthestMove && std::fmod(values[i], 2) == 0;
  }
};

struct Command {
  const char* name;
  const char* arguments;
  const char* example;  // of arguments
  const char* does;
  std::size_t count;
  std::function<bool(const Arguments&)> fits;
  std::function<void(LightFaults&, const Arguments&)> change;
};

const std::vector<Command>& commands() {
  static const std::vector<Command> kCommands = {
      {"normal", "", "", "no fault of light", 0, [](const Arguments&) { return true; },
       [](LightFaults& f, const Arguments&) { f = {}; }},
      {"dead", "LED", "3", "the LED never shines", 1, [](const Arguments& a) { return a.is_led(0); },
       [](LightFaults& f, const Arguments& a) { f.dead.insert(a.whole(0)); }},
      {"stuck", "LED", "3", "the LED always shines", 1, [](const Arguments& a) { return a.is_led(0); },
       [](LightFaults& f, const Arguments& a) { f.stuck.insert(a.whole(0)); }},
      {"swap", "LED LED", "3 4", "the wires of two LEDs change places", 2,
       [](const Arguments& a) { return a.is_led(0) && a.is_led(1); },
       [](LightFaults& f, const Arguments& a) { f.swapped.emplace_back(a.whole(0), a.whole(1)); }},
      {"dim", "LED SHARE", "3 0.5", "the LED gives this share of its light, 0 to 100", 2,
       [](const Arguments& a) { return a.is_led(0) && a.is_light(1); },
       [](LightFaults& f, const Arguments& a) { f.dimmed[a.whole(0)] = a.values[1]; }},
      {"flicker", "SIGMA", "0.01", "each LED's light varies by this from shot to shot, relative, 0 to 1", 1,
       [](const Arguments& a) { return a.is_share(0); },
       [](LightFaults& f, const Arguments& a) { f.flicker = a.values[0]; }},
      {"pulses", "HERTZ DEPTH DUTY", "500 1 0.6",
       "the LEDs' driver gives pulses of the same mean: so many a second, this share of the light out "
       "between them, each of DUTY of a period",
       3,
       [](const Arguments& a) {
         return a.is_frequency(0) && a.is_share(1) && a.is_share(2) && a.values[2] > 0;
       },
       [](LightFaults& f, const Arguments& a) {
         f.pulses = LightWave{a.values[0], a.values[1], a.values[2]};
       }},
      {"ambient", "SHARE", "0.1", "light of the room, of the brightest LED's at the table's centre, 0 to 100",
       1, [](const Arguments& a) { return a.is_light(0); },
       [](LightFaults& f, const Arguments& a) { f.ambient = a.values[0]; }},
      {"lamp", "HERTZ DEPTH", "100 0.3",
       "the room's light rises and falls by this share of it, so often a second, as a sine", 2,
       [](const Arguments& a) { return a.is_frequency(0) && a.is_share(1); },
       [](LightFaults& f, const Arguments& a) {
         f.lamp = LightWave{a.values[0], a.values[1], {}};
       }},
      {"move", "X Y", "6 -4",
       "the camera was knocked: the picture lies X pixels right and Y down, even, to 1000", 2,
       [](const Arguments& a) { return a.is_step(0) && a.is_step(1); },
       [](LightFaults& f, const Arguments& a) {
         f.move_x = a.whole(0);
         f.move_y = a.whole(1);
       }},
  };
  return kCommands;
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (wrong != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::string said(const Command& command, const char* arguments) {
  return *arguments == '\0' ? command.name : fmt::format("{} {}", command.name, arguments);
}

Json json_of(const std::optional<LightWave>& wave) {
  if (!wave) return {};
  Json told = {{"hertz", wave->hertz}, {"depth", wave->depth}};
  if (wave->duty) told["duty"] = *wave->duty;
  return told;
}

Error refusal(const std::vector<std::string>& words, const std::string& why, const std::string& remedy) {
  return {ErrorKind::kUsage, "no such fault of light", fmt::format("light {}", fmt::join(words, " ")), why,
          remedy};
}

}  // namespace

std::vector<CommandWords> light_fault_words() {
  std::vector<CommandWords> all;
  for (const Command& c : commands())
    all.push_back({"light " + said(c, c.arguments), c.does, "light " + said(c, c.example)});
  return all;
}

Result<void> change_faults(LightFaults& faults, const std::vector<std::string>& words, int leds) {
  std::vector<std::string> names;
  for (const Command& command : commands()) {
    names.emplace_back(command.name);
    if (words.empty() || words[0] != command.name) continue;
    Arguments arguments{{}, leds};
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (const std::optional<double> value = number_of(words[i])) arguments.values.push_back(*value);
    }
    if (words.size() != command.count + 1 || arguments.count() != command.count || !command.fits(arguments)) {
      return refusal(words, command.does,
                     fmt::format("say light {}; LEDs are 1 to {}", said(command, command.arguments), leds));
    }
    command.change(faults, arguments);
    return {};
  }
  return refusal(words, fmt::format("known are {}", fmt::join(names, ", ")), "choose one of these");
}

Json json_of(const LightFaults& faults) {
  Json dimmed = Json::object();
  for (const auto& [led, share] : faults.dimmed) dimmed[std::to_string(led)] = share;
  return {{"dead", faults.dead},       {"stuck", faults.stuck},        {"swapped", faults.swapped},
          {"dimmed", dimmed},          {"flicker", faults.flicker},    {"pulses", json_of(faults.pulses)},
          {"ambient", faults.ambient}, {"lamp", json_of(faults.lamp)}, {"move_x", faults.move_x},
          {"move_y", faults.move_y}};
}

std::vector<double> with_faults(const LightFaults& faults, std::vector<double> pins) {
  const auto of = [&pins](int led) -> double& { return pins[static_cast<std::size_t>(led - 1)]; };
  for (const auto& [a, b] : faults.swapped) std::swap(of(a), of(b));
  for (const int led : faults.stuck) of(led) = 1;
  for (const int led : faults.dead) of(led) = 0;
  for (const auto& [led, share] : faults.dimmed) of(led) *= share;
  return pins;
}

}  // namespace weft::virtual_rig
