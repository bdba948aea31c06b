// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace weft::capture {

/// A shutter time as libgphoto2 lists it, in us: "1/60", "10/25", "1.3", "0.0166s", "30". Nothing for "Bulb".
std::optional<double> shutter_us_of(std::string_view text);

/// The number of a listed ISO or aperture: "100", "f/5.6". Nothing for "Auto".
std::optional<double> number_of(std::string_view text);

/// One value that a camera can be set to.
struct Choice {
  std::string text;  ///< as the camera lists it
  double value = 0;
};

/// The listed texts that are values, rising.
std::vector<Choice> choices_of(const std::vector<std::string>& listed,
                               std::optional<double> (*value_of)(std::string_view));

/// The choice nearest to `wanted`, at most 1 percent off; else kBadData naming the ones on either side.
Result<Choice> nearest_choice(const std::vector<Choice>& choices, double wanted, const std::string& name);

}  // namespace weft::capture
