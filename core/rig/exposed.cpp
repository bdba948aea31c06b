// SPDX-License-Identifier: Apache-2.0
#include "core/rig/exposed.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/base/percent.h"
#include "core/rig/exposure_words.h"

namespace weft {
namespace {

// The least that is clipped and the least room of one shot at several exposures: brackets are there for both.
std::map<std::pair<int, Polariser>, Exposed> best_of_shots(const Session& session) {
  std::map<std::pair<int, Polariser>, Exposed> shots;
  for (const Shot& shot : session.shots) {
    if (shot.superseded_by || (shot.role != ShotRole::kLit && shot.role != ShotRole::kBracket)) continue;
    const std::optional<Exposed> exposed = exposed_of(shot);
    if (!exposed) continue;
    Exposed& best = shots.try_emplace({shot.led, shot.polariser}, *exposed).first->second;
    best = {std::min(best.clipped, exposed->clipped), std::min(best.room, exposed->room)};
  }
  return shots;
}

// The worst of each LED's shots through films.
std::map<int, Exposed> exposed_by_led(const Session& session) {
  std::map<int, Exposed> leds;
  for (const auto& [shot, exposed] : best_of_shots(session)) {
    Exposed& worst = leds.try_emplace(shot.first, exposed).first->second;
    worst = {std::max(worst.clipped, exposed.clipped), std::min(worst.room, exposed.room)};
  }
  return leds;
}

std::string names_of(const std::vector<int>& some, std::size_t all) {
  if (some.size() == all && all > 1) return fmt::format("All {} LEDs", all);
  std::string names = some.size() == 1 ? "LED " : "LEDs ";
  for (std::size_t i = 0; i < some.size(); ++i)
    names += fmt::format("{}{}", i == 0 ? "" : i + 1 == some.size() ? " and " : ", ", some[i]);
  return names;
}

std::string over_words(const std::map<int, Exposed>& leds) {
  std::vector<int> over, clipped;
  double least = 1, most = 0, most_clipped = 0;
  for (const auto& [led, exposed] : leds) {
    if (exposed.clipped >= kOverFrom) {
      over.push_back(led);
      least = std::min(least, exposed.clipped);
      most = std::max(most, exposed.clipped);
    } else if (exposed.clipped > kMostClipped) {
      clipped.push_back(led);
      most_clipped = std::max(most_clipped, exposed.clipped);
    }
  }
  if (!over.empty()) {
    const std::string from = percent_words(least), to = percent_words(most);
    return fmt::format("{} {} over: {} percent of a channel are full; scan again with a metered exposure",
                       names_of(over, leds.size()), over.size() == 1 ? "is" : "are",
                       from == to ? to : from + " to " + to);
  }
  if (clipped.empty()) return "";
  return fmt::format(
      "{} {} up to {} percent of a channel full; scan again with a shorter exposure, or with a bracket at a "
      "quarter of it",
      names_of(clipped, leds.size()), clipped.size() == 1 ? "has" : "have", percent_words(most_clipped));
}

}  // namespace

void set_exposed(const Exposed& exposed, Json& shot) {
  shot["exposed"] = {{"clipped", exposed.clipped}, {"room", exposed.room}};
}

std::optional<Exposed> exposed_of(const Shot& shot) {
  return exposed_in(shot.document);
}

std::optional<Exposed> exposed_in(const Json& shot) {
  const auto found = shot.find("exposed");
  if (found == shot.end() || !found->is_object()) return std::nullopt;
  const Json clipped = found->value("clipped", Json()), room = found->value("room", Json());
  if (!clipped.is_number() || !room.is_number()) return std::nullopt;
  return Exposed{clipped.get<double>(), room.get<double>()};
}

std::string why_useless(const Exposed& exposed, double exposure_us, double bracket) {
  const std::string time = exposure_words(exposure_us);
  if (exposed.clipped >= kUselessFrom && bracket >= 1)
    return fmt::format("{} percent of a channel are full at {}", percent_words(exposed.clipped), time);
  if (exposed.room >= kUselessDarkFrom && bracket <= 1)
    return fmt::format("it is dark: {:.0f} times {} would be right", exposed.room, time);
  return "";
}

bool is_exposed_wrong(const Session& session) {
  const std::map<int, Exposed> leds = exposed_by_led(session);
  const auto is_over = [](const auto& led) { return led.second.clipped >= kOverFrom; };
  const auto is_dark = [](const auto& led) { return led.second.room >= kDarkFrom; };
  return std::ranges::any_of(leds, is_over) || (!leds.empty() && std::ranges::all_of(leds, is_dark));
}

std::string exposure_warning(const Session& session) {
  const std::map<int, Exposed> leds = exposed_by_led(session);
  if (leds.empty()) return "";
  if (std::string over = over_words(leds); !over.empty()) return over;
  double room = std::numeric_limits<double>::infinity();
  for (const auto& [led, exposed] : leds) room = std::min(room, exposed.room);
  if (room < kDarkFrom) return "";
  std::vector<int> all;
  for (const auto& [led, exposed] : leds) all.push_back(led);
  return fmt::format(
      "{} {} dark: the exposure could be {:.0f} times as long; scan again with a metered exposure, or with "
      "more light where the camera has no longer one",
      names_of(all, all.size()), all.size() == 1 ? "is" : "are", room);
}

}  // namespace weft
