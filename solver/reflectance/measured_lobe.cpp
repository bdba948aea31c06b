// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/measured_lobe.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"

namespace weft::solver {
namespace {

constexpr std::array<const char*, 9> kRefusals = {"measured",     "too-few-pixels", "lambert-fits",
                                                  "nothing-fits", "strength",       "too-broad",
                                                  "bent-diffuse", "too-narrow",     "uncertain"};
// Pixels of the sample that decide among starts.
constexpr std::size_t kTrialPixels = 1000;
// Where fits begin: from a polished surface to a felt, and across the yarn of an anisotropic lobe.
constexpr std::array<double, 4> kStartAlphas = {0.08, 0.2, 0.45, 0.8};
constexpr std::array<double, 2> kStartAcross = {0.2, 0.5};
// f0 of a fibre, and a yarn's alpha along it over that across.
constexpr double kStartF0 = 0.03, kStartAlong = 0.3;
// Alpha of a sharp and of a broad lobe, over that of one, and f0 of both.
constexpr std::array<std::array<double, 2>, 3> kStartTwo = {{{0.8, 2}, {0.7, 4}, {0.9, 3}}};
constexpr double kStartTwoF0 = 1.4, kStartShare = 0.4;  // f0 over that of one; share of the broad lobe
constexpr std::size_t kStartPixels = 300;               // that two lobes are first tried on
// Where GGX costs so many times what another family does two lobes of it are not what is missing.
constexpr double kFarFromGgx = 3;
// Rounds of one fit; fits from where pixels found other valleys; rounds of a fit and the yarns' sides.
constexpr int kRounds = 15, kMostRestarts = 4, kYarnRounds = 3;
constexpr double kMovedShare = 0.002;  // pixels that still find another valley
constexpr double kMovedCost = 0.5;     // what a pixel must win to count as moved
constexpr double kUndecided = 0.05;    // of the cost
constexpr int kStartSteps = 5;         // of a pixel, from another start

bool has_yarn(const Lobe& lobe) {
  return lobe.family == LobeFamily::kAnisotropicGgx;
}

// Keeps the solution of each pixel that costs less.
void keep_cheaper(const LobeFit& other, LobeFit& fit) {
  for (std::size_t i = 0; i < fit.b.size(); ++i) {
    if (!(other.cost[i] < fit.cost[i])) continue;
    fit.b[i] = other.b[i];
    fit.yarn[i] = other.yarn[i];
    fit.cost[i] = other.cost[i];
  }
}

// The families in turn over some pixels of one material.
class Trial {
 public:
  Trial(const LobeSamples& samples, std::vector<Vec3> start, const std::array<double, 3>& tint, int threads)
      : samples_(samples), start_(std::move(start)), tint_(tint), threads_(threads) {}

  LobeFit lambert() const { return fit_lobe(samples_, unfitted({}), {.threads = threads_}); }

  LobeFit isotropic(LobeFamily family) const {
    const LobeParameters fitted = parameters_of(family);
    std::optional<LobeFit> best;
    for (const double alpha : kStartAlphas) {
      LobeFit fit =
          fit_lobe(samples_, unfitted({.family = family, .alpha = alpha, .f0 = kStartF0}), options(fitted));
      if (!best || fit.total() < best->total()) best = std::move(fit);
    }
    return restarted(std::move(*best), fitted);
  }

  LobeFit anisotropic() const {
    std::optional<LobeFit> best;
    for (const double alpha : kStartAcross) {
      for (const double axis : {0.0, kPi / 4}) {
        LobeFit fit = with_yarns(unfitted({.family = LobeFamily::kAnisotropicGgx,
                                           .alpha = alpha,
                                           .f0 = kStartF0,
                                           .along = kStartAlong,
                                           .axis = axis}));
        if (!best || fit.total() < best->total()) best = std::move(fit);
      }
    }
    return restarted(std::move(*best), parameters_of(LobeFamily::kAnisotropicGgx));
  }

