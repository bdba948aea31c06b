// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/brackets.h"

#include <algorithm>
#include <utility>

namespace weft::solve {

void join_brackets(std::vector<BracketShot> shots, Mosaics& mosaics) {
  if (shots.empty()) return;
  mosaics.brackets.resize(mosaics.count());
  double least = 1;
  for (BracketShot& shot : shots) {
    const Radiometry radiometry(shot.frame, mosaics.dark ? &*mosaics.dark : nullptr, mosaics.response,
                                {mosaics.exposure.exposure_us * shot.ratio, mosaics.exposure.iso});
    mosaics.brackets[shot.light].push_back({std::move(shot.frame), radiometry});
    least = std::min(least, shot.ratio);
  }
  mosaics.noise.per_reading /= least;
  mosaics.noise.floor /= least * least;
  mosaics.noise.shared /= least * least;
}

Result<void> add_brackets(const Exposures& exposures) {
  const SolvePlan& plan = exposures.plan;
  Photographs& photographs = exposures.photographs;
  std::vector<BracketShot> shots;
  for (std::size_t i = 0; i < exposures.beside.brackets.size(); ++i) {
    const Shot& shot = plan.brackets[i];
    const double exposure_us = plan.lit.front().exposure_us;
    shots.push_back({photographs.light_of(shot.led),
                     plan.calibration.response->exposure_ratio(shot.exposure_us, exposure_us).value(),
                     std::move(exposures.beside.brackets[i])});
  }
  photographs.conditions.facts.brackets = static_cast<int>(shots.size());
  if (Mosaics* mosaics = photographs.mosaics()) join_brackets(std::move(shots), *mosaics);
  return {};
}

}  // namespace weft::solve
