// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/lens_glare.h"

namespace weft::solve {

Result<void> tell_veil(const Exposures& exposures) {
  const Mosaics* mosaics = exposures.photographs.mosaics();
  if (mosaics != nullptr && mosaics->response.veil)
    exposures.photographs.conditions.facts.veil = mosaics->response.veil->share;
  return {};
}

}  // namespace weft::solve
