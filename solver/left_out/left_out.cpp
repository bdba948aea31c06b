// SPDX-License-Identifier: Apache-2.0
#include "solver/left_out/left_out.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/statistics.h"
#include "solver/in_double/pixel.h"

namespace weft::solver {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Errors count up to so many times their median: no method predicts a highlight.
constexpr double kCutAt = 4;
// Below this share of the cubed trace a determinant is rounding.
constexpr double kRankDeficient = 1e-12;
// Median of the absolute value of a normal deviate.
constexpr double kMedianOfNormal = 0.6745;

struct Pair {
  std::size_t patch;
  double a, b;  // absolute errors over the brightness
};

std::size_t pixels_of(const Patch& patch) {
  return static_cast<std::size_t>(patch.pixels.pixels());
}

// What both predicted, block by block.
std::vector<std::vector<Pair>> pairs_of(const LeftOut& a, const LeftOut& b) {
  std::vector<std::vector<Pair>> blocks(a.grid.count());
  std::size_t pixel = 0;
  for (std::size_t p = 0; p < a.patches.size(); ++p) {
    for (const std::size_t end = pixel + pixels_of(a.patches[p]); pixel < end; ++pixel) {
      if (!(a.scale[pixel] > 0)) continue;
      for (std::size_t k = 0; k < a.lights; ++k) {
        const std::size_t i = pixel * a.lights + k;
        const double of_a = std::abs(a.error[i]) / a.scale[pixel];
        const double of_b = std::abs(b.error[i]) / a.scale[pixel];
        if (std::isfinite(of_a) && std::isfinite(of_b)) blocks[a.patches[p].block].push_back({p, of_a, of_b});
      }
    }
  }
  return blocks;
}

// Mean gains of the patches of one block. `pairs` are in the order of patches.
std::vector<double> gains_of(const std::vector<Pair>& pairs) {
  std::vector<double> errors;
  for (const Pair& pair : pairs) errors.insert(errors.end(), {pair.a, pair.b});
  const double limit = kCutAt * median(std::move(errors));
  std::vector<double> means;
  for (std::size_t i = 0; i < pairs.size();) {
    double sum = 0;
    const std::size_t first = i;
    for (; i < pairs.size() && pairs[i].patch == pairs[first].patch; ++i) {
      sum += std::min(pairs[i].a, limit) - std::min(pairs[i].b, limit);
    }
    means.push_back(sum / static_cast<double>(i - first));
  }
  return means;
}

Gain gain_of(const std::vector<double>& means) {
  Gain gain;
  gain.patches = static_cast<int>(means.size());
  const auto n = static_cast<double>(means.size());
  for (const double mean : means) gain.mean += mean / n;
  double square = 0;
  for (const double mean : means) square += std::pow(mean - gain.mean, 2);
  if (means.size() > 1) gain.sigma = std::sqrt(square / (n * (n - 1)));
  return gain;
}

// Gathers the errors of lit readings.
class ErrorGatherer {
 public:
  explicit ErrorGatherer(const LeftOut& left_out) : left_out_(left_out) {}

  void add_light(std::size_t light) {
    for (std::size_t pixel = 0; pixel < left_out_.scale.size(); ++pixel) {
      const std::size_t i = pixel * left_out_.lights + light;
      const double reading = left_out_.reading[i], scale = left_out_.scale[pixel];
      if (!(scale > 0) || !(reading >= kShadowShare * scale) || !std::isfinite(left_out_.error[i])) continue;
      relative_.push_back(std::abs(left_out_.error[i]) / reading);
      square_ += std::pow(std::min(std::abs(left_out_.error[i]) / scale, 1.0), 2);
      knows_noise_ = knows_noise_ && !std::isnan(left_out_.noise[i]);
      noise_.push_back(kMedianOfNormal * left_out_.noise[i] / reading);
      noise_square_ += std::pow(std::min(left_out_.noise[i] / scale, 1.0), 2);
    }
  }

  LeftOutError error() {
    const auto n = static_cast<double>(relative_.size());
    const bool knows_noise = knows_noise_ && !noise_.empty();
    LeftOutError error;
    error.readings = relative_.size();
    error.rms = std::sqrt(square_ / n);
    error.median = median(std::move(relative_));
    error.noise_rms = knows_noise ? std::sqrt(noise_square_ / n) : kNaN;
    error.noise_median = knows_noise ? median(std::move(noise_)) : kNaN;
    return error;
  }

 private:
  const LeftOut& left_out_;
  std::vector<double> relative_, noise_;
  double square_ = 0, noise_square_ = 0;
  bool knows_noise_ = true;
};

}  // namespace

std::size_t turns_of(std::size_t lights) {
  return std::min(lights, kMostTurns);
}

void left_out_noise(std::span<const Vec3> directions, std::span<const double> variances,
                    std::span<float> sigma) {
  const std::size_t lights = directions.size(), turns = turns_of(lights);
  const auto vector = [&](std::size_t k) {
    return Eigen::Vector3d(directions[k].x, directions[k].y, directions[k].z);
  };
  const auto information = [&](std::size_t first, std::size_t step) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t k = first; k < lights; k += step) {
      const Eigen::Vector3d l = vector(k);
      if (std::isfinite(variances[k])) sum.noalias() += (l / variances[k]) * l.transpose();
    }
    return sum;
  };
  const Eigen::Matrix3d all = information(0, 1);
  const double least_determinant = kRankDeficient * std::pow(all.trace(), 3);
  for (std::size_t turn = 0; turn < turns; ++turn) {
    const Eigen::Matrix3d others = all - information(turn, turns);
    const bool spans = others.determinant() > least_determinant;
    const Eigen::Matrix3d covariance = others.inverse();
    for (std::size_t k = turn; k < lights; k += turns) {
      const double variance = variances[k] + vector(k).dot(covariance * vector(k));
      sigma[k] = static_cast<float>(spans ? std::sqrt(variance) : kNaN);
    }
  }
}

bool Gain::keeps() const {
  return patches >= kLeastPatches && mean > sigma;
}

BlockChoice Comparison::choice() const {
  std::vector<float> weights;
  for (const Gain& block : blocks) {
    weights.push_back((block.patches < kLeastPatches ? frame : block).keeps() ? 1.0F : 0.0F);
  }
  return {grid, std::move(weights)};
}

Comparison compare(const LeftOut& a, const LeftOut& b) {
  Comparison comparison;
  comparison.grid = a.grid;
  std::vector<double> all;
  for (const std::vector<Pair>& pairs : pairs_of(a, b)) {
    const std::vector<double> means = gains_of(pairs);
    comparison.blocks.push_back(gain_of(means));
    all.insert(all.end(), means.begin(), means.end());
  }
  comparison.frame = gain_of(all);
  return comparison;
}

double jackknife_deg(std::span<const Vec3> normals) {
  if (normals.size() < 2) return kNaN;
  const auto turns = static_cast<double>(normals.size());
  Vec3 mean;
  for (const Vec3& n : normals) mean = mean + (1 / turns) * n;
  double square = 0;
  for (const Vec3& n : normals) square += dot(n - mean, n - mean);
  return degrees(std::sqrt((turns - 1) / turns * square));
}

LeftOutError error_of_light(const LeftOut& left_out, std::size_t light) {
  ErrorGatherer errors(left_out);
  errors.add_light(light);
  return errors.error();
}

LeftOutError error_of_all(const LeftOut& left_out) {
  ErrorGatherer errors(left_out);
  for (std::size_t k = 0; k < left_out.lights; ++k) errors.add_light(k);
  return errors.error();
}

}  // namespace weft::solver
