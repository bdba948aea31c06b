// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/calibration_sigma.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace weft::solver {
namespace {

constexpr CalibrationSigma kUnknown = {180, 1};

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Vector3d eigen(Vec3 v) {
  return {v.x, v.y, v.z};
}

Error bad_covariance(std::string where, std::string why) {
  return {ErrorKind::kBadData, "covariance of the lights cannot be used", std::move(where), std::move(why),
          "calibrate the lights again, or take \"covariance\" out of lights.json"};
}

}  // namespace

// The parameter of one of `leds` that a name means; none where it belongs to another LED.
std::optional<CalibrationSigmas::Parameter> CalibrationSigmas::parameter_named(const std::string& name,
                                                                               std::span<const int> leds,
                                                                               bool& is_known) {
  constexpr std::string_view kPrefix = "led";
  struct Named {
    std::string_view name;
    Kind kind;
    std::string_view axes;  // a letter each, or none
  };
  constexpr std::array<Named, 5> kNames = {{{".position_mm.", Kind::kPosition, "xyz"},
                                            {".aim.", Kind::kAim, "xyz"},
                                            {".mu", Kind::kMu, ""},
                                            {".log_flux", Kind::kLogFlux, ""},
                                            {".log_gain_quadratic.", Kind::kLogGain, "012345"}}};
  is_known = false;
  if (!name.starts_with(kPrefix)) return {};
  int led = 0;
  const char* end = name.data() + name.size();
  const auto [rest_begin, failed] = std::from_chars(name.data() + kPrefix.size(), end, led);
  std::string_view rest(rest_begin, static_cast<std::size_t>(end - rest_begin));
  if (failed != std::errc() || led < 1) return {};
  for (const Named& named : kNames) {
    if (!rest.starts_with(named.name)) continue;
    rest.remove_prefix(named.name.size());
    const std::size_t axis = rest.size() == 1 ? named.axes.find(rest) : named.axes.npos;
    is_known = named.axes.empty() ? rest.empty() : axis != named.axes.npos;
    const auto light = std::find(leds.begin(), leds.end(), led);
    if (!is_known || light == leds.end()) return {};
    return Parameter{static_cast<std::size_t>(light - leds.begin()), named.kind,
                     named.axes.empty() ? 0 : static_cast<int>(axis)};
  }
  return {};
}

Result<CalibrationSigmas> CalibrationSigmas::make(const LightField& field, Size size,
                                                  std::span<const int> leds,
                                                  const ParameterCovariance& covariance,
                                                  const std::optional<NoiseModel>& noise) {
  if (!std::holds_alternative<NearLights>(field.lights())) {
    return bad_covariance("lights", "they are distant; positions, aims and lobes are those of near lights");
  }
  CalibrationSigmas sigmas;
  sigmas.field_ = &field;
  sigmas.size_ = size;
  sigmas.noise_ = noise;
  const std::size_t n = covariance.parameters.size();
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < n; ++i) {
    bool is_known = false;
    const std::optional<Parameter> parameter = parameter_named(covariance.parameters[i], leds, is_known);
    if (!is_known) {
      return bad_covariance(covariance.parameters[i], "no parameter of a light has this name");
    }
    if (!parameter) continue;
    used.push_back(i);
    sigmas.parameters_.push_back(*parameter);
  }
  for (const std::size_t i : used) {
    for (const std::size_t j : used) sigmas.sigma_.push_back(covariance.matrix[i * n + j]);
  }
  return sigmas;
}

double CalibrationSigmas::log_derivative(const Parameter& parameter, Vec3 v, Vec3 normal, int x,
                                         int y) const {
  const NearLight& led = std::get<NearLights>(field_->lights()).leds[parameter.light];
  const auto part = [&](Vec3 gradient) {
    return std::array{gradient.x, gradient.y, gradient.z}[static_cast<std::size_t>(parameter.axis)];
  };
  switch (parameter.kind) {
    case Kind::kPosition:
      return part((led.mu / dot(v, led.aim)) * led.aim + (1 / dot(v, normal)) * normal -
                  ((led.mu + 3) / dot(v, v)) * v);
    case Kind::kAim:
      return part(led.mu * ((1 / dot(v, led.aim)) * v - led.aim));
    case Kind::kMu:
      return std::log(-dot(v, led.aim) / length(v));
    case Kind::kLogFlux:
      return 1;
    case Kind::kLogGain:
      break;
  }
  const double u = 2.0 * x / std::max(size_.width - 1, 1) - 1;
  const double w = 2.0 * y / std::max(size_.height - 1, 1) - 1;
  return std::array{1.0, u, w, u * u, u * w, w * w}[static_cast<std::size_t>(parameter.axis)];
}

