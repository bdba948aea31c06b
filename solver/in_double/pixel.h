// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/vec.h"
#include "core/rig/radiometry.h"
#include "core/solve/solve_record.h"
#include "solver/method.h"

namespace weft::solver {

/// One pixel under one light: `direction` l and, for each plane, strength e and reading r (+infinity
/// saturated, NaN missing, -infinity known to be in shadow).
struct PixelRow {
  Vec3 direction;
  std::array<double, 3> strength = {};
  std::array<double, 3> reading = {};
};

/// What is minimised.
enum class Estimator {
  kLeastSquares,   ///< sum of (x_k - l_k . b)^2 with x = r / e
  kLeastAbsolute,  ///< sum of |x_k - l_k . b|, by reweighting (L1)
  kSparse,         ///< least squares plus a sparse error a reading (Ikehata et al., CVPR 2012: SBL)
  kWeighted,   ///< least squares over the variances that a first solution predicts; shadowed readings that
               ///< fit are taken back
  kRejecting,  ///< kWeighted without the readings that do not fit the others
  kTrimmed     ///< where readings scatter, kWeighted from a start that most of them agree on, with
               ///< highlights doubted; elsewhere kRejecting
};

/// Readings are trimmed where their scatter is over this many times what noise explains.
inline constexpr double kTrimFrom = 4;
/// The trimmed readings must scatter by no more than this share of all, or trimming explains nothing.
inline constexpr double kTrimmedShare = 0.2;

struct PixelOptions {
  int planes = 1;  ///< 1 (a photosite of a mosaic) or 3 (RGB)
  bool shadow_mask = false;
  std::optional<NoiseModel> noise;  ///< of a mosaic; without one the scatter of the residuals stands for it
  Estimator estimator = Estimator::kLeastSquares;
  double trim_from = kTrimFrom;  ///< kTrimmed: scatter over what noise explains, from which it starts anew
  std::array<double, 3> plane_weights = kLuminance;  ///< as of TileInput
};

/// How a system of equations was solved, by its condition number.
enum class EquationsSolvedBy { kNothing, kNormalEquations, kQr, kSvd };

/// What TileOutput holds for one pixel.
struct PixelSolution {
  Vec3 normal = {0, 0, 1};
  std::array<double, 3> albedo = {};
  double sigma_normal_deg = 180;
  std::array<double, 3> sigma_albedo = {};
  double residual = 0;
  std::uint16_t status = 0;
  EquationsSolvedBy path = EquationsSolvedBy::kNothing;
  int rejected = 0;  ///< readings left out because the others contradict them
};

/// What became of a reading.
enum class ReadingUse { kUsed, kSaturated, kMissing, kShadowed, kRejected };

/// A reading as the solution of its pixel sees it. Where there is none, nothing is predicted.
struct ReadingStory {
  ReadingUse use = ReadingUse::kMissing;
  double predicted = 0;  ///< of a mosaic the reading; of RGB the weighted sum of its planes, each over its
                         ///< strength
  double reading = 0;    ///< as predicted is; NaN where it is saturated or missing
  double sigma = 0;      ///< of the reading, by noise and by what no noise model knows
};

/// The slow obvious truth of the kernels, in double, and the last resort of the pixels that float32 cannot
/// answer for: condition number over kFloatCondition, fewer than three readings, nothing but noise.
///
/// Rows are divided by their strength (row equilibration). The factorisation follows the condition number of
/// the weighted rows: normal equations up to kDoubleCondition, Householder QR up to kIllConditionedFrom,
/// beyond it Jacobi SVD and a flag. Keeps its memory from pixel to pixel; one object serves one thread.
class PixelSolver {
 public:
  explicit PixelSolver(const PixelOptions& options);
  ~PixelSolver();
  PixelSolver(PixelSolver&&) noexcept;
  PixelSolution solve(std::span<const PixelRow> rows);
  /// The same, and a story for each row.
  PixelSolution explain(std::span<const PixelRow> rows, std::span<ReadingStory> stories);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// How PixelSolver does what the method of this name (solver/method.h) does to one pixel by itself. The seed
/// stands here as least squares.
PixelOptions pixel_options_of(std::string_view method);

PixelSolution solve_pixel(std::span<const PixelRow> rows, const PixelOptions& options);

/// float32 normal equations are good up to here (0.01 degrees; Higham's cond^2 u).
inline constexpr double kFloatCondition = 30;
/// Normal equations in double are good up to here.
inline constexpr double kDoubleCondition = 1e3;

/// A masked system keeps the mask only while its determinant stays above this.
inline constexpr double kLeastMaskedDeterminant = 0.02;
/// Readings below this share of the bright ones are taken to be in shadow.
inline constexpr double kShadowShare = 0.15;
/// However dark they are, this many readings are kept.
inline constexpr int kLeastKept = 4;
/// "Bright" is the reading of this rank from the top: the third of ten (the 70 % quantile).
inline int bright_rank(std::size_t lights) {
  return 1 + static_cast<int>(0.3 * static_cast<double>(lights - 1) + 1e-9);
}

/// A reading is called specular where it is over the sum of kSpecularTimes its prediction, kSpecularSigmas
/// standard deviations of its noise, and kSpecularMargin of the albedo.
inline constexpr double kSpecularTimes = 3;
inline constexpr double kSpecularSigmas = 3;
inline constexpr double kSpecularMargin = 0.08;

/// A reading stands out of the noise from so many standard deviations of a dark one.
inline constexpr double kDarkSigmas = 3;

/// Departures from Lambert's law that no noise model knows, as a share of the albedo: added to the noise
/// wherever readings are weighed and judged. Without a noise model it stands for the noise as well, and for
/// the calibration of whoever took the photographs: one percent.
inline double model_share(bool has_noise) {
  return has_noise ? 0.001 : 0.01;
}
/// A reading that was left out for a shadow is taken back where it fits the others and these predict it to be
/// lit by so many sigma.
inline constexpr double kTakenBackFrom = 1;
/// A reading is rejected where its studentised residual, squared, is over this many times the scatter of the
/// others.
inline constexpr double kRejectFrom = 9;
inline constexpr int kMostRejected = 4;
/// A reading whose freedom is below this pulls the solution to itself altogether. Freedom is 1 minus
/// leverage.
inline constexpr double kLeastFreedom = 1e-6;

/// Where readings are trimmed, what exceeds its prediction by more than kDoubtFrom sigma has kDoubt times
/// the square of the rest added to its variance, in so many rounds.
inline constexpr double kDoubtFrom = 2;
inline constexpr double kDoubt = 10;
inline constexpr int kDoubtRounds = 4;

}  // namespace weft::solver
