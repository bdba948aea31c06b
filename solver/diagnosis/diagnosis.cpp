// SPDX-License-Identifier: Apache-2.0
#include "solver/diagnosis/diagnosis.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "solver/diagnosis/robust_fit.h"

namespace weft::solver {
namespace {

constexpr std::size_t kFewestLights = 6;
constexpr std::size_t kMostToPair = 12;   // lights of which all pairs are tried
constexpr std::size_t kWorstToPair = 10;  // of more lights than that
constexpr std::size_t kMostToLeaveOut = 16;
constexpr double kDeadShare = 0.05;
constexpr double kExchangeFalls = 0.5;
constexpr double kExchangeLeaves = 0.12;
constexpr double kExchangeShare = 1.5;  // of all K lights' residual, over K
constexpr std::size_t kNeighbours = 5;
constexpr double kMostlyAlone = 0.5;  // share of its gain that its neighbours do not have
constexpr double kGainFalls = 0.6;
// A cloth that is this far from the model says nothing of a few percent.
constexpr double kMostResidual = 0.1;
constexpr double kLeastGain = 0.01;
constexpr double kGainSigmas = 5;
// A light's gain is read where it falls no flatter than this cosine.
constexpr double kLeastCosine = 0.3;
constexpr std::size_t kClasses = 4;  // of how the cloth faces a light
constexpr std::size_t kParts = 8;    // of the picture
constexpr double kOutlierTimes = 5;
constexpr double kSigmaOfMad = 1.4826;  // of a normal distribution

struct Gain {
  double value = 1;  // median over pixels
  double range = 0;  // between the classes
};

// Gain against the cosine between the normal and the half vector of light and view, which highlights follow.
using Ratios = std::vector<std::pair<double, double>>;

// The ratios of all lights in some pixels. A reading is held against a fit that does not know it; where there
// are many, one hardly bends the fit.
void take_ratios(const Evidence& evidence, const LightModel& model, std::size_t first, std::size_t last,
                 std::vector<Ratios>& ratios) {
  RobustFit fit;
  const auto take = [&](std::size_t p, std::size_t k) {
    if (!fit.is_usable(k) || !(fit.predicted(k) > kLeastCosine * fit.albedo())) return;
    const Vec3 half = normalized(evidence.at(p, k).direction + Vec3{0, 0, 1});
    ratios[k].emplace_back(dot(half, fit.normal()), fit.value(k) / fit.predicted(k));
  };
  for (std::size_t p = first; p < last; ++p) {
    const bool leave_out = evidence.lights <= kMostToLeaveOut;
    if (!leave_out && !fit.fit(evidence, p, model)) continue;
    for (std::size_t k = 0; k < evidence.lights; ++k) {
      if (model.gain[k] > 0 && (!leave_out || fit.fit(evidence, p, model, k))) take(p, k);
    }
  }
}

Gain gain_of(Ratios ratios) {
  if (ratios.size() < 4 * kClasses) return {};
  std::sort(ratios.begin(), ratios.end());
  std::vector<double> all, by_class;
  for (std::size_t c = 0; c < kClasses; ++c) {
    std::vector<double> some;
    for (std::size_t i = ratios.size() * c / kClasses; i < ratios.size() * (c + 1) / kClasses; ++i) {
      some.push_back(ratios[i].second);
    }
    all.insert(all.end(), some.begin(), some.end());
    by_class.push_back(median(std::move(some)));
  }
  const auto [least, most] = std::minmax_element(by_class.begin(), by_class.end());
  return {median(std::move(all)), *most - *least};
}

std::vector<Gain> gains_of(const Evidence& evidence, const LightModel& model, int threads) {
  std::array<std::vector<Ratios>, kParts> parts;
  parallel_for(kParts, threads, [&](std::size_t i, int) {
    parts[i].resize(evidence.lights);
    take_ratios(evidence, model, evidence.pixels() * i / kParts, evidence.pixels() * (i + 1) / kParts,
                parts[i]);
  });
  std::vector<Gain> gains;
  for (std::size_t k = 0; k < evidence.lights; ++k) {
    Ratios all;
    for (const auto& part : parts) all.insert(all.end(), part[k].begin(), part[k].end());
    gains.push_back(gain_of(std::move(all)));
  }
  return gains;
}

// The share of log gains that follows a + b l_z^2 of the lights, by least absolute deviations.
std::vector<double> zenith_trend(const Evidence& evidence, const LightModel& model,
                                 const std::vector<Gain>& gains) {
  const auto lights = static_cast<Eigen::Index>(evidence.lights);
  Eigen::MatrixXd a = Eigen::MatrixXd::Ones(lights, 2);
  Eigen::VectorXd y(lights), w(lights);
  for (Eigen::Index k = 0; k < lights; ++k) {
    const auto light = static_cast<std::size_t>(k);
    double z = 0;
    for (std::size_t p = 0; p < evidence.pixels(); ++p) z += evidence.at(p, light).direction.z;
    a(k, 1) = std::pow(z / static_cast<double>(evidence.pixels()), 2);
    y[k] = std::log(gains[light].value);
    w[k] = model.gain[light] > 0 ? 1 : 0;
  }
  const Eigen::VectorXd counts = w;
  Eigen::Vector2d c = Eigen::Vector2d::Zero();
  for (int round = 0; round < 30; ++round) {
    // Where all lights have one zenith angle the two terms are one: the smaller solution is as good.
    const Eigen::Matrix2d g =
        a.transpose() * w.asDiagonal() * a + 1e-9 * w.sum() * Eigen::Matrix2d::Identity();
    c = g.inverse() * (a.transpose() * w.asDiagonal() * y);
    const Eigen::VectorXd deviation = (y - a * c).cwiseAbs().cwiseMax(1e-3);
    w = counts.cwiseQuotient(deviation);
  }
  const Eigen::VectorXd trend = a * c;
  return {trend.begin(), trend.end()};
}

// Gives the cloth what is the cloth's. Light left out of a fit is predicted too far from the mean by about a
// third, hence the damping.
void follow_trend(const Evidence& evidence, LightModel& model, int threads) {
  constexpr double kDamping = 0.7, kSettled = 5e-4;
  for (int round = 0; round < 4; ++round) {
    const std::vector<double> trend = zenith_trend(evidence, model, gains_of(evidence, model, threads));
    double most = 0;
    for (std::size_t k = 0; k < evidence.lights; ++k) {
      model.gain[k] *= std::exp(kDamping * trend[k]);
      most = std::max(most, std::abs(trend[k]));
    }
    if (most < kSettled) return;
  }
}

// Median over pixels of the mean deviation over the albedo: of all lights, and of some of them.
struct Deviation {
  double all = 0, some = 0;
};
Deviation deviation_of(const Evidence& evidence, const LightModel& model, const std::vector<char>& some,
                       std::size_t first, std::size_t last) {
  std::vector<double> of_all, of_some;
  RobustFit fit;
  for (std::size_t p = first; p < last; ++p) {
    if (!fit.fit(evidence, p, model)) continue;
    of_all.push_back(fit.deviation());
    double part = 0;
    int counted = 0;
    for (std::size_t k = 0; k < evidence.lights; ++k) {
      if (!some[k] || !fit.is_usable(k)) continue;
      part += std::abs(fit.residual(k));
      ++counted;
    }
    if (counted > 0) of_some.push_back(part / counted);
  }
  return {median(std::move(of_all)), median(std::move(of_some))};
}
Deviation deviation_of(const Evidence& evidence, const LightModel& model, const std::vector<char>& some) {
  return deviation_of(evidence, model, some, 0, evidence.pixels());
}

// That of all lights where it is below a bound; infinity as soon as half of the pixels say that it is not.
double deviation_below(const Evidence& evidence, const LightModel& model, double bound) {
  std::vector<double> deviations;
  std::size_t beyond = 0;
  RobustFit fit;
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    if (!fit.fit(evidence, p, model)) continue;
    deviations.push_back(fit.deviation());
    beyond += deviations.back() >= bound;
    if (2 * beyond >= evidence.pixels() + 1) return std::numeric_limits<double>::infinity();
  }
  return median(std::move(deviations));
}

// How far a correction turns the normals of least squares: median over pixels.
double turned_deg(const Evidence& evidence, const LightModel& before, const LightModel& after) {
  RobustFit was, is;
  std::vector<double> angles;
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    if (was.fit(evidence, p, before, RobustFit::kNone, 1) &&
        is.fit(evidence, p, after, RobustFit::kNone, 1)) {
      angles.push_back(angle_deg(was.normal(), is.normal()));
    }
  }
  return median(std::move(angles));
}

