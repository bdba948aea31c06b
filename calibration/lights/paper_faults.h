// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calibration/lights/paper_model.h"

namespace weft::calibration {

// Where paper is not what the fit takes it for. What one LED does to a block is the light's; what all do to
// it is the paper's: a stain darkens it under every LED alike, a fold turns it, brighter under some and
// darker under others.

/// One block of one capture under all LEDs: how its readings depart from the model.
struct PaperSpot {
  std::size_t sheet = 0;
  double x_px = 0, y_px = 0;  ///< in the frame
  double u_mm = 0, v_mm = 0;  ///< on the sheet
  double common = 0;          ///< mean of ln(measured / predicted) over LEDs and channels
  double varying = 0;         ///< rms of the LEDs' own departures about it
};

/// Blocks of the same place in the frame: `readings` of one sheet and block side by side.
std::vector<PaperSpot> spots_of(const PaperScene& scene, std::span<const PaperReading> readings);

/// Neighbouring spots that are far out.
struct PaperFault {
  bool is_fold = false;       ///< else a stain
  double u_mm = 0, v_mm = 0;  ///< its middle
  double area_mm2 = 0;
  double departure = 0;             ///< the most, relative
  std::vector<std::size_t> sheets;  ///< captures that show it, sorted
  std::vector<std::size_t> spots;   ///< indices
};

/// A spot is far out where its departure is over kFaultFrom times the median over all spots, and over
/// kFaultFromRelative.
inline constexpr double kFaultFrom = 6;
inline constexpr double kFaultFromRelative = 0.007;
/// Faults are cut out of the paper; with more than this share of its spots gone it is no white sheet.
inline constexpr double kMostFaultyShare = 0.05;

/// The faults, the largest first. `spacing_mm` is about that of neighbouring spots.
std::vector<PaperFault> find_faults(std::span<const PaperSpot> spots, double spacing_mm);

}  // namespace weft::calibration
