// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "calibration/camera/pose.h"
#include "calibration/checks/rig_movement.h"

// What tags and places would show if parts of a rig had moved. Internal to calibration/checks.

namespace weft::calibration {

/// A rig after changes: what moved against the calibration, zero where nothing did.
struct RigState {
  Vec3 camera_turn, camera_shift_mm;  ///< radians; about the projection centre, axes of the rig frame
  Vec3 table_turn, table_shift_mm;    ///< about the rig frame's origin
  std::vector<Vec3> led_shift_mm;
  std::vector<double> led_log_factor;
  double log_factor = 0;   ///< of the brightness of all LEDs
  std::vector<int> order;  ///< order[k] is the LED, from 0, that lights when LED k is called
};

/// Numbers that one kind of change brings.
int parameters_of(ChangeKind kind);
/// The state with the numbers of a change added; turns in radians, factors as logs.
RigState changed(RigState state, const RigChange& change, std::span<const double> by);

class RigModel {
 public:
  /// Keeps what is usable of the evidence: tags that the calibration has, readings that are positive numbers
  /// of LEDs that light the place from the front.
  RigModel(const Calibration& calibration, const RigEvidence& evidence, const MovementOptions& options);

  RigState calibrated() const;
  int leds() const { return static_cast<int>(lights_.leds.size()); }
  int corners() const { return static_cast<int>(corners_.size() - points_); }
  int readings() const { return static_cast<int>(readings_.size()); }
  int observations() const { return static_cast<int>(first_reading()) + readings(); }

  /// Pixels of the tags' corners and of fixed points, then logs of readings over reflectance, means of
  /// channels.
  Eigen::VectorXd measured() const;
  /// The same as a state has it; not finite where a tag is behind the camera or a place is not lit.
  Eigen::VectorXd predicted(const RigState& state) const;
  /// The covariance of measured(): noise, and what is unknown of surfaces and of the calibration. LEDs light
  /// in the order of the state and stand where the calibration has them.
  Eigen::MatrixXd covariance(const RigState& state) const;

  CameraModel camera_after(const RigState& state) const;
  NearLights lights_after(const RigState& state) const;

 private:
  struct Corner {
    Vec3 point_mm;
    PixelPoint seen_px;
    double sigma_px = 0;
  };
  struct Reading {
    std::size_t place = 0;
    std::size_t led = 0;
    double log_reading = 0;
    double channels[3] = {};  ///< weights of the mean, 0 where a channel is not used
  };
  Eigen::Index first_reading() const { return 2 * static_cast<Eigen::Index>(corners_.size()); }
  double log_reading(const NearLights& lights, const RigState& state, const Reading& reading) const;
  void add_light_covariance(const ParameterCovariance& covariance, const RigState& state,
                            Eigen::MatrixXd& sum) const;

  CameraModel camera_;
  NearLights lights_;
  std::optional<ParameterCovariance> light_covariance_;
  MovementOptions options_;
  std::vector<Corner> corners_;  ///< fixed points are the last ones
  std::size_t points_;
  std::vector<LitPlace> places_;
  std::vector<Reading> readings_;
};

}  // namespace weft::calibration
