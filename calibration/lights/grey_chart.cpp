// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/grey_chart.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "calibration/lights/paper_model.h"

namespace weft::calibration {
namespace {

constexpr int kFewest = 3;  // patches of a LED and channel

// What the parameters are, in their order: log fluxes by LED and channel, log errors of the reflectances,
// then what the whole chart has in common, then the bend.
enum Common { kTurnX, kTurnY, kHeight, kDelta, kBend, kCommon };

struct Observation {
  Eigen::Index flux = 0, patch = 0;
  double log_flux = 0;  // that explains the reading alone
  double weight = 0;
  std::array<double, kCommon> by_common = {};
};

class GreyChart {
 public:
  GreyChart(const CameraModel& camera, const NearLights& lights, std::span<const GreyPatch> patches,
            std::span<const double> full_reading, const GreyChartOptions& options)
      : camera_(camera), lights_(lights), patches_(patches), full_reading_(full_reading), options_(options) {}

  Result<GreyChartFit> run();

 private:
  struct Solution {
    Eigen::VectorXd x;
    Eigen::MatrixXd covariance;
    double chi_square = 0;
  };

  void observe();
  void observe(std::size_t patch, std::size_t led);
  Result<void> check_counts() const;
  Solution solved(bool with_bend) const;
  GreyChartFit fit_of(const Solution& straight, const Solution& bent) const;

  Eigen::Index fluxes() const { return 3 * static_cast<Eigen::Index>(lights_.leds.size()); }
  Eigen::Index first_common() const { return fluxes() + static_cast<Eigen::Index>(patches_.size()); }

  const CameraModel& camera_;
  const NearLights& lights_;
  std::span<const GreyPatch> patches_;
  std::span<const double> full_reading_;
  const GreyChartOptions& options_;
  std::vector<Observation> observations_;
};

void GreyChart::observe() {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    for (std::size_t k = 0; k < lights_.leds.size(); ++k) observe(p, k);
  }
}

void GreyChart::observe(std::size_t patch, std::size_t led) {
  const GreyPatch& grey = patches_[patch];
  Paper paper;
  paper.delta = options_.delta;
  const Pose flat = {.translation_mm = {0, 0, options_.height_mm}};
  const auto term = paper_term(sight_of(camera_, grey.x_px, grey.y_px), lights_.leds[led], paper, flat);
  if (!term) return;
  const auto [u, v] = frame_place(camera_.size, grey.x_px, grey.y_px);
  const double sigma = std::hypot(options_.reading_sigma, options_.stray / grey.reflectance);
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const double reading = grey.reading_rgb[led][channel];
    if (!(reading > 0) || !std::isfinite(reading)) continue;
    Observation& o = observations_.emplace_back();
    o.flux = 3 * static_cast<Eigen::Index>(led) + c;
    o.patch = fluxes() + static_cast<Eigen::Index>(patch);
    o.log_flux = std::log(reading / grey.reflectance) - term->log_value - lights_.log_gain(led, c, u, v);
    o.weight = 1 / sigma;
    o.by_common[kTurnX] = term->by_turn.x;
    o.by_common[kTurnY] = term->by_turn.y;
    o.by_common[kHeight] = term->by_centre.z;
    o.by_common[kDelta] = term->by_delta;
    o.by_common[kBend] = -reading / full_reading_[led];
  }
}

Result<void> GreyChart::check_counts() const {
  std::vector<int> count(static_cast<std::size_t>(fluxes()), 0);
  for (const Observation& o : observations_) ++count[static_cast<std::size_t>(o.flux)];
  const auto least = std::min_element(count.begin(), count.end());
  if (*least >= kFewest) return {};
  return Error{
      ErrorKind::kBadData, "the grey chart cannot be used",
      fmt::format("LED {}", (least - count.begin()) / 3 + 1),
      fmt::format("{} of {} patches show its light, {} are needed", *least, patches_.size(), kFewest),
      "expose the chart so that its white patch is at 80 percent of full scale under every LED"};
}

