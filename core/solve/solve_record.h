// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace weft {

/// Bits of status.png. The first two and kInvalidReading say that a reading was left out; the others speak of
/// the pixel itself.
enum StatusBit : std::uint16_t {
  kSaturated = 1 << 0,
  kShadowed = 1 << 1,
  kZeroDof = 1 << 2,         ///< exactly three readings: nothing left to test them by
  kDark = 1 << 3,            ///< no reading stands out of the noise
  kIllConditioned = 1 << 4,  ///< condition number of the light matrix from 1e6
  kNoSolution = 1 << 5,      ///< fewer than three readings, or light directions of rank below three
  kSpecular = 1 << 6,        ///< a reading over three times the Lambert prediction
  kInvalidReading = 1 << 7,
  kGlossy = 1 << 8,       ///< solved with the lobe that its material shares
  kYarnAcross = 1 << 9,   ///< such a pixel, whose yarn lies across the lobe's axis
  kSecondLobe = 1 << 10,  ///< such a pixel, of the second of two materials
};
/// These say how a pixel was solved and speak against nothing.
inline constexpr unsigned kHowSolved = kGlossy | kYarnAcross | kSecondLobe;

struct StatusName {
  StatusBit bit;
  const char* name;
};

inline constexpr std::array<StatusName, 11> kStatusNames = {{{kSaturated, "SATURATED"},
                                                             {kShadowed, "SHADOWED"},
                                                             {kZeroDof, "ZERO_DOF"},
                                                             {kDark, "DARK"},
                                                             {kIllConditioned, "ILL_CONDITIONED"},
                                                             {kNoSolution, "NO_SOLUTION"},
                                                             {kSpecular, "SPECULAR"},
                                                             {kInvalidReading, "INVALID_READING"},
                                                             {kGlossy, "GLOSSY"},
                                                             {kYarnAcross, "YARN_ACROSS"},
                                                             {kSecondLobe, "SECOND_LOBE"}}};

/// Raised whenever the bytes of an output may change.
inline constexpr int kSolverVersion = 16;

}  // namespace weft
