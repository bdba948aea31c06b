// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/materials.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/statistics.h"
#include "solver/reflectance/blend.h"

namespace weft::solver {
namespace {

// Pixels of the sample that tell whether a split is worth more.
constexpr std::size_t kSplitPixels = 800, kLeastTrialPixels = 60;
// Rounds of fitting two lobes and of telling which pixel is of which.
constexpr int kMostRounds = 6;
// Share of the cost of one lobe for all: a first split that saves less leads nowhere.
constexpr double kPromising = 0.7;
const Lobe kSharp = {.family = LobeFamily::kGgx, .alpha = 0.15, .f0 = 0.05};
const Lobe kBroad = {.family = LobeFamily::kGgx, .alpha = 0.45, .f0 = 0.05};
// A pixel's status says of which of two lobes it is (GLOSSY, SECOND_LOBE), or of none.
constexpr std::ptrdiff_t kMostShining = 2;
// Pixels that may still change sides once it is settled.
constexpr double kSettledShare = 0.01;

// Where materials fade into each other at most so many pixels are left to neither: those that are worst
// explained, by a cost over their degrees of freedom from kMixedFrom on.
constexpr double kMostMixed = 0.35, kMixedFrom = 2;
// Share of these that must be blends of both.
constexpr double kLeastBlends = 0.7;

using Sides = std::vector<std::uint8_t>;  // which of the lobes, or kNeither, by pixel
constexpr std::uint8_t kNeither = 255;

// The best fit of the families that were tried; Lambert's law where it fits.
const LobeCandidate& best_of(const MeasuredLobe& measured) {
  if (measured.refusal == LobeRefusal::kLambertFits) return measured.candidates.front();
  return *std::ranges::min_element(measured.candidates, {}, &LobeCandidate::chi2);
}

double chi2_of(const MeasuredLobe& measured) {
  return measured.is_measured() ? measured.fit.chi2 : best_of(measured).chi2;
}

bool is_explained(const MeasuredLobe& measured) {
  return measured.is_measured() ? measured.fit.chi2 <= kLobeFitsTo
                                : measured.refusal == LobeRefusal::kLambertFits;
}

// Pixels where a lobe leaves them: of both yarns and of all starts the cheapest.
LobeFit settled(const LobeSamples& samples, const std::vector<Vec3>& start, const Lobe& lobe, int threads) {
  LobeFit fit =
      with_better_yarns(samples, {lobe, start, std::vector<double>(start.size(), 0.0), {}, 0}, threads);
  try_other_starts(samples, threads, fit);
  return fit;
}

Sides above_median(const std::vector<double>& values) {
  const double middle = median(values);
  Sides sides;
  for (const double value : values) sides.push_back(value > middle ? 1 : 0);
  return sides;
}

// Pixels in groups, each with a lobe.
struct Split {
  std::vector<Lobe> lobes;
  Sides sides;
  double cost = std::numeric_limits<double>::infinity();
  std::vector<double> costs = {};  // by pixel
};

class Splitter {
 public:
  Splitter(const LobeSamples& samples, const std::vector<Vec3>& start, int threads)
      : samples_(samples), start_(start), threads_(threads) {}

  LobeFit fitted(const Lobe& lobe) const { return settled(samples_, start_, lobe, threads_); }

  // Each pixel goes where it costs less.
  Split assigned(const std::vector<Lobe>& lobes) const {
    Split split = {lobes, Sides(start_.size()), 0, fitted(lobes.front()).cost};
    for (std::uint8_t side = 1; side < lobes.size(); ++side) {
      const std::vector<double> costs = fitted(lobes[side]).cost;
      for (std::size_t i = 0; i < costs.size(); ++i) {
        if (!(costs[i] < split.costs[i])) continue;
        split.sides[i] = side;
        split.costs[i] = costs[i];
      }
    }
    for (const double cost : split.costs) split.cost += cost;
    return split;
  }

