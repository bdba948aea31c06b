// SPDX-License-Identifier: Apache-2.0
#include "solver/in_double/pixel.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/rig/light_field.h"
#include "solver/in_double/factor.h"
#include "solver/in_double/triples.h"
#include "solver/method.h"

namespace weft::solver {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr int kReweightings = 30;

enum class Use { kFitted, kShadowed, kRejected };

ReadingUse story_of(Use use) {
  switch (use) {
    case Use::kFitted:
      return ReadingUse::kUsed;
    case Use::kShadowed:
      return ReadingUse::kShadowed;
    case Use::kRejected:
      return ReadingUse::kRejected;
  }
  return ReadingUse::kMissing;
}

// One equilibrated reading: x = r / e by plane, and `light` = sum of plane weights times x, which the normal
// is solved from.
struct Reading {
  Vector3d l;
  std::size_t row = 0;  // that it is of
  std::array<double, 3> x = {};
  double light = 0;
  double inverse_strength = 0;  // of plane 0
  Use use = Use::kFitted;
  double variance = 1;  // of `light`, as the last solution predicts it, and what else it is doubted for
};

// What the fitted readings say of a solution.
struct Residuals {
  std::array<Vector3d, 3> b = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};  // of each plane
  std::array<double, 3> plane_square = {};  // sums of the squared residuals
  double square = 0;                        // the same of `light`
  double weights = 0;
  Matrix3d noise = Matrix3d::Zero();   // sum of w^2 v l l^T over the variances v of the noise model
  Vector3d shared = Vector3d::Zero();  // sum of w / e l: what noise that all readings share changes
};

}  // namespace

struct PixelSolver::Work {
  PixelOptions options;
  std::vector<Reading> readings;
  std::vector<WeightedDirection> system;
  std::vector<double> sorted;
  std::vector<std::size_t> fitted;
  double scatter = 0;  // of the readings in `fitted`, over their variances
  std::uint16_t status = 0;
  Factor fit;

  double rho() const { return fit.b.stableNorm(); }
  Vector3d normal() const { return fit.b / rho(); }
  std::size_t planes() const { return static_cast<std::size_t>(options.planes); }
  bool has_noise() const { return planes() == 1 && options.noise.has_value(); }

