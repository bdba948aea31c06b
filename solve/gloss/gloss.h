// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "solve/correction/surface_witness.h"
#include "solve/photographs/photographs.h"
#include "solver/left_out/block_choice.h"
#include "solver/method.h"
#include "solver/reflectance/lobe_readings.h"
#include "solver/reflectance/materials.h"

namespace weft::solve {

class LightCorrection;

/// From where the photographs see the cloth; under distant lights from straight above.
solver::Sight sight_of(const Photographs& photographs);

/// Lobes, and the unit that their readings and albedo are over: 1 where the albedo is absolute.
struct MeasuredGloss {
  std::vector<solver::MeasuredLobe> lobes;  ///< one to three; of a refused one Lambert's law holds
  double unit = 1;
};

/// The lobes that the pixels of sample_gloss() share with those of a second pose, one a material
/// (solver/reflectance/materials.h). They depend on the photographs alone, and on the correction that their
/// readings go through, if there is one. Where the scale of the albedo is relative, the unit is the one in
/// which the lobe is as strong as that of a fibre, as far as the albedo stays that of a cloth, and before a
/// lobe is found the one in which the albedo is a usual one: any scale of the intensities leads to the same
/// lobe.
/// Errors of the calibration count as if both poses saw the rig from the same side, which at 20 degrees makes
/// them wrong by 6 percent. Errors: of the correction.
Result<MeasuredGloss> measure_gloss(const Photographs& photographs, const solver::Method& base,
                                    LightCorrection* correction, int threads);

/// f0 of R, G and B.
struct F0OfChannels {
  std::array<double, 3> f0 = {}, sigma = {};
};

/// What solving with lobes came to.
struct GlossFacts : MeasuredGloss {
  double share = 0;   ///< of the blocks of the frame that are solved with them
  double misfit = 1;  ///< chi-square that the best lobe leaves, of the worst material; at least 1
  /// Share of the cloth that outshines it where metal is among the readings (is_like_metal()); 0 elsewhere.
  double metal_share = 0;
  /// Where left-out light is for the lobes and curl against them: they are not used, and not called measured.
  std::optional<CurlWitness> against = {};
  double seconds = 0;           ///< that looking for them took, whatever the frame's size
  bool of_film_pair = false;    ///< they were sought in crossed and parallel photographs
  bool of_second_pose = false;  ///< and in a second pose of the cloth
  /// The f0 of each lobe with a tint, in the channels of the albedo that is written.
  std::vector<std::optional<F0OfChannels>> f0_of_channels = {};

  bool is_measured() const { return lobes.front().is_measured(); }
};

/// The lobes of a frame, if it shows any, and the blocks on which it predicts left-out light better than
/// Lambert's law. The photographs must outlive it.
class Gloss {
 public:
  /// Where none is measured nothing changes.
  static Result<Gloss> find(const Photographs& photographs, const solver::Method& base,
                            LightCorrection* correction, const JobContext& context);

  GlossFacts facts;

  /// Solves with the lobes where they earn their place, elsewhere as `base`, which must outlive this, does.
  /// Where all materials have a lobe, and `base` wants no RGB, it begins from the standard method's normals.
  const solver::Method& over(const solver::Method& base);

 private:
  explicit Gloss(solver::Sight sight) : sight_(sight) {}
  const solver::Method& beneath(const solver::Method& base) const;

  solver::Sight sight_;
  std::unique_ptr<solver::Method> standard_ = solver::standard_method();
  std::optional<solver::BlockChoice> choice_;
  std::vector<std::unique_ptr<solver::Method>> methods_;  // that over() gave away
};

}  // namespace weft::solve
