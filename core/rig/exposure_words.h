// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace weft {

/// An exposure as people write it: "250 us", "12.5 ms", "1.6 s".
std::string exposure_words(double exposure_us);

}  // namespace weft
