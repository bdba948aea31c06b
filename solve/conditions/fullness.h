// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "solve/photographs/photographs.h"

namespace weft::pipeline {

/// How full photographs are: shares of the readings of all lights.
struct Fullness {
  double full = 0;     ///< saturated
  double missing = 0;  ///< no readings at all, as outside a mask
  double lit = 0;      ///< above 0
  /// Share of the way from black to white that one photosite in ten thousand exceeds, in the brightest frame
  /// or bracket. None of developed photographs, whose white nobody knows.
  std::optional<double> brightest = {};
};

/// From every 16th pair of rows of each photograph.
Fullness fullness_of(const Photographs& photographs);

}  // namespace weft::pipeline
