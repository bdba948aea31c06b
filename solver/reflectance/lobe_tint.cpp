// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_tint.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "solver/reflectance/blend.h"
#include "solver/reflectance/lobe_by_lights.h"
#include "solver/reflectance/materials.h"
#include "solver/reflectance/reading_slopes.h"

namespace weft::solver {
namespace {

// Pixels of a channel that tell its f0, and those that light is left out of.
constexpr std::size_t kMostTintPixels = 1500, kMostJudgedPixels = 400;
// A reading less than a normal and an albedo have unknowns leaves nothing for f0.
constexpr int kLeastTintReadings = 4;
// Rounds of pixels and tint in turn; they end where no channel moves by more than the second.
constexpr int kTintRounds = 4;
constexpr double kSettledTint = 0.003;
// Steps of a pixel that light is left out of, from where all lights had it.
constexpr int kJudgeSteps = 5;
// Chi2 of a tinted lobe: where two materials mirror in two colours one that fits neither is better than none.
constexpr double kMostTintedChi2 = 4;
// Pixels of green that tell whether it is worth more, the chi2 from which it is anyway, and what it must win.
constexpr std::size_t kGreenPixels = 1000;
constexpr double kNearlyFits = 3, kGreenWins = 0.9;
// Difference of the shares of two channels that follow the second of two lobes.
constexpr double kSplitByChannel = 0.5;
// Standard errors of what the tint must win on left-out light.
constexpr double kWinsBy = 3;

// Values of the form, as LobeParameter has them but for f0, and then three f0.
constexpr std::array<LobeParameter, 4> kForm = {LobeParameter::kLogAlpha, LobeParameter::kLogAlong,
                                                LobeParameter::kAxis, LobeParameter::kBend};
// Share of the albedo of all channels where a channel seems to have none.
constexpr double kLeastChannel = 1e-3;
// The form and a tint for each channel.
constexpr int kTintValues = static_cast<int>(kForm.size()) + 3;
using TintVector = Eigen::Matrix<double, kTintValues, 1>;
using TintMatrix = Eigen::Matrix<double, kTintValues, kTintValues>;

struct Channel {
  LobeSamples samples;
  LobeFit fit;  // its lobe without a tint
};
using Channels = std::array<Channel, 3>;

// Evenly taken from all that have readings, each where `fit` has it.
Channel channel_of(const LobeFit& fit, const ChannelSamples& all, std::size_t c) {
  const LobeSamples& of = all.of[c];
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < of.pixels(); ++i) {
    if (used_of(of.of(i)) >= kLeastTintReadings && length(fit.b[all.pixel[c][i]]) > 0) usable.push_back(i);
  }
  Channel channel = {LobeSamples(of.lights(), of.states()), {}};
  Lobe& lobe = channel.fit.lobe;
  lobe = fit.lobe;
  lobe.f0 = f0_of(fit.lobe, static_cast<int>(c));
  lobe.tint = {1, 1, 1};
  const std::size_t count = std::min(usable.size(), kMostTintPixels);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = usable[i * usable.size() / count], number = all.pixel[c][at];
    const Vec3 b = fit.b[number];
    const double yarn = fit.yarn[number];
    channel.samples.add(of.of(at));
    const std::optional<double> albedo = albedo_beneath({lobe, {}, 0}, of.of(at), normalized(b), yarn);
    channel.fit.b.push_back(albedo.value_or(0) > 0 ? *albedo * normalized(b) : kLeastChannel * b);
    channel.fit.yarn.push_back(yarn);
  }
  return channel;
}

// f0 of each channel, all else of the form held; none where one says nothing.
std::optional<Channels> fitted_channels(const LobeFit& fit, const ChannelSamples& samples, int threads) {
  LobeParameters f0_alone = {};
  f0_alone[static_cast<std::size_t>(LobeParameter::kF0)] = true;
  Channels channels = {channel_of(fit, samples, 0), channel_of(fit, samples, 1), channel_of(fit, samples, 2)};
  for (const Channel& channel : channels) {
    if (channel.samples.pixels() < kLeastTintPixels) return {};
  }
  for (Channel& channel : channels)
    channel.fit = fit_lobe(channel.samples, std::move(channel.fit), {.fitted = f0_alone, .threads = threads});
  return channels;
}

