// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene_rules.h"

#include <algorithm>

namespace weft::simulator {
namespace {

bool has_yarn_colours(const MaterialSettings& m) {
  return m.warp_albedo || m.weft_albedo || m.warp_dye || m.weft_dye || m.stripe_yarns > 0 ||
         m.yarn_variation > 0;
}

bool tells_yarns_apart(const TranslucencySettings& t) {
  return t.warp_share || t.weft_share || t.warp_mean_mm || t.weft_mean_mm;
}

bool has_chart(const Scene& s) {
  return std::any_of(s.targets.begin(), s.targets.end(),
                     [](const TargetSettings& t) { return kind_of(t.pattern) == TargetKind::kChart; });
}

bool passes_nothing(const Spectrum& s) {
  return std::all_of(s.samples.begin(), s.samples.end(), [](double share) { return share == 0; });
}

bool has_photosites(const EffectSettings& e) {
  return e.bloom || e.dark_current || e.uneven_response || e.nonlinearity;
}

bool loses_readings(const Scene& s) {
  return std::any_of(s.damage.begin(), s.damage.end(),
                     [](const DamageSettings& d) { return d.kind == DamageKind::kMissing; });
}

constexpr const char* kNearLight = "set near_light = true, or leave it out";
constexpr const char* kRelief = "set relief = true, or leave it out";
constexpr const char* kOneColour = "keep one of the two";

constexpr SceneRule kRules[] = {
    {"material", [](const Scene& s) { return !is_woven(s.geometry.kind) && has_yarn_colours(s.material); },
     "it has colours for yarns, and this geometry has none",
     "remove them, or choose a woven kind of geometry"},
    {"material.translucency",
     [](const Scene& s) { return !is_woven(s.geometry.kind) && tells_yarns_apart(s.material.translucency); },
     "it tells warp from weft, and this geometry has neither",
     "give \"share\" and \"mean_mm\" alone, or choose a woven kind of geometry"},
    {"material.dye",
     [](const Scene& s) { return s.material.dye && s.material.albedo != MaterialSettings().albedo; },
     "\"albedo\" gives the same cloth another colour", kOneColour},
    {"material.warp_dye", [](const Scene& s) { return s.material.warp_dye && s.material.warp_albedo; },
     "\"warp_albedo\" gives the same yarns another colour", kOneColour},
    {"material.weft_dye", [](const Scene& s) { return s.material.weft_dye && s.material.weft_albedo; },
     "\"weft_albedo\" gives the same yarns another colour", kOneColour},
    {"target", [](const Scene& s) { return has_chart(s) && s.spectra.chart.empty(); },
     "the patches of a chart are spectra, and there are none",
     "give spectra.chart a folder or a list of 24 spectra"},
    {"effects.finite_led", [](const Scene& s) { return s.effects.finite_led && !s.effects.near_light; },
     "without near_light every LED is infinitely far away and has no size", kNearLight},
    {"effects.relief", [](const Scene& s) { return s.effects.relief && !s.effects.near_light; },
     "without near_light no height of the cloth brings it nearer to a LED", kNearLight},
    {"effects.vignetting", [](const Scene& s) { return s.effects.vignetting && !s.effects.near_light; },
     "without near_light the calibration holds distant lights, which have no place for a vignette",
     kNearLight},
    {"effects.cast_shadows", [](const Scene& s) { return s.effects.cast_shadows && !s.effects.relief; },
     "shadows are cast by the height of the cloth, which only relief lets light see", kRelief},
    {"effects.interreflection", [](const Scene& s) { return s.effects.interreflection && !s.effects.relief; },
     "light is traced over the height of the cloth, which only relief lets light see", kRelief},
    {"effects.spectral",
     [](const Scene& s) {
       const MaterialSettings& m = s.material;
       return s.effects.spectral && !m.dye && !(m.warp_dye && m.weft_dye) && !has_chart(s);
     },
     "neither a dye nor a chart says what there is to see by wavelength",
     "give material.dye, or warp_dye and weft_dye, or put a chart on the table"},
    {"effects.spectral",
     [](const Scene& s) {
       return s.effects.spectral &&
              (passes_nothing(s.spectra.led) ||
               std::any_of(s.spectra.filters.begin(), s.spectra.filters.end(), passes_nothing));
     },
     "the LED shines nothing or a filter of the camera passes nothing",
     "give led and filters in the section [spectra]"},
    {"frames", [](const Scene& s) { return s.frames == FrameFormat::kExr && has_photosites(s.effects); },
     "bloom, dark_current, uneven_response and nonlinearity act on photosites, and developed frames have "
     "none",
     "leave these effects out, or set frames = \"dng\""},
    {"damage", [](const Scene& s) { return s.frames == FrameFormat::kDng && loses_readings(s); },
     "the whole counts of a raw file have no way to say that one is missing", "set frames = \"exr\""},
};

}  // namespace

std::span<const SceneRule> scene_rules() {
  return kRules;
}

}  // namespace weft::simulator
