// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/solve/solve_record.h"

namespace weft {

/// Bits 11 to 13 of status.png are a number: how many eighths of a pixel with kGlossy are of the other of two
/// materials than kSecondLobe says, 0 to 4.
inline constexpr int kBlendShift = 11;
inline constexpr unsigned kMostBlend = 4, kBlendParts = 8;
inline constexpr unsigned kBlendBits = 7U << kBlendShift;

/// That number; of maps that were made anew from several pixels at most kMostBlend.
inline unsigned blend_of(unsigned status) {
  return std::min((status & kBlendBits) >> kBlendShift, kMostBlend);
}
/// Bits of a pixel of which so many eighths, 0 to 8, are of the second material.
inline unsigned status_of_blend(unsigned second_parts) {
  const bool is_second = second_parts > kMostBlend;
  return (is_second ? unsigned{kSecondLobe} : 0U) | (is_second ? kBlendParts - second_parts : second_parts)
                                                        << kBlendShift;
}
/// The second material's share of a pixel, 0 to 1.
inline double second_share_of(unsigned status) {
  const double other = static_cast<double>(blend_of(status)) / kBlendParts;
  return (status & kSecondLobe) != 0 ? 1 - other : other;
}

}  // namespace weft