// What the pixels say of form and f0 together, and what errors of the lights do to both.
class TintEquations {
 public:
  TintEquations(const Channels& channels, const LobeParameters& form)
      : form_(form), lights_(channels.front().samples.lights()) {
    const auto lights = static_cast<Eigen::Index>(lights_);
    mixed_ = Eigen::MatrixXd::Zero(kTintValues, static_cast<Eigen::Index>(LobeByLights::kErrors) * lights);
    for (Eigen::MatrixXd& colour : coloured_) colour = Eigen::MatrixXd::Zero(kTintValues, lights);
    double cost = 0, freedom = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const Channel& channel = channels[c];
      LobeParameters fitted = form;
      fitted[static_cast<std::size_t>(LobeParameter::kF0)] = true;
      const NudgedLobes there = nudged(channel.fit.lobe, fitted);
      for (std::size_t i = 0; i < channel.samples.pixels(); ++i) add(channel, there, c, i);
      cost += channel.fit.total();
      freedom += static_cast<double>(channel.samples.used()) - 3 * static_cast<double>(channel.fit.b.size());
    }
    chi2_ = freedom > 0 ? 2 * cost / freedom : 1;
  }

  // The covariance of the three f0, from noise, from the lights as `errors` has them, and from their drift.
  Eigen::Matrix3d covariance(std::span<const double> errors) const {
    TintMatrix information = information_;
    for (Eigen::Index p = 0; p < information.rows(); ++p) information(p, p) += 1e-9;
    const TintMatrix inverse = information.ldlt().solve(TintMatrix::Identity());
    TintMatrix all = std::max(chi2_, 1.0) * inverse;
    const Eigen::MatrixXd change = inverse * mixed_;
    Eigen::MatrixXd of_lights = Eigen::MatrixXd::Zero(change.cols(), change.cols());
    if (errors.size() == static_cast<std::size_t>(change.cols() * change.cols())) {
      using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      of_lights = Eigen::Map<const Rows>(errors.data(), change.cols(), change.cols());
    }
    for (Eigen::Index i = 0; i < change.cols(); i += static_cast<Eigen::Index>(LobeByLights::kErrors))
      of_lights(i, i) += kLightDrift * kLightDrift;
    all += change * of_lights * change.transpose();
    for (const Eigen::MatrixXd& colour : coloured_) {
      const Eigen::MatrixXd by_colour = inverse * colour;
      all += kColourDrift * kColourDrift * by_colour * by_colour.transpose();
    }
    return all.bottomRightCorner<3, 3>();
  }

 private:
  using Slopes = ReadingSlopes<kTintValues>;

  Slopes slopes_of(const Channel& channel, const NudgedLobes& there, std::size_t c, const LobeReading& r,
                   std::size_t pixel) const {
    const Lobe& lobe = channel.fit.lobe;
    const Vec3 b = channel.fit.b[pixel];
    const double yarn = channel.fit.yarn[pixel];
    const ModelledReading m = modelled_with_derivative(lobe, b, r.from, yarn);
    Slopes s;
    s.weight = r.weight * huber_weight((r.x - m.x) * std::sqrt(r.weight));
    s.by_b = m.by_b;
    const auto slope_by = [&](LobeParameter p) {
      const NudgedLobe& off = there[static_cast<std::size_t>(p)];
      return (modelled(off.lobe, b, r.from, yarn) - m.x) / off.by;
    };
    for (std::size_t p = 0; p < kForm.size(); ++p) {
      if (form_[static_cast<std::size_t>(kForm[p])])
        s.by_values[static_cast<Eigen::Index>(p)] = slope_by(kForm[p]);
    }
    s.by_values[static_cast<Eigen::Index>(kForm.size() + c)] = slope_by(LobeParameter::kF0);
    s.by_errors = slopes_by_errors(lobe, r, b, yarn, m.x);
    return s;
  }

  void add(const Channel& channel, const NudgedLobes& there, std::size_t c, std::size_t pixel) {
    const auto readings = channel.samples.of(pixel);
    std::vector<Slopes> slopes(readings.size());
    for (std::size_t k = 0; k < readings.size(); ++k) {
      if (readings[k].weight > 0) slopes[k] = slopes_of(channel, there, c, readings[k], pixel);
    }
    take_out_pixel(std::span(slopes));
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const Slopes& s = slopes[k];
      information_ += s.weight * s.by_values * s.by_values.transpose();
      const std::size_t light = k % lights_;
      for (std::size_t e = 0; e < LobeByLights::kErrors; ++e)
        mixed_.col(static_cast<Eigen::Index>(LobeByLights::kErrors * light + e)) +=
            (s.weight * s.by_errors[e]) * s.by_values;
      coloured_[c].col(static_cast<Eigen::Index>(light)) += (s.weight * s.by_errors[0]) * s.by_values;
    }
  }

  const LobeParameters& form_;
  std::size_t lights_;
  TintMatrix information_ = TintMatrix::Zero();
  Eigen::MatrixXd mixed_;
  std::array<Eigen::MatrixXd, 3> coloured_;
  double chi2_ = 1;
};

