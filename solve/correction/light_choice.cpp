// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/light_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/statistics.h"
#include "core/image/tiles.h"
#include "solve/correction/leave_out_lights.h"

namespace weft::solve {
namespace {

using solver::Gain;
using solver::LeftOut;
using solver::Patch;

// Mean albedos that are tried where the scale is relative. Those that win are refined between their
// neighbours. As they are solved they have light of the bounces in them, on deep white cloth 1.4 times its
// own; the last one only shows whether brighter cloth would do worse.
constexpr std::array<double, 10> kAlbedos = {0, 0.125, 0.18, 0.25, 0.35, 0.5, 0.7, 1, 1.4, 2};
// A robust solve leaves readings out, so noise makes it err by more than all lights would: by up to this,
// squared, on matt twills.
constexpr double kNoiseMargin = 1.1;
// What a small frame has too few patches of, it has rows of: so many are wanted.
constexpr std::size_t kWantedPatches = 256;
constexpr int kMostRowsOfCell = 32;

// The patches that choose, with more rows of their cells where they are few.
std::vector<Patch> patches_to_choose_by(Size size) {
  const std::vector<Patch> few = solver::patches_of(size, solver::PatchUse::kChoose);
  std::vector<Patch> patches;
  const int copies =
      std::clamp(static_cast<int>(kWantedPatches / std::max<std::size_t>(few.size(), 1)), 1, kMostRowsOfCell);
  for (const Patch& patch : few) {
    const int cell = patch.pixels.y0 / kRowGroup * kRowGroup;
    for (int i = 0; i < copies; ++i) {
      Patch copy = patch;
      copy.pixels.y0 = cell + (patch.pixels.y0 - cell + i * kRowGroup / copies) % kRowGroup;
      copy.pixels.y1 = copy.pixels.y0 + 1;
      if (copy.pixels.y1 <= size.height) patches.push_back(copy);
    }
  }
  return patches;
}

void append(LeftOut& all, const LeftOut& more) {
  all.grid = more.grid;
  all.lights = more.lights;
  all.patches.insert(all.patches.end(), more.patches.begin(), more.patches.end());
  all.scale.insert(all.scale.end(), more.scale.begin(), more.scale.end());
  all.reading.insert(all.reading.end(), more.reading.begin(), more.reading.end());
  all.error.insert(all.error.end(), more.error.begin(), more.error.end());
  all.noise.insert(all.noise.end(), more.noise.begin(), more.noise.end());
  all.turned_deg.insert(all.turned_deg.end(), more.turned_deg.begin(), more.turned_deg.end());
}

// `with` as errors of equal brightness. Noise stays what it was, and of errors no larger than the subtracted
// light it may well have been the cause.
LeftOut as_bright_as(const LeftOut& without, LeftOut with) {
  std::vector<double> shares;
  for (std::size_t pixel = 0; pixel < with.scale.size(); ++pixel) {
    if (without.scale[pixel] > 0 && with.scale[pixel] > 0)
      shares.push_back(1 -
                       static_cast<double>(with.scale[pixel]) / static_cast<double>(without.scale[pixel]));
  }
  const double share = median(std::move(shares));
  const solver::LeftOutError error = solver::error_of_all(without);
  const double noise = std::isfinite(error.noise_median) ? kNoiseMargin * std::pow(error.noise_median, 2) : 0;
  const double other = 1 - (noise + share * share) / std::pow(error.median, 2);
  if (!(other > 0)) return with;
  for (std::size_t pixel = 0; pixel < with.scale.size(); ++pixel) {
    if (!(with.scale[pixel] > 0)) continue;
    const double darker = static_cast<double>(without.scale[pixel]) / static_cast<double>(with.scale[pixel]);
    const auto factor = static_cast<float>(std::sqrt(1 - other + other * darker * darker));
    for (std::size_t k = 0; k < with.lights; ++k) with.error[pixel * with.lights + k] *= factor;
  }
  return with;
}

double mean_albedo(const SolvedFrame& solved, const std::vector<Patch>& patches) {
  double sum = 0, count = 0;
  for (const Patch& patch : patches) {
    for (int p = 0; p < solved.albedo.planes(); ++p) {
      for (int x = patch.pixels.x0; x < patch.pixels.x1; ++x) {
        sum += static_cast<double>(solved.albedo(x, patch.pixels.y0, p));
        ++count;
      }
    }
  }
  return count > 0 ? sum / count : 0;
}

// Where the parabola through three points has its vertex.
double vertex_of(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  const double left = (y[1] - y[0]) / (x[1] - x[0]), right = (y[2] - y[1]) / (x[2] - x[1]);
  const double bend = (right - left) / (x[2] - x[0]);
  return bend < 0 ? (x[0] + x[1]) / 2 - left / (2 * bend) : x[1];
}

// What left-out light says of the variants that were tried: with and without shadows, by albedo scale.
class Trial {
 public:
  Trial(const Photographs& photographs, const solver::Method& method, LightCorrection& correction,
        const LightStages& traced, std::vector<double> scales)
      : photographs_(photographs),
        method_(method),
        correction_(correction),
        traced_(traced),
        scales_(std::move(scales)),
        left_out_{std::vector<LeftOut>(scales_.size()), std::vector<LeftOut>(scales_.size())} {}

