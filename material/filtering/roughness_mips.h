// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "material/surface.h"

// Mips that reflect as what lies beneath them does: where normals differ below a texel their spread becomes
// roughness (Toksvig 2004; Neubelt and Pettineo 2013, "Specular Antialiasing": seed 000; Chan 2018, section
// 2: seed 001). Without it a weave turns to a mirror with distance.
//
// r is the length of the mean normal, and 1/kappa = (1 - r^2) / (r (3 - r^2)) the width of the von
// Mises-Fisher lobe of that mean (Banerjee et al. 2005). Unlike the listing of seed 000 it has no jump at r
// = 1.

namespace weft::material {

enum class MipRule {
  kVmf,          ///< alpha^2 + 2 / kappa: the variance that a turned mirror has (default)
  kVmfYarns,     ///< alpha^2 I + (4 / kappa) C / trace C, C the covariance of normals: keeps the weave's
                 ///< direction
  kVmfSeedCode,  ///< alpha^2 + 1 / kappa: listing ComputeRoughness of seed 000
  kVmfSeedEq37,  ///< alpha^2 + 1 / (2 kappa): eq. 37 of seed 000
  kToksvig,      ///< Blinn-Phong's power m = 2 / alpha^2 - 2 becomes r m / (r + m (1 - r)): seed 004
  kLengths,  ///< normal_length() of the pixels' lobes times their normals is averaged: seed 001 algorithm 3
  kLean,     ///< alpha^2 I + 2 cov(slopes): Olano and Baker 2010
  kClean,    ///< alpha^2 + trace cov(slopes): Baker 2011
  kNone,     ///< alpha^2 as it is averaged: what an engine makes of the maps alone
};

struct MipRuleName {
  MipRule rule;
  const char* name;
};
inline constexpr std::array<MipRuleName, 9> kMipRules = {{{MipRule::kVmf, "vmf"},
                                                          {MipRule::kVmfYarns, "vmf-yarns"},
                                                          {MipRule::kVmfSeedCode, "seed-code"},
                                                          {MipRule::kVmfSeedEq37, "seed-eq37"},
                                                          {MipRule::kToksvig, "toksvig"},
                                                          {MipRule::kLengths, "lengths"},
                                                          {MipRule::kLean, "lean"},
                                                          {MipRule::kClean, "clean"},
                                                          {MipRule::kNone, "none"}}};
const char* name_of(MipRule rule);
std::optional<MipRule> mip_rule_named(std::string_view name);

/// Width of a GGX lobe: across the yarn and along it, and the yarn's azimuth from x towards y.
struct LobeWidth {
  double across = 1, along = 1;  ///< alpha, 0 to 1
  double azimuth_deg = 0;
};

/// 1/kappa of a mean normal of length r: 0 from r = 1 on, no bound towards 0.
double inverse_kappa(double r);

/// Sums over the pixels beneath a texel, from which any rule can be read.
struct Footprint {
  double weight = 0;
  Vec3 normal;                       ///< sum of w n
  Vec3 shortened;                    ///< sum of w n times normal_length() of the pixel
  std::array<double, 5> products{};  ///< sums of w n_x n_x, n_x n_y, n_y n_y, n_x n_z, n_y n_z
  std::array<double, 5> slopes{};    ///< sums of w p, q, p p, p q, q q
  std::array<double, 3> alphas{};    ///< sums of w times alpha^2 as a tensor of x and y: xx, xy, yy

  /// A pixel. Slopes count up to 20 (87 degrees). `shortening`: normal_length() of the lobe; for kLengths
  /// only.
  void add(double w, Vec3 unit_normal, const LobeWidth& lobe, double shortening = 1);
  void add(double share, const Footprint& other);
};

/// What a texel holds. Where nothing lies beneath, or normals cancel: (0, 0, 1) and alpha 1.
struct MipTexel {
  Vec3 normal = {0, 0, 1};
  LobeWidth
      lobe;  ///< along <= across <= 1, azimuth of the narrow direction in 0 to 180, 0 where both are equal
};
MipTexel filtered(const Footprint& footprint, MipRule rule);

/// By which area a normal counts in a mean.
enum class NormalWeight {
  kProjected,  ///< as seen from above: all alike (seed 001 algorithm 2; what hardware filters by)
  kFacet,      ///< its own: 1 / n_z (seed 001 algorithm 1); the mean is then that of slopes
};

/// What lies between the centres of pixels (seed 001, section 2.3).
enum class PixelMeaning {
  kFacet,   ///< nothing: the finest level stays as it is
  kSample,  ///< slopes go on linearly: pixels have a spread of their own
};

struct MipOptions {
  MipRule rule = MipRule::kVmf;
  NormalWeight weight = NormalWeight::kProjected;
  PixelMeaning pixels = PixelMeaning::kFacet;
  double alpha = 1;  ///< 0 to 1, where the surface has no lobe: across the yarn, which lies along x
  double along = 1;  ///< and along it, over that; their product is 0 to 1 too
  Size base = {};    ///< of level 0, nowhere larger than the surface; empty: the surface's own
  int finest = 1;    ///< the first level that is made
  int threads = 0;
};

struct MipLevel {
  int level = 0;
  Image<float> normal;    ///< X, Y, Z of unit length
  Image<float> lobe;      ///< alpha across and along, azimuth in degrees: LobeWidth as in MipTexel
  double mean_alpha = 0;  ///< root of the mean alpha^2, of what a person calls the level's roughness
};

/// Levels of width and height max(1, base >> level), down to 1 x 1. A texel is the box of the picture that it
/// covers, of pixels that it cuts by their share, so that odd sizes lose no border. Pixels without a solution
/// are left out, and those with an opacity count by it. Constant normals leave alpha bit for bit; a lobe that
/// is wider along than across comes back with its axes exchanged, the same lobe. The same bytes for any
/// number of threads. Nothing comes back of 1 x 1 pixels. kUsage for an alpha out of 0 to 1, a level below 0,
/// a base that is larger than the surface and a surface without pixels.
Result<std::vector<MipLevel>> roughness_mips(const Surface& surface, const MipOptions& options = {});

}  // namespace weft::material
