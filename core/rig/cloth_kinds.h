// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace weft {

/// Kinds of cloth that a person may say a scan is of (`kind` of a session's metadata), where its photographs
/// do not tell its gloss. calibration::planned_cloths() has what is assumed of each, in this order.
inline constexpr std::array<std::string_view, 5> kClothKinds = {"cotton", "wool", "velvet", "satin",
                                                                "dark-satin"};

}  // namespace weft
