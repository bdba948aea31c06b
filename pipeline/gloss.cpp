// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gloss.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "pipeline/left_out.h"
#include "pipeline/light_correction.h"
#include "solver/reflectance/glossy_method.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::pipeline {
namespace {

// What the calibration does not know of the lights, as the centre of the frame sees them.
Result<void> add_calibration(const Photographs& photographs, std::vector<solver::MeasuredLobe>& lobes) {
  if (!photographs.light_covariance) return {};
  const Result<solver::CalibrationSigmas> sigmas =
      solver::CalibrationSigmas::make(*photographs.field, photographs.size, photographs.leds,
                                      *photographs.light_covariance, photographs.noise());
  if (!sigmas) return sigmas.error();
  const std::vector<double> covariance =
      sigmas->light_errors_at(photographs.size.width / 2, photographs.size.height / 2);
  for (solver::MeasuredLobe& lobe : lobes) {
    if (lobe.is_measured()) solver::add_light_errors(covariance, lobe);
  }
  return {};
}

std::vector<solver::KnownLobe> lobes_of(const GlossFacts& facts) {
  std::vector<solver::KnownLobe> lobes;
  for (const solver::MeasuredLobe& measured : facts.lobes)
    lobes.push_back({measured.lobe, solver::one_sigma_off(measured.lobe, measured.covariance)});
  return lobes;
}

}  // namespace

solver::Sight sight_of(const Photographs& photographs) {
  std::optional<Vec3> centre;
  if (photographs.camera) centre = centre_of(*photographs.camera);
  return solver::Sight(centre, photographs.field->cloth_height_mm());
}

Result<std::vector<solver::MeasuredLobe>> measure_gloss(const Photographs& photographs,
                                                        const solver::Method& base,
                                                        LightCorrection* correction, int threads) {
  Result<GlossSamples> sampled = sample_gloss(photographs, base, correction, threads);
  if (!sampled) return std::move(sampled).error();
  std::vector<GlossSamples> poses = {std::move(*sampled)};
  if (photographs.second_pose) poses.push_back(by_leds(*photographs.second_pose, photographs.leds));
  solver::LobeSamples samples(photographs.count(), poses.front().states);
  std::vector<Vec3> start;
  for (std::size_t i = 0; i < kGlossPixels; ++i) {
    for (const GlossSamples& pose : poses) {
      if (i >= pose.pixels()) continue;
      samples.add(pose.of(i));
      start.push_back(pose.start[i]);
    }
  }
  std::vector<solver::MeasuredLobe> lobes = solver::measure_materials(samples, start, threads);
  if (Result<void> ok = add_calibration(photographs, lobes); !ok) return std::move(ok).error();
  solver::MeasuredLobe& lobe = lobes.front();
  if (lobes.size() == 1 && lobe.is_measured() && poses.size() == 1)
    lobe.parts = solver::measure_parts(samples, lobe.fit, poses.front().part, lobe.sigma_alpha, threads);
  return lobes;
}

Result<Gloss> Gloss::find(const Photographs& photographs, const solver::Method& base,
                          LightCorrection* correction, const JobContext& context) {
  Gloss gloss(sight_of(photographs));
  Stopwatch watch;
  Result<std::vector<solver::MeasuredLobe>> lobes =
      measure_gloss(photographs, base, correction, context.threads);
  if (!lobes) return std::move(lobes).error();
  gloss.facts.seconds = watch.lap();
  gloss.facts.lobes = std::move(*lobes);
  gloss.facts.of_film_pair = photographs.parallel.has_value();
  gloss.facts.of_second_pose = photographs.second_pose.has_value();
  if (!gloss.facts.is_measured()) return gloss;
  const auto glossy = solver::glossy_method(gloss.beneath(base), lobes_of(gloss.facts), gloss.sight_);
  const auto variant = [&](const solver::Method& method) {
    return SolveVariant{.method = &method, .correction = correction, .judged_by_parallel = true};
  };
  Result<solver::BlockChoice> choice = choose_by_block(photographs, variant(base), variant(*glossy), context);
  if (!choice) return std::move(choice).error();
  gloss.facts.share = choice->share();
  if (gloss.facts.share > 0) gloss.choice_ = std::move(*choice);
  return gloss;
}

// A pixel with a lobe begins where the cheaper method leaves it: what that gets wrong the lobe explains.
const solver::Method& Gloss::beneath(const solver::Method& base) const {
  const bool all_shine =
      std::ranges::all_of(facts.lobes, [](const solver::MeasuredLobe& l) { return l.is_measured(); });
  return all_shine && !base.wants_rgb() ? *standard_ : base;
}

const solver::Method& Gloss::over(const solver::Method& base) {
  if (!choice_) return base;
  methods_.push_back(solver::glossy_method(beneath(base), lobes_of(facts), sight_));
  methods_.push_back(solver::blended_method(base, *methods_.back(), *choice_));
  return *methods_.back();
}

}  // namespace weft::pipeline