// Before and after a correction, of these lights, over the whole picture and over its parts.
void weigh(const Evidence& evidence, const LightModel& before, const LightModel& after, Fault& fault) {
  std::vector<char> concerned(evidence.lights, 0);
  for (const std::size_t k : fault.lights) concerned[k] = 1;
  fault.residual_before = deviation_of(evidence, before, concerned).some;
  fault.residual_after = deviation_of(evidence, after, concerned).some;
  fault.moved_deg = turned_deg(evidence, before, after);
  int parts = 0, agree = 0;
  for (std::size_t i = 0; i < kParts; ++i) {
    const std::size_t first = evidence.pixels() * i / kParts, last = evidence.pixels() * (i + 1) / kParts;
    const double was = deviation_of(evidence, before, concerned, first, last).some;
    const double is = deviation_of(evidence, after, concerned, first, last).some;
    if (!std::isfinite(was) || !std::isfinite(is)) continue;
    ++parts;
    agree += is < was;
  }
  fault.agreement = parts > 0 ? static_cast<double>(agree) / parts : 0;
}

// Lights whose photograph is dark where the others say it should not be; they leave the model.
void name_dead(const Evidence& evidence, LightModel& model, std::vector<Fault>& faults) {
  RobustFit fit;
  std::vector<std::vector<double>> seen(evidence.lights);
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    if (!fit.fit(evidence, p, model)) continue;
    for (std::size_t k = 0; k < evidence.lights; ++k) {
      if (std::isfinite(fit.value(k)) && fit.predicted(k) > kLeastCosine * fit.albedo()) {
        seen[k].push_back(fit.value(k) / fit.predicted(k));
      }
    }
  }
  std::vector<Fault> dead;
  for (std::size_t k = 0; k < evidence.lights; ++k) {
    if (seen[k].size() < 2 * kParts || !(quantile(seen[k], 0.9) < 2 * kDeadShare)) continue;
    const double share = median(seen[k]);
    if (!(share < kDeadShare)) continue;
    const auto agree =
        std::count_if(seen[k].begin(), seen[k].end(), [](double s) { return s < 2 * kDeadShare; });
    Fault fault;
    fault.lights = {k};
    fault.value = share;
    fault.agreement = static_cast<double>(agree) / static_cast<double>(seen[k].size());
    dead.push_back(std::move(fault));
  }
  for (const Fault& fault : dead) model.gain[fault.lights[0]] = 0;
  faults.insert(faults.end(), dead.begin(), dead.end());
}

