// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/movement_words.h"

#include <fmt/format.h>

#include <cctype>

namespace weft::calibration {
namespace {

std::string with_sigma(double value, double sigma, int digits) {
  return fmt::format("{:.{}f} ± {:.{}f}", value, digits, sigma, digits);
}

std::string axes(Vec3 value, Vec3 sigma, int digits) {
  return fmt::format("x {}, y {}, z {}", with_sigma(value.x, sigma.x, digits),
                     with_sigma(value.y, sigma.y, digits), with_sigma(value.z, sigma.z, digits));
}

std::string shift(const RigChange& change) {
  return fmt::format("by {:.2f} mm ({})", length(change.shift_mm),
                     axes(change.shift_mm, change.shift_sigma_mm, 2));
}

std::string turn(const RigChange& change) {
  return fmt::format("turned by {:.3f} degrees ({})", length(change.turn_deg),
                     axes(change.turn_deg, change.turn_sigma_deg, 3));
}

std::string percent(const RigChange& change) {
  return fmt::format("{} percent", with_sigma(100 * change.factor, 100 * change.factor_sigma, 2));
}

/// What happened, without numbers.
std::string plainly(const RigChange& change) {
  switch (change.kind) {
    case ChangeKind::kCamera:
      return "the camera has moved";
    case ChangeKind::kTable:
      return "the table has moved";
    case ChangeKind::kLedMoved:
      return fmt::format("LED {} has moved", change.led);
    case ChangeKind::kLedFaded:
      return fmt::format("LED {} is brighter or darker", change.led);
    case ChangeKind::kLedsSwapped:
      return fmt::format("LEDs {} and {} are exchanged", change.led, change.other_led);
    case ChangeKind::kAllFaded:
      break;
  }
  return "all LEDs are brighter or darker, or exposure or aperture are others";
}

Json vec_json(Vec3 v) {
  return {v.x, v.y, v.z};
}

}  // namespace

std::string name_of(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::kCamera:
      return "CAMERA_MOVED";
    case ChangeKind::kTable:
      return "TABLE_MOVED";
    case ChangeKind::kLedMoved:
      return "LED_MOVED";
    case ChangeKind::kLedFaded:
      return "LED_FADED";
    case ChangeKind::kLedsSwapped:
      return "LEDS_EXCHANGED";
    case ChangeKind::kAllFaded:
      break;
  }
  return "ALL_FADED";
}

std::string place_evidence_words(const Movement& movement) {
  const auto counted = [](int n, const char* what) {
    return n == 0 ? "" : fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  const std::string tags = counted(movement.corners / 4, "tag"),
                    points = counted(movement.points, "fixed point");
  return tags + (tags.empty() || points.empty() ? "" : " and ") + points;
}

std::string sentence(const RigChange& change) {
  std::string text;
  switch (change.kind) {
    case ChangeKind::kCamera:
      text = fmt::format("the camera has {} and moved {}", turn(change), shift(change));
      break;
    case ChangeKind::kTable:
      text = fmt::format("the table has {} and moved {}", turn(change), shift(change));
      break;
    case ChangeKind::kLedMoved:
      text = fmt::format("LED {} has moved {}", change.led, shift(change));
      break;
    case ChangeKind::kLedFaded:
      text = fmt::format("LED {} gives {} of its light", change.led, percent(change));
      break;
    case ChangeKind::kLedsSwapped:
      text = plainly(change);
      break;
    case ChangeKind::kAllFaded:
      text =
          fmt::format("all LEDs give {} of their light, or exposure or aperture are others", percent(change));
      break;
  }
  for (std::size_t i = 0; i < change.alternatives.size(); ++i)
    text += fmt::format("{} {}", i == 0 ? "; the evidence cannot tell it from this:" : ", or",
                        plainly(change.alternatives[i]));
  return text;
}

Json json_of(const RigChange& change) {
  Json json = {{"change", name_of(change.kind)}};
  if (change.led > 0) json["led"] = change.led;
  if (change.other_led > 0) json["other_led"] = change.other_led;
  if (change.kind == ChangeKind::kCamera || change.kind == ChangeKind::kTable) {
    json["turn_deg"] = vec_json(change.turn_deg);
    json["turn_sigma_deg"] = vec_json(change.turn_sigma_deg);
  }
  if (change.kind == ChangeKind::kCamera || change.kind == ChangeKind::kTable ||
      change.kind == ChangeKind::kLedMoved) {
    json["shift_mm"] = vec_json(change.shift_mm);
    json["shift_sigma_mm"] = vec_json(change.shift_sigma_mm);
  }
  if (change.kind == ChangeKind::kLedFaded || change.kind == ChangeKind::kAllFaded) {
    json["factor"] = change.factor;
    json["factor_sigma"] = change.factor_sigma;
  }
  json["evidence"] = change.evidence;
  for (const RigChange& other : change.alternatives) {
    Json named = {{"change", name_of(other.kind)}};
    if (other.led > 0) named["led"] = other.led;
    if (other.other_led > 0) named["other_led"] = other.other_led;
    json["or"].push_back(std::move(named));
  }
  return json;
}

Verdict verdict_of(const RigChange& change) {
  std::string text = sentence(change);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  const bool is_wiring = change.kind == ChangeKind::kLedsSwapped;
  return {name_of(change.kind), std::move(text),
          is_wiring ? "plug them back, or run weft calibrate update"
                    : "run weft calibrate update with this session"};
}

}  // namespace weft::calibration