  // Keeps the rows that can be used at all; says in `status` why others cannot.
  void take_valid(std::span<const PixelRow> rows) {
    readings.clear();
    status = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const PixelRow& row = rows[k];
      bool missing = false, saturated = false, unlit = false;
      Reading r;
      r.l = Vector3d(row.direction.x, row.direction.y, row.direction.z);
      r.row = k;
      r.inverse_strength = 1 / row.strength[0];
      for (std::size_t p = 0; p < planes(); ++p) {
        saturated |= row.reading[p] == kInfinity;
        missing |= std::isnan(row.reading[p]);
        unlit |= !(row.strength[p] > 0) || row.reading[p] == -kInfinity;
        r.x[p] = row.reading[p] / row.strength[p];
        r.light += (planes() == 1 ? 1.0 : options.plane_weights[p]) * r.x[p];
      }
      if (missing) {
        status |= kInvalidReading;
      } else if (saturated) {
        status |= kSaturated;
      } else if (unlit) {
        status |= kShadowed;
      } else {
        readings.push_back(r);
      }
    }
  }

  bool all_dark() const {
    const double sigma = has_noise() ? std::sqrt(options.noise->floor + options.noise->shared) : 0.0;
    return !readings.empty() && std::none_of(readings.begin(), readings.end(), [&](const Reading& r) {
      return r.light > kDarkSigmas * sigma * r.inverse_strength;
    });
  }

  // Leaves out what shadow darkened, unless too little would be left to solve with.
  void leave_out_shadow(std::size_t lights) {
    sorted.clear();
    for (const Reading& r : readings) sorted.push_back(r.light);
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    const auto ranked = [&](int rank) {
      const auto i = static_cast<std::size_t>(rank) - 1;
      return i < sorted.size() ? sorted[i] : -kInfinity;
    };
    const double threshold = std::min(kShadowShare * ranked(bright_rank(lights)), ranked(kLeastKept));
    Matrix3d lit = Matrix3d::Zero();
    for (Reading& r : readings) {
      r.use = r.light >= threshold ? Use::kFitted : Use::kShadowed;
      if (r.use == Use::kFitted) lit += r.l * r.l.transpose();
    }
    if (lit.determinant() > kLeastMaskedDeterminant) return;
    for (Reading& r : readings) r.use = Use::kFitted;
  }

  // Fits what is in use, each reading over its variance, and predicts the variances anew.
  bool solve_fitted() {
    system.clear();
    for (const Reading& r : readings) {
      if (r.use == Use::kFitted) system.push_back({r.l, 1 / r.variance, r.light});
    }
    fit = factorise(system);
    const double solved = fit.path == EquationsSolvedBy::kNothing ? 0 : rho();
    return solved > 0 && std::isfinite(solved);
  }
  void predict_variances() {
    const double model = std::pow(model_share(has_noise()) * rho(), 2);
    for (Reading& r : readings) r.variance = noise_variance(r) + model;
  }
  double noise_variance(const Reading& r) const {
    if (!has_noise()) return 0;
    const double predicted = std::max(0.0, r.l.dot(fit.b)) / r.inverse_strength;
    return options.noise->variance(predicted) * r.inverse_strength * r.inverse_strength;
  }
  bool solve_weighted() {
    predict_variances();
    return solve_fitted();
  }

  std::size_t fitted_count() const { return system.size(); }
  double squared_misfit(const Reading& r) const { return std::pow(r.light - r.l.dot(fit.b), 2) / r.variance; }

  // Shadowed readings that the others predict to be lit, and as bright as they are.
  bool take_back_what_fits() {
    bool any = false;
    for (Reading& r : readings) {
      if (r.use != Use::kShadowed) continue;
      const double predicted = r.l.dot(fit.b), sigma2 = r.variance + r.l.dot(fit.inverse * r.l);
      if (predicted <= kTakenBackFrom * std::sqrt(sigma2) ||
          std::pow(r.light - predicted, 2) > kRejectFrom * sigma2)
        continue;
      r.use = Use::kFitted;
      any = true;
    }
    return any;
  }

  // The reading in use that the others contradict most, or null. Its own share of the scatter is taken out
  // before it is judged (Cook and Weisberg 1982, externally studentised residuals).
  Reading* worst_misfit() {
    const auto n = static_cast<double>(fitted_count());
    if (fitted_count() <= kLeastKept) return nullptr;
    scatter = 0;
    for (const Reading& r : readings) {
      if (r.use == Use::kFitted) scatter += squared_misfit(r);
    }
    Reading* worst = nullptr;
    double most = 0;
    for (Reading& r : readings) {
      if (r.use != Use::kFitted) continue;
      const double freedom = 1 - r.l.dot(fit.inverse * r.l) / r.variance;
      if (!(freedom > kLeastFreedom)) continue;
      const double t2 = squared_misfit(r) / freedom;
      const double others = std::max(0.0, scatter - t2) / (n - 4);
      if (t2 > kRejectFrom * std::max(1.0, others) && t2 > most) {
        most = t2;
        worst = &r;
      }
    }
    return worst;
  }

  bool reject_misfits() {
    for (int i = 0; i < kMostRejected; ++i) {
      Reading* worst = worst_misfit();
      if (worst == nullptr) return true;
      worst->use = Use::kRejected;
      if (!solve_fitted()) return false;
    }
    return true;
  }

  bool asks_for_trimming() {
    scatter = 0;
    fitted.clear();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      if (readings[i].use != Use::kFitted) continue;
      fitted.push_back(i);
      scatter += squared_misfit(readings[i]);
    }
    const std::size_t n = fitted.size();
    return n > kLeastKept && scatter > options.trim_from * static_cast<double>(n - 3);
  }

  // Starts over from the triple of lights that most readings agree with (Rousseeuw 1984, least trimmed
  // squares), if that explains them far better.
  bool start_from_most_consistent() {
    const std::size_t n = fitted.size(), covered = trimmed_count(n);
    double least = kTrimmedShare * scatter;
    std::optional<Vector3d> best;
    for (const Triple& t : triples_of(n)) {
      Matrix3d a;
      Vector3d x;
      for (int i = 0; i < 3; ++i) {
        const Reading& r = readings[fitted[t[static_cast<std::size_t>(i)]]];
        a.row(i) = r.l.transpose();
        x[i] = r.light;
      }
      const double determinant = a.determinant();
      if (!(std::abs(determinant) > kLeastTripleDeterminant)) continue;
      const Vector3d b = a.inverse() * x;
      sorted.clear();
      for (const std::size_t i : fitted) {
        sorted.push_back(std::pow(readings[i].light - readings[i].l.dot(b), 2) / readings[i].variance);
      }
      std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(covered) - 1,
                       sorted.end());
      double sum = 0;
      for (std::size_t i = 0; i < covered; ++i) sum += sorted[i];
      if (sum < least) {
        least = sum;
        best = b;
      }
    }
    if (!best) return true;
    fit.b = *best;
    // The readings that agree, by the scale that the covered ones show.
    const double scale2 = std::max(1.0, least / static_cast<double>(covered - 2));
    sorted.clear();
    for (const std::size_t i : fitted) sorted.push_back(squared_misfit(readings[i]));
    std::vector<double> ranked = sorted;
    std::sort(ranked.begin(), ranked.end());
    const double limit = std::max(kRejectFrom * scale2, ranked[covered - 1]);
    for (std::size_t j = 0; j < n; ++j) {
      if (sorted[j] > limit) readings[fitted[j]].use = Use::kRejected;
    }
    return solve_fitted() && solve_weighted();
  }

  // A highlight adds light, nothing takes any away: what is brighter than predicted is doubted the more the
  // brighter it is.
  bool doubt_highlights() {
    for (int i = 0; i < kDoubtRounds; ++i) {
      predict_variances();
      for (Reading& r : readings) {
        const double excess = r.light - r.l.dot(fit.b) - kDoubtFrom * std::sqrt(r.variance);
        r.variance += kDoubt * std::pow(std::max(0.0, excess), 2);
      }
      if (!solve_fitted()) return false;
    }
    return true;
  }

  double residual(const Reading& r) const { return r.light - r.l.dot(fit.b); }

  // Weights 1 / |r|, smoothed where |r| is under a ten thousandth of the albedo.
  bool solve_least_absolute() {
    for (int i = 0; i < kReweightings; ++i) {
      const double least = 1e-4 * rho();
      for (Reading& r : readings) r.variance = std::max(std::abs(residual(r)), least);
      if (!solve_fitted()) return false;
    }
    return true;
  }

  // Each reading has a sparse error of variance gamma_k beside noise of variance lambda, in units of the
  // albedo: gamma_k <- (gamma w r)^2 + gamma - gamma^2 (w - w^2 l^T (L^T W L)^-1 l), w = 1 / (lambda +
  // gamma).
  bool solve_sparse() {
    constexpr double kLambda = 1e-6;
    const double albedo = rho();
    for (Reading& r : readings) r.variance = kLambda + 1;
    for (int i = 0; i < kReweightings; ++i) {
      if (!solve_fitted()) return false;
      for (Reading& r : readings) {
        const double w = 1 / r.variance, gamma = r.variance - kLambda;
        const double leverage = w * w * r.l.dot(fit.inverse * r.l);
        r.variance = kLambda + std::max(0.0, std::pow(gamma * w * residual(r) / albedo, 2) + gamma -
                                                 gamma * gamma * (w - leverage));
      }
    }
    return solve_fitted();
  }

  bool estimate() {
    if (!solve_fitted()) return false;
    if (options.estimator == Estimator::kLeastSquares) return true;
    if (options.estimator == Estimator::kLeastAbsolute) return solve_least_absolute();
    if (options.estimator == Estimator::kSparse) return solve_sparse();
    if (!solve_weighted()) return false;
    const bool trimming = options.estimator == Estimator::kTrimmed && asks_for_trimming();
    if (trimming && !start_from_most_consistent()) return false;
    if (take_back_what_fits() && !solve_weighted()) return false;
    if (options.estimator == Estimator::kWeighted) return true;
    return trimming ? doubt_highlights() : reject_misfits() && solve_weighted();
  }

  PixelSolution unsolved() const;
  PixelSolution solution();
  Residuals residuals() const;
  void add_sigmas_of_noise(const Residuals& sums, PixelSolution& s) const;
  void add_sigmas_of_scatter(const Residuals& sums, PixelSolution& s) const;
  int mark_readings();
};

