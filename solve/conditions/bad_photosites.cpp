// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/bad_photosites.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace weft::solve {

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

Result<void> mend_photosites(const Exposures& exposures) {
  Photographs& photographs = exposures.photographs;
  Mosaics* mosaics = photographs.mosaics();
  if (mosaics == nullptr) return {};
  FramesBeside& beside = exposures.beside;
  std::vector<RawFrame*> others;
  for (RawFrame& frame : std::get<Mosaics>(beside.repeats).frames) others.push_back(&frame);
  for (RawFrame& frame : beside.brackets) others.push_back(&frame);
  if (photographs.parallel) {
    for (RawFrame& frame : std::get<Mosaics>(*photographs.parallel).frames) others.push_back(&frame);
  }
  const int threads = exposures.context.threads;
  replace_bad_photosites(find_bad_photosites(*mosaics, beside.known_bad, threads), *mosaics, others, threads);
  photographs.conditions.facts.hot_photosites = static_cast<int>(mosaics->replaced.size());
  return {};
}

}  // namespace weft::solve