  // Two lobes, from where the best one leaves the pixels; `first` pixels decide among starts.
  LobeFit two(const Lobe& one, const LobeSamples& first) const {
    LobeFit settled = fit_lobe(samples_, unfitted(one, start_), {.rounds = 0, .threads = threads_});
    try_other_starts(samples_, threads_, settled);
    const LobeParameters fitted = parameters_of(LobeFamily::kTwoGgx);
    const std::vector<Vec3> first_b(settled.b.begin(),
                                    settled.b.begin() + static_cast<std::ptrdiff_t>(first.pixels()));
    std::optional<LobeFit> best;
    for (const auto& [sharper, broader] : kStartTwo) {
      const Lobe start = {.family = LobeFamily::kTwoGgx,
                          .alpha = std::max(sharper * one.alpha, 0.02),
                          .f0 = kStartTwoF0 * one.f0,
                          .broad = std::min(broader * one.alpha, 1.0),
                          .broad_share = kStartShare};
      LobeFit fit = fit_lobe(first, unfitted(start, first_b), options(fitted, kCoarselySettled));
      if (!best || fit.total() < best->total()) best = std::move(fit);
    }
    return canonical(restarted(fit_lobe(samples_, unfitted(best->lobe, settled.b), options(fitted)), fitted));
  }

  // The same family with a diffuse part that may bend.
  LobeFit bent(const LobeFit& straight) const {
    const LobeParameters fitted = parameters_of(straight.lobe, true);
    return restarted(fit_lobe(samples_, straight, options(fitted)), fitted);
  }

  // A lobe that was found on other pixels of the material, from where they begin.
  LobeFit refined(const Lobe& lobe) const {
    const LobeParameters fitted = parameters_of(lobe, lobe.bend != 0);
    LobeFit fit = unfitted(lobe);
    if (has_yarn(lobe)) fit = with_better_yarns(samples_, std::move(fit), threads_);
    return canonical(restarted(fit_lobe(samples_, std::move(fit), options(fitted)), fitted));
  }

 private:
  LobeFitOptions options(LobeParameters fitted, double settled = LobeFitOptions().settled) const {
    return {.fitted = fitted, .rounds = kRounds, .settled = settled, .threads = threads_};
  }

  // Each pixel's yarn is the one of the two that costs it less.
  LobeFit with_yarns(LobeFit fit) const {
    for (int round = 0; round < kYarnRounds; ++round) {
      fit = with_better_yarns(samples_, std::move(fit), threads_);
      fit = fit_lobe(samples_, std::move(fit),
                     options(parameters_of(LobeFamily::kAnisotropicGgx), kCoarselySettled));
    }
    return fit;
  }
  // Every pixel from other normals too, the shared values anew, until hardly one finds a better valley.
  LobeFit restarted(LobeFit fit, LobeParameters fitted) const {
    for (int round = 0; round < kMostRestarts; ++round) {
      const std::vector<double> before = fit.cost;
      try_other_starts(samples_, threads_, fit);
      std::size_t moved = 0;
      for (std::size_t i = 0; i < before.size(); ++i) {
        if (fit.cost[i] < before[i] - kMovedCost) ++moved;
      }
      fit = fit_lobe(samples_, std::move(fit), options(fitted));
      if (static_cast<double>(moved) < kMovedShare * static_cast<double>(before.size())) break;
    }
    return fit;
  }

  // The same lobe, rougher across than along and its axis within 90 degrees around x; of two the sharp one
  // first.
  static LobeFit canonical(LobeFit fit) {
    Lobe& lobe = fit.lobe;
    if (lobe.family == LobeFamily::kTwoGgx && lobe.alpha > lobe.broad) {
      std::swap(lobe.alpha, lobe.broad);
      lobe.broad_share = 1 - lobe.broad_share;
    }
    if (lobe.along > 1) {
      lobe.alpha *= lobe.along;
      lobe.along = 1 / lobe.along;
      for (double& yarn : fit.yarn) yarn = kPi / 2 - yarn;
    }
    const double turned = std::remainder(lobe.axis, kPi);
    lobe.axis = std::remainder(turned, kPi / 2);
    if (std::abs(turned - lobe.axis) > kPi / 4) {
      for (double& yarn : fit.yarn) yarn = kPi / 2 - yarn;
    }
    return fit;
  }

