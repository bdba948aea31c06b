// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/number.h"

namespace weft::capture {
namespace {

constexpr double kMostOff = 0.01;

std::optional<double> plain_number(std::string_view text) {
  const std::optional<double> value = as_number(text);
  return value && *value > 0 ? value : std::nullopt;
}

}  // namespace

std::optional<double> shutter_us_of(std::string_view text) {
  if (text.ends_with('s')) text.remove_suffix(1);
  const std::size_t slash = text.find('/');
  const auto over = plain_number(text.substr(0, slash));
  const auto under =
      slash == std::string_view::npos ? std::optional(1.0) : plain_number(text.substr(slash + 1));
  if (!over || !under) return {};
  return 1e6 * *over / *under;
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with("f/")) text.remove_prefix(2);
  return plain_number(text);
}

std::vector<Choice> choices_of(const std::vector<std::string>& listed,
                               std::optional<double> (*value_of)(std::string_view)) {
  std::vector<Choice> choices;
  for (const std::string& text : listed) {
    if (const auto value = value_of(text)) choices.push_back({text, *value});
  }
  std::ranges::stable_sort(choices, {}, &Choice::value);
  return choices;
}

Result<Choice> nearest_choice(const std::vector<Choice>& choices, double wanted, const std::string& name) {
  const auto off = [wanted](const Choice& choice) { return std::abs(choice.value - wanted); };
  const auto nearest = std::ranges::min_element(choices, {}, off);
  if (nearest != choices.end() && off(*nearest) <= kMostOff * wanted) return *nearest;

  std::string sides;
  const auto above = std::ranges::upper_bound(choices, wanted, {}, &Choice::value);
  if (above != choices.begin()) sides = std::prev(above)->text;
  if (above != choices.end()) sides += (sides.empty() ? "" : " and ") + above->text;
  return Error{ErrorKind::kBadData, "the camera has no such " + name, fmt::format("{:.10g}", wanted),
               sides.empty() ? "it lists none" : "the nearest are " + sides,
               sides.empty()
                   ? "set the camera's mode dial to M and fit the lens that the rig was calibrated with"
                   : "ask for one of those"};
}

}  // namespace weft::capture