LobeTint tint_of(const Channels& channels, const LobeParameters& form, const TintOptions& options) {
  LobeTint tint;
  for (std::size_t c = 0; c < 3; ++c) tint.f0[c] = channels[c].fit.lobe.f0;
  const double mean =
      std::max(std::inner_product(tint.f0.begin(), tint.f0.end(), options.weights.begin(), 0.0), 1e-9);
  const Eigen::Matrix3d covariance = TintEquations(channels, form).covariance(options.light_errors);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    tint.sigma[c] = std::sqrt(std::max(covariance(i, i), 0.0));
    tint.tint[c] = tint.f0[c] / mean;
    Eigen::Vector3d by_f0;
    for (std::size_t k = 0; k < 3; ++k)
      by_f0[static_cast<Eigen::Index>(k)] = ((k == c ? 1 : 0) - tint.tint[c] * options.weights[k]) / mean;
    const double variance = by_f0.dot(covariance * by_f0);
    tint.sigma_of_tint[c] = std::hypot(std::sqrt(std::max(variance, 0.0)), kTintModelShare * tint.tint[c]);
  }
  return tint;
}

// Huber's cost of the reading of every light, predicted from the other lights, by pixel.
std::vector<double> left_out_costs(const LobeSamples& samples, const Lobe& lobe, std::vector<Vec3> b,
                                   const std::vector<double>& yarn, int threads) {
  std::vector<double> costs(samples.pixels(), 0.0), unused(samples.pixels());
  samples.fit_pixels(lobe, yarn, kJudgeSteps, threads, b, unused);
  for (std::size_t light = 0; light < samples.lights(); ++light) {
    LobeSamples others(samples.lights(), samples.states());
    for (std::size_t i = 0; i < samples.pixels(); ++i) {
      std::vector<LobeReading> readings(samples.of(i).begin(), samples.of(i).end());
      for (std::size_t k = light; k < readings.size(); k += samples.lights()) readings[k].weight = 0;
      others.add(readings);
    }
    std::vector<Vec3> by_others = b;
    others.fit_pixels(lobe, yarn, kJudgeSteps, threads, by_others, unused);
    for (std::size_t i = 0; i < samples.pixels(); ++i) {
      for (std::size_t k = light; k < samples.of(i).size(); k += samples.lights())
        costs[i] += cost_of(lobe, samples.of(i).subspan(k, 1), by_others[i], yarn[i]);
    }
  }
  return costs;
}