  LobeFit unfitted(const Lobe& lobe) const { return unfitted(lobe, start_); }
  LobeFit unfitted(Lobe lobe, const std::vector<Vec3>& start) const {
    lobe.tint = tint_;
    return {lobe, start, std::vector<double>(start.size(), 0.0), {}, 0};
  }

  const LobeSamples& samples_;
  std::vector<Vec3> start_;
  std::array<double, 3> tint_;
  int threads_;
};

bool agrees(const Lobe& a, const Lobe& b) {
  return std::abs(a.alpha - b.alpha) <= kAlphaAgrees && std::abs(a.f0 - b.f0) <= kF0Agrees * a.f0;
}

double median_albedo_of(const LobeFit& fit) {
  std::vector<double> albedos;
  for (const Vec3& b : fit.b) albedos.push_back(length(b));
  return median(std::move(albedos));
}

LobeRefusal refusal_of(const LobeFit& fit, double lambert_chi2, AlbedoScale scale) {
  if (fit.chi2 > kLobeFitsTo && fit.chi2 > kLeastWon * lambert_chi2) return LobeRefusal::kNothingFits;
  if (!has_strength_of_cloth(fit.lobe.f0, median_albedo_of(fit), scale)) return LobeRefusal::kStrength;
  if (!(fit.lobe.alpha < kMostAlpha)) return LobeRefusal::kTooBroad;
  if (!(fit.lobe.alpha * std::min(fit.lobe.along, 1.0) > kLeastAlpha)) return LobeRefusal::kTooNarrow;
  return LobeRefusal::kNone;
}

// Whether a yarn's lobe is GGX under another name.
bool is_round(const Lobe& lobe) {
  return lobe.family == LobeFamily::kAnisotropicGgx && lobe.along > kMostAlong && lobe.along < 1 / kMostAlong;
}

std::size_t pixels_with_enough(const LobeSamples& samples) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.pixels(); ++i)
    count += used_of(samples.of(i)) >= kLeastLobeReadings ? 1U : 0U;
  return count;
}

double sigma_of(const LobeCovariance& covariance, LobeParameter parameter) {
  const auto i = static_cast<std::size_t>(parameter);
  return std::sqrt(std::max(covariance[i][i], 0.0));
}

void set_covariance(const LobeCovariance& covariance, MeasuredLobe& measured) {
  measured.covariance = covariance;
  measured.sigma_alpha = sigma_of(covariance, LobeParameter::kLogAlpha);
  measured.sigma_f0 = sigma_of(covariance, LobeParameter::kF0);
  const bool has_two = measured.lobe.family == LobeFamily::kTwoGgx;
  (has_two ? measured.sigma_broad : measured.sigma_along) = sigma_of(covariance, LobeParameter::kLogAlong);
  (has_two ? measured.sigma_share : measured.sigma_axis) = sigma_of(covariance, LobeParameter::kAxis);
}

