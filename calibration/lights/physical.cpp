// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/physical.h"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "calibration/lights/light_parameters.h"
#include "calibration/lights/reading_cost.h"
#include "calibration/lights/student.h"

namespace weft::calibration {
namespace {

constexpr std::size_t kFewestReadings = 30;
constexpr double kGainsFrom = 3;          // times what the cost falls by where LEDs have no gains
constexpr double kGainsFromShare = 0.05;  // of the cost
constexpr std::size_t kPatches = 12;      // of a sheet, 4 x 3 of the frame
constexpr double kSettled = 0.3;          // sigmas that one more step may change a parameter by
constexpr double kFlickerCounts = 0.1;    // shots that the flicker that was expected counts for
constexpr double kToldFrom = 1e-3;        // of a shot's light: by readings, not by the prior
constexpr int kFlickerRounds = 20;
constexpr double kFarReach = 1e8;   // valleys are long and nearly straight: begin with Gauss-Newton
constexpr double kNear = 1e-5;      // share of the cost that a stage's last step takes away
constexpr double kThere = 1e-8;     // and the last stage's
constexpr double kCapFlicker = 2;   // times what was expected: where LEDs have gains it runs away
constexpr double kHuberFrom = 3.5;  // of the length of three residuals, which 99 percent stay below

Error cannot_fit(std::string where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "lights cannot be fitted", std::move(where), std::move(why),
          std::move(remedy)};
}

class Fit {
 public:
  Fit(const PaperScene& start, std::span<const PaperReading> readings, const LightFitOptions& options)
      : start_(start), readings_(readings), options_(options) {}

  Result<LightFit> run() {
    if (Result<void> ok = check(); !ok) return std::move(ok).error();
    if (Result<void> ok = begin(); !ok) return std::move(ok).error();
    add_readings();
    add_priors();
    solve();
    measure_misfit();
    find_covariance();
    settle();
    if (Result<void> ok = check_leds(); !ok) return std::move(ok).error();
    return std::move(fit_);
  }

 private:
  Result<void> check() const;
  Result<void> begin();
  void add_readings();
  void add_priors();
  void expect_flicker(double sigma);
  void solve();
  void minimise(double tolerance);
  void take_steps(double tolerance);
  void begin_again();
  void free_lobes();
  void find_flicker();
  bool leds_have_gains();
  void measure_misfit();
  Eigen::MatrixXd inverse_of_normal_matrix() const;
  void find_other_shot(const Eigen::MatrixXd& sigma);
  void find_covariance();
  void settle();
  Result<void> check_leds() const;
  void find_normal_matrix();
  std::size_t patch_of(const PaperReading& reading) const;
  double likeness_of_neighbours(const Eigen::MatrixXd& sigma);
  double& shot(std::size_t sheet, std::size_t led) { return p_.shots[sheet * p_.leds.size() + led]; }
  std::vector<double*> blocks();
  std::vector<double*> shot_blocks();
  static ceres::Problem::Options shared_loss() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  const PaperScene& start_;
  std::span<const PaperReading> readings_;
  const LightFitOptions& options_;
  std::vector<std::array<double, 3>> sigmas_;  // of the readings
  Parameters p_, tape_;                        // as they are, and as the fit began
  double reach_ = kFarReach;                   // of steps, in Ceres's measure
  ceres::LossFunctionWrapper loss_{nullptr, ceres::TAKE_OWNERSHIP};
  ceres::Problem problem_{shared_loss()};
  std::vector<ceres::ResidualBlockId> reading_blocks_, prior_blocks_;
  ceres::ResidualBlockId flicker_prior_ = nullptr;
  Eigen::MatrixXd normal_;  // lower half
  Eigen::VectorXd gradient_;
  std::vector<Eigen::VectorXd> pull_;  // share of the gradient, by patch
  std::map<const double*, Eigen::Index> begin_;
  LightFit fit_;
};

Result<void> Fit::check() const {
  std::vector<std::size_t> of_led(start_.lights.leds.size());
  for (const PaperReading& r : readings_) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(r.reading_rgb[c] > 0 && std::isfinite(r.reading_rgb[c]) && r.relative_sigma[c] >= 0 &&
            r.relative_sigma[c] + options_.unevenness + options_.flatness_deg > 0)) {
        return cannot_fit(
            fmt::format("LED {}, sheet {}, pixel ({:.0f}, {:.0f})", r.led + 1, r.sheet + 1, r.x_px, r.y_px),
            fmt::format("its average is {:.3g} with a relative error of {:.3g}", r.reading_rgb[c],
                        r.relative_sigma[c]),
            "leave out blocks that are not lit");
      }
    }
    ++of_led[r.led];
  }
  for (std::size_t k = 0; k < of_led.size(); ++k) {
    if (of_led[k] >= kFewestReadings) continue;
    return cannot_fit(
        fmt::format("LED {}", k + 1),
        fmt::format("{} blocks of paper are lit by it, {} are needed", of_led[k], kFewestReadings),
        "photograph a larger sheet, or look whether the LED lights");
  }
  return {};
}

