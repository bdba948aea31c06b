// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "core/base/vec.h"
#include "simulator/geometry/print.h"
#include "simulator/reflectance/presets.h"
#include "simulator/scene/geometry_keys.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"

// The keys of [material] and of its sections: a part of scene_keys.h.

namespace weft::simulator {

template <typename Visitor>
void walk(Visitor& v, PrintSettings& p) {
  v.picture({"file", "",
             "A picture of three channels, linear albedo from 0 to 1. What an 8-bit picture holds is taken "
             "as linear, too"},
            p.file, p.albedo);
  v.require(check_print(p), "file");
  walk(v, p.placement);
  v.require(p.albedo || !p.file.empty() || p == PrintSettings(), "file", "a picture to print was expected");
}

template <typename Visitor>
void walk_lobe(Visitor& v, Rgb& f0, Beneath& beneath) {
  v.rgb({"f0", "", "Reflectance at normal incidence"}, f0, kShare);
  v.choice(
      {"beneath", "",
       "What light reaches the colour below the highlight: all, what the highlight leaves, or that of a "
       "polished surface"},
      beneath,
      {{"lambert", Beneath::kLambert}, {"balanced", Beneath::kBalanced}, {"coupled", Beneath::kCoupled}});
}

template <typename Visitor>
void walk(Visitor&, Lambert&) {}

template <typename Visitor>
void walk(Visitor& v, Ggx& m) {
  v.number({"alpha", "", "Roughness"}, m.alpha, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, AnisotropicGgx& m) {
  v.number({"alpha", "", "Roughness across the fibres"}, m.alpha, kShare);
  v.number({"anisotropy", "", "Roughness along the fibres is `alpha` (1 - `anisotropy`)"}, m.anisotropy,
           kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, Beckmann& m) {
  v.number({"alpha", "", "Roughness"}, m.alpha, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, BlinnPhong& m) {
  v.number({"gloss", "", "The highlight has the power 2^(13 `gloss`)"}, m.gloss, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, Cloth& m) {
  v.number({"alpha", "", "Spread of the fibres about upright"}, m.alpha, kShare);
  v.number({"amplitude", "", "Of the fuzz against the offset"}, m.amplitude, {0, 1000});
  v.rgb({"f0", "", "Reflectance at normal incidence"}, m.f0, kShare);
}

template <typename Visitor>
void walk(Visitor& v, MultipleScattering& m) {
  v.number({"gloss", "", "0 is rough, 1 smooth"}, m.gloss, kShare);
}

template <typename Visitor>
void walk(Visitor& v, OrenNayar& m) {
  v.number({"sigma", "radians", "Standard deviation of the facets' slope"}, m.sigma, {0, kPi / 2});
}

template <typename Visitor>
void walk(Visitor& v, DisneyDiffuse& m) {
  v.number({"roughness", "", "0 is smooth, 1 rough"}, m.roughness, kShare);
}

template <typename Visitor>
void walk(Visitor& v, FibreCones& m) {
  v.number({"spread_deg", "degrees", "How broad the cone is that a fibre mirrors into"}, m.spread_deg,
           {0.1, 45});
  v.number({"tilt_deg", "degrees", "How much the fibres' scales lean"}, m.tilt_deg, {-20, 20});
  v.number({"twist_deg", "degrees", "Between fibres and the surface's x"}, m.twist_deg, {-90, 90});
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, MixedGgx& m) {
  v.number({"alpha", "", "Roughness of the first lobe"}, m.alpha, kShare);
  v.number({"second_alpha", "", "Roughness of the second lobe"}, m.second_alpha, kShare);
  v.number({"second_share", "", "The second lobe's share of the facets"}, m.second_share, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, Reflectance& r) {
  choose(v, {"model", "", "How the surface reflects"}, r,
         {"lambert", "ggx", "anisotropic_ggx", "beckmann", "blinn_phong", "cloth", "multiple_scattering",
          "oren_nayar", "disney_diffuse", "fibre_cones", "mixed_ggx"});
  std::visit([&](auto& model) { walk(v, model); }, r);
}

template <typename Visitor>
void walk(Visitor& v, TranslucencySettings& t) {
  constexpr Range kMean_mm = {0.001, 5};
  v.number({"share", "", "Of the light that falls on the cloth"}, t.share, {0, 0.9});
  v.number({"mean_mm", "mm", "Mean distance between where light enters and where it leaves"}, t.mean_mm,
           kMean_mm);
  v.number({"warp_share", "", "Woven: of the light that falls on the warp", "`share`"}, t.warp_share,
           {0, 0.9});
  v.number({"warp_mean_mm", "mm", "Woven: for light that enters the warp", "`mean_mm`"}, t.warp_mean_mm,
           kMean_mm);
  v.number({"weft_share", "", "Woven: of the light that falls on the weft", "`share`"}, t.weft_share,
           {0, 0.9});
  v.number({"weft_mean_mm", "mm", "Woven: for light that enters the weft", "`mean_mm`"}, t.weft_mean_mm,
           kMean_mm);
}

template <typename Visitor>
void walk(Visitor& v, MaterialSettings& m) {
  v.spectrum({"dye", "",
              "A spectrum in the place of `albedo`. Without the effect `spectral` it has the colour that an "
              "observer sees under the LED's white"},
             m.dye);
  v.spectrum({"warp_dye", "", "Woven: a spectrum in the place of `warp_albedo`"}, m.warp_dye);
  v.spectrum({"weft_dye", "", "Woven: a spectrum in the place of `weft_albedo`"}, m.weft_dye);
  std::optional<std::string> named;
  v.text({"preset", "",
          "A cloth's `[material.reflectance]` by [its name](../reflectance.md#presets), and its albedo where "
          "the "
          "scene has none. `truth/scene.toml` has its numbers in its place"},
         named);
  if (named) {
    const Result<ClothPreset> found = preset(*named);
    v.require(found, "preset");
    if (found) {
      m.reflectance = found->reflectance;
      if (!m.dye) m.albedo = found->albedo;
    }
  }
  v.rgb({"albedo", "", "Diffuse reflectance"}, m.albedo, kShare);
  v.rgb({"warp_albedo", "", "Woven: of the warp", "`albedo`"}, m.warp_albedo, kShare);
  v.rgb({"weft_albedo", "", "Woven: of the weft", "`albedo`"}, m.weft_albedo, kShare);
  v.integer({"stripe_yarns", "yarns",
             "Woven: 0 gives each set its colour; n gives both sets n yarns of the warp's colour, then n of "
             "the weft's. 4 on a 2/2 twill is houndstooth"},
            m.stripe_yarns, 0, 1000);
  v.number({"yarn_variation", "", "Woven: the albedo of a yarn is multiplied by a number in 1 ± this"},
           m.yarn_variation, {0, 0.5});
  v.optional_section("print",
                     "A picture that multiplies the colours of the cloth. Beside a picture that does not "
                     "repeat nothing is printed",
                     m.print);
  v.section("reflectance", "Effect `reflectance`, by one of [these models](../reflectance.md)",
            m.reflectance);
  v.section("translucency",
            "Effect `translucency`: light that enters a yarn and leaves beside where it entered",
            m.translucency);
}

}  // namespace weft::simulator