// `rivals`: the same family with or without the bend, whichever was not taken, and other families that
// explain the readings as well. Half of what they differ by is the least sigma; correlations are the fit's.
void write_sigmas(LobeCovariance covariance, const std::vector<Lobe>& rivals, MeasuredLobe& measured) {
  const Lobe& lobe = measured.lobe;
  const auto widen = [&](LobeParameter parameter, double least) {
    const double formal = sigma_of(covariance, parameter);
    if (!(least > formal)) return;
    const auto i = static_cast<std::size_t>(parameter);
    for (std::size_t q = 0; q < kLobeParameters; ++q) {
      covariance[i][q] *= formal > 0 ? least / formal : 0;
      covariance[q][i] = covariance[i][q];
    }
    covariance[i][i] = least * least;
  };
  for (const Lobe& rival : rivals) {
    widen(LobeParameter::kLogAlpha, std::abs(std::log(lobe.alpha / rival.alpha)) / 2);
    widen(LobeParameter::kF0, std::abs(lobe.f0 - rival.f0) / 2);
    widen(LobeParameter::kLogAlong, std::abs(std::log(lobe.along / rival.along)) / 2);
    if (lobe.family != LobeFamily::kTwoGgx) continue;
    widen(LobeParameter::kLogBroad, std::abs(std::log(lobe.broad / rival.broad)) / 2);
    widen(LobeParameter::kBroadShare, std::abs(lobe.broad_share - rival.broad_share) / 2);
  }
  set_covariance(covariance, measured);
  const double product = measured.sigma_alpha * measured.sigma_f0;
  measured.correlation = product > 0 ? std::clamp(covariance[0][1] / product, -1.0, 1.0) : 0;
}

// A LED is hardly ever as bright as it was when it was calibrated.
void add_drift(MeasuredLobe& measured) {
  const std::size_t errors = measured.by_lights.errors();
  std::vector<double> covariance(errors * errors, 0.0);
  for (std::size_t i = 0; i < errors; i += LobeByLights::kErrors)
    covariance[i * errors + i] = kLightDrift * kLightDrift;
  add_light_errors(covariance, measured);
}

// Every so many-th reading that the lobe explains most of.
std::vector<LobePoint> points_of(const LobeSamples& samples, const LobeFit& fit) {
  std::vector<LobePoint> points;
  for (std::size_t i = 0; i < samples.pixels(); ++i) {
    const Vec3 n = normalized(fit.b[i]);
    for (const LobeReading& r : samples.of(i)) {
      const double cosine = dot(n, r.from.light);
      if (r.weight == 0 || !(cosine > 0.1)) continue;
      const double shine = cosine * specular(fit.lobe, n, r.from, fit.yarn[i]);
      const double diffuse = modelled(fit.lobe, fit.b[i], r.from, fit.yarn[i]) - shine;
      // Where the lobe is weaker than what no model knows, the reading says nothing of it.
      if (!(shine > kLobeModelShare * std::max(r.x, kLeastModelled))) continue;
      const double angle = equal_angle(fit.lobe, n, r.from.half, fit.yarn[i]);
      const double facets = relative_facets(fit.lobe, angle);
      points.push_back({degrees(angle), facets * (r.x - diffuse) / shine, facets});
    }
  }
  std::vector<LobePoint> few;
  const std::size_t count = std::min(points.size(), kMostLobePoints);
  for (std::size_t i = 0; i < count; ++i) few.push_back(points[i * points.size() / count]);
  return few;
}

std::array<double, 2> half_angles(const LobeSamples& samples, const LobeFit& fit) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < samples.pixels(); ++i) {
    for (const LobeReading& r : samples.of(i)) {
      if (r.weight > 0) angles.push_back(angle_deg(fit.b[i], r.from.half));
    }
  }
  if (angles.empty()) return {};
  return {quantile(angles, 0.02), quantile(angles, 0.98)};
}

struct Family {
  LobeFit fit;
  double wins;  // share of GGX's cost that it must save
};

// GGX first.
std::vector<Family> fitted_families(const Trial& trial, std::size_t states) {
  std::vector<Family> families = {{trial.isotropic(LobeFamily::kGgx), 0},
                                  {trial.isotropic(LobeFamily::kBeckmann), kOtherWins},
                                  {trial.anisotropic(), kYarnWins}};
  // One state of the films does not tell sheen from a diffuse part that bends. Two do: what is left of the
  // costs is all the shape of the lobe, of which sheen has as many values as GGX.
  if (states > 1) families.push_back({trial.isotropic(LobeFamily::kCloth), 0});
  return families;
}

