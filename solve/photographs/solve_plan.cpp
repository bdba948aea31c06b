// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

std::vector<Shot> SolvePlan::frames() const {
  std::vector<Shot> all = lit;
  if (dark) all.push_back(*dark);
  all.insert(all.end(), repeats.begin(), repeats.end());
  all.insert(all.end(), parallel.begin(), parallel.end());
  all.insert(all.end(), brackets.begin(), brackets.end());
  if (blade) all.push_back(*blade);
  return all;
}

std::vector<std::filesystem::path> SolvePlan::files() const {
  std::vector<std::filesystem::path> all;
  for (const Shot& shot : frames()) all.push_back(session.path_of(shot));
  return all;
}

std::vector<int> SolvePlan::numbers() const {
  std::vector<int> all;
  for (const Shot& shot : lit) all.push_back(shot.led);
  return all;
}

}  // namespace weft::solve