// Lights that are worth trying to exchange: all, or of many the worst.
std::vector<std::size_t> suspects(const Evidence& evidence, const LightModel& model) {
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < evidence.lights; ++k) {
    if (model.gain[k] > 0) all.push_back(k);
  }
  if (all.size() <= kMostToPair) return all;
  std::vector<std::vector<double>> deviations(evidence.lights);
  RobustFit fit;
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    if (!fit.fit(evidence, p, model)) continue;
    for (const std::size_t k : all) {
      if (fit.is_usable(k)) deviations[k].push_back(std::abs(fit.residual(k)));
    }
  }
  std::vector<double> worst;
  for (std::vector<double>& of_light : deviations) {
    worst.push_back(of_light.empty() ? 0 : median(std::move(of_light)));
  }
  std::stable_sort(all.begin(), all.end(), [&](std::size_t i, std::size_t j) { return worst[i] > worst[j]; });
  all.resize(kWorstToPair);
  return all;
}

LightModel exchanged(LightModel model, std::pair<std::size_t, std::size_t> pair) {
  std::swap(model.frame[pair.first], model.frame[pair.second]);
  return model;
}

// The order of photographs that lowers the deviation most, one exchange of two after another.
LightModel best_order(const Evidence& evidence, LightModel model, int threads) {
  constexpr int kMostExchanges = 4;
  const std::vector<std::size_t> some = suspects(evidence, model);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t j = 1; j < some.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) pairs.emplace_back(some[i], some[j]);
  }
  double least = deviation_of(evidence, model, std::vector<char>(evidence.lights, 0)).all;
  for (int round = 0; round < kMostExchanges; ++round) {
    // Two of K lights that fit again lower the mean of K by about a share of 2 / K and more.
    const double bound = least * (1 - 0.5 / static_cast<double>(evidence.lights));
    std::vector<double> deviations(pairs.size());
    parallel_for(pairs.size(), threads, [&](std::size_t i, int) {
      deviations[i] = deviation_below(evidence, exchanged(model, pairs[i]), bound);
    });
    const auto best = std::min_element(deviations.begin(), deviations.end());
    if (!(*best < bound)) break;
    least = *best;
    model = exchanged(std::move(model), pairs[static_cast<std::size_t>(best - deviations.begin())]);
  }
  return model;
}