  // Leaves lights out of patches inside one slab of the correction.
  Result<void> judge(const std::vector<Patch>& patches, const JobContext& context) {
    for (const bool shadows : {false, true}) {
      if (shadows && !traced_.shadows) continue;
      for (std::size_t i = 0; i < scales_.size(); ++i) {
        correction_.apply_only({shadows, scales_[i] > 0, scales_[i]});
        const Result<LeftOut> judged = leave_out_lights(
            photographs_, {.method = &method_, .correction = &correction_}, patches, context);
        if (!judged) return judged.error();
        append(left_out_[shadows][i], *judged);
      }
    }
    return {};
  }

  // The scale that predicts best, among all but the first, which is none.
  std::size_t best_scale() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < scales_.size(); ++i) {
      if (gain(traced_.shadows, i) > gain(traced_.shadows, best)) best = i;
    }
    return best;
  }
  // Whether the last scale does worse than the best by more than its sigma.
  bool bounds(std::size_t best) const {
    const std::vector<LeftOut>& tried = left_out_[traced_.shadows];
    const Gain brighter = gain_of_correction(tried[best], tried.back());
    return brighter.mean < -brighter.sigma;
  }
  // Between the neighbours of the best.
  double refined(std::size_t best) const {
    if (best == 0 || best + 1 == scales_.size()) return scales_[best];
    const bool s = traced_.shadows;
    return vertex_of({scales_[best - 1], scales_[best], scales_[best + 1]},
                     {gain(s, best - 1), gain(s, best), gain(s, best + 1)});
  }

  // Both effects, each alone or none, with this scale.
  LightChoice choose(std::size_t scale) const {
    const auto tried = [&](bool shadows, bool bounces) -> const LeftOut& {
      return left_out_[shadows][bounces ? scale : 0];
    };
    LightChoice choice;
    const bool both = traced_.shadows && scale > 0;
    if (both) {
      choice.shadows = gain_of_correction(tried(false, true), tried(true, true));
      choice.interreflection = gain_of_correction(tried(true, false), tried(true, true));
      if (choice.shadows.keeps() && choice.interreflection.keeps() &&
          gain_of_correction(tried(false, false), tried(true, true)).keeps()) {
        choice.stages = {true, true};
        return choice;
      }
    }
    if (traced_.shadows) choice.shadows = gain_of_correction(tried(false, false), tried(true, false));
    if (scale > 0) choice.interreflection = gain_of_correction(tried(false, false), tried(false, true));
    const bool bounces = choice.interreflection.keeps();
    choice.stages.shadows =
        choice.shadows.keeps() && !(bounces && choice.interreflection.mean > choice.shadows.mean);
    choice.stages.interreflection = bounces && !choice.stages.shadows;
    return choice;
  }

 private:
  double gain(bool shadows, std::size_t scale) const {
    if (scale == 0) return 0;
    return gain_of_correction(left_out_[shadows][0], left_out_[shadows][scale]).mean;
  }

  const Photographs& photographs_;
  const solver::Method& method_;
  LightCorrection& correction_;
  LightStages traced_;
  std::vector<double> scales_;                    // the first is 0: no bounce
  std::array<std::vector<LeftOut>, 2> left_out_;  // [shadows][scale]
};

}  // namespace

Gain gain_of_correction(const LeftOut& without, const LeftOut& with) {
  return solver::compare(without, as_bright_as(without, with)).frame;
}

Result<LightChoice> choose_light(const Photographs& photographs, const solver::Method& method,
                                 const SolvedFrame& solved, LightCorrection& correction,
                                 const LightStages& traced, const JobContext& context) {
  const std::vector<Patch> patches = patches_to_choose_by(photographs.size);
  const bool is_relative = photographs.albedo_scale == AlbedoScale::kRelative;
  const double albedo = mean_albedo(solved, patches);
  std::vector<double> scales = {0};
  if (traced.interreflection && !is_relative) scales.push_back(1);
  if (traced.interreflection && is_relative && albedo > 0) {
    for (std::size_t i = 1; i < kAlbedos.size(); ++i) scales.push_back(kAlbedos[i] / albedo);
  }
  Trial trial(photographs, method, correction, traced, scales);
  for (const std::vector<Patch>& row : patches_of_few_rows(patches, photographs.size)) {
    if (Result<void> judged = trial.judge(row, context); !judged) return std::move(judged).error();
  }

  if (!is_relative || scales.size() == 1) return trial.choose(scales.size() - 1);
  const std::size_t best = trial.best_scale();
  const bool is_open = best > 0 && !trial.bounds(best);
  LightChoice choice = trial.choose(is_open ? 0 : best);
  choice.scale_is_open = is_open;
  choice.stages.albedo_scale = trial.refined(best);
  return choice;
}

std::size_t light_choice_patches(Size size) {
  return of_few_rows(patches_to_choose_by(size), size).size();
}

}  // namespace weft::solve