// Lights where the tape says, each with the flux that suits its readings best.
Result<void> Fit::begin() {
  p_.sheets.resize(start_.sheets.size());
  for (auto& spline : p_.splines)
    spline.resize(static_cast<std::size_t>(options_.spline_columns) *
                  static_cast<std::size_t>(options_.spline_rows));
  std::vector<double> count(start_.lights.leds.size());
  for (const NearLight& led : start_.lights.leds) {
    LedParameters& p = p_.leds.emplace_back();
    p.position_mm = array_of(led.position_mm);
    p.aim = array_of(normalized(led.aim));
    p.mu = led.mu;
    p.log_flux = {};
  }
  for (const PaperReading& r : readings_) {
    const auto term = paper_term(sight_of(start_.camera, r.x_px, r.y_px), start_.lights.leds[r.led],
                                 start_.paper, start_.sheets[r.sheet].rig_from_sheet);
    const auto sigma = sigma_of(start_, r, options_);
    if (!term || !sigma) {
      return cannot_fit(fmt::format("LED {}, sheet {}", r.led + 1, r.sheet + 1),
                        "where the rig file has it, it does not light the sheet at all",
                        "correct the LED's position and aim in rig.toml, or the tags in sheet.toml");
    }
    sigmas_.push_back(*sigma);
    ++count[r.led];
    for (std::size_t c = 0; c < 3; ++c)
      p_.leds[r.led].log_flux[c] +=
          std::log(r.reading_rgb[c] / start_.paper.reflectance_rgb[c]) - term->log_value;
  }
  for (std::size_t k = 0; k < count.size(); ++k) {
    for (double& flux : p_.leds[k].log_flux) flux /= count[k];
  }
  p_.shots.resize(p_.sheets.size() * p_.leds.size());
  p_.paper[5] = options_.lambertian ? 0 : start_.paper.delta;
  tape_ = p_;
  return {};
}

void Fit::add_readings() {
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const PaperReading& r = readings_[i];
    LedParameters& led = p_.leds[r.led];
    reading_blocks_.push_back(problem_.AddResidualBlock(
        new ReadingCost(start_, r, sigmas_[i], options_), &loss_,
        std::vector<double*>{led.position_mm.data(), led.aim.data(), &led.mu, led.log_flux.data(),
                             led.quadratic.data(), p_.splines[0].data(), p_.splines[1].data(),
                             p_.splines[2].data(), p_.paper.data(), p_.sheets[r.sheet].data(),
                             &shot(r.sheet, r.led)}));
  }
  for (LedParameters& led : p_.leds) {
    problem_.SetManifold(led.aim.data(), new ceres::SphereManifold<3>());
  }
  if (options_.lambertian) problem_.SetManifold(p_.paper.data(), new ceres::SubsetManifold(6, {5}));
}

