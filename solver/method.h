// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/light_field.h"
#include "core/rig/radiometry.h"
#include "core/solve/solve_record.h"

namespace weft::solver {

/// Rec.709 luminance weights of linear R, G, B: what one normal for three channels is solved from where
/// nothing is known of them.
inline constexpr std::array<double, 3> kLuminance = {0.2126, 0.7152, 0.0722};

/// K frames of one tile as readings (core/rig/radiometry.h: +infinity is saturated, NaN is missing; -infinity
/// is known to be in shadow).
///
/// One plane is a mosaic: each photosite is solved alone, with its own direction and its colour's strength,
/// so that the normal needs no demosaicing. Three planes are RGB and share one normal, solved from the sum
/// of the channels, each divided by its strength and times its weight.
struct TileInput {
  Rect tile;       ///< absolute pixels; tile.x0 is a multiple of kRowGroup
  int planes = 1;  ///< 1 or 3
  CfaPattern cfa;  ///< colour of each photosite where planes is 1
  std::span<const View<const float>>
      readings;  ///< [k * planes + p], (0, 0) is the tile's corner, rows padded
  const LightField* field = nullptr;
  std::optional<NoiseModel> noise;  ///< of a mosaic; without one the scatter of the residuals stands for it
  std::array<double, 3> plane_weights = kLuminance;  ///< of RGB; none below 0, their sum is 1
  double lobe_share =
      1;  ///< of a lobe that reaches the readings, over that of diffuse light: films change it
  /// The same lights once more through parallel films, where the readings are of crossed ones; else empty.
  /// Normals and albedo are solved without them; they tell lobes.
  std::span<const View<const float>> parallel = {};
};

/// The lobe's share in readings through parallel films: half of what is mirrored passes, a quarter of what is
/// scattered. Through crossed ones it is this times their leak.
inline constexpr double kParallelLobeShare = 2;

/// How many pixels were solved in which way, and readings rejected on the way.
struct SolveTally {
  std::int64_t by_kernel = 0;                                   ///< in float32
  std::int64_t by_normal_equations = 0, by_qr = 0, by_svd = 0;  ///< in double
  std::int64_t unsolved = 0;
  std::int64_t rejected_readings = 0;

  SolveTally& operator+=(const SolveTally& other);
};

/// What a method writes for every pixel of the tile; views have (0, 0) at the tile's corner and padded rows.
/// A pixel without solution gets the normal (0, 0, 1), the best albedo for that normal and a sigma of
/// kUnknownAngleDeg.
struct TileOutput {
  std::array<View<float>, 3> normal;        ///< X, Y, Z of the rig frame, unit length
  std::array<View<float>, 3> albedo;        ///< rho of the photosite in [0] where planes is 1, else R, G, B
  View<float> sigma_normal_deg;             ///< sqrt(tr(P C P)) / rho in degrees: rms angle
  std::array<View<float>, 3> sigma_albedo;  ///< absolute, as albedo
  View<float> residual;                     ///< rms of the readings used, over the albedo
  View<std::uint16_t> status;               ///< StatusBit
  SolveTally* tally = nullptr;              ///< added to, where there is one
};

inline constexpr float kUnknownAngleDeg = 180;

/// A way from readings to normals. Stateless: one object serves all threads.
class Method {
 public:
  virtual ~Method() = default;
  virtual void solve(const TileInput& input, const TileOutput& output) const = 0;
  /// Whether it expects RGB (planes = 3) where the photographs are mosaics, as the paper it follows did.
  virtual bool wants_rgb() const { return false; }
  /// What a pixel of its output sends on of a light of strength 1 from `light`, with that share of its lobe:
  /// by Lambert's law, where it knows no other. Column and row of the tile; of RGB green speaks.
  virtual double reflected(const TileInput& input, const TileOutput& output, int x, int y, Vec3 light,
                           double lobe_share) const;
};

/// "The paper's": four systems a pixel, one for each channel and one for luminance, each by Eigen's two-sided
/// Jacobi SVD in double (Neubelt and Pettineo 2013, eq. 24-30). No shadow mask.
std::unique_ptr<Method> seed_method();
/// Every valid reading in one least-squares system, no shadow mask (eq. 29).
std::unique_ptr<Method> least_squares_method();
/// Least squares without the readings in attached shadow: those below 0.15 of the third brightest of ten, as
/// long as four readings and a well-conditioned system remain.
std::unique_ptr<Method> fast_method();

/// Two-step weighted least squares of the readings that the shadow mask leaves: solved once, and again with
/// every reading over the variance that the first solution predicts; shadowed readings that fit are taken
/// back.
std::unique_ptr<Method> weighted_method();
/// Weighted, then readings that do not fit the others are left out one by one.
std::unique_ptr<Method> standard_method();
/// Robust in double: what float32 is held against.
std::unique_ptr<Method> exact_method();
/// Standard in double.
std::unique_ptr<Method> exact_standard_method();
/// Standard; where its residuals ask for it, from the start that most readings agree on.
std::unique_ptr<Method> robust_method();
/// Least trimmed squares at every pixel (Rousseeuw 1984), then weighted.
std::unique_ptr<Method> trimmed_method();

/// The least sum of absolute residuals, and least squares with sparse errors (Ikehata et al., CVPR 2012),
/// both in double by reweighting, of every valid reading.
std::unique_ptr<Method> least_absolute_method();
std::unique_ptr<Method> sparse_method();

/// The levels of --quality, from the cheapest to the dearest.
enum class Level { kPreview, kFast, kStandard, kRobust, kReference };

/// What a level solves: tiles as they come, tiles of a picture of half the size, or tiles of a whole frame
/// several times, with what the frame says of the light over it (solve/levels/reference.h).
enum class Extent { kTiles, kHalfSize, kWholeFrame };

/// Levels and methods by the name a person gives them.
struct MethodName {
  const char* name = "";
  const char* help = "";            ///< in a few words
  std::optional<Level> level = {};  ///< none: a method of --method
  /// Takes the clipped values of developed photographs at their word, so that it can be held against
  /// published figures. Saturated raw counts enter no method.
  bool keeps_clipped = false;
  std::unique_ptr<Method> (*make)() = nullptr;
  Extent extent = Extent::kTiles;
};
/// The levels in their order, then the methods.
std::span<const MethodName> method_names();
const MethodName& method_of(Level level);
/// Null where there is none of that name.
const MethodName* find_method(std::string_view name);

}  // namespace weft::solver
