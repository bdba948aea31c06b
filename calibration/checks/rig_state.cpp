// SPDX-License-Identifier: Apache-2.0
#include "calibration/checks/rig_state.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "calibration/checks/light_at.h"
#include "calibration/lights/paper_model.h"

namespace weft::calibration {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vec3 from(std::span<const double> by, std::size_t first) {
  return {by[first], by[first + 1], by[first + 2]};
}

/// Where a point is that was at `point_mm` and is fixed to the camera's body.
Pose camera_movement(const RigState& state, Vec3 centre_mm) {
  const Mat3 turn = rotation_of(state.camera_turn);
  return {turn, centre_mm + state.camera_shift_mm - turn * centre_mm};
}

Pose table_movement(const RigState& state) {
  return {rotation_of(state.table_turn), state.table_shift_mm};
}

/// A step of the parameter "ledNN.field" of a light covariance; nothing where there is no such parameter.
std::optional<NearLights> stepped(NearLights lights, std::string_view name, double by) {
  std::size_t number = 0;
  if (!name.starts_with("led")) return std::nullopt;
  const auto [rest, failed] = std::from_chars(name.data() + 3, name.data() + name.size(), number);
  if (failed != std::errc() || number < 1 || number > lights.leds.size()) return std::nullopt;
  const std::string_view field(rest, static_cast<std::size_t>(name.data() + name.size() - rest));
  NearLight& led = lights.leds[number - 1];
  constexpr std::string_view kQuadratic = ".log_gain_quadratic.";
  if (field == ".position_mm.x")
    led.position_mm.x += by;
  else if (field == ".position_mm.y")
    led.position_mm.y += by;
  else if (field == ".position_mm.z")
    led.position_mm.z += by;
  else if (field == ".aim.x")
    led.aim.x += by;
  else if (field == ".aim.y")
    led.aim.y += by;
  else if (field == ".aim.z")
    led.aim.z += by;
  else if (field == ".mu")
    led.mu += by;
  else if (field == ".log_flux")
    for (double& flux : led.flux_rgb) flux *= std::exp(by);
  else if (field.starts_with(kQuadratic) && field.size() == kQuadratic.size() + 1 && field.back() >= '0' &&
           field.back() <= '5')
    led.log_gain_quadratic[static_cast<std::size_t>(field.back() - '0')] += by;
  else
    return std::nullopt;
  led.aim = normalized(led.aim);
  return lights;
}

}  // namespace

int parameters_of(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::kCamera:
    case ChangeKind::kTable:
      return 6;
    case ChangeKind::kLedMoved:
      return 3;
    case ChangeKind::kLedFaded:
    case ChangeKind::kAllFaded:
      return 1;
    case ChangeKind::kLedsSwapped:
      break;
  }
  return 0;
}

RigState changed(RigState state, const RigChange& change, std::span<const double> by) {
  const auto led = static_cast<std::size_t>(std::max(change.led, 1) - 1);
  switch (change.kind) {
    case ChangeKind::kCamera:
      state.camera_turn = state.camera_turn + from(by, 0);
      state.camera_shift_mm = state.camera_shift_mm + from(by, 3);
      break;
    case ChangeKind::kTable:
      state.table_turn = state.table_turn + from(by, 0);
      state.table_shift_mm = state.table_shift_mm + from(by, 3);
      break;
    case ChangeKind::kLedMoved:
      state.led_shift_mm[led] = state.led_shift_mm[led] + from(by, 0);
      break;
    case ChangeKind::kLedFaded:
      state.led_log_factor[led] += by[0];
      break;
    case ChangeKind::kAllFaded:
      state.log_factor += by[0];
      break;
    case ChangeKind::kLedsSwapped:
      std::swap(state.order[led], state.order[static_cast<std::size_t>(change.other_led - 1)]);
      break;
  }
  return state;
}