void Fit::add_priors() {
  const auto add = [&](ceres::CostFunction* cost, std::vector<double*> at) {
    prior_blocks_.push_back(problem_.AddResidualBlock(cost, nullptr, at));
  };
  constexpr std::array<double, kOwnGains> kNone = {};
  for (LedParameters& led : p_.leds) {
    add(prior(led.position_mm, options_.position_sigma_mm), {led.position_mm.data()});
    add(prior(led.aim, radians(options_.aim_sigma_deg)), {led.aim.data()});
    add(prior({&led.mu, 1}, options_.mu_sigma), {&led.mu});
    add(prior(kNone, options_.quadratic_sigma), {led.quadratic.data()});
  }
  // What all LEDs have in common belongs to the shared gain, and its mean to the fluxes. No reading
  // contradicts these gauges; were they tighter they would slow the steps of Levenberg-Marquardt.
  constexpr double kGauge = 1e-3;
  const auto n = static_cast<Eigen::Index>(p_.leds.size() * kOwnGains);
  RowMatrix sum(static_cast<Eigen::Index>(kOwnGains), n);
  for (Eigen::Index i = 0; i < n; ++i)
    sum.col(i) =
        Eigen::VectorXd::Unit(sum.rows(), i % sum.rows()) / (kGauge * static_cast<double>(p_.leds.size()));
  std::vector<double*> quadratics;
  for (LedParameters& led : p_.leds) quadratics.push_back(led.quadratic.data());
  add(new LinearPrior(sum, Eigen::VectorXd::Zero(n),
                      std::vector<int>(p_.leds.size(), static_cast<int>(kOwnGains))),
      quadratics);
  const std::vector<double> mean = mean_basis(options_);
  const auto coefficients = static_cast<Eigen::Index>(mean.size());
  for (auto& spline : p_.splines) {
    add(prior(spline, options_.spline_sigma), {spline.data()});
    add(new LinearPrior(third_differences(options_) / options_.spline_bend_sigma,
                        Eigen::VectorXd::Zero(coefficients), {static_cast<int>(coefficients)}),
        {spline.data()});
    add(new LinearPrior(Eigen::Map<const RowMatrix>(mean.data(), 1, coefficients) / kGauge,
                        Eigen::VectorXd::Zero(coefficients), {static_cast<int>(coefficients)}),
        {spline.data()});
  }
  RowMatrix widths = RowMatrix::Identity(6, 6) / options_.log_albedo_sigma;
  widths(5, 5) = 1 / options_.delta_sigma;
  add(new LinearPrior(widths, Eigen::VectorXd::Zero(6), {6}), {p_.paper.data()});
  for (std::size_t j = 0; j < p_.sheets.size(); ++j) {
    add(new LinearPrior(whitening(start_.sheets[j]), Eigen::VectorXd::Zero(6), {6}), {p_.sheets[j].data()});
  }
  expect_flicker(options_.flicker);
}

void Fit::expect_flicker(double sigma) {
  if (flicker_prior_ != nullptr) {
    problem_.RemoveResidualBlock(flicker_prior_);
    std::erase(prior_blocks_, flicker_prior_);
  }
  const std::vector<double*> shots = shot_blocks();
  const auto n = static_cast<Eigen::Index>(shots.size());
  flicker_prior_ =
      problem_.AddResidualBlock(new LinearPrior(RowMatrix::Identity(n, n) / sigma, Eigen::VectorXd::Zero(n),
                                                std::vector<int>(shots.size(), 1)),
                                nullptr, shots);
  prior_blocks_.push_back(flicker_prior_);
  fit_.flicker = sigma;
}

// From a tape ten millimetres wrong every reading looks like an outlier: plain squares lead near, Huber's
// loss to the end. LEDs get gains of their own only where the readings ask for them, as those take away most
// of what tells how far a LED is. A fit with gains begins at the tape again: where one without them came to
// lie is far off along a bent valley, and the way back takes hundreds of steps.
void Fit::solve() {
  const auto hold_gains = [&](bool hold) {
    for (LedParameters& led : p_.leds) {
      double* gains = led.quadratic.data();
      hold ? problem_.SetParameterBlockConstant(gains) : problem_.SetParameterBlockVariable(gains);
    }
  };
  hold_gains(true);
  minimise(kNear);
  loss_.Reset(new ceres::HuberLoss(kHuberFrom), ceres::TAKE_OWNERSHIP);
  minimise(kNear);
  find_flicker();
  minimise(kNear);
  hold_gains(false);
  fit_.leds_have_gains = leds_have_gains();
  if (fit_.leds_have_gains) {
    begin_again();
    minimise(kNear);
    find_flicker();  // of which gains had been a part
  } else {
    hold_gains(true);
  }
  minimise(kThere);
  free_lobes();
}

