// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

// What openness does to light (Chan, "Material advances in Call of Duty: WWII", 2018, eq. 43 to 60): numbers
// a pixel. `openness` is that of Occlusion, 0 to 1; albedo is a channel's, 0 to 1. Values outside are
// clamped.

namespace weft::material {

/// What hidden directions send back, of the irradiance that a point in the open has.
enum class HiddenLight {
  kNone,        ///< eq. 45: nothing, plain openness
  kWhite,       ///< eq. 46: white cloth, hidden alike
  kSameOpen,    ///< eq. 47: cloth of the same albedo in the open
  kSameHidden,  ///< eq. 48: cloth of the same albedo, hidden alike
  /// eq. 49: what the point itself sends back (Stewart and Langer 1997): all bounces between points that are
  /// alike. The text beside figure 15 names eq. 48; its reasoning is that of 49. The best of them on weaves.
  kAsThePoint,
};

/// The share of a uniform sky's irradiance that reaches a point, bounces included: eq. 44's A. Where nothing
/// of the sky is seen it is 0, also at albedo 1, where eq. 49 is 0 / 0.
inline double lit_share(double openness, double albedo, HiddenLight hidden = HiddenLight::kAsThePoint) {
  const double a = std::clamp(openness, 0.0, 1.0), rho = std::clamp(albedo, 0.0, 1.0);
  switch (hidden) {
    case HiddenLight::kNone:
      return a;
    case HiddenLight::kWhite:
      return a * (1 - a) + a;
    case HiddenLight::kSameOpen:
      return rho * (1 - a) + a;
    case HiddenLight::kSameHidden:
      return rho * a * (1 - a) + a;
    case HiddenLight::kAsThePoint:
      break;
  }
  return a > 0 ? a / (1 - rho + rho * a) : 0;
}

/// Radiance of a Lambertian point in the shade (eq. 44): albedo / pi times irradiance times lit_share.
inline double shaded_radiance(double openness, double albedo, double irradiance,
                              HiddenLight hidden = HiddenLight::kAsThePoint) {
  return albedo / kPi * irradiance * lit_share(openness, albedo, hidden);
}

/// The cone about the normal through which as much of the sky is seen: cosine of the angle from its axis to
/// its edge, 0 for the whole sky (eq. 50 to 56).
inline double cone_cosine(double openness) {
  return std::sqrt(1 - std::clamp(openness, 0.0, 1.0));
}
/// Its angle in degrees, 90 for the whole sky.
inline double cone_angle_deg(double openness) {
  return degrees(std::asin(std::sqrt(std::clamp(openness, 0.0, 1.0))));
}

/// Direct light through that cone: `cos_to_light` is the cosine from the cone's axis to the light. About the
/// bent normal the soft edge is nearer to rays than no shadow at all; about the normal neither edge is.
inline double lit_by_hard_cone(double openness, double cos_to_light) {  // eq. 57
  return cone_cosine(openness) < cos_to_light ? 1 : 0;
}
inline double lit_by_soft_cone(double openness, double cos_to_light) {  // eq. 58
  const double edge = std::max(cone_cosine(openness), 0.001);           // listing 4 keeps it from 0
  const double part = std::clamp(cos_to_light / edge, 0.0, 1.0);
  return part * part;
}

/// The cone for specular light as the game shipped it, opened with gloss and at grazing views (eq. 59 and 60,
/// tuned by eye there): for comparison with SpecularOcclusion. As listing 3 has it, (1 - gloss^8) and
/// (1 - (1 - n.v)^4); eq. 59 prints gloss^2 and a bracket too far.
inline double shipped_cone_cosine(double cosine, double gloss, double cos_view) {
  const double g = std::clamp(1.5 * gloss, 0.0, 1.0), grazing = 1 - std::clamp(cos_view, 0.0, 1.0);
  return cosine * (1 - std::pow(g, 8)) * (1 - std::pow(grazing, 4));
}

}  // namespace weft::material