// Rings of photographs that each belong to the next light of the ring; those that are named stay exchanged.
void name_exchanged(const Evidence& evidence, int threads, LightModel& model, std::vector<Fault>& faults) {
  const LightModel ordered = best_order(evidence, model, threads);
  LightModel named = model;
  std::vector<char> done(evidence.lights, 0);
  for (std::size_t first = 0; first < evidence.lights; ++first) {
    if (done[first] || ordered.frame[first] == first) continue;
    Fault fault;
    fault.kind = FaultKind::kExchanged;
    LightModel before = ordered;
    for (std::size_t k = first; !done[k]; k = ordered.frame[k]) {
      done[k] = 1;
      fault.lights.push_back(k);
      fault.shown_by.push_back(ordered.frame[k]);
      before.frame[k] = k;
    }
    weigh(evidence, before, ordered, fault);
    const double whole = deviation_of(evidence, ordered, done).all / deviation_of(evidence, before, done).all;
    if (!(fault.residual_after < std::min(kExchangeFalls * fault.residual_before, kExchangeLeaves) &&
          whole < 1 - kExchangeShare / static_cast<double>(evidence.lights))) {
      continue;
    }
    for (const std::size_t k : fault.lights) named.frame[k] = ordered.frame[k];
    faults.push_back(std::move(fault));
  }
  model = std::move(named);
}

// Mean direction of a light over the pixels.
Vec3 direction_of(const Evidence& evidence, std::size_t light) {
  Vec3 sum;
  for (std::size_t p = 0; p < evidence.pixels(); ++p) sum = sum + evidence.at(p, light).direction;
  return normalized(sum);
}

// What the lights nearest to light k give: what a cloth does to light from there it does to all of them.
double neighbours_log_gain(const Evidence& evidence, const LightModel& model, const std::vector<Gain>& gains,
                           std::size_t k) {
  const Vec3 here = direction_of(evidence, k);
  std::vector<std::pair<double, double>> others;  // minus the cosine, log gain
  for (std::size_t i = 0; i < evidence.lights; ++i) {
    if (i == k || !(model.gain[i] > 0)) continue;
    others.emplace_back(-dot(here, direction_of(evidence, i)), std::log(gains[i].value));
  }
  std::sort(others.begin(), others.end());
  std::vector<double> logs;
  for (std::size_t i = 0; i < std::min(kNeighbours, others.size()); ++i) logs.push_back(others[i].second);
  return median(std::move(logs));
}

