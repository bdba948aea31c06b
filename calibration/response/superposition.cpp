// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/superposition.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::calibration {
namespace {

constexpr int kCurveRounds = 4;
constexpr int kLevelBins = 24;
constexpr double kPrior = 0.1;  // of a and b, all channels together

// Parameters: offset, a and b by channel, then two gains a triple.
constexpr Eigen::Index kOffset = 0;
constexpr Eigen::Index kFirstGain = 7;
constexpr Eigen::Index curve_of(std::size_t channel) {
  return 1 + 2 * static_cast<Eigen::Index>(channel);
}

struct Curve {
  double a, b;
  double of(const Moments& m) const { return m.v + a * m.v2 + b * m.v3; }
};

// One square of one triple and channel.
struct Square {
  std::size_t channel, triple;
  Moments first, second, both;
  double dark;    // v without light, where known
  double weight;  // 1 / variance of what is missing
};

double variance_of(const Moments& m, const SuperpositionNoise& noise) {
  return (std::max(m.v, 0.0) / noise.electrons_at_full + noise.read_noise * noise.read_noise) / m.photosites;
}

bool holds_all(const SuperposedLight& light, std::size_t block, std::size_t channel) {
  return light.first->blocks[block][channel].photosites > 0 &&
         light.second->blocks[block][channel].photosites > 0 &&
         light.both->blocks[block][channel].photosites > 0;
}

std::vector<Square> squares_of(std::span<const SuperposedLight> lights, const SuperpositionNoise& noise) {
  std::vector<Square> squares;
  for (std::size_t t = 0; t < lights.size(); ++t) {
    for (std::size_t block = 0; block < lights[t].both->blocks.size(); ++block) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (!holds_all(lights[t], block, c)) continue;
        Square s = {c,
                    t,
                    lights[t].first->blocks[block][c],
                    lights[t].second->blocks[block][c],
                    lights[t].both->blocks[block][c],
                    lights[t].dark != nullptr ? (*lights[t].dark)[c] : 0,
                    0};
        s.weight =
            1 / (variance_of(s.first, noise) + variance_of(s.second, noise) + variance_of(s.both, noise));
        squares.push_back(s);
      }
    }
  }
  return squares;
}

struct Fit {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;
};

Curve curve_at(const Eigen::VectorXd& p, std::size_t channel) {
  return {p[curve_of(channel)], p[curve_of(channel) + 1]};
}

// What is missing of first + second = both at `p`, and its derivatives there.
double missing(const Square& s, const Eigen::VectorXd& p, bool finds_offset, Eigen::VectorXd* slope) {
  const double offset = s.dark + p[kOffset];
  const Moments first = shifted(s.first, offset), second = shifted(s.second, offset),
                both = shifted(s.both, offset);
  const Curve curve = curve_at(p, s.channel);
  const auto gain = kFirstGain + 2 * static_cast<Eigen::Index>(s.triple);
  const double g = 1 + p[gain], h = 1 + p[gain + 1];
  if (slope != nullptr) {
    slope->setZero();
    const auto falls = [&](const Moments& m) { return -(1 + 2 * curve.a * m.v + 3 * curve.b * m.v2); };
    if (finds_offset) (*slope)[kOffset] = g * falls(first) + h * falls(second) - falls(both);
    (*slope)[curve_of(s.channel)] = g * first.v2 + h * second.v2 - both.v2;
    (*slope)[curve_of(s.channel) + 1] = g * first.v3 + h * second.v3 - both.v3;
    (*slope)[gain] = curve.of(first);
    (*slope)[gain + 1] = curve.of(second);
  }
  return g * curve.of(first) + h * curve.of(second) - curve.of(both);
}

// Inverse covariance before anything was seen.
Eigen::MatrixXd prior_of(Eigen::Index parameters, const SuperpositionNoise& noise, bool finds_offset) {
  Eigen::MatrixXd prior = Eigen::MatrixXd::Identity(parameters, parameters) / (noise.drift * noise.drift);
  const double own = noise.channel_spread * noise.channel_spread;
  const Eigen::Matrix3d among = (own * Eigen::Matrix3d::Identity()).array() + kPrior * kPrior;
  const Eigen::Matrix3d inverse = among.inverse();
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t d = 0; d < 3; ++d) {
      for (const Eigen::Index k : {0, 1}) {  // of a, of b
        prior(curve_of(c) + k, curve_of(d) + k) =
            inverse(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(d));
      }
    }
  }
  prior(kOffset, kOffset) = finds_offset ? 0 : 1;
  return prior;
}

// Gauss-Newton with the priors as further observations.
Fit solved(const std::vector<Square>& squares, std::size_t triples, const SuperpositionNoise& noise,
           bool finds_offset) {
  const Eigen::Index n = kFirstGain + 2 * static_cast<Eigen::Index>(triples);
  const Eigen::MatrixXd prior = prior_of(n, noise, finds_offset);
  Fit fit = {Eigen::VectorXd::Zero(n), {}};
  Eigen::VectorXd slope(n);
  for (int round = 0; round < kCurveRounds; ++round) {
    Eigen::MatrixXd normal = prior;
    Eigen::VectorXd right = -prior * fit.parameters;
    for (const Square& s : squares) {
      const double off = missing(s, fit.parameters, finds_offset, &slope);
      // Only these entries of the slope are not 0.
      const Eigen::Index c = curve_of(s.channel), g = kFirstGain + 2 * static_cast<Eigen::Index>(s.triple);
      const std::array<Eigen::Index, 5> at = {kOffset, c, c + 1, g, g + 1};
      for (const Eigen::Index i : at) {
        right[i] -= s.weight * slope[i] * off;
        for (const Eigen::Index j : at) normal(i, j) += s.weight * slope[i] * slope[j];
      }
    }
    const Eigen::LDLT<Eigen::MatrixXd> factored(normal);
    fit.parameters += factored.solve(right);
    fit.covariance = factored.solve(Eigen::MatrixXd::Identity(n, n));
  }
  return fit;
}

