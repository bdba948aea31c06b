// SPDX-License-Identifier: Apache-2.0
#include "bench/cloths/drawn_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "bench/sanity/drawn_cloth.h"
#include "core/base/vec.h"

namespace weft::bench {
namespace {

using namespace simulator;

using Make = void (*)(KindOfCloth& cloth, Draws& draws);

void all_effects(EffectSettings& effects) {
  effects.near_light = effects.relief = effects.cast_shadows = effects.interreflection = effects.noise =
      effects.reflectance = effects.translucency = true;
}

Rgb tinted(double albedo, Draws& draws) {
  Rgb colour;
  for (double& c : colour) c = std::clamp(albedo * draws.between(0.85, 1.12), 0.004, 0.92);
  return colour;
}

void weave(KindOfCloth& cloth, GeometryKind kind, double flank_deg, Draws& draws) {
  GeometrySettings& g = cloth.scene.geometry;
  g.kind = kind;
  g.warp_pitch_mm = draws.between(0.6, 1.1);
  g.weft_pitch_mm = g.warp_pitch_mm * draws.between(0.85, 1.2);
  g.flank_deg = flank_deg * draws.between(0.9, 1.1);
  g.crimp = (kind == GeometryKind::kPlain ? 0.0016 : 0.0012) * flank_deg * draws.between(0.7, 1.1);
  g.twist_relief = draws.between(0, 0.008);
  g.fibre_relief = draws.between(0, 0.003);
  g.fibre_spacing = 0.25;
  cloth.scene.material.yarn_variation = draws.between(0, 0.08);
}

void plain(KindOfCloth& cloth, double flank_deg, Draws& draws) {
  weave(cloth, GeometryKind::kPlain, flank_deg, draws);
}
void twill(KindOfCloth& cloth, double flank_deg, Draws& draws) {
  weave(cloth, GeometryKind::kTwill, flank_deg, draws);
}
void satin(KindOfCloth& cloth, double flank_deg, Draws& draws) {
  weave(cloth, GeometryKind::kSatin, flank_deg, draws);
}

void spread(KindOfCloth& cloth, double share, double mean_mm) {
  cloth.scene.material.translucency.share = share;
  cloth.scene.material.translucency.mean_mm = mean_mm;
}

MaterialSettings with(const Reflectance& reflectance, const Rgb& albedo) {
  MaterialSettings material;
  material.reflectance = reflectance;
  material.albedo = albedo;
  return material;
}

Ggx ggx(double alpha, double f0) {
  Ggx lobe;
  lobe.alpha = alpha;
  lobe.f0 = Rgb{f0, f0, f0};
  return lobe;
}
AnisotropicGgx drawn_out(double alpha, double anisotropy, const Rgb& f0) {
  AnisotropicGgx lobe;
  lobe.alpha = alpha;
  lobe.anisotropy = anisotropy;
  lobe.f0 = f0;
  return lobe;
}
Cloth fuzz(double alpha, double amplitude, const Rgb& f0) {
  Cloth lobe;
  lobe.alpha = alpha;
  lobe.amplitude = amplitude;
  lobe.f0 = f0;
  return lobe;
}

double place_in(double at_mm, double period_mm) {
  return at_mm / period_mm - std::floor(at_mm / period_mm);
}

// Stripes along y, `share` of their period wide.
std::function<bool(double, double)> stripes(double period_mm, double from, double to) {
  return [=](double x, double) {
    const double at = place_in(x, period_mm);
    return at >= from && at < to;
  };
}

std::function<bool(double, double)> dots(double period_mm, double radius_mm) {
  return [=](double x, double y) {
    const double row = std::floor(y / period_mm);
    const double u = (place_in(x + 0.5 * row * period_mm, period_mm) - 0.5) * period_mm;
    const double v = (place_in(y, period_mm) - 0.5) * period_mm;
    return u * u + v * v < radius_mm * radius_mm;
  };
}

void colour(KindOfCloth& cloth, double albedo, Draws& draws) {
  cloth.scene.material.albedo = tinted(albedo, draws);
}
void two_colours(KindOfCloth& cloth, double warp, double weft, Draws& draws) {
  cloth.scene.material.warp_albedo = tinted(warp, draws);
  cloth.scene.material.weft_albedo = tinted(weft, draws);
}

void white_cotton(KindOfCloth& c, Draws& d) {
  plain(c, d.between(25, 36), d);
  colour(c, d.between(0.65, 0.85), d);
  spread(c, d.between(0.15, 0.4), d.between(0.2, 0.5));
}
// As renderers without interreflection draw it.
void cotton_without_bounces(KindOfCloth& c, Draws& d) {
  plain(c, d.between(20, 34), d);
  colour(c, d.between(0.6, 0.85), d);
  spread(c, d.between(0.3, 0.6), d.between(0.2, 0.5));
  c.scene.effects.interreflection = false;
}
void chiffon(KindOfCloth& c, Draws& d) {
  plain(c, d.between(18, 28), d);
  colour(c, d.between(0.5, 0.75), d);
  spread(c, d.between(0.4, 0.6), d.between(0.3, 0.6));
}
void flannel(KindOfCloth& c, Draws& d) {
  twill(c, d.between(20, 28), d);
  c.scene.geometry.fibre_relief = 0.01;
  c.scene.material.reflectance = fuzz(0.6, 4, {0.01, 0.01, 0.01});
  colour(c, d.between(0.25, 0.5), d);
  spread(c, d.between(0.1, 0.3), d.between(0.2, 0.4));
}
void denim(KindOfCloth& c, Draws& d) {
  twill(c, d.between(26, 36), d);
  c.scene.geometry.over = 3;
  c.scene.geometry.under = 1;
  two_colours(c, d.between(0.04, 0.1), d.between(0.5, 0.7), d);
  c.scene.material.yarn_variation = 0.2;
}
void gingham(KindOfCloth& c, Draws& d) {
  plain(c, d.between(15, 28), d);
  two_colours(c, d.between(0.05, 0.3), d.between(0.6, 0.8), d);
  c.scene.material.stripe_yarns = 3 + d.below(3);
}
void poplin(KindOfCloth& c, Draws& d) {
  plain(c, d.between(10, 16), d);
  colour(c, d.between(0.7, 0.88), d);
}
void canvas(KindOfCloth& c, Draws& d) {
  plain(c, d.between(36, 46), d);
  c.scene.material.reflectance = OrenNayar{d.between(0.2, 0.5)};
  colour(c, d.between(0.25, 0.4), d);
}
void hopsack(KindOfCloth& c, Draws& d) {
  plain(c, d.between(42, 52), d);
  colour(c, d.between(0.6, 0.85), d);
}
void sateen(KindOfCloth& c, Draws& d) {
  satin(c, d.between(15, 25), d);
  c.scene.material.reflectance = ggx(d.between(0.3, 0.45), 0.03);
  colour(c, d.between(0.3, 0.7), d);
}
void silk_satin(KindOfCloth& c, Draws& d) {
  satin(c, d.between(10, 22), d);
  c.scene.material.reflectance = drawn_out(d.between(0.3, 0.45), d.between(0.3, 0.6), {0.05, 0.05, 0.05});
  colour(c, d.between(0.2, 0.5), d);
}
void dark_lining(KindOfCloth& c, Draws& d) {
  twill(c, d.between(12, 22), d);
  c.scene.material.reflectance = drawn_out(d.between(0.3, 0.4), d.between(0.3, 0.5), {0.05, 0.05, 0.05});
  colour(c, d.between(0.02, 0.06), d);
}
void changeant(KindOfCloth& c, Draws& d) {
  plain(c, d.between(10, 20), d);
  c.scene.material.reflectance = drawn_out(d.between(0.35, 0.45), d.between(0.4, 0.6), {0.04, 0.04, 0.04});
  c.scene.material.warp_albedo = Rgb{0.4, 0.06, 0.08};
  c.scene.material.weft_albedo = Rgb{0.05, 0.25, 0.1};
}
void patent(KindOfCloth& c, Draws& d) {
  c.scene.geometry.waves = {{0.2, d.between(5, 9), d.between(0, 90), 0},
                            {0.1, d.between(3, 5), d.between(90, 180), 40}};
  c.scene.material.reflectance = ggx(d.between(0.07, 0.15), 0.045);
  colour(c, d.between(0.03, 0.4), d);
}
void wet_look(KindOfCloth& c, Draws& d) {
  plain(c, d.between(12, 20), d);
  MixedGgx lobe;
  lobe.alpha = 0.15;
  lobe.second_alpha = 0.5;
  lobe.f0 = {0.045, 0.045, 0.045};
  c.scene.material.reflectance = lobe;
  colour(c, d.between(0.03, 0.12), d);
}
void lurex(KindOfCloth& c, Draws& d) {
  plain(c, d.between(14, 24), d);
  colour(c, d.between(0.1, 0.4), d);
  const double period = 4 * c.scene.geometry.warp_pitch_mm;
  c.parts = {
      {with(drawn_out(0.35, 0.4, {0.75, 0.6, 0.35}), {0.004, 0.004, 0.004}), stripes(period, 0, 0.25)}};
}
void sequins(KindOfCloth& c, Draws& d) {
  plain(c, d.between(14, 20), d);
  colour(c, d.between(0.2, 0.4), d);
  c.parts = {{with(ggx(d.between(0.2, 0.3), 0.85), {0.004, 0.004, 0.004}), dots(4, 1.5)}};
}
void foil_print(KindOfCloth& c, Draws& d) {
  twill(c, d.between(14, 22), d);
  colour(c, d.between(0.1, 0.3), d);
  c.parts = {{with(ggx(d.between(0.3, 0.4), 0.6), {0.01, 0.01, 0.01}), dots(6, 2)}};
}
void three_stripes(KindOfCloth& c, Draws& d) {
  twill(c, d.between(14, 22), d);
  colour(c, d.between(0.4, 0.7), d);
  c.parts = {{with(ggx(0.22, 0.05), tinted(0.08, d)), stripes(9, 0, 0.33)},
             {with(ggx(0.42, 0.04), tinted(0.3, d)), stripes(9, 0.33, 0.66)}};
}
void embroidery(KindOfCloth& c, Draws& d) {
  plain(c, d.between(16, 24), d);
  colour(c, d.between(0.3, 0.6), d);
  c.parts = {{with(drawn_out(0.35, 0.5, {0.05, 0.05, 0.05}), tinted(0.2, d)), dots(7, 2.5)}};
}
void velvet(KindOfCloth& c, Draws& d) {
  plain(c, d.between(10, 20), d);
  c.scene.material.reflectance = fuzz(d.between(0.35, 0.5), d.between(5, 12), {0.05, 0.02, 0.02});
  c.scene.material.albedo = {0.25, 0.03, 0.04};
}
void black_velvet(KindOfCloth& c, Draws& d) {
  plain(c, d.between(10, 20), d);
  c.scene.material.reflectance = fuzz(d.between(0.3, 0.4), d.between(5, 12), {0.03, 0.03, 0.03});
  colour(c, 0.012, d);
}
void jersey(KindOfCloth& c, Draws& d) {
  GeometrySettings& g = c.scene.geometry;
  g.kind = GeometryKind::kKnit;
  g.wale_mm = d.between(1, 1.4);
  g.course_mm = 0.75 * g.wale_mm;
  g.loop_flank_deg = d.between(40, 55);
  colour(c, d.between(0.2, 0.6), d);
}
void wool_knit(KindOfCloth& c, Draws& d) {
  jersey(c, d);
  spread(c, d.between(0.15, 0.35), d.between(0.2, 0.4));
  colour(c, d.between(0.5, 0.75), d);
}
void corduroy(KindOfCloth& c, Draws& d) {
  const double wale = d.between(1.6, 2.6);
  c.scene.geometry.waves = {{wale * d.between(0.08, 0.13), wale, d.between(-8, 8), 0}};
  c.scene.material.reflectance = fuzz(d.between(0.4, 0.6), d.between(2, 5), {0.02, 0.02, 0.02});
  colour(c, d.between(0.1, 0.4), d);
}
void crepe(KindOfCloth& c, Draws& d) {
  plain(c, d.between(22, 30), d);
  c.scene.geometry.fibre_relief = c.scene.geometry.twist_relief = 0.01;
  colour(c, d.between(0.3, 0.6), d);
}
void tweed(KindOfCloth& c, Draws& d) {
  twill(c, d.between(28, 38), d);
  two_colours(c, d.between(0.06, 0.2), d.between(0.3, 0.5), d);
  c.scene.material.yarn_variation = 0.35;
  c.scene.geometry.fibre_relief = 0.012;
}
void houndstooth(KindOfCloth& c, Draws& d) {
  twill(c, d.between(20, 28), d);
  two_colours(c, 0.03, d.between(0.6, 0.75), d);
  c.scene.material.stripe_yarns = 4;
}
void seersucker(KindOfCloth& c, Draws& d) {
  plain(c, d.between(14, 20), d);
  c.scene.geometry.waves = {{0.25, d.between(4, 7), d.between(0, 180), 0}};
  colour(c, d.between(0.5, 0.8), d);
}
void fibre_silk(KindOfCloth& c, Draws& d) {
  satin(c, d.between(10, 18), d);
  FibreCones lobe;
  lobe.spread_deg = d.between(8, 16);
  c.scene.material.reflectance = lobe;
  colour(c, d.between(0.15, 0.5), d);
}
void felt(KindOfCloth& c, Draws& d) {
  plain(c, d.between(8, 14), d);
  c.scene.geometry.fibre_relief = 0.006;
  c.scene.material.reflectance = MultipleScattering{d.between(0.1, 0.4)};
  colour(c, d.between(0.2, 0.6), d);
}
void brushed(KindOfCloth& c, Draws& d) {
  twill(c, d.between(16, 24), d);
  c.scene.material.reflectance = DisneyDiffuse{d.between(0.3, 0.9)};
  colour(c, d.between(0.2, 0.6), d);
}
void boiled_wool(KindOfCloth& c, Draws& d) {
  plain(c, d.between(34, 44), d);
  c.scene.geometry.fibre_relief = 0.01;
  spread(c, d.between(0.2, 0.35), d.between(0.25, 0.5));
  colour(c, d.between(0.3, 0.55), d);
}
void pinstripe(KindOfCloth& c, Draws& d) {
  twill(c, d.between(14, 22), d);
  colour(c, d.between(0.03, 0.08), d);
  c.parts = {{with(ggx(0.35, 0.04), tinted(0.5, d)), stripes(5, 0, 0.2)}};
}
void ball(KindOfCloth& c, Draws& d) {
  c.scene.geometry.kind = GeometryKind::kSphere;
  c.scene.geometry.radius_mm = 5.5;
  c.scene.geometry.contact_deg = 60;
  c.scene.material.reflectance = ggx(d.between(0.3, 0.5), 0.04);
  colour(c, d.between(0.2, 0.6), d);
}

void linen(KindOfCloth& c, Draws& d) {
  plain(c, d.between(26, 36), d);
  c.scene.geometry.fibre_relief = 0.008;
  c.scene.material.reflectance = OrenNayar{d.between(0.3, 0.6)};
  colour(c, d.between(0.4, 0.65), d);
}
void drill(KindOfCloth& c, Draws& d) {
  twill(c, d.between(24, 42), d);
  c.scene.material.reflectance = OrenNayar{d.between(0.15, 0.6)};
  colour(c, d.between(0.1, 0.6), d);
}

Reflectance any_reflectance(Draws& d) {
  const double f0 = d.between(0.02, 0.06);
  switch (d.below(12)) {
    case 0:
      return OrenNayar{d.between(0.1, 0.6)};
    case 1:
      return DisneyDiffuse{d.between(0.2, 0.9)};
    case 2:
      return MultipleScattering{d.between(0.1, 0.5)};
    case 3:
      return ggx(d.of_ratio(0.1, 0.5), f0);
    case 4:
      return drawn_out(d.between(0.2, 0.5), d.between(0.2, 0.7), {f0, f0, f0});
    case 5:
      return fuzz(d.between(0.3, 0.6), d.between(2, 12), {f0 / 2, f0 / 2, f0 / 2});
    case 6: {
      MixedGgx lobe;
      lobe.alpha = d.between(0.12, 0.25);
      lobe.second_alpha = d.between(0.35, 0.6);
      lobe.f0 = {f0, f0, f0};
      return lobe;
    }
    case 7: {
      FibreCones lobe;
      lobe.spread_deg = d.between(8, 18);
      return lobe;
    }
    default:
      return Lambert{};
  }
}
void any_geometry(KindOfCloth& c, Draws& d) {
  constexpr std::array kWeaves = {GeometryKind::kPlain, GeometryKind::kTwill, GeometryKind::kSatin};
  const double wave_mm = d.of_ratio(1.6, 8);
  switch (d.below(10)) {
    case 0:
      jersey(c, d);
      break;
    case 1:
      c.scene.geometry.waves = {{wave_mm * d.between(0.02, 0.12), wave_mm, d.between(0, 180), 0}};
      break;
    default:
      weave(c, kWeaves[static_cast<std::size_t>(d.below(3))], d.between(6, 50), d);
  }
  if (d.with(0.2)) c.scene.geometry.fibre_relief = d.between(0.003, 0.012);
  if (d.with(0.15)) c.scene.geometry.waves = {{d.between(0.05, 0.3), d.between(4, 10), d.between(0, 180), 0}};
}
// A cloth of no kind: whatever relief in whatever colours of whatever reflectance.
void anything(KindOfCloth& c, Draws& d) {
  any_geometry(c, d);
  c.scene.material.reflectance = any_reflectance(d);
  const GeometryKind kind = c.scene.geometry.kind;
  const bool is_woven =
      kind == GeometryKind::kPlain || kind == GeometryKind::kTwill || kind == GeometryKind::kSatin;
  if (is_woven && d.with(0.35)) {
    two_colours(c, d.of_ratio(0.02, 0.6), d.of_ratio(0.1, 0.8), d);
    c.scene.material.stripe_yarns = d.below(6);
  } else {
    colour(c, d.of_ratio(0.01, 0.9), d);
  }
  if (d.with(0.25)) spread(c, d.between(0.1, 0.6), d.between(0.15, 0.5));
  c.scene.effects.interreflection = d.with(0.9);
  if (!d.with(0.2)) return;
  const double period = d.of_ratio(1.5, 9);
  MaterialSettings other = with(any_reflectance(d), tinted(d.of_ratio(0.02, 0.7), d));
  if (d.with(0.25)) other = with(drawn_out(d.between(0.2, 0.4), 0.3, {0.8, 0.7, 0.5}), {0.004, 0.004, 0.004});
  c.parts = {{other, d.with(0.5) ? stripes(period, 0, d.between(0.1, 0.6)) : dots(period, 0.35 * period)}};
}

struct Kind {
  const char* name;
  Make make;
};
constexpr std::array kKinds = {
    Kind{"white cotton", white_cotton},
    Kind{"chiffon", chiffon},
    Kind{"cotton without bounces", cotton_without_bounces},
    Kind{"boiled wool", boiled_wool},
    Kind{"flannel", flannel},
    Kind{"wool knit", wool_knit},
    Kind{"denim", denim},
    Kind{"tweed", tweed},
    Kind{"gingham", gingham},
    Kind{"houndstooth", houndstooth},
    Kind{"poplin", poplin},
    Kind{"seersucker", seersucker},
    Kind{"hopsack", hopsack},
    Kind{"canvas", canvas},
    Kind{"silk satin", silk_satin},
    Kind{"sateen", sateen},
    Kind{"dark lining", dark_lining},
    Kind{"changeant", changeant},
    Kind{"patent", patent},
    Kind{"wet look", wet_look},
    Kind{"lurex", lurex},
    Kind{"foil print", foil_print},
    Kind{"three stripes", three_stripes},
    Kind{"pinstripe", pinstripe},
    Kind{"embroidery", embroidery},
    Kind{"sequins", sequins},
    Kind{"velvet", velvet},
    Kind{"black velvet", black_velvet},
    Kind{"jersey", jersey},
    Kind{"corduroy", corduroy},
    Kind{"brushed", brushed},
    Kind{"crepe", crepe},
    Kind{"felt", felt},
    Kind{"fibre silk", fibre_silk},
    Kind{"ball", ball},
    Kind{"linen", linen},
    Kind{"drill", drill},
};

// Every second kind is of the one set.
std::array<std::vector<std::string>, 2> names_by_set() {
  std::array<std::vector<std::string>, 2> names;
  for (std::size_t i = 0; i < kKinds.size(); ++i) names[i % 2].emplace_back(kKinds[i].name);
  return names;
}

}  // namespace

std::span<const std::string> names_of_kinds(KindSet set) {
  static const std::vector<std::string> kAnything = {"anything"};
  if (set == KindSet::kAnything) return kAnything;
  static const std::array<std::vector<std::string>, 2> kNames = names_by_set();
  return kNames[set == KindSet::kChosenOn ? 0 : 1];
}

KindOfCloth draw_kind(const std::string& name, std::uint32_t seed) {
  KindOfCloth cloth;
  cloth.name = name;
  cloth.scene.seed = seed;
  all_effects(cloth.scene.effects);
  const auto* kind = std::ranges::find(kKinds, name, &Kind::name);
  Draws draws(seed * 64 + static_cast<std::uint32_t>(kind - kKinds.begin()));
  kind == kKinds.end() ? anything(cloth, draws) : kind->make(cloth, draws);
  cloth.scene.geometry.fibre_seed = seed;
  return cloth;
}

}  // namespace weft::bench
