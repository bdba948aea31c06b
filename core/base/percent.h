// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace weft {

/// A share in percent as a sentence has it, two digits and whole ones: "0.026", "2.6", "26", "100". What is
/// under a thousandth of a percent is "under 0.001".
std::string percent_words(double share);

}  // namespace weft