// Whether left-out light of the channels is nearer to what their own f0 makes than to what the mean makes.
bool predicts_better(const Channels& channels, const Lobe& mean, int threads) {
  std::vector<double> wins;
  for (const Channel& channel : channels) {
    const LobeSamples few = channel.samples.first(kMostJudgedPixels);
    const auto count = static_cast<std::ptrdiff_t>(few.pixels());
    const std::vector<Vec3> b(channel.fit.b.begin(), channel.fit.b.begin() + count);
    const std::vector<double> yarn(channel.fit.yarn.begin(), channel.fit.yarn.begin() + count);
    Lobe grey = mean;
    grey.tint = {1, 1, 1};
    const std::vector<double> own = left_out_costs(few, channel.fit.lobe, b, yarn, threads),
                              others = left_out_costs(few, grey, b, yarn, threads);
    for (std::size_t i = 0; i < own.size(); ++i) wins.push_back(others[i] - own[i]);
  }
  const auto n = static_cast<double>(wins.size());
  const double won = std::accumulate(wins.begin(), wins.end(), 0.0) / n;
  double squares = 0;
  for (const double each : wins) squares += (each - won) * (each - won);
  return won > kWinsBy * std::sqrt(squares / n / n);
}

// Pixels of one material, or of all.
struct Material {
  LobeSamples samples;
  std::vector<Vec3> start;
  ChannelSamples channels;
};

Material part_of(const Material& all, const std::vector<std::size_t>& numbers) {
  Material part = {LobeSamples(all.samples.lights(), all.samples.states(), all.samples.scale()),
                   {},
                   all.channels.part(numbers)};
  for (const std::size_t i : numbers) {
    part.samples.add(all.samples.of(i));
    part.start.push_back(all.start[i]);
  }
  return part;
}

LobeFit settled_with(const Material& material, const Lobe& lobe, int threads) {
  const std::vector<double> along(material.start.size(), 0.0);
  LobeFit fit = with_better_yarns(material.samples, {lobe, material.start, along, {}, 0}, threads);
  try_other_starts(material.samples, threads, fit);
  return fit;
}

class TintSearch {
 public:
  TintSearch(Material all, const TintOptions& options)
      : all_(std::move(all)),
        options_(options),
        is_mosaic_(all_.samples.of(0).front().from.channel != LitFrom::kMixed) {}

  // Measures a tint on pixels of one material, whose normals are as `fit` has them; `grey` was measured
  // without a tint.
  std::optional<MeasuredLobe> tinted(const Material& material, LobeFit fit, const MeasuredLobe& grey) const {
    const bool bends = fit.lobe.bend != 0;
    std::optional<LobeTint> tint = measure_tint(fit, bends, material.channels, options_);
    for (int round = 0; round < kTintRounds; ++round) {
      if (!tint || !is_off(*tint)) return {};
      // The weighted sum of RGB has the mean f0, whatever the tint.
      if (!is_mosaic_) break;
      fit.lobe.f0 = weighted(tint->f0);
      fit.lobe.tint = tint->tint;
      fit = with_better_yarns(material.samples, std::move(fit), options_.threads);
      fit = fit_lobe(material.samples, std::move(fit),
                     {.fitted = parameters_of(fit.lobe, bends), .threads = options_.threads});
      const std::array<double, 3> before = tint->tint;
      tint = measure_tint(fit, bends, material.channels, options_);
      double moved = 0;
      for (std::size_t c = 0; tint && c < 3; ++c)
        moved = std::max(moved, std::abs(tint->tint[c] - before[c]));
      if (moved < kSettledTint) break;
    }
    if (!tint || !is_off(*tint)) return {};
    return measured(material, *tint, grey);
  }

  // The lobes of these forms with their tints; none where none has one.
  std::vector<MeasuredLobe> with_tints(std::vector<MeasuredLobe> lobes) const {
    if (lobes.size() == 1) {
      const MeasuredLobe& one = lobes.front();
      const bool of_all = one.fit.b.size() == all_.start.size();
      std::optional<MeasuredLobe> found =
          tinted(all_, of_all ? one.fit : settled_with(all_, one.lobe, options_.threads), one);
      return found ? std::vector<MeasuredLobe>{std::move(*found)} : std::vector<MeasuredLobe>();
    }
    bool any = false;
    // With tints some pixels change sides.
    for (int pass = 0; pass < (is_mosaic_ ? 2 : 1); ++pass) {
      const std::array<LobeFit, 2> fits = fits_of(lobes);
      any = false;
      for (std::size_t side = 0; side < 2; ++side) {
        if (!lobes[side].is_measured()) continue;
        const auto [material, fit] = side_of(fits, side);
        std::optional<MeasuredLobe> found = tinted(material, fit, lobes[side]);
        any = any || found;
        if (found) lobes[side] = std::move(*found);
      }
      if (!any) return {};
    }
    return lobes;
  }

