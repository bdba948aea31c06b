// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "solver/diagnosis/evidence_row.h"

namespace weft::solver {

/// What is assumed about the lights: light k shines in photograph `frame[k]` with `gain[k]` times its
/// strength; a gain of 0 leaves it out.
struct LightModel {
  std::vector<std::size_t> frame;
  std::vector<double> gain;

  static LightModel as_calibrated(std::size_t lights);
};

/// One pixel fitted under a model by the least sum of absolute deviations, which a few wrong readings do not
/// bend (iteratively reweighted, Schlossmacher 1973). Buffers are reused from pixel to pixel.
class RobustFit {
 public:
  /// Fits without light `left_out`, if one is named; `rounds` 1 is plain least squares. False where fewer
  /// than five readings are usable, their directions are of rank below three, or the pixel is too dark to say
  /// anything.
  bool fit(const Evidence& evidence, std::size_t pixel, const LightModel& model, std::size_t left_out = kNone,
           int rounds = kRounds);

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  static constexpr int kRounds = 8;

  /// Whether light k's reading is finite and not in attached shadow.
  bool is_usable(std::size_t k) const { return usable_[k]; }
  /// x_k = r / (e gain).
  double value(std::size_t k) const { return x_[k]; }
  double predicted(std::size_t k) const;  ///< max(0, l . b)
  double albedo() const { return albedo_; }
  Vec3 normal() const { return (1 / albedo_) * b_; }
  /// (x_k - predicted) / albedo.
  double residual(std::size_t k) const { return (x_[k] - predicted(k)) / albedo_; }
  double deviation() const;  ///< mean size of the residuals of usable lights

 private:
  std::vector<Vec3> l_;
  std::vector<double> x_, finite_;
  std::vector<char> usable_;
  Vec3 b_;
  double albedo_ = 0;
};

}  // namespace weft::solver