// What is known beforehand are further observations, of 0.
GreyChart::Solution GreyChart::solved(bool with_bend) const {
  const Eigen::Index common = with_bend ? kCommon : kBend, size = first_common() + common;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  const double tilt = radians(options_.tilt_sigma_deg);
  const std::array<double, kBend> sigma = {tilt, tilt, options_.height_sigma_mm, options_.delta_sigma};
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const Eigen::Index at = fluxes() + static_cast<Eigen::Index>(p);
    normal(at, at) = 1 / (options_.reflectance_sigma * options_.reflectance_sigma);
  }
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    const Eigen::Index at = first_common() + static_cast<Eigen::Index>(i);
    normal(at, at) = 1 / (sigma[i] * sigma[i]);
  }
  const Eigen::VectorXd prior = normal.diagonal();
  double squares = 0;
  for (const Observation& o : observations_) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
    row[o.flux] = row[o.patch] = o.weight;
    for (Eigen::Index i = 0; i < common; ++i)
      row[first_common() + i] = o.weight * o.by_common[static_cast<std::size_t>(i)];
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    right += o.weight * o.log_flux * row;
    squares += std::pow(o.weight * o.log_flux, 2);
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * Eigen::MatrixXd(normal.selfadjointView<Eigen::Lower>()) * scale.asDiagonal();
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  Solution out;
  out.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  out.x = out.covariance * right;
  const double freedom = static_cast<double>(observations_.size()) +
                         static_cast<double>((prior.array() > 0).count()) - static_cast<double>(size);
  out.chi_square = (squares - out.x.dot(right)) / freedom;
  out.covariance *= std::max(out.chi_square, 1.0);
  return out;
}

GreyChartFit GreyChart::fit_of(const Solution& straight, const Solution& bent) const {
  GreyChartFit fit;
  fit.lights = lights_;
  fit.chi_square = straight.chi_square;
  const Eigen::MatrixXd& cov = straight.covariance;
  const auto leds = static_cast<Eigen::Index>(lights_.leds.size());
  for (Eigen::Index k = 0; k < leds; ++k) {
    std::array<double, 3>& flux = fit.lights.leds[static_cast<std::size_t>(k)].flux_rgb;
    std::array<double, 3>& sigma = fit.flux_sigma.emplace_back();
    for (Eigen::Index c = 0; c < 3; ++c) {
      flux[static_cast<std::size_t>(c)] = std::exp(straight.x[3 * k + c]);
      sigma[static_cast<std::size_t>(c)] = std::sqrt(cov(3 * k + c, 3 * k + c));
    }
    const auto over_green = [&](Eigen::Index c) {
      const Eigen::Index a = 3 * k + c, g = 3 * k + 1;
      return std::sqrt(std::max(cov(a, a) + cov(g, g) - 2 * cov(a, g), 0.0));
    };
    fit.balance_sigma.push_back({over_green(0), over_green(2)});
    for (Eigen::Index l = 0; l < leds; ++l)
      fit.log_flux_covariance.push_back(cov.block<3, 3>(3 * k, 3 * l).mean());
  }
  for (std::size_t p = 0; p < patches_.size(); ++p)
    fit.off_percent.push_back(100 * std::expm1(straight.x[fluxes() + static_cast<Eigen::Index>(p)]));
  const Eigen::Index bend = first_common() + kBend;
  fit.bend = bent.x[bend];
  fit.bend_sigma = std::sqrt(bent.covariance(bend, bend));
  return fit;
}

Result<GreyChartFit> GreyChart::run() {
  observe();
  if (Result<void> ok = check_counts(); !ok) return std::move(ok).error();
  return fit_of(solved(false), solved(true));
}

}  // namespace

Result<GreyChartFit> fit_grey_chart(const CameraModel& camera, const NearLights& lights,
                                    std::span<const GreyPatch> patches, std::span<const double> full_reading,
                                    const GreyChartOptions& options) {
  const bool fits = full_reading.size() == lights.leds.size() && !lights.leds.empty() &&
                    std::all_of(patches.begin(), patches.end(), [&](const GreyPatch& p) {
                      return p.reading_rgb.size() == lights.leds.size() && p.reflectance > 0;
                    });
  const double least = std::min({options.height_sigma_mm, options.tilt_sigma_deg, options.reflectance_sigma,
                                 options.delta_sigma, options.reading_sigma});
  if (!fits || !(least > 0)) {
    return Error{ErrorKind::kUsage, "the grey chart does not fit", "patches",
                 "they need a reading of every LED, reflectances and sigmas above 0",
                 "give each patch its reflectance and its reading under each LED"};
  }
  return GreyChart(camera, lights, patches, full_reading, options).run();
}

}  // namespace weft::calibration
