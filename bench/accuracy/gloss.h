// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "bench/accuracy/scenes.h"
#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct GlossOptions {
  SceneSet set = SceneSet::kHeldOut;
  std::string cloth;  ///< this one alone, such as "satin"; empty: all
  std::uint32_t seed = 1;
  int threads = 0;
};

/// Cloths of each weave whose lobe the solver has a family for, and cloths whose truth is another
/// model. A row each:
/// robust_deg: mean angle to the true normal by the readings that Lambert's law explains best
/// (solver::robust_method). lobe_deg, lobe_p95_deg: by the level robust, with the lobe it found.
/// reference_deg: by the level reference. albedo_rel: mean of |A - B| / B of the level robust.
/// albedo_rel_rgb: of red, green and blue, and before, by the readings that Lambert's law explains best.
/// f0_rgb: by channel, where a tint was found. alpha, along, f0: what was found, beside what is true where
/// that has such numbers. said: measured, or why not. changes: whether alpha is said to change across the
/// frame. fit_s: seconds of finding it on one thread. robust_us, glossy_us: microseconds a pixel of
/// robust_method, and of it and the lobe, on one thread. kUsage where no cloth has the given name.
Result<Rows> gloss_table(const GlossOptions& options);

}  // namespace weft::bench
