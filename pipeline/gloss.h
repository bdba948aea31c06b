// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/job.h"
#include "core/result.h"
#include "pipeline/photographs.h"
#include "solver/left_out/block_choice.h"
#include "solver/method.h"
#include "solver/reflectance/lobe_readings.h"
#include "solver/reflectance/measured_lobe.h"

namespace weft::pipeline {

class LightCorrection;

/// From where the photographs see the cloth.
solver::Sight sight_of(const Photographs& photographs);

/// At most so many pixels of a material are fitted: more say nothing of a lobe that model error does not
/// drown.
inline constexpr std::size_t kGlossPixels = 4000;

/// The lobe that the pixels of the sample tiles (solver/sample_tiles.h) share, from where `base` solves them.
/// They depend on the photographs alone, and on the correction that their readings go through, if there is
/// one. Errors: of the correction.
Result<solver::MeasuredLobe> measure_gloss(const Photographs& photographs, const solver::Method& base,
                                           LightCorrection* correction, int threads);

/// What solving with a lobe came to.
struct GlossFacts {
  solver::MeasuredLobe lobe;
  double share = 0;  ///< of the blocks of the frame that are solved with it
};

/// The lobe of a frame, if it shows one, and the blocks on which it predicts left-out light better than
/// Lambert's law. The photographs must outlive it.
class Gloss {
 public:
  /// A lobe that is measured nowhere changes nothing.
  static Result<Gloss> find(const Photographs& photographs, const solver::Method& base,
                            LightCorrection* correction, const JobContext& context);

  GlossFacts facts;

  /// Solves with the lobe where it earns its place, elsewhere as `base`, which must outlive this, does.
  const solver::Method& over(const solver::Method& base);

 private:
  explicit Gloss(solver::Sight sight) : sight_(sight) {}

  solver::Sight sight_;
  std::optional<solver::BlockChoice> choice_;
  std::vector<std::unique_ptr<solver::Method>> methods_;  // that over() gave away
};

}  // namespace weft::pipeline