RigModel::RigModel(const Calibration& calibration, const RigEvidence& evidence,
                   const MovementOptions& options)
    : camera_(*calibration.camera),
      lights_(std::get<NearLights>(*calibration.lights)),
      light_covariance_(calibration.light_covariance),
      options_(options),
      points_(evidence.points.size()),
      places_(evidence.places) {
  for (const TagSighting& tag : evidence.tags) {
    for (const Fiducial& fiducial : calibration.fiducials) {
      if (fiducial.id != tag.id || fiducial.dictionary != tag.dictionary) continue;
      for (std::size_t i = 0; i < 4; ++i)
        corners_.push_back({fiducial.corners_mm[i], tag.corners_px[i], options.corner_sigma_px});
    }
  }
  for (const PlacedPoint& point : evidence.points)
    corners_.push_back({point.point_mm, point.seen_px, std::hypot(options.corner_sigma_px, point.sigma_px)});
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const LitPlace& place = places_[p];
    for (std::size_t k = 0; k < std::min(place.reading_rgb.size(), lights_.leds.size()); ++k) {
      Reading reading = {p, k, 0, {}};
      int channels = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double ratio = place.reading_rgb[k][c] / place.reflectance_rgb[c];
        if (!std::isfinite(ratio) || !(ratio > 0) || !(lights_.leds[k].flux_rgb[c] > 0)) continue;
        reading.log_reading += std::log(ratio);
        reading.channels[c] = 1;
        ++channels;
      }
      if (channels == 0) continue;
      reading.log_reading /= channels;
      for (double& weight : reading.channels) weight /= channels;
      if (std::isfinite(log_reading(lights_, calibrated(), reading))) readings_.push_back(reading);
    }
  }
}

RigState RigModel::calibrated() const {
  RigState state;
  state.led_shift_mm.resize(lights_.leds.size());
  state.led_log_factor.resize(lights_.leds.size());
  for (int k = 0; k < leds(); ++k) state.order.push_back(k);
  return state;
}

double RigModel::log_reading(const NearLights& lights, const RigState& state, const Reading& reading) const {
  const LitPlace& place = places_[reading.place];
  const Pose moved = place.on_table ? table_movement(state) : camera_movement(state, centre_of(camera_));
  const auto k = static_cast<std::size_t>(state.order[reading.led]);
  NearLight led = lights.leds[k];
  led.position_mm = led.position_mm + state.led_shift_mm[k];
  const std::optional<LightAt> light = light_at(led, moved(place.point_mm));
  if (!light) return kNaN;
  const double cosine = dot(moved.rotation * place.normal, light->direction);
  if (!(cosine > 0)) return kNaN;
  const auto [u, v] = frame_place(camera_.size, place.x_px, place.y_px);
  double log_flux = 0;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    if (reading.channels[channel] > 0)
      log_flux += reading.channels[channel] * (std::log(led.flux_rgb[channel]) + lights.log_gain(k, c, u, v));
  }
  const double delta = place.delta != 0 ? place.delta : options_.paper_delta;
  const double paper = 1 - delta * (1 - cosine);
  return log_flux + std::log(paper * cosine) + light->log_geometry + state.led_log_factor[k] +
         state.log_factor;
}

Eigen::VectorXd RigModel::measured() const {
  Eigen::VectorXd y(observations());
  Eigen::Index i = 0;
  for (const Corner& corner : corners_) {
    y[i++] = corner.seen_px.x;
    y[i++] = corner.seen_px.y;
  }
  for (const Reading& reading : readings_) y[i++] = reading.log_reading;
  return y;
}

Eigen::VectorXd RigModel::predicted(const RigState& state) const {
  Eigen::VectorXd y(observations());
  Eigen::Index i = 0;
  const CameraModel camera = camera_after(state);
  for (const Corner& corner : corners_) {
    const Vec3 p = project(camera, corner.point_mm);
    y[i++] = p.z > 0 ? p.x : kNaN;
    y[i++] = p.z > 0 ? p.y : kNaN;
  }
  for (const Reading& reading : readings_) y[i++] = log_reading(lights_, state, reading);
  return y;
}

