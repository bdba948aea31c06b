// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/led_gains.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "solve/conditions/drift.h"
#include "solve/correction/leave_out_lights.h"
#include "solve/photographs/tile_reader.h"
#include "solver/in_double/pixel.h"
#include "solver/in_double/pixelwise.h"
#include "solver/method.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSampleStep = 5;  // columns and lines, odd: photosites of every colour
constexpr std::size_t kFewestLights = 6, kFewestPixels = 500;
constexpr double kLitFrom = 0.25;  // of the third brightest reading
constexpr int kRounds = 4;
constexpr int kQuarters = 4;
constexpr double kUnknownFrom = 0.9;  // of the prior: such a gain was told by no pixel

// The lit readings of one photosite.
struct SamplePixel {
  int quarter = 0;  // of the frame
  std::vector<std::size_t> light;
  MatrixXd direction;    // a row each
  VectorXd x, variance;  // reading over strength
};

std::vector<SamplePixel> read_pixels(const Photographs& photographs, const NoiseModel& noise) {
  std::vector<SamplePixel> pixels;
  std::vector<solver::PixelRow> rows(photographs.count());
  TileReader reader(photographs, {.width = solver::kSampleTile, .height = solver::kSampleTile});
  for (const Rect& tile : solver::sample_tiles(photographs.size)) {
    const solver::TileInput input = reader.read(tile);
    for (int y = 0; y < tile.height(); y += kSampleStep) {
      for (int x = 0; x < tile.width(); x += kSampleStep) {
        solver::read_pixel(input, x, y, rows);
        std::vector<double> bright;
        for (const solver::PixelRow& row : rows) {
          if (std::isfinite(row.reading[0]) && row.strength[0] > 0)
            bright.push_back(row.reading[0] / row.strength[0]);
        }
        if (bright.size() < kFewestLights) continue;
        std::ranges::nth_element(bright, bright.begin() + 2, std::greater{});
        SamplePixel pixel;
        pixel.quarter = (2 * (tile.x0 + x) >= photographs.size.width ? 1 : 0) +
                        (2 * (tile.y0 + y) >= photographs.size.height ? 2 : 0);
        for (std::size_t k = 0; k < rows.size(); ++k) {
          const double value = rows[k].reading[0] / rows[k].strength[0];
          if (std::isfinite(value) && value > kLitFrom * bright[2]) pixel.light.push_back(k);
        }
        const auto n = static_cast<Eigen::Index>(pixel.light.size());
        if (pixel.light.size() < kFewestLights) continue;
        pixel.direction.resize(n, 3);
        pixel.x.resize(n);
        pixel.variance.resize(n);
        for (Eigen::Index i = 0; i < n; ++i) {
          const solver::PixelRow& row = rows[pixel.light[static_cast<std::size_t>(i)]];
          const double e = row.strength[0];
          pixel.direction.row(i) << row.direction.x, row.direction.y, row.direction.z;
          pixel.x[i] = row.reading[0] / e;
          pixel.variance[i] =
              noise.variance(row.reading[0]) / (e * e) + std::pow(solver::model_share(true) * pixel.x[i], 2);
        }
        pixels.push_back(std::move(pixel));
      }
    }
  }
  return pixels;
}

// The normal equations of one round, and how well the pixels fit before its step.
struct Equations {
  MatrixXd a;
  VectorXd rhs;
  std::vector<double> misfit;  // by pixel
};

// Pixels that fit worse than noise explains count for less, as their misfit says.
Equations gather(const std::vector<SamplePixel>& pixels, const VectorXd& log_gain,
                 std::optional<int> without_quarter = {}) {
  Equations all = {MatrixXd::Zero(log_gain.size(), log_gain.size()), VectorXd::Zero(log_gain.size()), {}};
  for (const SamplePixel& pixel : pixels) {
    if (pixel.quarter == without_quarter) continue;
    const Eigen::Index n = pixel.x.size();
    const VectorXd root_w = pixel.variance.cwiseInverse().cwiseSqrt();
    VectorXd x = pixel.x;
    for (Eigen::Index i = 0; i < n; ++i)
      x[i] *= std::exp(-log_gain[static_cast<Eigen::Index>(pixel.light[static_cast<std::size_t>(i)])]);
    const MatrixXd l = root_w.asDiagonal() * pixel.direction;
    const Eigen::LDLT<Eigen::Matrix3d> normal(l.transpose() * l);
    if (normal.info() != Eigen::Success || normal.rcond() < 1e-6) continue;
    const VectorXd wx = root_w.asDiagonal() * x;
    const VectorXd predicted = l * normal.solve(l.transpose() * wx);
    const VectorXd residual = wx - predicted;
    const double misfit = residual.squaredNorm() / static_cast<double>(n - 3);
    all.misfit.push_back(misfit);
    MatrixXd m = predicted.asDiagonal();
    m -= l * normal.solve(l.transpose() * m);
    const double weight = 1 / std::max(1.0, misfit);
    const MatrixXd mm = weight * (m.transpose() * m);
    const VectorXd mr = weight * (m.transpose() * residual);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto p = static_cast<Eigen::Index>(pixel.light[static_cast<std::size_t>(i)]);
      all.rhs[p] += mr[i];
      for (Eigen::Index j = 0; j < n; ++j)
        all.a(p, static_cast<Eigen::Index>(pixel.light[static_cast<std::size_t>(j)])) += mm(i, j);
    }
  }
  return all;
}