void Fit::begin_again() {
  p_ = tape_;
  reach_ = kFarReach;
  free_lobes();
}

void Fit::free_lobes() {
  for (LedParameters& led : p_.leds) problem_.SetParameterBlockVariable(&led.mu);
}

// The flicker under which the shots' gains are as large as they were found, each counted by how far readings
// rather than the prior tell it (the evidence's maximum, MacKay 1992). Nothing but the prior's width changes,
// so all is linear; where no reading tells a gain, what was expected stays.
void Fit::find_flicker() {
  find_normal_matrix();
  const Eigen::MatrixXd sigma = inverse_of_normal_matrix();
  const Eigen::VectorXd step = -sigma * gradient_;
  const std::vector<double*> shots = shot_blocks();
  const auto n = static_cast<Eigen::Index>(shots.size());
  const Eigen::Index first = begin_[shots.front()];
  Eigen::VectorXd gains = step.segment(first, n);
  for (Eigen::Index i = 0; i < n; ++i) gains[i] += *shots[static_cast<std::size_t>(i)];
  const double expected = std::pow(options_.flicker, 2), was = std::pow(fit_.flicker, 2);
  const Eigen::MatrixXd known = sigma.block(first, first, n, n).inverse();
  const Eigen::MatrixXd by_readings = known - Eigen::MatrixXd::Identity(n, n) / was;
  const Eigen::VectorXd pull = known * gains;
  double variance = was;
  for (int i = 0; i < kFlickerRounds; ++i) {
    const Eigen::MatrixXd covariance = (by_readings + Eigen::MatrixXd::Identity(n, n) / variance).inverse();
    const double told = static_cast<double>(n) - covariance.trace() / variance;
    variance = (kFlickerCounts * expected + (covariance * pull).squaredNorm()) / (kFlickerCounts + told);
  }
  fit_.flickers_too_much = variance > std::pow(kMostFlicker, 2) * expected;
  expect_flicker(std::sqrt(std::min(variance, kCapFlicker * kCapFlicker * expected)));
}

// A lobe is no flatter than none. Ceres keeps to bounds by shortening whole steps, which crawls where one
// holds; so all lobes are free, and those that end below 0 are held there.
void Fit::minimise(double tolerance) {
  for (bool again = true; again;) {
    take_steps(tolerance);
    again = false;
    for (LedParameters& led : p_.leds) {
      if (led.mu >= 0) continue;
      led.mu = 0;
      problem_.SetParameterBlockConstant(&led.mu);
      again = true;
    }
  }
}

void Fit::take_steps(double tolerance) {
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  how.max_num_iterations = options_.most_iterations;
  how.initial_trust_region_radius = reach_;
  how.function_tolerance = tolerance;
  how.parameter_tolerance = 1e-9;
  how.num_threads = options_.threads;
  how.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem_, &summary);
  fit_.iterations += static_cast<int>(summary.iterations.size()) - 1;
  reach_ = std::clamp(summary.iterations.back().trust_region_radius, 1.0, kFarReach);
  fit_.settled = summary.IsSolutionUsable();
}

// By the score test: whether freeing all gains would lower the cost by far more than so many idle parameters
// do, and by a share that is worth it where residuals are not random.
bool Fit::leds_have_gains() {
  find_normal_matrix();
  const double expected = static_cast<double>(kOwnGains * p_.leds.size());
  const double drop = gradient_.dot(normal_.selfadjointView<Eigen::Lower>().ldlt().solve(gradient_));
  double cost = 0;
  problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  const double chi_square = 2 * cost / (3 * static_cast<double>(readings_.size()));
  return drop > kGainsFrom * expected * std::max(1.0, chi_square) && drop > kGainsFromShare * 2 * cost;
}