  // The pixels that are worst explained are on neither side.
  void trim(Split& split) const {
    std::vector<double> misfits(split.costs.size());
    for (std::size_t i = 0; i < misfits.size(); ++i) misfits[i] = misfit(i, split.costs[i]);
    const double from = std::max(quantile(misfits, 1 - kMostMixed), kMixedFrom);
    for (std::size_t i = 0; i < misfits.size(); ++i) {
      if (misfits[i] > from) split.sides[i] = kNeither;
    }
  }

  // Whether most of the pixels on neither side are of both.
  bool are_blends(const Sides& sides, const Lobe& first, const Lobe& second) const {
    const LobeFit a = fitted(first), b = fitted(second);
    double mixed = 0, blends = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (sides[i] != kNeither) continue;
      const LobeFit& nearer = b.cost[i] < a.cost[i] ? b : a;
      const BlendFit blend = fit_blend(first, second, samples_.of(i), nearer.b[i], nearer.yarn[i]);
      mixed += 1;
      blends +=
          misfit(i, blend.fit.cost) < kMixedFrom || blend.fit.cost <= kBlendCosts * nearer.cost[i] ? 1 : 0;
    }
    return blends >= kLeastBlends * mixed;
  }

  // Lobes and sides in turn, from a first guess, until hardly a pixel changes its side. None where it is
  // promising no longer over what fewer lobes cost.
  std::optional<Split> grown(Split split, double cost_of_fewer, bool trims = false) const {
    for (int round = 0; round < kMostRounds; ++round) {
      std::vector<Lobe> lobes;
      for (std::uint8_t side = 0; side < split.lobes.size(); ++side) {
        const Group group = of(split.sides, side);
        if (group.start.size() < kLeastTrialPixels) return std::nullopt;
        lobes.push_back(lobe_of(group, split.lobes[side]));
      }
      Split next = assigned(lobes);
      if (trims) trim(next);
      std::size_t moved = 0;
      for (std::size_t i = 0; i < next.sides.size(); ++i) moved += next.sides[i] != split.sides[i] ? 1U : 0U;
      split = std::move(next);
      if (static_cast<double>(moved) < kSettledShare * static_cast<double>(split.sides.size())) break;
    }
    if (!(split.cost < kPromising * cost_of_fewer)) return std::nullopt;
    return split;
  }

  // All that can be said of the pixels of a side.
  MeasuredLobe measured(const Sides& sides, std::uint8_t side) const {
    const Group group = of(sides, side);
    return measure_lobe(group.samples, group.start, threads_);
  }

 private:
  struct Group {
    LobeSamples samples;
    std::vector<Vec3> start;
  };

  double misfit(std::size_t pixel, double cost) const {
    return 2 * cost / std::max(1, used_of(samples_.of(pixel)) - 3);
  }

  Group of(const Sides& sides, std::uint8_t side) const {
    Group group = {LobeSamples(samples_.lights(), samples_.states(), samples_.scale()), {}};
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (sides[i] != side) continue;
      group.samples.add(samples_.of(i));
      group.start.push_back(start_[i]);
    }
    return group;
  }

  // Lambert's where that fits, else the cheapest of those that are fitted from one that is near and from
  // a sharp and a broad one.
  Lobe lobe_of(const Group& group, const Lobe& near) const {
    const LobeFit lambert = fit_lobe(group.samples, settled(group.samples, group.start, {}, threads_),
                                     {.rounds = 0, .threads = threads_});
    if (lambert.chi2 <= kLambertFitsTo) return {};
    std::optional<LobeFit> best;
    for (const Lobe& first : {near, kSharp, kBroad}) {
      if (!first.shines()) continue;
      LobeFit fit =
          fit_lobe(group.samples, settled(group.samples, group.start, first, threads_),
                   {.fitted = parameters_of(first.family), .settled = kCoarselySettled, .threads = threads_});
      if (!best || fit.total() < best->total()) best = std::move(fit);
    }
    return best->lobe;
  }

  const LobeSamples& samples_;
  const std::vector<Vec3>& start_;
  int threads_;
};