Eigen::MatrixXd RigModel::covariance(const RigState& state) const {
  const Eigen::Index first = first_reading();
  const double tilt = std::tan(radians(options_.tilt_sigma_deg));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(observations(), observations());
  for (Eigen::Index i = 0; i < first; ++i) {
    const double sigma = corners_[static_cast<std::size_t>(i / 2)].sigma_px;
    sum(i, i) = sigma * sigma;
  }

  // What a place's tilt against its normal changes: the light's direction along the place over the cosine.
  std::vector<Vec3> by_tilt;
  for (const Reading& reading : readings_) {
    const LitPlace& place = places_[reading.place];
    const auto lit = static_cast<std::size_t>(state.order[reading.led]);
    const Vec3 l = normalized(lights_.leds[lit].position_mm - place.point_mm);
    const double cosine = dot(l, place.normal);
    by_tilt.push_back((tilt / cosine) * (l - cosine * place.normal));
  }
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    for (std::size_t j = 0; j < readings_.size(); ++j) {
      const Reading &a = readings_[i], &b = readings_[j];
      double& s = sum(first + static_cast<Eigen::Index>(i), first + static_cast<Eigen::Index>(j));
      if (i == j) {
        const double few = options_.few_pixels * places_[a.place].reading_sigma;
        s += options_.reading_sigma * options_.reading_sigma + few * few;
      }
      if (a.led == b.led) s += options_.flicker * options_.flicker;
      if (a.place == b.place) s += dot(by_tilt[i], by_tilt[j]);
      if (places_[a.place].surface == places_[b.place].surface)
        s += places_[a.place].reflectance_sigma * places_[b.place].reflectance_sigma;
    }
  }
  if (light_covariance_) add_light_covariance(*light_covariance_, state, sum);
  return sum;
}

void RigModel::add_light_covariance(const ParameterCovariance& covariance, const RigState& state,
                                    Eigen::MatrixXd& sum) const {
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  Eigen::MatrixXd by_parameter = Eigen::MatrixXd::Zero(observations(), n);
  for (Eigen::Index p = 0; p < n; ++p) {
    constexpr double kStep = 1e-5;
    const std::string& name = covariance.parameters[static_cast<std::size_t>(p)];
    const std::optional<NearLights> up = stepped(lights_, name, kStep), down = stepped(lights_, name, -kStep);
    if (!up || !down) continue;
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      const double by =
          (log_reading(*up, state, readings_[i]) - log_reading(*down, state, readings_[i])) / (2 * kStep);
      // A LED that does not light the place in this order makes the prediction fail, not the covariance.
      by_parameter(first_reading() + static_cast<Eigen::Index>(i), p) = std::isfinite(by) ? by : 0;
    }
  }
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> matrix(
      covariance.matrix.data(), n, n);
  sum += by_parameter * matrix * by_parameter.transpose();
}

CameraModel RigModel::camera_after(const RigState& state) const {
  const Pose before = {camera_.camera_from_rig_rotation, camera_.camera_from_rig_translation_mm};
  const Pose after = before * inverse(camera_movement(state, centre_of(camera_))) * table_movement(state);
  CameraModel camera = camera_;
  camera.camera_from_rig_rotation = after.rotation;
  camera.camera_from_rig_translation_mm = after.translation_mm;
  return camera;
}

NearLights RigModel::lights_after(const RigState& state) const {
  const Pose table_from_rig = inverse(table_movement(state));
  NearLights after = lights_;
  for (std::size_t k = 0; k < after.leds.size(); ++k) {
    const auto from_led = static_cast<std::size_t>(state.order[k]);
    NearLight& led = after.leds[k];
    led = lights_.leds[from_led];
    led.position_mm = table_from_rig(led.position_mm + state.led_shift_mm[from_led]);
    led.aim = table_from_rig.rotation * led.aim;
    for (double& flux : led.flux_rgb) flux *= std::exp(state.led_log_factor[from_led] + state.log_factor);
  }
  return after;
}

}  // namespace weft::calibration