void Fit::measure_misfit() {
  const auto cost_of = [&](const std::vector<ceres::ResidualBlockId>& which, std::vector<double>* residuals) {
    ceres::Problem::EvaluateOptions plain;
    plain.residual_blocks = which;
    plain.apply_loss_function = false;
    double cost = 0;
    problem_.Evaluate(plain, &cost, residuals, nullptr, nullptr);
    return 2 * cost;
  };
  std::vector<double> residuals;
  const double readings = cost_of(reading_blocks_, &residuals), priors = cost_of(prior_blocks_, nullptr);
  const double prior_rows = problem_.NumResiduals() - 3.0 * static_cast<double>(readings_.size());
  double free = 0;
  for (double* block : blocks()) {
    if (!problem_.IsParameterBlockConstant(block)) free += problem_.ParameterBlockTangentSize(block);
  }
  fit_.degrees_of_freedom = 3.0 * static_cast<double>(readings_.size()) + prior_rows - free;
  fit_.chi_square = (readings + priors) / fit_.degrees_of_freedom;
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    std::array<double, 3>& of = fit_.residuals.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) of[c] = -residuals[3 * i + c] * sigmas_[i][c];
  }
}

// In the order of Parameters: Ceres lists them by address, which changes sums from run to run.
std::vector<double*> Fit::blocks() {
  std::vector<double*> all;
  for (LedParameters& led : p_.leds) {
    for (double* block :
         {led.position_mm.data(), led.aim.data(), &led.mu, led.log_flux.data(), led.quadratic.data()})
      all.push_back(block);
  }
  for (auto& spline : p_.splines) all.push_back(spline.data());
  all.push_back(p_.paper.data());
  for (auto& sheet : p_.sheets) all.push_back(sheet.data());
  std::erase_if(all, [&](const double* block) { return !problem_.HasParameterBlock(block); });
  const std::vector<double*> shots = shot_blocks();
  all.insert(all.end(), shots.begin(), shots.end());
  return all;
}

std::vector<double*> Fit::shot_blocks() {
  std::vector<double*> shots;
  for (double& shot : p_.shots) {
    if (problem_.HasParameterBlock(&shot)) shots.push_back(&shot);
  }
  return shots;
}

// Finds the matrix of all that is free, each block in the tangent of its manifold, and where each begins.
void Fit::find_normal_matrix() {
  ceres::Problem::EvaluateOptions all;
  begin_.clear();
  Eigen::Index size = 0;
  for (double* block : blocks()) {
    if (problem_.IsParameterBlockConstant(block)) continue;
    all.parameter_blocks.push_back(block);
    begin_[block] = size;
    size += problem_.ParameterBlockTangentSize(block);
  }
  all.residual_blocks = reading_blocks_;
  all.residual_blocks.insert(all.residual_blocks.end(), prior_blocks_.begin(), prior_blocks_.end());
  ceres::CRSMatrix jacobian;
  std::vector<double> gradient, residuals;
  problem_.Evaluate(all, nullptr, &residuals, &gradient, &jacobian);
  pull_.assign(start_.sheets.size() * kPatches, Eigen::VectorXd::Zero(size));
  gradient_ = Eigen::Map<const Eigen::VectorXd>(gradient.data(), size);
  normal_ = Eigen::MatrixXd::Zero(size, size);
  for (int row = 0; row < jacobian.num_rows; ++row) {
    const auto begin = static_cast<std::size_t>(jacobian.rows[static_cast<std::size_t>(row)]);
    const auto end = static_cast<std::size_t>(jacobian.rows[static_cast<std::size_t>(row) + 1]);
    for (std::size_t i = begin; i < end; ++i) {
      if (jacobian.values[i] == 0) continue;
      for (std::size_t j = begin; j <= i; ++j)
        normal_(jacobian.cols[i], jacobian.cols[j]) += jacobian.values[i] * jacobian.values[j];
    }
    const auto reading = static_cast<std::size_t>(row) / 3;
    if (reading >= readings_.size()) continue;
    Eigen::VectorXd& pull = pull_[patch_of(readings_[reading])];
    for (std::size_t i = begin; i < end; ++i)
      pull[jacobian.cols[i]] += residuals[static_cast<std::size_t>(row)] * jacobian.values[i];
  }
}

// Sheets in patches that are larger than waves of paper.
std::size_t Fit::patch_of(const PaperReading& r) const {
  const auto place = [](double at, int pixels, std::size_t count) {
    return std::min(static_cast<std::size_t>(std::max(at, 0.0) / pixels * static_cast<double>(count)),
                    count - 1);
  };
  const Size frame = start_.camera.size;
  return r.sheet * kPatches + place(r.y_px, frame.height, 3) * 4 + place(r.x_px, frame.width, 4);
}

