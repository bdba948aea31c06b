// SPDX-License-Identifier: Apache-2.0
#include "core/rig/exposure_words.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace weft {
namespace {

TEST(ExposureWords, AreThoseOfPeople) {
  for (const auto& [exposure_us, words] : std::vector<std::pair<double, std::string>>{{16.2, "16.2 us"},
                                                                                      {250, "250 us"},
                                                                                      {12500, "12.5 ms"},
                                                                                      {1e6 / 60, "16.67 ms"},
                                                                                      {999'999, "1000 ms"},
                                                                                      {1.5e6, "1.5 s"},
                                                                                      {30e6, "30 s"},
                                                                                      {1e9, "1000 s"},
                                                                                      {1e11, "100000 s"}}) {
    EXPECT_EQ(exposure_words(exposure_us), words);
  }
}

}  // namespace
}  // namespace weft
