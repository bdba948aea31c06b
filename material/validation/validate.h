// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/solve/verdict.h"
#include "material/surface.h"

// Whether maps are those of a cloth, and fit to be put on a material. Nothing here corrects a map: a value
// out of the usual range may be right, and a check says when it is likely to be.

namespace weft::material {

enum class Severity { kPassed, kWarning, kError };
inline constexpr std::array kSeverityNames = {"passed", "warning", "error"};
const char* name_of(Severity severity);

/// What one check says. Every check that had its input gives one, passed or not.
struct Finding {
  Verdict verdict;  ///< name for programs, a sentence with the numbers, and a remedy unless it passed
  Severity severity = Severity::kPassed;
  double number = 0;          ///< what was measured
  double limit = 0;           ///< what it was held to, in the same unit
  Image<std::uint8_t> where;  ///< 255 at the pixels that the sentence is about; empty: of no pixels
};

/// A patch whose true colour is known.
struct KnownGrey {
  Rect pixels;
  double reflectance = 0;
};

/// Maps to look at. What is empty or not there is not checked.
struct MapsToValidate {
  const Surface* surface = nullptr;  ///< needed
  View<const float> openness = {};   ///< 0 to 1
  View<const float> height_mm = {};
  /// X, Y, Z as they are to be exported; empty: those of the surface's slopes.
  std::array<View<const float>, 3> normals = {};
  std::vector<KnownGrey> greys = {};
  bool is_metal = false;            ///< typed by a person; F0 is then that of a metal
  bool has_measured_black = false;  ///< the session has a dark frame: dark albedos may be believed
  /// The solve's level, "standard"; empty: nobody knows. No remedy names it or one below.
  std::string level = {};
  bool is_of_rig = true;             ///< else no remedy names its calibration
  bool is_height_of_slopes = false;  ///< integrated from this surface's slopes, so that its scale is theirs
  bool is_colour_changed = false;    ///< by a person, in a step that can be taken back
};

/// Limits of the checks; the page docs/filtering.md has their sources.
struct ValidationLimits {
  double dark_error = 0.0130, dark_warning = 0.0319;   ///< linear luminance: sRGB 30 and 50
  double bright_warning = 0.871, bright_error = 0.95;  ///< sRGB 240; proposal
  double outside_share = 0.001;                        ///< of pixels that may lie beyond these
  double least_f0 = 0.02, most_f0 = 0.08;              ///< of a dielectric
  double least_metal_f0 = 0.328;                       ///< sRGB 155
  double energy = 1;                                   ///< of what is reflected, a channel
  double gamut = -0.002;                               ///< least channel
  double saturation = 40;                              ///< largest over least channel
  double lighting = 0.05;                              ///< slope over openness; correlation with normals
  double seam = 1;                                     ///< step at the wrap over the largest step inside
  double normal_length = 0.01;                         ///< off 1
  double height_off_slopes_deg = 1;                    ///< median: creases are off by more
  double least_mm_per_pixel = 0.005, most_mm_per_pixel = 1;
  double grey_off = 0.03;  ///< relative, of a patch's luminance; of channels alike
  int threads = 0;
};

/// Checks, in this order: ALBEDO_DARK, ALBEDO_BRIGHT, GAMUT, SATURATION (all on the albedo averaged 3 x 3, as
/// noise makes tails), F0, ENERGY (albedo + F0), LOBE_ENERGY (albedo + directional albedo of the mean lobe at
/// 0 and 60 degrees, as engines add them), LIGHT_IN_ALBEDO_OPENNESS, LIGHT_IN_ALBEDO_NORMALS, SEAM (tiles),
/// NORMAL_LENGTH, HEIGHT_OFF_SLOPES, TEXEL_DENSITY, GREYS. Pixels without a solution and holes (opacity under
/// 0.3) count nowhere. kUsage where there is no surface or a map has another size, kBadData where nothing has
/// a solution.
Result<std::vector<Finding>> validate(const MapsToValidate& maps, const ValidationLimits& limits = {});

/// The worst severity among findings, and verdicts of those that did not pass.
Severity worst_of(const std::vector<Finding>& findings);
std::vector<Verdict> verdicts_of(const std::vector<Finding>& findings);

/// What isotropic GGX with Smith's shadowing and Schlick's Fresnel reflects of light from all sides to a view
/// `view_deg` from the normal, 0 to 90: at most 1. By 32 x 32 visible facets (Heitz 2018), right to 0.002.
double ggx_directional_albedo(double alpha, double f0, double view_deg);

}  // namespace weft::material