double median_log_gain(const LightModel& model, const std::vector<Gain>& gains) {
  std::vector<double> logs;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    if (model.gain[k] > 0) logs.push_back(std::log(gains[k].value));
  }
  return median(std::move(logs));
}

struct Candidate {
  std::size_t light = 0;
  double log_gain = 0;  // against the median light
  double around = 0;    // log_gain of its neighbours
  double range = 0;
};

// The light that is farthest from its neighbours.
Candidate farthest(const Evidence& evidence, const LightModel& model, const std::vector<Gain>& gains) {
  const double middle = median_log_gain(model, gains);
  Candidate most;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    if (!(model.gain[k] > 0)) continue;
    const double log_gain = std::log(gains[k].value) - middle;
    const double around = neighbours_log_gain(evidence, model, gains, k) - middle;
    if (std::abs(log_gain - around) > std::abs(most.log_gain - most.around)) {
      most = {k, log_gain, around, gains[k].range};
    }
  }
  return most;
}

// Standard deviation of the other lights' log gains.
double scatter(const LightModel& model, const std::vector<Gain>& gains, std::size_t but) {
  const double middle = median_log_gain(model, gains);
  std::vector<double> deviations;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    if (model.gain[k] > 0 && k != but) deviations.push_back(std::abs(std::log(gains[k].value) - middle));
  }
  return kSigmaOfMad * median(std::move(deviations));
}

// The fault that light k is off alone, if it is one, and the model with it corrected.
std::optional<Fault> gain_fault(const Evidence& evidence, const LightModel& model, const Candidate& candidate,
                                int threads, LightModel& corrected) {
  const std::size_t k = candidate.light;
  const auto stands_out = [&](double log_gain) {
    const double off = std::abs(std::expm1(log_gain)), alone = std::abs(log_gain - candidate.around);
    return off > std::max(kLeastGain, candidate.range) && alone > std::max(kLeastGain, kMostlyAlone * off);
  };
  // A light that is left out of the fit is off by no less there than it is.
  if (!stands_out(candidate.log_gain)) return std::nullopt;
  corrected = model;
  std::vector<Gain> gains;
  double more = candidate.log_gain;
  for (int step = 0; step < 3; ++step) {  // what it had bent of the trend and of the fits is bent back
    corrected.gain[k] *= std::exp(more);
    follow_trend(evidence, corrected, threads);
    gains = gains_of(evidence, corrected, threads);
    more = std::log(gains[k].value) - median_log_gain(corrected, gains);
  }
  const double log_gain = std::log(corrected.gain[k] / model.gain[k]);
  const double sigma = scatter(corrected, gains, k);
  if (!stands_out(log_gain) || !(std::abs(log_gain) > kGainSigmas * sigma)) return std::nullopt;
  Fault fault;
  fault.kind = FaultKind::kGain;
  fault.lights = {k};
  fault.value = std::exp(log_gain);
  fault.sigma = fault.value * sigma;
  weigh(evidence, model, corrected, fault);
  if (!(fault.residual_after < kGainFalls * fault.residual_before)) return std::nullopt;
  return fault;
}

// One light after another that is off alone, each corrected before the next is looked for.
void name_gains(const Evidence& evidence, int threads, LightModel& model, std::vector<Fault>& faults) {
  const std::vector<char> none(evidence.lights, 0);
  if (!(deviation_of(evidence, model, none).all < kMostResidual)) return;
  for (std::size_t round = 0; round < evidence.lights / 3; ++round) {
    LightModel corrected;
    std::optional<Fault> fault = gain_fault(
        evidence, model, farthest(evidence, model, gains_of(evidence, model, threads)), threads, corrected);
    if (!fault) return;
    faults.push_back(std::move(*fault));
    model = std::move(corrected);
  }
}