std::array<std::vector<SuperpositionBin>, 3> binned(const std::vector<Square>& squares,
                                                    const Eigen::VectorXd& p, bool finds_offset) {
  Eigen::VectorXd straight = p;
  straight.segment(1, kFirstGain - 1).setZero();
  struct Sum {
    double weight = 0, v = 0, before = 0, after = 0;
  };
  std::array<std::array<Sum, kLevelBins>, 3> sums;
  for (const Square& s : squares) {
    const double v = s.both.v - s.dark - p[kOffset];
    const double at = std::clamp(v * kLevelBins, 0.0, kLevelBins - 1.0);
    Sum& sum = sums[s.channel][static_cast<std::size_t>(at)];
    sum.weight += s.weight;
    sum.v += s.weight * v;
    sum.before += s.weight * missing(s, straight, finds_offset, nullptr);
    sum.after += s.weight * missing(s, p, finds_offset, nullptr);
  }
  std::array<std::vector<SuperpositionBin>, 3> bins;
  for (std::size_t c = 0; c < 3; ++c) {
    for (const Sum& s : sums[c]) {
      if (s.weight > 0 && s.v > 0) bins[c].push_back({s.v / s.weight, s.before / s.v, s.after / s.v});
    }
  }
  return bins;
}

// Distance of the curve at v from the chord 0 to 1.
double bulge(std::array<double, 2> ab, double v) {
  return v * (ab[0] * (v - 1) + ab[1] * (v * v - 1));
}

}  // namespace

double departure_from_line(std::array<double, 2> linearity) {
  // Through 0 only the slope is free: the best slope is between those that leave the chord on one side, and
  // what it leaves is a convex function of it.
  const auto worst = [&](double tilt) {
    double most = 0;
    for (int i = 1; i <= 100; ++i) {
      const double v = i / 100.0;
      most = std::max(most, std::abs(bulge(linearity, v) - tilt * v));
    }
    return most;
  };
  double low = -1, high = 1;
  for (int i = 0; i < 80; ++i) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    (worst(left) < worst(right) ? high : low) = worst(left) < worst(right) ? right : left;
  }
  return worst((low + high) / 2);
}

double Superposition::departure(std::size_t channel) const {
  return departure_from_line(linearity[channel]);
}

double Superposition::sigma_departure(std::size_t channel) const {
  // At v = 1/2 the chord's distance is -(a + 3/2 b) / 4; the best line halves it, about.
  const auto [aa, bb, ab] = covariance[channel];
  return std::sqrt(std::max(aa + 2.25 * bb + 3 * ab, 0.0)) / 8;
}

Result<Superposition> fit_superposition(std::span<const SuperposedLight> lights,
                                        const SuperpositionNoise& noise) {
  const std::vector<Square> squares = squares_of(lights, noise);
  if (squares.empty()) {
    return Error{ErrorKind::kBadData, "linearity cannot be measured", "pairs of LEDs",
                 "no part of the frame is neither full nor black under one LED, the other and both",
                 "take the pair at shorter exposures, so that both together are not full"};
  }
  const bool finds_offset =
      std::any_of(lights.begin(), lights.end(), [](const SuperposedLight& l) { return l.dark == nullptr; });
  const Fit fit = solved(squares, lights.size(), noise, finds_offset);

  Superposition result;
  result.offset = fit.parameters[kOffset];
  double chi_square = 0;
  for (const Square& s : squares) {
    const double off = missing(s, fit.parameters, finds_offset, nullptr);
    chi_square += s.weight * off * off;
    result.highest_v[s.channel] = std::max(result.highest_v[s.channel], s.both.v - s.dark - result.offset);
  }
  const double freedom =
      std::max(static_cast<double>(squares.size()) - static_cast<double>(fit.parameters.size()), 1.0);
  result.chi_square_per_freedom = chi_square / freedom;
  const double inflation = std::max(result.chi_square_per_freedom, 1.0);
  if (finds_offset) result.sigma_offset = std::sqrt(inflation * fit.covariance(kOffset, kOffset));
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Index i = curve_of(c);
    const Curve curve = curve_at(fit.parameters, c);
    result.linearity[c] = {curve.a, curve.b};
    result.covariance[c] = {inflation * fit.covariance(i, i), inflation * fit.covariance(i + 1, i + 1),
                            inflation * fit.covariance(i, i + 1)};
  }
  result.bins = binned(squares, fit.parameters, finds_offset);
  return result;
}

double sum_over_both(const SuperposedLight& light) {
  double sum = 0, both = 0;
  for (std::size_t block = 0; block < light.both->blocks.size(); ++block) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!holds_all(light, block, c)) continue;
      const double dark = light.dark != nullptr ? (*light.dark)[c] : 0;
      sum += light.first->blocks[block][c].v + light.second->blocks[block][c].v - 2 * dark;
      both += light.both->blocks[block][c].v - dark;
    }
  }
  return both > 0 ? sum / both : 1;
}

}  // namespace weft::calibration