  // Whether the channels of a mosaic may have kept each other from one lobe: where the best one for all fits
  // nearly, green alone must follow it better.
  bool may_shine_in_green(const MeasuredLobe& of_all) const {
    const LobeCandidate& best = *std::ranges::min_element(of_all.candidates, {}, &LobeCandidate::chi2);
    if (best.chi2 > kNearlyFits) return true;
    const Material few = green(kGreenPixels);
    const LobeFit fit =
        fit_lobe(few.samples, settled_with(few, best.lobe, options_.threads),
                 {.fitted = parameters_of(best.lobe, best.lobe.bend != 0), .threads = options_.threads});
    return fit.chi2 < kGreenWins * best.chi2;
  }

  // What green alone says.
  std::vector<MeasuredLobe> of_green() const {
    const Material all = green(all_.start.size());
    return measure_materials(all.samples, all.start, options_.threads);
  }

  // Two lobes that are those of two channels rather than of two materials.
  bool is_split_by_channel(const std::vector<MeasuredLobe>& lobes) const {
    const std::array<LobeFit, 2> fits = fits_of(lobes);
    std::array<double, 3> second = {};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::vector<std::size_t>& of = all_.channels.pixel[c];
      const auto count =
          std::ranges::count_if(of, [&](std::size_t i) { return fits[1].cost[i] < fits[0].cost[i]; });
      second[c] = static_cast<double>(count) / static_cast<double>(of.size());
    }
    const auto [least, most] = std::ranges::minmax_element(second);
    return *most - *least > kSplitByChannel;
  }

  bool is_mosaic() const { return is_mosaic_; }

 private:
  // At most so many pixels of green.
  Material green(std::size_t count) const {
    const LobeSamples& of = all_.channels.of[1];
    Material some = {of.first(count), {}, ChannelSamples(of.lights(), of.states())};
    for (std::size_t i = 0; i < some.samples.pixels(); ++i)
      some.start.push_back(all_.start[all_.channels.pixel[1][i]]);
    return some;
  }
  std::array<LobeFit, 2> fits_of(const std::vector<MeasuredLobe>& two) const {
    return {settled_with(all_, two[0].lobe, options_.threads),
            settled_with(all_, two[1].lobe, options_.threads)};
  }
  double weighted(const std::array<double, 3>& f0) const {
    return std::inner_product(f0.begin(), f0.end(), options_.weights.begin(), 0.0);
  }
  static std::array<double, 3> f0_by_channel(const Lobe& lobe) {
    return {f0_of(lobe, 0), f0_of(lobe, 1), f0_of(lobe, 2)};
  }

  std::pair<Material, LobeFit> side_of(const std::array<LobeFit, 2>& fits, std::size_t side) const {
    std::vector<std::size_t> numbers;
    LobeFit fit = {fits[side].lobe, {}, {}, {}, 0};
    for (std::size_t i = 0; i < all_.start.size(); ++i) {
      if ((fits[1].cost[i] < fits[0].cost[i]) != (side == 1)) continue;
      numbers.push_back(i);
      fit.b.push_back(fits[side].b[i]);
      fit.yarn.push_back(fits[side].yarn[i]);
    }
    return {part_of(all_, numbers), std::move(fit)};
  }

  // The lobe with a tint that is known, if it stands.
  std::optional<MeasuredLobe> measured(const Material& material, const LobeTint& held,
                                       const MeasuredLobe& grey) const {
    MeasuredLobe found = grey;
    if (is_mosaic_) found = measure_lobe(material.samples, material.start, options_.threads, held.tint);
    if (!found.is_measured() || found.fit.chi2 > kMostTintedChi2) return {};
    const bool bends = found.lobe.bend != 0;
    found.lobe.tint = found.fit.lobe.tint = held.tint;
    const std::optional<Channels> channels = fitted_channels(found.fit, material.channels, options_.threads);
    if (!channels) return {};
    LobeTint tint = tint_of(*channels, parameters_of(found.lobe, bends), options_);
    if (!is_off(tint) || !predicts_better(*channels, found.lobe, options_.threads)) return {};
    tint.tint = held.tint;
    tint.f0 = f0_by_channel(found.lobe);
    found.tint = tint;
    return found;
  }

  Material all_;
  const TintOptions& options_;
  bool is_mosaic_;
};