// The materials, those that are measured first, and of these the one with most pixels; none where one of them
// is not explained, none is measured, or more are than a pixel can be told to be of.
std::optional<std::vector<MeasuredLobe>> all_explained(const Splitter& all, const Split& split) {
  struct Material {
    MeasuredLobe measured;
    std::ptrdiff_t pixels;
  };
  std::vector<Material> materials;
  for (std::uint8_t side = 0; side < split.lobes.size(); ++side) {
    materials.push_back({all.measured(split.sides, side), std::ranges::count(split.sides, side)});
    if (!is_explained(materials.back().measured)) return std::nullopt;
  }
  std::ranges::stable_sort(materials, [](const Material& a, const Material& b) {
    return std::pair(a.measured.is_measured(), a.pixels) > std::pair(b.measured.is_measured(), b.pixels);
  });
  const auto shining =
      std::ranges::count_if(materials, [](const Material& m) { return m.measured.is_measured(); });
  if (shining == 0 || shining > kMostShining) return std::nullopt;
  std::vector<MeasuredLobe> lobes;
  for (Material& material : materials) lobes.push_back(std::move(material.measured));
  return lobes;
}

// From each of these first guesses, the one that comes to cost least.
std::optional<Split> best_grown(const Splitter& trial, std::vector<Split> firsts, double cost_of_fewer) {
  std::optional<Split> best;
  for (Split& first : firsts) {
    std::optional<Split> split = trial.grown(std::move(first), cost_of_fewer);
    if (split && (!best || split->cost < best->cost)) best = std::move(split);
  }
  return best;
}

}  // namespace

bool may_be_two(const MeasuredLobe& one) {
  if (one.refusal == LobeRefusal::kTooFewPixels || one.refusal == LobeRefusal::kLambertFits) return false;
  return chi2_of(one) > kLobeFitsTo;
}

std::vector<MeasuredLobe> measure_materials(const LobeSamples& samples, const std::vector<Vec3>& start,
                                            int threads) {
  std::vector<MeasuredLobe> one = {measure_lobe(samples, start, threads)};
  if (auto two = measure_two_lobes(samples, start, one.front(), threads)) one.front() = std::move(*two);
  if (!may_be_two(one.front())) return one;
  const LobeSamples few = samples.first(kSplitPixels);
  const std::vector<Vec3> few_start(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(few.pixels()));
  const Splitter trial(few, few_start, threads);
  const Lobe& of_all = best_of(one.front()).lobe;
  const double cost_of_all = trial.fitted(of_all).total();
  std::vector<double> brightness;
  for (const Vec3& b : few_start) brightness.push_back(length(b));
  const std::vector<Lobe> same = {of_all, of_all};
  std::optional<Split> best = best_grown(trial,
                                         {{same, above_median(trial.fitted({}).cost), cost_of_all},
                                          {same, above_median(brightness), cost_of_all},
                                          trial.assigned({kSharp, kBroad})},
                                         cost_of_all);
  if (!best) return one;
  // What the trial pixels told must hold for all.
  const Splitter all(samples, start, threads);
  // A third that is matt, beside two that shine.
  const std::optional<Split> three = best_grown(
      trial, {trial.assigned({kSharp, kBroad, {}}), trial.assigned({best->lobes[0], best->lobes[1], {}})},
      best->cost);
  if (three) {
    if (auto lobes = all_explained(all, all.assigned(three->lobes))) return std::move(*lobes);
  }
  if (auto two = all_explained(all, all.assigned(best->lobes))) return std::move(*two);
  // Where they fade into each other pixels of both spoil either.
  trial.trim(*best);
  const std::optional<Split> soft = trial.grown(*best, cost_of_all, true);
  if (!soft) return one;
  Split whole = all.assigned(soft->lobes);
  all.trim(whole);
  std::optional<std::vector<MeasuredLobe>> two = all_explained(all, whole);
  if (!two || !all.are_blends(whole.sides, (*two)[0].lobe, (*two)[1].lobe)) return one;
  return std::move(*two);
}

}  // namespace weft::solver
