// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "core/rig/photosites.h"
#include "solve/conditions/conditions.h"
#include "solve/photographs/photographs.h"

namespace weft::solve {

/// The photosites that say nothing of light (core/rig/photosites.h), sorted, each once: hot in the dark shot,
/// dead in the lit ones, or `known` to be bad.
std::vector<Photosite> find_bad_photosites(const Mosaics& mosaics, const std::vector<Photosite>& known,
                                           int threads);

/// Gives them what their neighbours say in every frame of the session: the mosaics, `others` and the dark
/// shot.
void replace_bad_photosites(std::vector<Photosite> bad, Mosaics& mosaics,
                            const std::vector<RawFrame*>& others, int threads);

/// Replaces the photosites that are hot, dead, or known to be bad, in every frame.
Result<void> mend_photosites(const Exposures& exposures);

}  // namespace weft::solve
