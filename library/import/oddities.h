// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "library/import/import_plan.h"

namespace weft::library {

enum class OddityKind {
  kRefused,   ///< sessions that will not be made
  kDoubtful,  ///< sessions that will be, and that a person should look at
  kLeftOver,  ///< files
};
inline constexpr std::array<const char*, 3> kOddityNames = {"refused", "doubtful", "left_over"};

/// All that is odd about an import in one way, said once however many there are.
struct ImportOddity {
  OddityKind kind = OddityKind::kRefused;
  std::string what;
  std::string remedy;  ///< of refused ones
  std::size_t count = 0;
  std::vector<std::string> first;  ///< names of a few
};

/// In the order of the plan: refused, doubtful, left over. Takes time as the plan is long.
std::vector<ImportOddity> oddities_of(const ImportProposal& plan);

/// "12 sessions are refused: frames are missing: a.weft, b.weft, c.weft and 9 more. Look for the frames ...".
std::string words_of(const ImportOddity& oddity);

}  // namespace weft::library
