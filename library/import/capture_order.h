// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "library/import/source_frame.h"

// In which order photographs were taken, by their names, their times and the camera's count.

namespace weft::library {

/// By names as people count, or by the numbers that a pattern finds in them; by times (equal ones by name),
/// nothing where one has no time.
std::vector<std::size_t> order_of_names(const std::vector<SourceFrame>& frames);
std::optional<std::vector<std::size_t>> order_of_times(const std::vector<SourceFrame>& frames);

/// What a name ends with, "DSC_9999.NEF": its number, and how far so many digits can count.
struct NameCount {
  std::string word;  ///< "DSC_"
  std::size_t number = 0, end = 1;
};
NameCount count_of(const std::string& label);

/// Two photographs, one after the other, between which a camera's clock was set back.
struct ClockStep {
  std::size_t before = 0, after = 0;  ///< frames
  double back_s = 0;
};
/// "the camera's clock went back by 3600 s between DSC_5.NEF and DSC_6.NEF".
std::string words_of(const ClockStep& step, const std::vector<SourceFrame>& frames);

/// Photographs in order of a counter that went on, whatever their times say.
struct CountedOrder {
  std::vector<std::size_t> order;
  std::vector<ClockStep> steps;
};

/// The order of names, where they are one word and a number that rises with few gaps, and so does the
/// camera's own count, if all photographs have it. Nothing where they are not, or where times run back more
/// often than a clock is set.
std::optional<CountedOrder> counted_order(const std::vector<SourceFrame>& frames);

}  // namespace weft::library
