// SPDX-License-Identifier: Apache-2.0
#include <iterator>

#include "torture/hard_case.h"
#include "torture/pixel_cases.h"

namespace weft::torture {

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> all;
  for (const auto& stage :
       {hard_captures, hard_calibrations, hard_solves, hard_lobes, hard_heights, hard_maps, hard_exports}) {
    std::vector<HardCase> cases = stage();
    all.insert(all.end(), std::make_move_iterator(cases.begin()), std::make_move_iterator(cases.end()));
  }
  return all;
}

}  // namespace weft::torture
