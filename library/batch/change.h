// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/describe/fields.h"

// How a solve differs from the one before it.

namespace weft::library {

/// The square of the maps that turned most, as a mean.
struct WorstWindow {
  int x = 0, y = 0, side = 0;  ///< pixels, its upper left corner
  double mean_deg = 0;

  friend bool operator==(const WorstWindow&, const WorstWindow&) = default;
};

/// A number of the solve before, and of this one.
struct BeforeAfter {
  double before = 0, after = 0;

  friend bool operator==(const BeforeAfter&, const BeforeAfter&) = default;
};

struct MapChange {
  std::int64_t pixels = 0;                                        ///< that have a normal in both
  double mean_deg = 0, median_deg = 0, p95_deg = 0, max_deg = 0;  ///< angles between old and new normals
  double albedo_rel = 0, albedo_bias_rel = 0;  ///< means of |new - old| / old and of (new - old) / old
  std::optional<BeforeAfter> sigma_deg = {};   ///< medians of the angle that sigma.exr predicts
  BeforeAfter unsolved = {};                   ///< shares of pixels
  std::optional<BeforeAfter> left_out = {};    ///< rms of how left-out lights are predicted, shares
  std::optional<double> status_changed = {};   ///< share of pixels whose status speaks otherwise
  WorstWindow worst = {};

  bool is_none() const { return max_deg == 0 && albedo_rel == 0; }
  friend bool operator==(const MapChange&, const MapChange&) = default;
};

void describe(Fields& fields, MapChange& change);

/// Sigma, or what left-out lights are off by, that grew by more than this share is worse.
inline constexpr double kWorseBy = 0.1;
/// So are unsolved pixels that grew by more than this share of all.
inline constexpr double kMoreUnsolved = 0.001;

/// In what the new solve is worse: "sigma 0.5 to 0.9 degrees", the gravest first; empty: in nothing.
std::vector<std::string> regressions(const MapChange& change);

/// How bad the regressions are: the largest factor by which something grew, 0 where nothing is worse.
double regression_weight(const MapChange& change);

/// Whether `a` is to be looked at before `b`: regressions first, the gravest first, then by the 95th
/// percentile.
bool is_graver(const MapChange& a, const MapChange& b);

}  // namespace weft::library