// How many times larger the variance of positions is than residuals of independent noise would make it: by
// the variance that is robust to whatever residuals of one patch have in common (Liang and Zeger 1986).
double Fit::likeness_of_neighbours(const Eigen::MatrixXd& sigma) {
  double sum = 0, count = 0;
  for (const LedParameters& led : p_.leds) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Eigen::Index at = begin_[led.position_mm.data()] + axis;
      double variance = 0;
      for (const Eigen::VectorXd& pull : pull_) variance += std::pow(sigma.row(at).dot(pull), 2);
      sum += variance / sigma(at, at);
      ++count;
    }
  }
  return sum / count;
}

Eigen::MatrixXd Fit::inverse_of_normal_matrix() const {
  const Eigen::Index size = normal_.rows();
  const Eigen::VectorXd scale = normal_.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal_ * scale.asDiagonal();
  const Eigen::MatrixXd inverse =
      scaled.selfadjointView<Eigen::Lower>().ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  return scale.asDiagonal() * (0.5 * (inverse + inverse.transpose())) * scale.asDiagonal();
}

// Each shot against what all others say of it. Where readings tell a share `told` of a gain and the prior the
// rest, readings alone say 1 / told times what was found, and gains of mere flicker scatter by the root of
// told. Sigmas are those of a normal as rare as Student's residual: of few shots a large one is not rare.
void Fit::find_other_shot(const Eigen::MatrixXd& sigma) {
  const double variance = fit_.flicker * fit_.flicker;
  const auto told_of = [&](double* shot) {
    const Eigen::Index at = begin_.at(shot);
    return 1 - sigma(at, at) / variance;
  };
  double freedom = 0;
  for (double* shot : shot_blocks()) freedom += told_of(shot);
  double worst = kOtherShotFrom_sigmas;
  for (std::size_t j = 0; j < p_.sheets.size(); ++j) {
    for (std::size_t k = 0; k < p_.leds.size(); ++k) {
      double* gain = &shot(j, k);
      const double told = begin_.contains(gain) ? told_of(gain) : 0;
      if (!(told > kToldFrom && freedom > 1)) continue;
      const double square = *gain * *gain / (told * variance);
      const double sigmas =
          square < freedom ? normal_as_rare(square, freedom) : std::numeric_limits<double>::infinity();
      if (sigmas <= worst || std::abs(*gain / told) <= kOtherShotFrom * options_.flicker) continue;
      worst = sigmas;
      fit_.other_shot = {j, k, *gain / told};
    }
  }
}