const LobeFit& best_of(const std::vector<Family>& families) {
  const LobeFit& ggx = families.front().fit;
  const LobeFit* best = &ggx;
  for (const Family& family : families) {
    if (is_round(family.fit.lobe)) continue;
    if (family.fit.total() < (1 - family.wins) * ggx.total() && family.fit.total() < best->total())
      best = &family.fit;
  }
  return *best;
}

// The families that explain the readings nearly as well as the best one; whether there are any.
bool add_rivals(const std::vector<Family>& families, const LobeFit& best, double lambert_chi2,
                AlbedoScale scale, std::vector<Lobe>& rivals) {
  const std::size_t before = rivals.size();
  for (const Family& family : families) {
    if (&family.fit == &best || is_round(family.fit.lobe)) continue;
    if (family.fit.total() < (1 + kUndecided) * best.total() &&
        refusal_of(family.fit, lambert_chi2, scale) == LobeRefusal::kNone)
      rivals.push_back(family.fit.lobe);
  }
  return rivals.size() > before;
}

bool is_certain(const MeasuredLobe& measured) {
  return measured.sigma_alpha < kMostSigmaAlpha && measured.sigma_f0 < kMostSigmaF0 * measured.lobe.f0;
}

// Two lobes, and each of them told.
bool is_certain_of_two(const MeasuredLobe& measured) {
  const Lobe& lobe = measured.lobe;
  const double lesser = std::min(lobe.broad_share, 1 - lobe.broad_share);
  return is_certain(measured) && measured.sigma_broad < kMostSigmaAlpha &&
         measured.sigma_share < kMostSigmaShare * lesser;
}

// Least chi2 of the family that was taken; where none was, of all.
double least_chi2(const MeasuredLobe& one) {
  const LobeCandidate* least = &one.candidates.front();
  for (const LobeCandidate& each : one.candidates) {
    if (one.is_measured() && each.lobe.family != one.lobe.family) continue;
    if (each.chi2 < least->chi2) least = &each;
  }
  return least->chi2;
}

bool are_two(const Lobe& lobe) {
  return lobe.broad_share > kLeastShare && lobe.broad_share < 1 - kLeastShare &&
         lobe.broad > kLeastBroader * lobe.alpha && lobe.broad < kMostAlpha;
}

MeasuredLobe refused(LobeRefusal why, MeasuredLobe measured) {
  MeasuredLobe none;
  none.refusal = why;
  none.candidates = std::move(measured.candidates);
  return none;
}

// What is said of a lobe beside its values.
void describe(const LobeSamples& samples, const LobeParameters& fitted, MeasuredLobe& measured) {
  measured.by_lights = LobeByLights(samples, measured.fit, fitted);
  add_drift(measured);
  measured.half_deg = half_angles(samples, measured.fit);
  measured.points = points_of(samples, measured.fit);
  measured.median_albedo = median_albedo_of(measured.fit);
  const auto wefts = std::ranges::count_if(measured.fit.yarn, [](double yarn) { return yarn > 0; });
  measured.weft_share = static_cast<double>(wefts) / static_cast<double>(measured.fit.yarn.size());
}

}  // namespace

bool has_strength_of_cloth(double f0, double median_albedo, AlbedoScale scale) {
  if (scale == AlbedoScale::kAbsolute) return f0 > kLeastF0 && f0 < kMostF0;
  return f0 * kBrightestCloth > kLeastF0 * median_albedo && f0 * kDarkestCloth < kMostF0 * median_albedo;
}

const char* name_of(LobeRefusal refusal) {
  return kRefusals[static_cast<std::size_t>(refusal)];
}

