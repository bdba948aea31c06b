// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/photosites.h"

#include <algorithm>
#include <utility>

namespace weft::pipeline {

std::vector<Photosite> find_bad_photosites(const Mosaics& mosaics, const std::vector<Photosite>& known,
                                           int threads) {
  const double read_noise = mosaics.response.read_noise_counts;
  const RawFrame* dark = mosaics.dark ? &*mosaics.dark : nullptr;
  std::vector<Photosite> bad = dead_photosites(mosaics.frames, dark, read_noise, threads);
  if (dark != nullptr) {
    const std::vector<Photosite> hot = hot_photosites(*dark, read_noise, threads);
    bad.insert(bad.end(), hot.begin(), hot.end());
  }
  bad.insert(bad.end(), known.begin(), known.end());
  std::sort(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  return bad;
}

void replace_bad_photosites(std::vector<Photosite> bad, Mosaics& mosaics,
                            const std::vector<RawFrame*>& others, int threads) {
  std::vector<RawFrame*> frames;
  for (RawFrame& frame : mosaics.frames) frames.push_back(&frame);
  frames.insert(frames.end(), others.begin(), others.end());
  if (mosaics.dark) frames.push_back(&*mosaics.dark);
  replace_photosites(frames, bad, threads);
  mosaics.replaced = std::move(bad);
}

}  // namespace weft::pipeline