// The best albedo for a normal of (0, 0, 1).
PixelSolution PixelSolver::Work::unsolved() const {
  PixelSolution s;
  s.status = status | kNoSolution;
  double weight = 0;
  for (const Reading& r : readings) weight += r.l.z() * r.l.z();
  if (!(weight > 0)) return s;
  for (std::size_t p = 0; p < planes(); ++p) {
    double sum = 0, variance = 0;
    for (const Reading& r : readings) {
      sum += r.l.z() * r.x[p];
      if (has_noise()) {
        variance +=
            std::pow(r.l.z() * r.inverse_strength, 2) * options.noise->variance(r.x[p] / r.inverse_strength);
      }
    }
    s.albedo[p] = std::max(0.0, sum / weight);
    s.sigma_albedo[p] = has_noise() ? std::sqrt(variance) / weight : s.albedo[p];
  }
  return s;
}

Residuals PixelSolver::Work::residuals() const {
  const bool weighted = options.estimator != Estimator::kLeastSquares;
  Residuals sums;
  for (const Reading& r : readings) {
    if (r.use != Use::kFitted) continue;
    const double w = weighted ? 1 / r.variance : 1;
    sums.weights += w;
    sums.square += std::pow(r.light - r.l.dot(fit.b), 2);
    if (has_noise()) {
      sums.noise += w * w * noise_variance(r) * r.l * r.l.transpose();
      sums.shared += w * r.inverse_strength * r.l;
    }
    for (std::size_t p = 0; p < planes(); ++p) sums.b[p] += w * r.x[p] * (fit.inverse * r.l);
  }
  for (const Reading& r : readings) {
    if (r.use != Use::kFitted) continue;
    for (std::size_t p = 0; p < planes(); ++p)
      sums.plane_square[p] += std::pow(r.x[p] - r.l.dot(sums.b[p]), 2);
  }
  return sums;
}

