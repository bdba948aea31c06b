// SPDX-License-Identifier: Apache-2.0
#include "core/rig/gloss_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace weft {
namespace {

constexpr double kGlossOctaves = 18;       // seed 001 eq. 2
constexpr double kBlinnPhongOctaves = 13;  // seed 004

struct ScaleName {
  GlossScale scale;
  const char* name;
};
constexpr std::array<ScaleName, 4> kScaleNames = {{{GlossScale::kAlpha, "alpha"},
                                                   {GlossScale::kRoughness, "roughness"},
                                                   {GlossScale::kGloss, "gloss"},
                                                   {GlossScale::kBlinnPhong, "blinn-phong"}}};

}  // namespace

const char* name_of(GlossScale scale) {
  return std::ranges::find(kScaleNames, scale, &ScaleName::scale)->name;
}

std::optional<GlossScale> gloss_scale_named(std::string_view name) {
  const auto* found = std::ranges::find(kScaleNames, name, &ScaleName::name);
  return found == kScaleNames.end() ? std::nullopt : std::optional(found->scale);
}

AlphaRange alpha_range(GlossScale scale) {
  return {alpha_of(scale, 0) < alpha_of(scale, 1) ? alpha_of(scale, 0) : alpha_of(scale, 1),
          std::max(alpha_of(scale, 0), alpha_of(scale, 1))};
}

double blinn_phong_power(double alpha) {
  return 2 / (alpha * alpha) - 2;
}

double alpha_of_power(double power) {
  return std::sqrt(2 / (std::max(power, 0.0) + 2));
}

double on_scale(GlossScale scale, double alpha) {
  const AlphaRange range = alpha_range(scale);
  const double a = std::clamp(alpha, range.least, range.most);
  switch (scale) {
    case GlossScale::kAlpha:
      return a;
    case GlossScale::kRoughness:
      return std::sqrt(a);
    case GlossScale::kGloss:
      return std::clamp(std::log2(2 / (a * a) - 1) / kGlossOctaves, 0.0, 1.0);
    case GlossScale::kBlinnPhong:
      return std::clamp(std::log2(blinn_phong_power(a)) / kBlinnPhongOctaves, 0.0, 1.0);
  }
  return a;
}

double alpha_of(GlossScale scale, double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  switch (scale) {
    case GlossScale::kAlpha:
      return v;
    case GlossScale::kRoughness:
      return v * v;
    case GlossScale::kGloss:
      return std::sqrt(2 / (1 + std::exp2(kGlossOctaves * v)));
    case GlossScale::kBlinnPhong:
      return alpha_of_power(std::exp2(kBlinnPhongOctaves * v));
  }
  return v;
}

}  // namespace weft
