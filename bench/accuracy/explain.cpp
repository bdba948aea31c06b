// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include "bench/accuracy/coverage.h"
#include "core/parallel.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::bench {

/// What `weft solve --explain` predicts, by `normal_deg` of sigma.exr, against what comes true: a row for
/// each scene and level, with the mean of both angles over all pixels with a solution, and their ratio. A
/// pixel of a preview is held against the four that it stands for.
Result<Rows> explain_table(const AccuracyTableOptions& options) {
  const int threads = resolved_threads(options.threads);
  Rows rows;
  for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, options.quick)) {
    const Result<std::vector<Patch>> patches = render_patches(scene, threads);
    if (!patches) return patches.error();
    for (const solver::MethodName& level : solver::method_names()) {
      if (!level.level) continue;
      double predicted = 0, real = 0, pixels = 0;
      for (const Patch& patch : *patches) {
        const Result<std::vector<StatedError>> errors = stated_errors(patch, level, threads);
        if (!errors) return errors.error();
        for (const StatedError& pixel : *errors) {
          predicted += solver::kMeanOfRms * static_cast<double>(pixel.sigma_deg);
          real += static_cast<double>(pixel.error_deg);
        }
        pixels += static_cast<double>(errors->size());
      }
      rows.push_back({{"scene", scene.name},
                      {"quality", level.name},
                      {"predicted_deg", predicted / pixels},
                      {"true_deg", real / pixels},
                      {"ratio", predicted / real}});
    }
  }
  return rows;
}

}  // namespace weft::bench