// From the covariance C = G^-1 (sum w^2 v l l^T) G^-1.
void PixelSolver::Work::add_sigmas_of_noise(const Residuals& sums, PixelSolution& s) const {
  const Vector3d n = normal();
  Matrix3d m = sums.noise;
  m += options.noise->shared * sums.shared * sums.shared.transpose();
  const Matrix3d c = fit.inverse * m * fit.inverse;
  const double along = std::max(0.0, n.dot(c * n)), across = std::max(0.0, c.trace() - n.dot(c * n));
  s.sigma_normal_deg = degrees(std::sqrt(across) / rho());
  s.sigma_albedo[0] = std::sqrt(along);
}

void PixelSolver::Work::add_sigmas_of_scatter(const Residuals& sums, PixelSolution& s) const {
  const Vector3d n = normal();
  const auto count = static_cast<double>(fitted_count());
  const double freedom = count - 3;
  // Without a noise model all weights are alike, and the inverse is that of their sum.
  const Matrix3d unit = fit.inverse * (sums.weights / count);
  const double along = std::max(0.0, n.dot(unit * n)), across = std::max(0.0, unit.trace() - n.dot(unit * n));
  s.sigma_normal_deg =
      freedom > 0 ? degrees(std::sqrt(sums.square / freedom * across) / rho()) : kUnknownAngleDeg;
  for (std::size_t p = 0; p < planes(); ++p)
    s.sigma_albedo[p] = freedom > 0 ? std::sqrt(sums.plane_square[p] / freedom * along) : s.albedo[p];
}

// Says in `status` what became of the readings. Returns how many were rejected.
int PixelSolver::Work::mark_readings() {
  const double margin = kSpecularMargin * rho();
  int rejected = 0;
  for (const Reading& r : readings) {
    if (r.use == Use::kShadowed) {
      status |= kShadowed;
      continue;
    }
    rejected += r.use == Use::kRejected;
    const double predicted = std::max(0.0, r.l.dot(fit.b));
    const double sigma = std::sqrt(noise_variance(r));
    if (r.light > kSpecularTimes * predicted + kSpecularSigmas * sigma + margin) status |= kSpecular;
  }
  if (fitted_count() == 3) status |= kZeroDof;
  return rejected;
}

