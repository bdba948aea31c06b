// SPDX-License-Identifier: Apache-2.0
#include "solve/gloss/gloss.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/statistics.h"
#include "core/rig/color_transform.h"
#include "solve/correction/leave_out_lights.h"
#include "solve/correction/light_correction.h"
#include "solve/gloss/sample_gloss.h"
#include "solve/photographs/diagnosis_pixels.h"
#include "solver/diagnosis/highlights.h"
#include "solver/reflectance/glossy_method.h"
#include "solver/reflectance/lobe_tint.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::solve {
namespace {

// Where no scale is known a lobe is first sought as if the median albedo were this.
constexpr double kUsualAlbedo = 0.18;
// F0 by the refractive indices of fibres, 1.5.
constexpr double kFibreF0 = 0.04;
constexpr double kRounding = 1e-9;

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

// A reading over `unit`, with the weight that it then has. What is left of its variance without the model's
// share is noise, or rounding.
solver::LobeReading in_unit(solver::LobeReading reading, double unit) {
  const auto modelled = [](double x) {
    return std::pow(solver::kLobeModelShare * std::max(x, solver::kLeastModelled), 2);
  };
  const double of_model = modelled(reading.x), x = reading.x / unit;
  if (reading.weight > 0) {
    const double noise = 1 / reading.weight - of_model;
    reading.weight = 1 / (modelled(x) + (noise > kRounding * of_model ? noise / (unit * unit) : 0));
  }
  reading.x = x;
  return reading;
}

GlossSamples in_unit(GlossSamples samples, double unit) {
  if (unit == 1) return samples;
  for (auto* readings : {&samples.readings, &samples.planes[0], &samples.planes[1], &samples.planes[2]}) {
    for (solver::LobeReading& each : *readings) each = in_unit(each, unit);
  }
  for (Vec3& b : samples.start) b = (1 / unit) * b;
  return samples;
}

// Pixels of one or two poses.
struct Sought {
  solver::LobeSamples samples;
  ByChannel channels;
  std::vector<Vec3> start;
};

Sought pixels_of(const std::vector<GlossSamples>& poses, const Photographs& photographs, double unit) {
  const std::size_t states = poses.front().states;
  Sought all = {solver::LobeSamples(photographs.count(), states, photographs.albedo_scale),
                ByChannel(photographs.count(), states),
                {}};
  std::vector<GlossSamples> scaled;
  for (const GlossSamples& pose : poses) scaled.push_back(in_unit(pose, unit));
  for (std::size_t i = 0; i < kGlossPixels; ++i) {
    for (const GlossSamples& pose : scaled) {
      if (i >= pose.pixels()) continue;
      all.samples.add(pose.of(i));
      all.channels.add(pose, i);
      all.start.push_back(pose.start[i]);
    }
  }
  return all;
}

// In which the median albedo is that of a cloth.
double unit_of_cloth(const GlossSamples& pose) {
  std::vector<double> albedos;
  for (const Vec3& b : pose.start) albedos.push_back(length(b));
  const double albedo = median(std::move(albedos));  // NaN of no pixels
  return albedo > 0 ? albedo / kUsualAlbedo : 1;
}

// In which this lobe has the f0 of a fibre, as far as the albedo stays that of a cloth.
double unit_of_fibre(const solver::MeasuredLobe& lobe) {
  return std::max(lobe.lobe.f0 / kFibreF0, lobe.median_albedo / solver::kBrightestCloth);
}

double misfit_of(const solver::MeasuredLobe& measured) {
  if (measured.is_measured()) return measured.fit.chi2;
  const auto& tried = measured.candidates;
  return tried.empty() ? 1 : std::ranges::min_element(tried, {}, &solver::LobeCandidate::chi2)->chi2;
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
  // Under distant lights no pixel of the cloth has a place.
  if (photographs.camera && std::holds_alternative<NearLights>(photographs.field->lights()))
    centre = centre_of(*photographs.camera);
  return solver::Sight(centre, photographs.field->cloth_height_mm());
}

Result<MeasuredGloss> measure_gloss(const Photographs& photographs, const solver::Method& base,
                                    LightCorrection* correction, int threads) {
  Result<GlossSamples> sampled = sample_gloss(photographs, base, correction, threads);
  if (!sampled) return std::move(sampled).error();
  std::vector<GlossSamples> poses = {std::move(*sampled)};
  if (photographs.second_pose) poses.push_back(by_leds(*photographs.second_pose, photographs.leds));
  const bool is_relative = photographs.albedo_scale == AlbedoScale::kRelative;
  MeasuredGloss gloss;
  if (is_relative) gloss.unit = unit_of_cloth(poses.front());
  Sought sought = pixels_of(poses, photographs, gloss.unit);
  std::vector<solver::MeasuredLobe>& lobes = gloss.lobes;
  lobes = solver::measure_materials(sought.samples, sought.start, threads);
  if (is_relative && lobes.front().is_measured()) {
    gloss.unit *= unit_of_fibre(lobes.front());
    sought = pixels_of(poses, photographs, gloss.unit);
    lobes = solver::measure_materials(sought.samples, sought.start, threads);
  }
  const Result<std::vector<double>> light_errors = light_errors_of(photographs);
  if (!light_errors) return light_errors.error();
  solver::find_tints(
      sought.samples, sought.start, sought.channels.samples,
      {.weights = photographs.plane_weights, .light_errors = *light_errors, .threads = threads}, lobes);
  for (solver::MeasuredLobe& each : lobes) {
    if (each.is_measured() && !light_errors->empty()) solver::add_light_errors(*light_errors, each);
  }
  solver::MeasuredLobe& lobe = lobes.front();
  if (lobes.size() == 1 && lobe.is_measured() && poses.size() == 1)
    lobe.parts =
        solver::measure_parts(sought.samples, lobe.fit, poses.front().part, lobe.sigma_alpha, threads);
  return gloss;
}

Result<Gloss> Gloss::find(const Photographs& photographs, const solver::Method& base,
                          LightCorrection* correction, const JobContext& context) {
  Gloss gloss(sight_of(photographs));
  Stopwatch watch;
  Result<MeasuredGloss> measured = measure_gloss(photographs, base, correction, context.threads);
  if (!measured) return std::move(measured).error();
  gloss.facts.seconds = watch.lap();
  gloss.facts.lobes = std::move(measured->lobes);
  gloss.facts.unit = measured->unit;
  for (const solver::MeasuredLobe& lobe : gloss.facts.lobes)
    gloss.facts.misfit = std::max(gloss.facts.misfit, misfit_of(lobe));
  for (const solver::MeasuredLobe& lobe : gloss.facts.lobes)
    gloss.facts.f0_of_channels.push_back(f0_of_channels(lobe, photographs));
  gloss.facts.of_film_pair = photographs.parallel.has_value();
  gloss.facts.of_second_pose = photographs.second_pose.has_value();
  if (gloss.facts.lobes.size() == 1 && is_like_metal(gloss.facts.lobes.front()))
    gloss.facts.metal_share = solver::outshining_share(read_evidence(photographs));
  if (!gloss.facts.is_measured()) return gloss;
  const auto glossy =
      solver::glossy_method(gloss.beneath(base), lobes_of(gloss.facts), gloss.sight_, gloss.facts.unit);
  const auto variant = [&](const solver::Method& method) {
    return SolveVariant{.method = &method, .correction = correction, .judged_by_parallel = true};
  };
  Result<solver::BlockChoice> choice = choose_by_block(photographs, variant(base), variant(*glossy), context);
  if (!choice) return std::move(choice).error();
  if (!(choice->share() > 0)) return gloss;
  const CurlWitness curl = ask_curl(photographs, base, *glossy, *choice, context.threads);
  if (curl.objects()) {
    gloss.facts.against = curl;
    for (solver::MeasuredLobe& lobe : gloss.facts.lobes) lobe.refusal = solver::LobeRefusal::kNothingFits;
    return gloss;
  }
  gloss.facts.share = choice->share();
  gloss.choice_ = std::move(*choice);
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
  methods_.push_back(solver::glossy_method(beneath(base), lobes_of(facts), sight_, facts.unit));
  methods_.push_back(solver::blended_method(base, *methods_.back(), *choice_));
  return *methods_.back();
}

}  // namespace weft::solve
