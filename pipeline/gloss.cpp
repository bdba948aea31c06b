// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gloss.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/color_transform.h"
#include "pipeline/left_out.h"
#include "pipeline/light_correction.h"
#include "solver/reflectance/glossy_method.h"
#include "solver/reflectance/lobe_tint.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::pipeline {
namespace {

// What the calibration does not know of the lights, as the centre of the frame sees them; empty where it does
// not say.
Result<std::vector<double>> light_errors_of(const Photographs& photographs) {
  if (!photographs.light_covariance) return std::vector<double>();
  const Result<solver::CalibrationSigmas> sigmas =
      solver::CalibrationSigmas::make(*photographs.field, photographs.size, photographs.leds,
                                      *photographs.light_covariance, photographs.noise());
  if (!sigmas) return sigmas.error();
  return sigmas->light_errors_at(photographs.size.width / 2, photographs.size.height / 2);
}

// The readings of each channel, of the pixels of all poses in the order of LobeSamples.
class ByChannel {
 public:
  ByChannel(std::size_t lights, std::size_t states) : samples(lights, states) {}

  void add(const GlossSamples& pose, std::size_t pixel) {
    if (pose.planes.front().empty()) samples.add(count_, pose.of(pixel));
    for (std::size_t p = 0; p < pose.planes.size() && !pose.planes[p].empty(); ++p)
      samples.add(count_, pose.of_plane(p, pixel));
    ++count_;
  }

  solver::ChannelSamples samples;

 private:
  std::size_t count_ = 0;
};

// Albedo is turned into Rec.709 when it is written, and so is f0.
std::optional<F0OfChannels> f0_of_channels(const solver::MeasuredLobe& lobe, const Photographs& photographs) {
  if (!lobe.tint) return {};
  F0OfChannels f0 = {lobe.tint->f0, lobe.tint->sigma};
  if (!photographs.color) return f0;
  f0.f0 = rec709_of_camera(*photographs.color, lobe.tint->f0);
  std::array<double, 3> variance = {};
  for (std::size_t k = 0; k < 3; ++k) {
    Rgb off = lobe.tint->f0;
    off[k] += lobe.tint->sigma[k];
    const Rgb moved = rec709_of_camera(*photographs.color, off);
    for (std::size_t c = 0; c < 3; ++c) variance[c] += (moved[c] - f0.f0[c]) * (moved[c] - f0.f0[c]);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    f0.sigma[c] = std::sqrt(variance[c]);
    f0.f0[c] = std::clamp(f0.f0[c], 0.0, 1.0);
  }
  return f0;
}

std::vector<solver::KnownLobe> lobes_of(const GlossFacts& facts) {
  std::vector<solver::KnownLobe> lobes;
  for (const solver::MeasuredLobe& measured : facts.lobes) {
    lobes.push_back(
        {measured.lobe, solver::one_sigma_off(measured.lobe, measured.covariance), measured.lobe});
    for (std::size_t c = 0; measured.tint && c < 3; ++c)
      lobes.back().tint_off.tint[c] += measured.tint->sigma_of_tint[c];
  }
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
  ByChannel channels(photographs.count(), poses.front().states);
  std::vector<Vec3> start;
  for (std::size_t i = 0; i < kGlossPixels; ++i) {
    for (const GlossSamples& pose : poses) {
      if (i >= pose.pixels()) continue;
      samples.add(pose.of(i));
      channels.add(pose, i);
      start.push_back(pose.start[i]);
    }
  }
  std::vector<solver::MeasuredLobe> lobes = solver::measure_materials(samples, start, threads);
  const Result<std::vector<double>> light_errors = light_errors_of(photographs);
  if (!light_errors) return light_errors.error();
  solver::find_tints(
      samples, start, channels.samples,
      {.weights = photographs.plane_weights, .light_errors = *light_errors, .threads = threads}, lobes);
  for (solver::MeasuredLobe& each : lobes) {
    if (each.is_measured() && !light_errors->empty()) solver::add_light_errors(*light_errors, each);
  }
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
  for (const solver::MeasuredLobe& lobe : gloss.facts.lobes)
    gloss.facts.f0_of_channels.push_back(f0_of_channels(lobe, photographs));
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