PixelSolution PixelSolver::Work::solution() {
  const Vector3d n = normal();
  const Residuals sums = residuals();
  PixelSolution s;
  s.path = fit.path;
  s.normal = {n.x(), n.y(), n.z()};
  s.residual = std::sqrt(sums.square / static_cast<double>(fitted_count())) / rho();
  for (std::size_t p = 0; p < planes(); ++p)
    s.albedo[p] = planes() == 1 ? rho() : std::max(0.0, n.dot(sums.b[p]));
  has_noise() ? add_sigmas_of_noise(sums, s) : add_sigmas_of_scatter(sums, s);
  s.sigma_normal_deg = std::min(s.sigma_normal_deg, double{kUnknownAngleDeg});
  s.rejected = mark_readings();
  s.status = status;
  return s;
}

PixelSolver::PixelSolver(const PixelOptions& options) : work_(std::make_unique<Work>()) {
  work_->options = options;
}
PixelSolver::~PixelSolver() = default;
PixelSolver::PixelSolver(PixelSolver&&) noexcept = default;

PixelSolution PixelSolver::solve(std::span<const PixelRow> rows) {
  Work& w = *work_;
  w.take_valid(rows);
  if (w.all_dark()) w.status |= kDark;
  if (w.options.shadow_mask) w.leave_out_shadow(rows.size());
  if (!w.estimate()) return w.unsolved();
  if (w.fit.condition >= kIllConditionedFrom) w.status |= kIllConditioned;
  return w.solution();
}

PixelSolution PixelSolver::explain(std::span<const PixelRow> rows, std::span<ReadingStory> stories) {
  const PixelSolution solution = solve(rows);
  const Work& w = *work_;
  const bool is_solved = solution.path != EquationsSolvedBy::kNothing;
  const Vector3d b = is_solved ? w.fit.b : Vector3d::Zero();
  const double model2 = std::pow(model_share(w.has_noise()) * b.norm(), 2);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const PixelRow& row = rows[k];
    const double strength = w.planes() == 1 ? row.strength[0] : 1;
    const Vector3d l(row.direction.x, row.direction.y, row.direction.z);
    ReadingStory& story = stories[k];
    story = {.use = ReadingUse::kShadowed, .predicted = strength * std::max(0.0, l.dot(b))};
    for (std::size_t p = 0; p < w.planes(); ++p) {
      if (row.reading[p] == kInfinity) story.use = ReadingUse::kSaturated;
      if (std::isnan(row.reading[p])) story.use = ReadingUse::kMissing;
      story.reading +=
          w.planes() == 1 ? row.reading[p] : w.options.plane_weights[p] * row.reading[p] / row.strength[p];
    }
    if (!std::isfinite(story.reading)) story.reading = std::numeric_limits<double>::quiet_NaN();
  }
  for (const Reading& r : w.readings) {
    ReadingStory& story = stories[r.row];
    const double strength = w.planes() == 1 ? 1 / r.inverse_strength : 1;
    story.use = story_of(r.use);
    story.sigma = is_solved ? strength * std::sqrt(w.noise_variance(r) + model2) : 0;
  }
  return solution;
}

PixelOptions pixel_options_of(std::string_view method) {
  if (method == "seed" || method == "least-squares" || method == "preview") return {};
  PixelOptions options;
  options.shadow_mask = method != "l1" && method != "sbl";
  if (method == "l1") options.estimator = Estimator::kLeastAbsolute;
  if (method == "sbl") options.estimator = Estimator::kSparse;
  if (method == "wls") options.estimator = Estimator::kWeighted;
  if (method == "standard") options.estimator = Estimator::kRejecting;
  if (method == "robust" || method == "reference" || method == "lts") options.estimator = Estimator::kTrimmed;
  if (method == "lts") options.trim_from = 0;
  return options;
}

PixelSolution solve_pixel(std::span<const PixelRow> rows, const PixelOptions& options) {
  return PixelSolver(options).solve(rows);
}

}  // namespace weft::solver
