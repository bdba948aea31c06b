// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace weft::solver {

/// Slopes of a row of pixels, in pixels of height a pixel of way.
struct SlopeRow {
  std::vector<float> right, down;  ///< dh / dx and dh / dy, y down the rows; 0 where the weight is 0
  std::vector<float> weight;
  std::int64_t clamped = 0;
};

/// A normal map read as slopes, row by row, so that no plane of them need be kept.
class Slopes {
 public:
  /// `mask` may be empty. `steepest` is the largest length of a slope.
  Slopes(const std::array<View<const float>, 3>& normal, View<const std::uint8_t> mask, double steepest)
      : normal_(normal), mask_(mask), steepest_(steepest) {}

  Size size() const { return normal_[0].size(); }
  void read(int y, SlopeRow& row) const;

 private:
  std::array<View<const float>, 3> normal_;
  View<const std::uint8_t> mask_;
  double steepest_;
};

/// What one look at all slopes tells.
struct SlopeSurvey {
  std::int64_t pixels = 0;  ///< with a weight
  std::int64_t clamped = 0;
  bool all_alike = false;               ///< every pixel counts, and with the same weight
  float mean_right = 0, mean_down = 0;  ///< of a plane: it fits any grid exactly and is left to no solver
};
SlopeSurvey survey_of(const Slopes& slopes, int threads);

/// What the height should step by from each pixel of a row to its right and to its lower neighbour, less the
/// mean slope, and the weight of that wish; both 0 where there is no such neighbour.
struct StepRow {
  std::vector<float> right, right_weight, down, down_weight;
};

/// The steps of consecutive rows, each slope read once.
class StepWalk {
 public:
  /// Stands at row `first`.
  StepWalk(const Slopes& slopes, const SlopeSurvey& survey, int first);
  void advance();
  const StepRow& here() const { return here_; }
  /// The right-hand side of the normal equations at this row: what flows in less what flows out.
  void source(double* values) const;

 private:
  void fill_here();

  const Slopes& slopes_;
  const SlopeSurvey& survey_;
  int y_;
  SlopeRow slope_here_, slope_below_;
  StepRow above_, here_;
};

}  // namespace weft::solver