// A plane through residuals over the frame: how much it explains, and how far it falls from edge to edge.
void fit_gradient(const std::vector<std::array<double, 3>>& points, LightEvidence& light) {
  if (points.size() < 16) return;
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  Eigen::Vector3d h = Eigen::Vector3d::Zero();
  double sum = 0, squares = 0;
  for (const auto& [u, v, r] : points) {
    const Eigen::Vector3d a(1, u, v);
    g += a * a.transpose();
    h += r * a;
    sum += r;
    squares += r * r;
  }
  const auto count = static_cast<double>(points.size());
  const double variance = squares - sum * sum / count;
  const Eigen::Vector3d c = g.ldlt().solve(h);
  if (!(variance > 0) || !c.allFinite()) return;
  light.gradient = 2 * std::hypot(c[1], c[2]);
  light.gradient_share = std::clamp((c.dot(h) - sum * sum / count) / variance, 0.0, 1.0);
}

// What each light's readings look like under the calibration as it is.
void describe_lights(const Evidence& evidence, Diagnosis& diagnosis) {
  const LightModel model = LightModel::as_calibrated(evidence.lights);
  std::vector<std::vector<std::array<double, 3>>> residuals(evidence.lights);
  std::vector<double> deviations;
  RobustFit fit;
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    if (!fit.fit(evidence, p, model)) continue;
    ++diagnosis.pixels;
    for (std::size_t k = 0; k < evidence.lights; ++k) {
      LightEvidence& light = diagnosis.lights[k];
      const double reading = evidence.at(p, k).reading;
      if (fit.is_usable(k)) {
        residuals[k].push_back({evidence.position[p][0], evidence.position[p][1], fit.residual(k)});
        deviations.push_back(std::abs(fit.residual(k)));
      } else if (std::isnan(reading)) {
        light.missing += 1;
      } else if (reading == std::numeric_limits<double>::infinity()) {
        light.saturated += 1;
      } else {
        light.shadowed += 1;
      }
    }
  }
  if (diagnosis.pixels == 0) return;
  const double bound = kOutlierTimes * median(std::move(deviations));
  const auto pixels = static_cast<double>(diagnosis.pixels);
  for (std::size_t k = 0; k < evidence.lights; ++k) {
    LightEvidence& light = diagnosis.lights[k];
    double sum = 0, squares = 0;
    std::vector<double> sizes;
    for (const auto& point : residuals[k]) {
      sizes.push_back(std::abs(point[2]));
      sum += point[2];
      squares += point[2] * point[2];
      light.outlier += std::abs(point[2]) > bound ? 1 / pixels : 0;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(residuals[k].size(), 1));
    light.residual_mean = sum / count;
    light.residual_rms = std::sqrt(squares / count);
    light.residual_median = sizes.empty() ? 0 : median(std::move(sizes));
    for (double* share : {&light.saturated, &light.shadowed, &light.missing}) *share /= pixels;
    fit_gradient(residuals[k], light);
  }
}

}  // namespace

Diagnosis diagnose(const Evidence& evidence, int threads) {
  Diagnosis diagnosis;
  diagnosis.lights.resize(evidence.lights);
  describe_lights(evidence, diagnosis);
  if (diagnosis.pixels == 0) return diagnosis;
  const std::vector<char> none(evidence.lights, 0);
  LightModel model = LightModel::as_calibrated(evidence.lights);
  diagnosis.residual = diagnosis.left = deviation_of(evidence, model, none).all;
  if (evidence.lights < kFewestLights) return diagnosis;

  name_dead(evidence, model, diagnosis.faults);
  follow_trend(evidence, model, threads);
  name_exchanged(evidence, threads, model, diagnosis.faults);
  follow_trend(evidence, model, threads);
  const std::vector<Gain> gains = gains_of(evidence, model, threads);
  for (std::size_t k = 0; k < evidence.lights; ++k) {
    diagnosis.lights[k].gain = gains[k].value;
    diagnosis.lights[k].gain_range = gains[k].range;
  }
  name_gains(evidence, threads, model, diagnosis.faults);
  diagnosis.left = deviation_of(evidence, model, none).all;
  return diagnosis;
}

}  // namespace weft::solver