// Log gains without what a line over the height of the lights explains of them.
VectorXd without_trend(const VectorXd& log_gain, const std::vector<SamplePixel>& pixels) {
  VectorXd height = VectorXd::Zero(log_gain.size()), count = VectorXd::Zero(log_gain.size());
  for (const SamplePixel& pixel : pixels) {
    for (std::size_t i = 0; i < pixel.light.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(pixel.light[i]);
      height[k] += pixel.direction(static_cast<Eigen::Index>(i), 2);
      count[k] += 1;
    }
  }
  height.array() /= count.array().max(1);
  height.array() -= height.mean();
  const double slope = log_gain.dot(height) / std::max(height.squaredNorm(), 1e-12);
  return (log_gain.array() - log_gain.mean()).matrix() - slope * height;
}

// The spread of the gains that each three quarters of the frame tell (a jackknife; Efron 1982). Lights that
// are not quite where the calibration has them are an error that all pixels of a part of the frame share: it
// is in no noise, and differs from one part to the other.
MatrixXd spread_over_the_frame(const std::vector<SamplePixel>& pixels, const VectorXd& log_gain,
                               double prior) {
  const MatrixXd prior_information = prior * MatrixXd::Identity(log_gain.size(), log_gain.size());
  MatrixXd steps(log_gain.size(), kQuarters);
  for (int quarter = 0; quarter < kQuarters; ++quarter) {
    const Equations others = gather(pixels, log_gain, quarter);
    steps.col(quarter) = (others.a + prior_information).ldlt().solve(others.rhs - prior * log_gain);
  }
  const VectorXd mean = steps.rowwise().mean();
  const MatrixXd off = steps.colwise() - mean;
  return (kQuarters - 1.0) / kQuarters * off * off.transpose();
}

bool is_worth_it(const LedGains& gains, const LedGainsOptions& options) {
  bool differs = false;
  for (std::size_t k = 0; k < gains.gain.size(); ++k) {
    const double change = std::abs(gains.gain[k] - 1);
    if (change > options.most_gain || gains.sigma[k] > kUnknownFrom * options.prior_sigma) return false;
    differs = differs || (change > options.least_change && change > options.least_sigmas * gains.sigma[k]);
  }
  return differs && gains.misfit_after < options.most_misfit;
}

}  // namespace

Result<std::optional<LedGains>> find_led_gains(const Photographs& photographs, const LedGainsOptions& options,
                                               const JobContext& context) {
  const std::optional<NoiseModel> noise = photographs.noise();
  if (!noise || photographs.planes().count != 1 || photographs.count() < kFewestLights)
    return std::optional<LedGains>();
  const std::vector<SamplePixel> pixels = read_pixels(photographs, *noise);
  if (pixels.size() < kFewestPixels) return std::optional<LedGains>();

  const auto lights = static_cast<Eigen::Index>(photographs.count());
  const double prior = 1 / (options.prior_sigma * options.prior_sigma);
  VectorXd log_gain = VectorXd::Zero(lights);
  LedGains found;
  Equations equations;
  for (int round = 0; round < kRounds; ++round) {
    equations = gather(pixels, log_gain);
    if (equations.misfit.size() < kFewestPixels) return std::optional<LedGains>();
    if (round == 0) found.misfit_before = median(equations.misfit);
    equations.a.diagonal().array() += prior;
    log_gain += equations.a.ldlt().solve(equations.rhs - prior * log_gain);
  }
  found.misfit_after = median(gather(pixels, log_gain).misfit);
  const MatrixXd covariance = equations.a.ldlt().solve(MatrixXd::Identity(lights, lights));
  // The common gain, which no residual shows, is left out of the spread: it turns no normal.
  const MatrixXd centre = MatrixXd::Identity(lights, lights) -
                          MatrixXd::Constant(lights, lights, 1 / static_cast<double>(lights));
  const VectorXd by_noise = (centre * covariance * centre).diagonal(),
                 by_place = (centre * spread_over_the_frame(pixels, log_gain, prior) * centre).diagonal();
  const VectorXd told = without_trend(log_gain, pixels);
  for (Eigen::Index k = 0; k < lights; ++k) {
    found.gain.push_back(std::exp(told[k]));
    found.sigma.push_back(
        std::sqrt(std::max(by_noise[k], 0.0) * std::max(1.0, found.misfit_after) + by_place[k]));
  }
  if (!is_worth_it(found, options)) return std::optional<LedGains>();

  const std::vector<solver::Patch> patches = solver::patches_of(photographs.size, solver::PatchUse::kChoose);
  const auto method = solver::standard_method();
  const Result<solver::LeftOut> without =
      leave_out_lights(photographs, {.method = method.get()}, patches, context);
  if (!without) return without.error();
  const Result<solver::LeftOut> with =
      leave_out_lights(photographs, {.method = method.get(), .gains = found.gain}, patches, context);
  if (!with) return with.error();
  found.left_out = solver::compare(*without, *with).frame;
  return std::optional(std::move(found));
}

Result<void> follow_cloth(const Exposures& exposures) {
  Photographs& photographs = exposures.photographs;
  ConditionFacts& facts = photographs.conditions.facts;
  if (was_told_by_patches(facts)) return {};
  const Result<std::optional<LedGains>> found = find_led_gains(photographs, {}, exposures.context);
  if (!found) return found.error();
  if (!*found || !(*found)->is_kept()) return {};
  const LedGains& told = **found;
  Result<LightField> field =
      LightField::make(brightened(photographs.field->lights(), told.gain), photographs.camera,
                       photographs.size, photographs.field->cloth_height_mm());
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  facts.cloth_gains = {{}, told.misfit_before, told.misfit_after, told.left_out->mean, told.left_out->sigma};
  for (std::size_t k = 0; k < photographs.leds.size(); ++k)
    facts.cloth_gains->leds.push_back({photographs.leds[k], told.gain[k], told.sigma[k]});
  return {};
}

}  // namespace weft::solve