// Chi2 of all pixels that follow lobes.
double chi2_of_all(const std::vector<MeasuredLobe>& lobes) {
  double sum = 0, pixels = 0;
  for (const MeasuredLobe& lobe : lobes) {
    if (!lobe.is_measured()) continue;
    sum += lobe.fit.chi2 * static_cast<double>(lobe.fit.b.size());
    pixels += static_cast<double>(lobe.fit.b.size());
  }
  return pixels > 0 ? sum / pixels : 0;
}

}  // namespace

void ChannelSamples::add(std::size_t number, std::span<const LobeReading> readings) {
  const auto channel = static_cast<std::size_t>(readings.front().from.channel);
  of[channel].add(readings);
  pixel[channel].push_back(number);
}

ChannelSamples ChannelSamples::part(std::span<const std::size_t> numbers) const {
  ChannelSamples some(of.front().lights(), of.front().states());
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<std::size_t> at;  // by number, one more; 0: none
    for (std::size_t i = 0; i < pixel[c].size(); ++i) {
      at.resize(std::max(at.size(), pixel[c][i] + 1));
      at[pixel[c][i]] = i + 1;
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] < at.size() && at[numbers[i]] > 0) some.add(i, of[c].of(at[numbers[i]] - 1));
    }
  }
  return some;
}

std::optional<LobeTint> measure_tint(const LobeFit& fit, bool bends, const ChannelSamples& samples,
                                     const TintOptions& options) {
  const std::optional<Channels> channels = fitted_channels(fit, samples, options.threads);
  if (!channels) return {};
  return tint_of(*channels, parameters_of(fit.lobe, bends), options);
}

bool is_off(const LobeTint& tint) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(tint.tint[c] - 1) > kTintSigmas * tint.sigma_of_tint[c]) return true;
  }
  return false;
}

void find_tints(const LobeSamples& samples, const std::vector<Vec3>& start, const ChannelSamples& channels,
                const TintOptions& options, std::vector<MeasuredLobe>& lobes) {
  const MeasuredLobe& first = lobes.front();
  if (first.refusal == LobeRefusal::kTooFewPixels || first.refusal == LobeRefusal::kLambertFits) return;
  for (const LobeSamples& of : channels.of) {
    if (of.pixels() < kLeastTintPixels) return;
  }
  const TintSearch search({samples, start, channels}, options);
  std::vector<MeasuredLobe> found;
  if (search.is_mosaic() && (first.is_measured() ? lobes.size() > 1 && search.is_split_by_channel(lobes)
                                                 : search.may_shine_in_green(first))) {
    std::vector<MeasuredLobe> of_green = search.of_green();
    // Two of green are those of all.
    if (of_green.front().is_measured() && (of_green.size() == 1 || !first.is_measured()))
      found = search.with_tints(std::move(of_green));
    // Two lobes may be those of two channels.
    if (first.is_measured() && chi2_of_all(found) > std::max(kLobeFitsTo, chi2_of_all(lobes))) found.clear();
  }
  if (found.empty() && first.is_measured()) found = search.with_tints(lobes);
  if (!found.empty()) lobes = std::move(found);
}

}  // namespace weft::solver
