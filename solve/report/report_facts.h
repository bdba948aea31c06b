// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/solve/solve.h"
#include "solve/report/reflectance_facts.h"
#include "solver/diagnosis/diagnosis.h"

// What report.json says of a solve (weft.solve-report/1). Numbers that are not finite are null there.

namespace weft::solve {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Shares of the maps' pixels, as kStatusNames has them.
struct StatusShares {
  std::array<double, kStatusNames.size()> shares = {};
};

/// How the readings of one light fit; shares but for gain.
struct LightFacts {
  int light = 0;
  double residual_rms = kNoNumber, residual_median = kNoNumber, residual_mean = kNoNumber;
  double gain = kNoNumber, gain_range = kNoNumber;
  double saturated = kNoNumber, shadowed = kNoNumber, missing = kNoNumber, outlier = kNoNumber;
  double gradient = kNoNumber, gradient_share = kNoNumber;
};

/// A light that contradicts the others; the numbers that its kind has.
struct FaultFacts {
  solver::FaultKind kind = {};
  std::vector<int> lights = {}, shown_by = {};
  double value = kNoNumber, sigma = kNoNumber;
  double residual_before = kNoNumber, residual_after = kNoNumber, moved_deg = kNoNumber;
  double confidence = kNoNumber;
};

/// A source of error in its own unit.
struct ErrorSource {
  std::string source, what;
  double value = 0;
  std::string unit;
};

/// Condition number of the lights over the frame; infinite where they do not span three directions.
struct LightCondition {
  double median = 0, worst = 0;
};

/// The predicted angle over the frame.
struct SigmaMap {
  double median = kNoNumber, p95 = kNoNumber;
  double solved = 1;  ///< share of the cloth that has a normal
  int square_px = 0, columns = 0, rows = 0;
  Json grid = Json::array();  ///< means of squares, row by row; null where there is none
};

struct SolveReportFacts {
  std::string title;
  bool is_of_photographs = false;  ///< else of a session
  std::string id, method;
  Size size = {};
  AlbedoScale albedo_scale = AlbedoScale::kRelative;
  std::int64_t pixels = 0;
  std::vector<Verdict> warnings = {};
  StatusShares status = {};
  std::int64_t looked_at = 0;  ///< pixels that lights were held against each other on
  double outshining = kNoNumber, residual = kNoNumber, residual_explained = kNoNumber;
  std::vector<LightFacts> lights = {};
  std::vector<FaultFacts> faults = {};
  std::vector<ErrorSource> budget = {};
  LightCondition condition = {};
  SigmaMap sigma_normal_deg = {};
  std::optional<AngleMiddle> sigma_noise_deg = {}, sigma_model_deg = {}, sigma_calibration_deg = {};
  std::optional<LeftOutFacts> check = {};
  std::optional<SolveError> error = {};
  std::vector<GateFacts> gates = {};
  std::vector<RegisteredShot> registration = {};
  std::optional<SharpeningFacts> sharpening = {};
  std::optional<LateralColorFacts> lateral_color = {};
  std::optional<ConditionFacts> conditions = {};
  Json seconds = Json::object();  ///< by phase
  std::optional<ReflectanceFacts> reflectance = {};
  std::optional<GlossSaid> gloss = {};
  std::optional<SolvePrice> foretold = {};
};
void describe(Fields& fields, SolveReportFacts& facts);
Json json_of(const SolveReportFacts& facts);

}  // namespace weft::solve