CalibrationSigma CalibrationSigmas::at(int x, int y, int c, Vec3 normal, double albedo) const {
  const auto& leds = std::get<NearLights>(field_->lights()).leds;
  const double rho = std::max(albedo, 1e-6);
  std::vector<Vec3> to_light(leds.size());  // v, from the cloth to each LED; 0 where it does not shine
  std::vector<Eigen::Vector3d> answer(leds.size(), Eigen::Vector3d::Zero());  // W A^T r of each LED alone
  Eigen::Matrix3d fit = Eigen::Matrix3d::Zero();
  int facing = 0;
  for (std::size_t k = 0; k < leds.size(); ++k) {
    const LightField::Light light = field_->at(k, c, x, y);
    const double cosine = dot(normal, light.direction);
    if (!(cosine > 0 && light.strength > 0)) continue;
    ++facing;
    to_light[k] = ((leds[k].position_mm.z - field_->cloth_height_mm()) / light.direction.z) * light.direction;
    const double reading = rho * light.strength * cosine;
    const double weight = 1 / (noise_ ? noise_->variance(reading) : light.strength * light.strength);
    const Eigen::Vector3d row = light.strength * eigen(light.direction);
    fit += weight * row * row.transpose();
    answer[k] = weight * reading * row;
  }
  bool solvable = false;
  Eigen::Matrix3d inverse;
  const double scale = fit.trace();
  if (facing >= 3 && scale > 0) {
    (fit / scale).eval().computeInverseWithCheck(inverse, solvable, 1e-14);
  }
  if (!solvable) return kUnknown;

  const auto n = static_cast<Eigen::Index>(parameters_.size());
  Eigen::Matrix3Xd change(3, n);  // K
  for (Eigen::Index p = 0; p < n; ++p) {
    const Parameter& parameter = parameters_[static_cast<std::size_t>(p)];
    const Vec3 v = to_light[parameter.light];
    change.col(p).setZero();
    if (dot(v, v) == 0) continue;
    change.col(p) = -log_derivative(parameter, v, normal, x, y) / scale * (inverse * answer[parameter.light]);
  }
  const Eigen::Map<const Square> sigma(sigma_.data(), n, n);
  const Eigen::Matrix3d covariance = change * sigma * change.transpose();
  const double along = eigen(normal).dot(covariance * eigen(normal));
  const double across = covariance.trace() - along;
  return {std::min(degrees(std::sqrt(std::max(across, 0.0)) / rho), 180.0),
          std::sqrt(std::max(along, 0.0)) / rho};
}

std::vector<double> CalibrationSigmas::light_errors_at(int x, int y) const {
  const auto& leds = std::get<NearLights>(field_->lights()).leds;
  constexpr Eigen::Index kErrors = 4;
  const auto n = static_cast<Eigen::Index>(parameters_.size()),
             errors = kErrors * static_cast<Eigen::Index>(leds.size());
  Square change = Square::Zero(errors, n);
  for (Eigen::Index p = 0; p < n; ++p) {
    const Parameter& parameter = parameters_[static_cast<std::size_t>(p)];
    const Vec3 direction = field_->at(parameter.light, 0, x, y).direction;
    const double distance = (leds[parameter.light].position_mm.z - field_->cloth_height_mm()) / direction.z;
    const Eigen::Index first = kErrors * static_cast<Eigen::Index>(parameter.light);
    // The cosine of a surface that faces the light does not change.
    change(first, p) = log_derivative(parameter, distance * direction, direction, x, y);
    if (parameter.kind != Kind::kPosition) continue;
    const Eigen::Vector3d l = eigen(direction);
    change.block<3, 1>(first + 1, p) =
        (Eigen::Vector3d::Unit(parameter.axis) - l[parameter.axis] * l) / distance;
  }
  const Square covariance = change * Eigen::Map<const Square>(sigma_.data(), n, n) * change.transpose();
  return {covariance.data(), covariance.data() + covariance.size()};
}

}  // namespace weft::solver