std::array<Vec3, kOtherStarts> other_starts(std::span<const LobeReading> readings, double median_albedo) {
  double least = std::numeric_limits<double>::infinity();
  std::array<const LobeReading*, 3> brightest = {};
  for (const LobeReading& r : readings) {
    if (!(r.weight > 0 && r.x > 0)) continue;
    least = std::min(least, r.x / std::max(r.from.light.z, 0.1));
    const LobeReading* next = &r;
    for (const LobeReading*& kept : brightest) {
      if (next != nullptr && (kept == nullptr || next->x > kept->x)) std::swap(kept, next);
    }
  }
  if (!std::isfinite(least)) least = median_albedo;
  const double albedo = std::min(least, median_albedo);
  const Vec3 level = {0, 0, least};
  std::array<Vec3, kOtherStarts> starts = {level, {0, 0, median_albedo}, level, level, level};
  constexpr std::array<std::size_t, brightest.size()> kMirrored = {0, 3, 4};
  // The more of the brightest lights, the more they have in common with the pixel's own mirror.
  Vec3 mirror = {0, 0, 0};
  for (std::size_t i = 0; i < brightest.size() && brightest[i] != nullptr; ++i) {
    mirror = mirror + (brightest[i]->x - least * brightest[i]->from.light.z) * brightest[i]->from.half;
    if (length(mirror) > 0) starts[kMirrored[i]] = albedo * normalized(mirror);
  }
  return starts;
}

void try_other_starts(const LobeSamples& samples, int threads, LobeFit& fit) {
  const double albedo = median_albedo_of(fit);
  LobeFit other = fit;
  for (std::size_t start = 0; start < kOtherStarts; ++start) {
    for (const double yarn : {0.0, kPi / 2}) {
      if (yarn > 0 && !has_yarn(fit.lobe)) continue;
      for (std::size_t i = 0; i < other.b.size(); ++i) {
        other.b[i] = other_starts(samples.of(i), albedo)[start];
        other.yarn[i] = yarn;
      }
      samples.fit_pixels(fit.lobe, other.yarn, kStartSteps, threads, other.b, other.cost);
      keep_cheaper(other, fit);
    }
  }
}

LobeFit with_better_yarns(const LobeSamples& samples, LobeFit fit, int threads) {
  fit.cost.resize(samples.pixels());
  fit.yarn.assign(fit.yarn.size(), 0);
  LobeFit weft = fit;
  samples.fit_pixels(fit.lobe, fit.yarn, kStartSteps, threads, fit.b, fit.cost);
  if (!has_yarn(fit.lobe)) return fit;
  weft.yarn.assign(weft.yarn.size(), kPi / 2);
  samples.fit_pixels(weft.lobe, weft.yarn, kStartSteps, threads, weft.b, weft.cost);
  keep_cheaper(weft, fit);
  return fit;
}

MeasuredLobe measure_lobe(const LobeSamples& samples, const std::vector<Vec3>& start, int threads,
                          const std::array<double, 3>& tint) {
  MeasuredLobe measured;
  if (pixels_with_enough(samples) < kLeastLobePixels) return measured;
  const LobeSamples few = samples.first(kTrialPixels);
  const Trial trial(few, {start.begin(), start.begin() + static_cast<std::ptrdiff_t>(few.pixels())}, tint,
                    threads);
  const double lambert_chi2 = trial.lambert().chi2;
  measured.candidates.push_back({{}, lambert_chi2});
  measured.refusal = LobeRefusal::kLambertFits;
  if (!(lambert_chi2 > kLambertFitsTo)) return measured;

  const std::vector<Family> families = fitted_families(trial, samples.states());
  for (const Family& family : families) measured.candidates.push_back({family.fit.lobe, family.fit.chi2});
  const LobeFit& straight = best_of(families);
  const LobeFit bent = trial.bent(straight);
  measured.candidates.push_back({bent.lobe, bent.chi2});
  const bool bends = bent.total() < (1 - kBendWins) * straight.total();
  const LobeFit& best = bends ? bent : straight;
  measured.refusal = refusal_of(best, lambert_chi2, samples.scale());
  if (measured.is_measured() && !bends && !agrees(best.lobe, bent.lobe))
    measured.refusal = LobeRefusal::kBentDiffuse;
  if (!measured.is_measured()) return measured;

  std::vector<Lobe> rivals = {bends ? straight.lobe : bent.lobe};
  measured.is_family_undecided = add_rivals(families, straight, lambert_chi2, samples.scale(), rivals);
  LobeFit refined = Trial(samples, start, tint, threads).refined(best.lobe);
  // What the trial pixels told may not hold for all.
  measured.refusal = refusal_of(refined, lambert_chi2, samples.scale());
  if (!measured.is_measured()) return measured;
  measured.fit = std::move(refined);
  measured.lobe = measured.fit.lobe;
  const LobeParameters fitted = parameters_of(measured.lobe, bends);
  write_sigmas(covariance_of(samples, measured.fit, fitted, threads), rivals, measured);
  if (!is_certain(measured)) return refused(LobeRefusal::kUncertain, std::move(measured));
  describe(samples, fitted, measured);
  return measured;
}

