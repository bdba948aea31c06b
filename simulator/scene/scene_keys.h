// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "simulator/geometry/knit.h"
#include "simulator/geometry/print.h"
#include "simulator/geometry/weave.h"
#include "simulator/light/measured_rig.h"
#include "simulator/reflectance/presets.h"
#include "simulator/scene/camera_keys.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_reader.h"
#include "simulator/targets/pattern.h"

// Every key of a scene, once: what reads, checks and writes scenes walks over these functions. Internal to
// simulator/scene.

namespace weft::simulator {

inline constexpr Range kLeak = {0, 0.5};
inline constexpr Range kFlux = {0, 1e12};
inline constexpr Range kHeight_mm = {-1000, 1000};
inline constexpr Range kTargetSize_mm = {0.1, 1e4};
inline constexpr Range kTargetGap_mm = {0, 1000};
inline constexpr int kChartPatches = 24;

/// The key that chooses the alternative of a variant; another one than before starts from its defaults.
template <typename Visitor, typename... Alternatives>
void choose(Visitor& v, const char* key, std::variant<Alternatives...>& value,
            const std::array<const char*, sizeof...(Alternatives)>& spelled) {
  Names<std::size_t> names;
  for (const char* each : spelled) names.emplace_back(each, names.size());
  std::size_t index = value.index();
  v.choice(key, index, names);
  const std::array<std::variant<Alternatives...>, sizeof...(Alternatives)> fresh = {Alternatives{}...};
  if (index != value.index()) value = fresh[index];
}

template <typename Visitor>
void walk(Visitor& v, PicturePlacement& p) {
  v.number("mm_per_sample", p.mm_per_sample, {1e-4, 1000});
  v.number("offset_x_mm", p.offset_x_mm, kCoordinate_mm);
  v.number("offset_y_mm", p.offset_y_mm, kCoordinate_mm);
  v.number("rotation_deg", p.rotation_deg, kAngle_deg);
  v.flag("repeats", p.repeats);
}

/// The part of GeometrySettings that is a section of its own.
struct HeightMapSection {
  GeometrySettings& geometry;
};

inline bool heights_are_in_range(const Image<float>& heights_mm) {
  for (int y = 0; y < heights_mm.height(); ++y) {
    const float* row = &heights_mm(0, y);
    if (!std::all_of(row, row + heights_mm.width(), [](float h) { return std::abs(h) <= kHeight_mm.most; }))
      return false;
  }
  return true;
}

template <typename Visitor>
void walk(Visitor& v, HeightMapSection& s) {
  GeometrySettings& g = s.geometry;
  v.picture("file", g.heights_file, g.heights_mm);
  v.require(g.heights_mm || !g.heights_file.empty(), "file", "a picture of heights was expected");
  if (g.heights_mm) {
    const Result<void> checked = check_heights(g);
    v.require(checked, "file");
    v.require(!checked || heights_are_in_range(*g.heights_mm), "file",
              "its heights are not between -1000 and 1000 mm");
  }
  walk(v, g.height_map);
}

template <typename Visitor>
void walk(Visitor& v, Fold& f) {
  v.number("amplitude_mm", f.amplitude_mm, kHeight_mm);
  v.number("wavelength_mm", f.wavelength_mm, {1e-3, 1e5});
  v.number("direction_deg", f.direction_deg, kAngle_deg);
  v.number("sharpness", f.sharpness, {0.1, 50});
}

template <typename Visitor>
void walk(Visitor& v, Wave& w) {
  v.number("amplitude_mm", w.amplitude_mm, kHeight_mm);
  v.number("wavelength_mm", w.wavelength_mm, {1e-3, 1e5});
  v.number("direction_deg", w.direction_deg, kAngle_deg);
  v.number("phase_deg", w.phase_deg, kAngle_deg);
}

template <typename Visitor>
void walk_weave(Visitor& v, GeometrySettings& g) {
  v.number("warp_pitch_mm", g.warp_pitch_mm, {0.01, 100});
  v.number("weft_pitch_mm", g.weft_pitch_mm, {0.01, 100});
  if (g.kind != GeometryKind::kPlain) {
    v.integer("over", g.over, 1, 32);
    v.integer("under", g.under, 1, 32);
    v.integer("step", g.step, 1, 63);
    const Draft draft = draft_of(g);
    v.require(draft.step < draft.period(), "step", "it must be below \"over\" + \"under\"");
  }
  v.number("crimp", g.crimp, {0, 0.5});
  v.number("flank_deg", g.flank_deg, {5, 80});
  v.number("twist_relief", g.twist_relief, {0, 0.1});
  v.number("flatness", g.flatness, {0, 0.9});
  v.number("fibre_relief", g.fibre_relief, {0, 0.05});
  v.number("fibre_spacing", g.fibre_spacing, {0.01, 1});
  v.number("fibre_angle_deg", g.fibre_angle_deg, {-60, 60});
  v.integer("fibre_seed", g.fibre_seed, 0, std::numeric_limits<std::int64_t>::max());
  v.require(yarns_stay_beside_their_neighbours(g), "crimp",
            "a yarn on top would cover its neighbours: lower it, \"twist_relief\" or \"fibre_relief\", or "
            "raise \"flank_deg\"");
}

template <typename Visitor>
void walk_knit(Visitor& v, GeometrySettings& g) {
  v.number("wale_mm", g.wale_mm, {0.01, 100});
  v.number("course_mm", g.course_mm, {0.01, 100});
  v.require(loops_reach_their_neighbours_only(g), "course_mm",
            "it must be between half of \"wale_mm\" and twice that");
  v.number("yarn_diameter", g.yarn_diameter, {0.1, 1});
  v.number("loop_flank_deg", g.loop_flank_deg, {5, 80});
}

template <typename Visitor>
void walk(Visitor& v, GeometrySettings& g) {
  std::optional<Family> family;
  v.choice("family", family,
           {{"smooth", Family::kSmooth}, {"plain", Family::kPlain}, {"deep", Family::kDeep}});
  if (family) g = family_settings(*family);
  v.choice("kind", g.kind,
           {{"flat", GeometryKind::kFlat},
            {"tilted", GeometryKind::kTilted},
            {"plain", GeometryKind::kPlain},
            {"twill", GeometryKind::kTwill},
            {"satin", GeometryKind::kSatin},
            {"knit", GeometryKind::kKnit},
            {"sphere", GeometryKind::kSphere},
            {"cylinder", GeometryKind::kCylinder},
            {"height_map", GeometryKind::kHeightMap}});
  v.require(!family || is_woven(g.kind), "family", "it is a weave, and this kind of geometry is none");
  v.number("cloth_height_mm", g.cloth_height_mm, {-100, 1000});
  if (g.kind == GeometryKind::kTilted) v.number("tilt_deg", g.tilt_deg, {0, 85});
  if (g.kind == GeometryKind::kTilted || g.kind == GeometryKind::kCylinder)
    v.number("azimuth_deg", g.azimuth_deg, kAngle_deg);
  if (is_woven(g.kind)) walk_weave(v, g);
  if (g.kind == GeometryKind::kKnit) walk_knit(v, g);
  if (g.kind == GeometryKind::kSphere || g.kind == GeometryKind::kCylinder) {
    v.number("radius_mm", g.radius_mm, {0.1, 1000});
    v.number("contact_deg", g.contact_deg, {5, 89});
  }
  if (g.kind == GeometryKind::kHeightMap) {
    HeightMapSection height_map = {g};
    v.section("height_map", height_map);
  }
  v.list("fold", g.folds);
  v.list("wave", g.waves);
}

template <typename Visitor>
void walk(Visitor& v, PrintSettings& p) {
  v.picture("file", p.file, p.albedo);
  v.require(check_print(p), "file");
  walk(v, p.placement);
  v.require(p.albedo || !p.file.empty() || p == PrintSettings(), "file", "a picture to print was expected");
}

template <typename Visitor>
void walk_lobe(Visitor& v, Rgb& f0, Beneath& beneath) {
  v.rgb("f0", f0, kShare);
  v.choice(
      "beneath", beneath,
      {{"lambert", Beneath::kLambert}, {"balanced", Beneath::kBalanced}, {"coupled", Beneath::kCoupled}});
}

template <typename Visitor>
void walk(Visitor&, Lambert&) {}

template <typename Visitor>
void walk(Visitor& v, Ggx& m) {
  v.number("alpha", m.alpha, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, AnisotropicGgx& m) {
  v.number("alpha", m.alpha, kShare);
  v.number("anisotropy", m.anisotropy, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, Beckmann& m) {
  v.number("alpha", m.alpha, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, BlinnPhong& m) {
  v.number("gloss", m.gloss, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, Cloth& m) {
  v.number("alpha", m.alpha, kShare);
  v.number("amplitude", m.amplitude, {0, 1000});
  v.rgb("f0", m.f0, kShare);
}

template <typename Visitor>
void walk(Visitor& v, MultipleScattering& m) {
  v.number("gloss", m.gloss, kShare);
}

template <typename Visitor>
void walk(Visitor& v, OrenNayar& m) {
  v.number("sigma", m.sigma, {0, kPi / 2});
}

template <typename Visitor>
void walk(Visitor& v, DisneyDiffuse& m) {
  v.number("roughness", m.roughness, kShare);
}

template <typename Visitor>
void walk(Visitor& v, FibreCones& m) {
  v.number("spread_deg", m.spread_deg, {0.1, 45});
  v.number("tilt_deg", m.tilt_deg, {-20, 20});
  v.number("twist_deg", m.twist_deg, {-90, 90});
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, MixedGgx& m) {
  v.number("alpha", m.alpha, kShare);
  v.number("second_alpha", m.second_alpha, kShare);
  v.number("second_share", m.second_share, kShare);
  walk_lobe(v, m.f0, m.beneath);
}

template <typename Visitor>
void walk(Visitor& v, Reflectance& r) {
  choose(v, "model", r,
         {"lambert", "ggx", "anisotropic_ggx", "beckmann", "blinn_phong", "cloth", "multiple_scattering",
          "oren_nayar", "disney_diffuse", "fibre_cones", "mixed_ggx"});
  std::visit([&](auto& model) { walk(v, model); }, r);
}

template <typename Visitor>
void walk(Visitor& v, TranslucencySettings& t) {
  constexpr Range kMean_mm = {0.001, 5};
  v.number("share", t.share, {0, 0.9});
  v.number("mean_mm", t.mean_mm, kMean_mm);
  v.number("warp_share", t.warp_share, {0, 0.9});
  v.number("warp_mean_mm", t.warp_mean_mm, kMean_mm);
  v.number("weft_share", t.weft_share, {0, 0.9});
  v.number("weft_mean_mm", t.weft_mean_mm, kMean_mm);
}

template <typename Visitor>
void walk(Visitor& v, MaterialSettings& m) {
  v.spectrum("dye", m.dye);
  v.spectrum("warp_dye", m.warp_dye);
  v.spectrum("weft_dye", m.weft_dye);
  std::optional<std::string> named;
  v.text("preset", named);
  if (named) {
    const Result<Preset> found = preset(*named);
    v.require(found, "preset");
    if (found) {
      m.reflectance = found->reflectance;
      if (!m.dye) m.albedo = found->albedo;
    }
  }
  v.rgb("albedo", m.albedo, kShare);
  v.rgb("warp_albedo", m.warp_albedo, kShare);
  v.rgb("weft_albedo", m.weft_albedo, kShare);
  v.integer("stripe_yarns", m.stripe_yarns, 0, 1000);
  v.number("yarn_variation", m.yarn_variation, {0, 0.5});
  v.optional_section("print", m.print);
  v.section("reflectance", m.reflectance);
  v.section("translucency", m.translucency);
}

template <typename Visitor>
void walk(Visitor& v, LedRing& r) {
  v.integer("count", r.count, 1, 256);
  v.number("zenith_deg", r.zenith_deg, {0, 89});
  v.number("azimuth_deg", r.azimuth_deg, kAngle_deg);
  v.number("distance_mm", r.distance_mm, {10, 1e4});
}

template <typename Visitor>
void walk(Visitor& v, LedSettings& l) {
  v.vec3("position_mm", l.position_mm, kCoordinate_mm);
  v.vec3("aim", l.aim, kCoordinate_mm);
  v.require(!l.aim || length(*l.aim) > 1e-6, "aim", "it must be longer than 0");
  v.number("mu", l.mu, {0, 100});
  v.rgb("flux_rgb", l.flux_rgb, kFlux);
}

/// The lights, and how far the camera is in whose frame a measured rig may be.
struct LightSection {
  LightSettings& lights;
  double camera_distance_mm;
};

template <typename Visitor>
void walk(Visitor& v, LightSection& s) {
  LightSettings& l = s.lights;
  v.number("flux", l.flux, kFlux);
  v.rgb("white_balance", l.white_balance, {1e-3, 100});
  v.number("mu", l.mu, {0, 100});
  v.number("led_radius_mm", l.led_radius_mm, {0, 100});
  v.number("drift", l.drift, {0, 0.5});
  v.number("flicker", l.flicker, {0, 0.1});
  v.number("stray", l.stray, kShare);
  v.number("ambient", l.ambient, kShare);
  std::optional<std::string> rig;
  v.file("rig", rig);
  if (rig) {
    const Result<std::vector<NearLight>> measured = read_measured_rig(*rig, s.camera_distance_mm);
    v.require(measured, "rig");
    if (measured) {
      for (const NearLight& led : *measured)
        l.leds.push_back({led.position_mm, led.aim, led.mu, led.flux_rgb});
    }
  }
  v.list("ring", l.rings);
  v.list("led", l.leds);
}

template <typename Visitor>
void walk(Visitor& v, FilmSettings& f) {
  v.choice("states", f.states,
           {{"none", FilmStates::kNone},
            {"crossed", FilmStates::kCrossed},
            {"parallel", FilmStates::kParallel},
            {"both", FilmStates::kBoth}});
  v.number("leak", f.leak, kLeak);
  v.number("transmission", f.transmission, {0.1, 1});
}

template <typename Visitor>
void walk(Visitor& v, SpectraSettings& s) {
  v.spectrum("led", s.led);
  v.spectra("filters", s.filters);
  v.chart("chart", s.chart, kChartPatches);
}

template <typename Visitor>
void walk(Visitor& v, TransportSettings& t) {
  v.integer("shadow_rays", t.shadow_rays, 1, 65536);
  v.integer("bounce_rays", t.bounce_rays, 1, 65536);
  v.integer("bounces", t.bounces, 1, 64);
}

template <typename Visitor>
void walk(Visitor& v, PaperSettings& p) {
  v.number("width_mm", p.width_mm, kTargetSize_mm);
  v.number("height_mm", p.height_mm, kTargetSize_mm);
}

template <typename Visitor>
void walk(Visitor& v, CheckerboardSettings& b) {
  v.integer("squares_x", b.squares_x, 1, 100);
  v.integer("squares_y", b.squares_y, 1, 100);
  v.number("square_mm", b.square_mm, kTargetSize_mm);
  v.number("margin_mm", b.margin_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, CharucoSettings& b) {
  v.integer("squares_x", b.squares_x, 2, 100);
  v.integer("squares_y", b.squares_y, 2, 100);
  v.number("square_mm", b.square_mm, kTargetSize_mm);
  v.number("marker_share", b.marker_share, {0.1, 0.95});
  v.text("dictionary", b.dictionary);
  v.number("margin_mm", b.margin_mm, kTargetGap_mm);
  v.flag("mirrored", b.mirrored);
}

template <typename Visitor>
void walk(Visitor& v, GreyScaleSettings& g) {
  v.numbers("reflectances", g.reflectances, kShare);
  v.number("patch_mm", g.patch_mm, kTargetSize_mm);
  v.number("gap_mm", g.gap_mm, kTargetGap_mm);
  v.number("margin_mm", g.margin_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, ChartSettings& c) {
  v.number("patch_mm", c.patch_mm, kTargetSize_mm);
  v.number("gap_mm", c.gap_mm, kTargetGap_mm);
  v.number("frame_mm", c.frame_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, TagSettings& t) {
  v.text("dictionary", t.dictionary);
  v.integer("id", t.id, 0, std::numeric_limits<int>::max());
  v.number("side_mm", t.side_mm, kTargetSize_mm);
  v.number("margin_mm", t.margin_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, SheetSettings& s) {
  v.number("waviness_deg", s.waviness_deg, {0, 10});
  v.number("wavelength_mm", s.wavelength_mm, {1, 1e4});
  v.number("grain_percent", s.grain_percent, {0, 20});
  v.number("grain_deg", s.grain_deg, {0, 20});
  v.number("grain_mm", s.grain_mm, {0.01, 10});
  v.number("non_lambertian", s.non_lambertian, {-0.5, 1});
}

template <typename Visitor>
void walk(Visitor& v, TargetSettings& t) {
  choose(v, "kind", t.pattern, {"paper", "checkerboard", "charuco", "grey_scale", "chart", "tag"});
  std::visit([&](auto& pattern) { walk(v, pattern); }, t.pattern);
  v.require(make_pattern(t.pattern), "kind");
  v.vec3("centre_mm", t.centre_mm, kCoordinate_mm);
  v.number("tilt_deg", t.tilt_deg, {0, 85});
  v.number("azimuth_deg", t.azimuth_deg, kAngle_deg);
  v.number("rotation_deg", t.rotation_deg, kAngle_deg);
  v.number("white", t.white, kShare);
  v.number("black", t.black, kShare);
  v.section("sheet", t.sheet);
}

template <typename Visitor>
void walk(Visitor& v, DamageSettings& d) {
  v.choice("kind", d.kind,
           {{"missing", DamageKind::kMissing},
            {"saturated", DamageKind::kSaturated},
            {"black", DamageKind::kBlack},
            {"fade", DamageKind::kFade}});
  v.integer("first_led", d.first_led, 1, 256);
  v.integer("last_led", d.last_led, 1, 256);
  v.require(d.first_led <= d.last_led, "last_led", "it must not be below \"first_led\"");
  v.number("left", d.left, kShare);
  v.number("right", d.right, kShare);
  v.require(d.left <= d.right, "right", "it must not be below \"left\"");
  v.number("top", d.top, kShare);
  v.number("bottom", d.bottom, kShare);
  v.require(d.top <= d.bottom, "bottom", "it must not be below \"top\"");
  if (d.kind == DamageKind::kFade) v.number("decades", d.decades, {0, 30});
}

template <typename Visitor>
void walk(Visitor& v, EffectSettings& e) {
  for (const EffectKey& effect : effect_keys()) v.flag(effect.name, e.*effect.on);
}

template <typename Visitor>
void walk(Visitor& v, ClothPose& p) {
  v.number("tilt_deg", p.tilt_deg, {0, kMostTilt_deg});
  v.number("downhill_deg", p.downhill_deg, kAngle_deg);
}

template <typename Visitor>
void walk(Visitor& v, Scene& s) {
  v.text("fabric", s.fabric);
  v.integer("seed", s.seed, 0, std::numeric_limits<std::int64_t>::max());
  v.choice("frames", s.frames, {{"dng", FrameFormat::kDng}, {"exr", FrameFormat::kExr}});
  v.automatic("effects", "to", s.auto_to_sigma);
  v.section("camera", s.camera);
  v.section("geometry", s.geometry);
  v.optional_section("pose", s.pose);
  v.section("material", s.material);
  LightSection lights = {s.lights, s.camera.distance_mm};
  v.section("lights", lights);
  v.optional_section("films", s.films);
  v.optional_section("spectra", s.spectra);
  v.section("transport", s.transport);
  v.list("target", s.targets);
  v.list("damage", s.damage);
  if (!s.auto_to_sigma) v.flags("effects", s.effects);
}

}  // namespace weft::simulator
