// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "calibration/lights/paper_model.h"
#include "core/base/vec.h"
#include "core/rig/lights.h"

namespace weft::test {

/// White paper under a rig whose every number is known, by the model of readings in closed form: its own
/// geometry and formulas in double, none of the product's. The camera is a pinhole straight above the table.
struct PaperRig {
  /// How a sheet lies: normal tilted from z, turned in its plane before.
  struct Lie {
    double tilt_deg = 0, azimuth_deg = 0, rotation_deg = 0;
    Vec3 centre_mm;
  };

  int width_px = 2464, height_px = 1632;
  double mm_per_pixel = 0.08, distance_mm = 600;
  NearLights lights;    ///< gains are not used; each LED's log_gain_quadratic is
  double vignette = 0;  ///< log gain in the frame's corner, growing with the square of the distance
  double delta = 0;     ///< of the paper: 1 - delta (1 - n . l)
  std::array<double, 5> log_albedo = {};  ///< in U, V, U^2, U V, V^2 over the sheet, U and V in [-1, 1]
  double half_width_mm = 148.5, half_height_mm = 105;
  std::vector<Lie> sheets;

  double reading(std::size_t sheet, std::size_t led, std::size_t channel, double x_px, double y_px) const;
};

/// The ten LEDs of bench/oracles/oracle_rig.h with aims up to 5 degrees off the centre and lobes of 0.7
/// to 1.3, a vignette of 20 percent, and paper whose albedo varies by half a percent, in five poses.
PaperRig common_rig();

/// Gives each LED a quadratic log gain of its own, random, with nothing in common.
void give_gains(NearLights& lights, double sigma);

/// 1: flat; 2: and tilted by 20 degrees about y; 3: and about x; 5: both ways; 9: and about the diagonals.
std::vector<PaperRig::Lie> lies(int count, double tilt_deg = 20);

/// What is told of a rig, and what is not.
struct PaperErrors {
  double noise = 0.002;    ///< relative, of each block and channel
  double flicker = 0;      ///< relative, of a LED's light from shot to shot
  double tape_mm = 10;     ///< LEDs are said to be so far from where they are, in a random direction
  double turn_deg = 0.05;  ///< standard deviation of the poses about each axis
  double shift_mm = 0.1;   ///< and along each
  std::uint64_t seed = 1;
};

struct PaperCaptures {
  calibration::PaperScene start;
  std::vector<calibration::PaperReading> readings;
};

/// Averages of columns x rows blocks over the frame, of each sheet under each LED.
PaperCaptures captures_of(const PaperRig& rig, const PaperErrors& errors, int columns = 26, int rows = 17);

/// Root of the mean square along one axis of how far LEDs are from the truth.
double position_error_mm(const NearLights& found, const NearLights& truth);
/// The same of directions from the table's centre, degrees: of the whole angle.
double direction_error_deg(const NearLights& found, const NearLights& truth);

}  // namespace weft::test