bool is_like_metal(const MeasuredLobe& measured) {
  const auto is_strong = [](const LobeCandidate& each) { return each.lobe.f0 > kLeastF0OfMetal; };
  return measured.refusal == LobeRefusal::kNothingFits && std::ranges::any_of(measured.candidates, is_strong);
}

std::optional<MeasuredLobe> measure_two_lobes(const LobeSamples& samples, const std::vector<Vec3>& start,
                                              const MeasuredLobe& one, int threads) {
  if (one.refusal == LobeRefusal::kTooFewPixels || one.refusal == LobeRefusal::kLambertFits) return {};
  const double lambert_chi2 = one.candidates.front().chi2;
  const LobeCandidate& ggx = one.candidates[1];
  const double least = least_chi2(one);
  if (ggx.chi2 > kFarFromGgx * least) return {};
  const LobeSamples few = samples.first(kTrialPixels);
  const Trial trial(few, {start.begin(), start.begin() + static_cast<std::ptrdiff_t>(few.pixels())},
                    ggx.lobe.tint, threads);
  const LobeFit straight = trial.two(ggx.lobe, samples.first(kStartPixels));
  if (!(straight.chi2 < (1 - kTwoWin) * least)) return {};
  const LobeFit bent = trial.bent(straight);
  const bool bends = bent.total() < (1 - kBendWins) * straight.total();
  const LobeFit& best = bends ? bent : straight;
  if (refusal_of(best, lambert_chi2, samples.scale()) != LobeRefusal::kNone || !are_two(best.lobe)) return {};
  if (!bends && !agrees(best.lobe, bent.lobe)) return {};
  LobeFit refined = Trial(samples, start, ggx.lobe.tint, threads).refined(best.lobe);
  if (refusal_of(refined, lambert_chi2, samples.scale()) != LobeRefusal::kNone || !are_two(refined.lobe))
    return {};
  if (one.is_measured() && !(refined.total() < (1 - kTwoWin) * one.fit.total())) return {};
  MeasuredLobe measured;
  measured.refusal = LobeRefusal::kNone;
  measured.candidates = one.candidates;
  measured.candidates.push_back({straight.lobe, straight.chi2});
  measured.candidates.push_back({bent.lobe, bent.chi2});
  measured.lobe = refined.lobe;
  measured.fit = std::move(refined);
  const LobeParameters fitted = parameters_of(measured.lobe, bends);
  write_sigmas(covariance_of(samples, measured.fit, fitted, threads), {bends ? straight.lobe : bent.lobe},
               measured);
  if (!is_certain_of_two(measured)) return {};
  describe(samples, fitted, measured);
  return measured;
}

void add_light_errors(std::span<const double> covariance, MeasuredLobe& measured) {
  LobeCovariance all = measured.by_lights.covariance_of(covariance);
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    for (std::size_t q = 0; q < kLobeParameters; ++q) all[p][q] += measured.covariance[p][q];
  }
  set_covariance(all, measured);
}

}  // namespace weft::solver