void Fit::find_covariance() {
  find_normal_matrix();
  Eigen::MatrixXd sigma = inverse_of_normal_matrix();
  const Eigen::Index size = sigma.rows();
  if (p_.sheets.size() > 2) find_other_shot(sigma);  // of two shots neither is the other one
  for (LedParameters& led : p_.leds) {  // what is held at its bound would not follow a step below it
    double& along = gradient_[begin_[&led.mu]];
    if (led.mu == 0) along = std::min(along, 0.0);
  }
  fit_.inflation = std::max({1.0, fit_.chi_square, likeness_of_neighbours(sigma)});
  sigma *= fit_.inflation;
  // Newton's decrement bounds what a step changes, in sigmas of whatever parameter.
  fit_.settled = fit_.settled && gradient_.dot(sigma * gradient_) <= std::pow(kSettled * fit_.inflation, 2);

  std::vector<Named> named;
  const auto name = [&](std::string text, const double* block, Eigen::VectorXd of_block) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
    row.segment(begin_[block], of_block.size()) = of_block;
    named.push_back({std::move(text), std::move(row)});
  };
  for (std::size_t k = 0; k < p_.leds.size(); ++k) {
    const LedParameters& led = p_.leds[k];
    const std::string prefix = fmt::format("led{:02}.", k + 1);
    for (int i = 0; i < 3; ++i)
      name(prefix + "position_mm." + "xyz"[i], led.position_mm.data(), Eigen::Vector3d::Unit(i));
    RowMatrix ambient_from_tangent(3, 2);
    ceres::SphereManifold<3>().PlusJacobian(led.aim.data(), ambient_from_tangent.data());
    for (int i = 0; i < 3; ++i) name(prefix + "aim." + "xyz"[i], led.aim.data(), ambient_from_tangent.row(i));
    name(prefix + "mu", &led.mu, Eigen::VectorXd::Ones(1));
    name(prefix + "log_flux", led.log_flux.data(), Eigen::Vector3d::Constant(1.0 / 3));
    for (int i = 0; fit_.leds_have_gains && i < static_cast<int>(kOwnGains); ++i)
      name(prefix + fmt::format("log_gain_quadratic.{}", i + 1), led.quadratic.data(),
           Eigen::VectorXd::Unit(static_cast<Eigen::Index>(kOwnGains), i));
  }
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(named.size()), size);
  for (std::size_t i = 0; i < named.size(); ++i) {
    fit_.covariance.parameters.push_back(named[i].name);
    rows.row(static_cast<Eigen::Index>(i)) = named[i].row;
  }
  const RowMatrix covariance = rows * sigma * rows.transpose();
  fit_.covariance.matrix.assign(covariance.data(), covariance.data() + covariance.size());

  for (const LedParameters& led : p_.leds) {
    const Eigen::Index at = begin_[led.position_mm.data()];
    fit_.position_sigma_mm.push_back(
        {std::sqrt(sigma(at, at)), std::sqrt(sigma(at + 1, at + 1)), std::sqrt(sigma(at + 2, at + 2))});
  }
  if (!options_.lambertian) {
    const Eigen::Index delta = begin_[p_.paper.data()] + 5;
    fit_.delta_sigma = std::sqrt(sigma(delta, delta));
  }
}

// Writes the scene, and gives the last of the shared gain's mean to the fluxes.
void Fit::settle() {
  fit_.scene = start_;
  fit_.sheets_before = start_.sheets;
  const std::vector<double> mean = mean_basis(options_);
  for (std::size_t c = 0; c < 3; ++c) {
    const double constant = std::inner_product(mean.begin(), mean.end(), p_.splines[c].begin(), 0.0);
    for (double& coefficient : p_.splines[c]) coefficient -= constant;
    for (LedParameters& led : p_.leds) led.log_flux[c] += constant;
    fit_.scene.lights.log_gain_rgb[c] = {options_.spline_columns, options_.spline_rows, p_.splines[c]};
  }
  for (std::size_t k = 0; k < p_.leds.size(); ++k) fit_.scene.lights.leds[k] = led_of(p_.leds[k]);
  std::copy_n(p_.paper.begin(), 5, fit_.scene.paper.log_albedo.begin());
  fit_.scene.paper.delta = p_.paper[5];
  fit_.scene.shot_log_gains.resize(p_.sheets.size());
  for (std::size_t j = 0; j < p_.sheets.size(); ++j) {
    fit_.scene.sheets[j].rig_from_sheet = pose_of(start_.sheets[j].rig_from_sheet, p_.sheets[j].data());
    for (std::size_t k = 0; k < p_.leds.size(); ++k) fit_.scene.shot_log_gains[j].push_back(shot(j, k));
  }
}

// Where LEDs come to lie says nothing where readings contradict each other.
Result<void> Fit::check_leds() const {
  if (fit_.misfits()) return {};
  for (std::size_t k = 0; k < p_.leds.size(); ++k) {
    const Vec3 off = fit_.scene.lights.leds[k].position_mm - start_.lights.leds[k].position_mm;
    if (length(off) <= kAstrayFrom_sigmas * options_.position_sigma_mm) continue;
    return cannot_fit(fmt::format("LED {}", k + 1),
                      fmt::format("the paper places it {:.0f} mm from where rig.toml has it", length(off)),
                      "measure its position again, and look whether two LEDs are exchanged");
  }
  return {};
}

}  // namespace

double LightFit::worst_position_sigma_mm() const {
  double worst = 0;
  for (const Vec3& s : position_sigma_mm) worst = std::max({worst, s.x, s.y, s.z});
  return worst;
}

Result<LightFit> fit_lights(const PaperScene& start, std::span<const PaperReading> readings,
                            const LightFitOptions& options) {
  return Fit(start, readings, options).run();
}

}  // namespace weft::calibration
