// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/brackets.h"

#include <algorithm>
#include <utility>

namespace weft::pipeline {

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

}  // namespace weft::pipeline
