// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "bench/accuracy/accuracy_scenes.h"
#include "bench/accuracy/score.h"
#include "core/base/parallel.h"
#include "simulator/reflectance/presets.h"
#include "simulator/sampling/random.h"
#include "solve/gloss/gloss.h"
#include "solve/gloss/sample_gloss.h"
#include "solver/reflectance/glossy_method.h"

namespace weft::bench {
namespace {

using namespace simulator;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct TrueLobe {
  double alpha = kNone, along = kNone, f0 = kNone;
  std::optional<Rgb> f0_rgb = {};  ///< where it is not grey
};

/// A material, and what the solver should find of it; without numbers where its truth is another model.
struct GlossyCloth {
  const char* name;
  Reflectance reflectance;
  double albedo;  ///< grey
  TrueLobe truth;
  std::function<void(Scene&)> change = {};  ///< what else is not as it should be
  bool is_level = false;                    ///< without relief, and one row for all families
  bool is_calibrated_wrong = false;         ///< see put_off()
  std::optional<Rgb> dye = {};              ///< the albedo, where it is not grey
  ClothPose second_pose = {};               ///< unless level, the cloth once more as it lies so
};

Rgb grey(double value) {
  return {value, value, value};
}

void weave_as_satin(Scene& scene) {
  scene.geometry.kind = GeometryKind::kSatin;
}

// Ink that differs from one eighth of a yarn to the next, by a factor of two at most.
void vary_within_yarns(Scene& scene) {
  constexpr int kSide = 96;
  auto ink = std::make_shared<Image<float>>(Size{kSide, kSide}, 3);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto bits = philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0}, {17, 0});
      for (int p = 0; p < 3; ++p) (*ink)(x, y, p) = static_cast<float>(0.5 + 0.5 * uniform(bits[0], bits[1]));
    }
  }
  scene.material.print.albedo = std::move(ink);
  scene.material.print.placement.mm_per_sample = 0.1;
}

// As solver::Lobe::f0 has it.
double mean_of(const Rgb& f0) {
  return solver::kLuminance[0] * f0[0] + solver::kLuminance[1] * f0[1] + solver::kLuminance[2] * f0[2];
}

Ggx ggx(double alpha) {
  return {.alpha = alpha, .f0 = grey(0.04), .beneath = Beneath::kBalanced};
}

void with_films(Scene& s) {
  s.films.states = FilmStates::kBoth;
}
void with_led_beside_camera(Scene& s) {
  s.lights.rings = default_rings();
  s.lights.rings.push_back({.count = 1, .zenith_deg = 8, .azimuth_deg = 120});
}

// What one more shot, or as many again, buys.
std::vector<GlossyCloth> cloths_with_more_light() {
  const TrueLobe of_velvet = {0.3, kNone, 0.05}, of_wool = {0.7, kNone, 0.046};
  return {
      {"ggx 0.50, pair", ggx(0.50), 0.4, {0.50, kNone, 0.04}, with_films},
      {"ggx 0.60, pair", ggx(0.60), 0.4, {0.60, kNone, 0.04}, with_films},
      {"satin, pair",
       AnisotropicGgx{.alpha = 0.45, .anisotropy = 0.65, .f0 = grey(0.05)},
       0.4,
       {0.45, 0.1575, 0.05},
       with_films},
      {"wool, pair", preset("wool")->reflectance, 0.3, of_wool, with_films},
      {"velvet, pair", preset("velvet")->reflectance, 0.04, of_velvet, with_films},
      {"lambert, pair", Lambert{}, 0.5, {}, with_films},
      {"level ggx 0.10", ggx(0.10), 0.4, {0.10, kNone, 0.04}, {}, true},
      {"level ggx 0.10, LED at 8", ggx(0.10), 0.4, {0.10, kNone, 0.04}, with_led_beside_camera, true},
      {.name = "level ggx 0.10, tilted by 20 too",
       .reflectance = ggx(0.10),
       .albedo = 0.4,
       .truth = {0.10, kNone, 0.04},
       .is_level = true,
       .second_pose = {20, 0}},
      {"level ggx 0.60, pair", ggx(0.60), 0.4, {0.60, kNone, 0.04}, with_films, true},
  };
}

// Highlights with a colour of their own, and white ones on cloth that has one.
std::vector<GlossyCloth> cloths_with_colours() {
  const Rgb gold = {0.10, 0.08, 0.04}, dark = {0.06, 0.05, 0.03}, red = {0.5, 0.12, 0.05};
  const auto satin = [](const Rgb& f0) { return AnisotropicGgx{.alpha = 0.35, .anisotropy = 0.6, .f0 = f0}; };
  const TrueLobe of_ggx = {0.30, kNone, mean_of(gold), gold}, of_satin = {0.35, 0.14, mean_of(gold), gold};
  const Ggx golden = {.alpha = 0.30, .f0 = gold, .beneath = Beneath::kBalanced};
  return {
      {.name = "tinted ggx 0.30", .reflectance = golden, .albedo = 0, .truth = of_ggx, .dye = red},
      {.name = "dark tinted ggx 0.30", .reflectance = golden, .albedo = 0, .truth = of_ggx, .dye = dark},
      {.name = "dark tinted satin", .reflectance = satin(gold), .albedo = 0, .truth = of_satin, .dye = dark},
      {.name = "red ggx 0.30",
       .reflectance = ggx(0.30),
       .albedo = 0,
       .truth = {0.30, kNone, 0.04},
       .dye = red},
      {.name = "red satin",
       .reflectance = satin(grey(0.05)),
       .albedo = 0,
       .truth = {0.35, 0.14, 0.05},
       .dye = red},
      {.name = "red cotton",
       .reflectance = MultipleScattering{.gloss = 0.2},
       .albedo = 0,
       .truth = {},
       .dye = red},
  };
}

std::vector<GlossyCloth> cloths() {
  const AnisotropicGgx satin = {.alpha = 0.45, .anisotropy = 0.65, .f0 = grey(0.05)};
  const AnisotropicGgx dark_satin = {.alpha = 0.35, .anisotropy = 0.6, .f0 = grey(0.05)};
  const TrueLobe of_satin = {0.45, 0.1575, 0.05}, of_dark_satin = {0.35, 0.14, 0.05};
  std::vector<GlossyCloth> all = {
      {"ggx 0.15", ggx(0.15), 0.4, {0.15, kNone, 0.04}},
      {"ggx 0.30", ggx(0.30), 0.4, {0.30, kNone, 0.04}},
      {"ggx 0.50", ggx(0.50), 0.4, {0.50, kNone, 0.04}},
      {"dark ggx 0.20", ggx(0.20), 0.05, {0.20, kNone, 0.04}},
      {"beckmann 0.30",
       Beckmann{.alpha = 0.3, .f0 = grey(0.04), .beneath = Beneath::kBalanced},
       0.4,
       {0.3, kNone, 0.04}},
      {"satin", satin, 0.4, of_satin},
      {"dark satin", dark_satin, 0.06, of_dark_satin},
      {"satin, wide LEDs, drift", satin, 0.4, of_satin,
       [](Scene& s) {
         s.effects.finite_led = s.effects.led_drift = s.effects.stray = true;
         s.lights.drift = 0.005;
         s.lights.flicker = 0.003;
       }},
      {"satin, blurred", satin, 0.4, of_satin, [](Scene& s) { s.effects.defocus = true; }},
      {"satin weave", satin, 0.4, of_satin, weave_as_satin},
      {"dark satin weave", dark_satin, 0.06, of_dark_satin, weave_as_satin},
      {"fibres", FibreCones{}, 0.4, {}},
      {"dark fibres", FibreCones{}, 0.06, {}},
      {"fibres, satin weave", FibreCones{}, 0.4, {}, weave_as_satin},
      {"two lobes", MixedGgx{.alpha = 0.15, .second_alpha = 0.5, .f0 = grey(0.05)}, 0.4, {}},
      {"dark two lobes", MixedGgx{.alpha = 0.15, .second_alpha = 0.5, .f0 = grey(0.05)}, 0.06, {}},
      {"ggx 0.30, calibrated wrong", ggx(0.30), 0.4, {0.30, kNone, 0.04}, {}, false, true},
      {"satin, calibrated wrong", satin, 0.4, of_satin, {}, false, true},
      {"dark satin, calibrated wrong", dark_satin, 0.06, of_dark_satin, {}, false, true},
      {"satin, albedo varies", satin, 0.5, of_satin, vary_within_yarns},
      {"dark satin, albedo varies", dark_satin, 0.08, of_dark_satin, vary_within_yarns},
      {"blinn-phong 0.35", BlinnPhong{.gloss = 0.35, .f0 = grey(0.04)}, 0.4, {}},
      {"satin, lambert beneath",
       AnisotropicGgx{.alpha = 0.45, .anisotropy = 0.65, .f0 = grey(0.05), .beneath = Beneath::kLambert}, 0.4,
       of_satin},
      {"satin, coupled beneath",
       AnisotropicGgx{.alpha = 0.45, .anisotropy = 0.65, .f0 = grey(0.05), .beneath = Beneath::kCoupled}, 0.4,
       of_satin},
      {"lambert", Lambert{}, 0.5, {}},
      {"oren-nayar 0.3", OrenNayar{.sigma = 0.3}, 0.4, {}},
      {"cotton", MultipleScattering{.gloss = 0.2}, 0.5, {}},
      {"wool", preset("wool")->reflectance, 0.3, {}},
      {"velvet", preset("velvet")->reflectance, 0.04, {}},
  };
  for (const std::vector<GlossyCloth>& more : {cloths_with_more_light(), cloths_with_colours()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

AccuracyScene scene_of(AccuracyScene scene, const GlossyCloth& cloth) {
  scene.name = scene.family + " " + cloth.name;
  scene.scene.effects.reflectance = true;
  scene.scene.material = {};
  scene.scene.material.reflectance = cloth.reflectance;
  scene.scene.material.albedo = cloth.dye.value_or(grey(cloth.albedo));
  if (cloth.is_level) {
    scene.name = cloth.name;
    scene.scene.geometry = {};
  }
  if (cloth.change) cloth.change(scene.scene);
  return scene;
}

// Every LED half a percent brighter or darker than it is said to be, and 1 mm from where it is said to stand.
Result<void> put_off(ClothPatch& patch) {
  NearLights lights = std::get<NearLights>(patch.field().lights());
  for (std::size_t k = 0; k < lights.leds.size(); ++k) {
    const auto number = static_cast<std::uint32_t>(k);
    const auto bits = philox({number, 0, 0, 0}, {23, 0}), more = philox({number, 1, 0, 0}, {23, 0});
    const double gain = 1 + 0.005 * (bits[0] % 2 == 0 ? 1 : -1);
    for (double& flux : lights.leds[k].flux_rgb) flux *= gain;
    const double z = 2 * uniform(more[0], more[1]) - 1, turn = 2 * kPi * uniform(bits[2], bits[3]);
    const double across = std::sqrt(1 - z * z);
    lights.leds[k].position_mm =
        lights.leds[k].position_mm + Vec3{across * std::cos(turn), across * std::sin(turn), z};
  }
  Result<LightField> field = LightField::make(std::move(lights), patch.photographs.camera, patch.size(),
                                              patch.field().cloth_height_mm());
  if (!field) return std::move(field).error();
  patch.photographs.field = std::move(*field);
  return {};
}

// The same cloth as it lies otherwise, in the middle of the frame.
Result<void> add_second_pose(const AccuracyScene& scene, const ClothPose& pose, int threads,
                             std::vector<ClothPatch>& patches) {
  Scene tilted = scene.scene;
  tilted.pose = pose;
  tilted.seed += 1000;  // other noise
  Result<ClothPatch> other = render_patch(tilted, scene.patches.front(), threads);
  if (!other) return std::move(other).error();
  const auto number = [](solve::Photographs& photographs) {
    photographs.leds.resize(photographs.count());
    std::iota(photographs.leds.begin(), photographs.leds.end(), 1);
  };
  number(other->photographs);
  Result<solve::GlossSamples> samples =
      sample_gloss(other->photographs, *solver::robust_method(), nullptr, threads);
  if (!samples) return std::move(samples).error();
  for (ClothPatch& patch : patches) {
    number(patch.photographs);
    patch.photographs.second_pose = *samples;
  }
  return {};
}

// Microseconds a pixel of a method on one thread.
Result<double> pixel_us(const ClothPatch& patch, const solver::Method& method) {
  SolvedMaps maps(patch.size());
  Result<void> solved;
  const double seconds = least_seconds(3, [&] {
    const solve::Photographs& photographs = patch.photographs;
    solved = solve_images(method, planes_of(patch.readings), patch.field(), photographs.planes().cfa,
                          photographs.noise(), 1, maps);
  });
  if (!solved) return solved.error();
  return 1e6 * seconds / static_cast<double>(patch.size().pixels());
}

Json or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Result<Json> row_of(const AccuracyScene& scene, const GlossyCloth& cloth, int threads) {
  Result<std::vector<ClothPatch>> patches = render_patches(scene, threads);
  if (!patches) return std::move(patches).error();
  for (ClothPatch& patch : *patches) {
    if (!cloth.is_calibrated_wrong) continue;
    if (Result<void> ok = put_off(patch); !ok) return std::move(ok).error();
  }
  if (!cloth.second_pose.is_level()) {
    if (Result<void> ok = add_second_pose(scene, cloth.second_pose, threads, *patches); !ok)
      return std::move(ok).error();
  }
  const BoundedPatches bounded = with_bounds(std::move(*patches), threads);
  const Contender robust = {"robust alone", as_product(solver::robust_method())};
  const Contender level = {"robust", by_level(solver::method_of(solver::Level::kRobust))};
  const Result<Json> before = score(robust, bounded, threads), after = score(level, bounded, threads);
  const Contender reference = {"reference", by_level(solver::method_of(solver::Level::kReference))};
  const Result<Json> corrected = score(reference, bounded, threads);
  if (!corrected) return corrected.error();
  if (!before) return before.error();
  if (!after) return after.error();

  const solve::Photographs& photographs = bounded.patches.front().photographs;
  const auto base = solver::robust_method();
  Result<solve::MeasuredGloss> measured = Error{};
  const double fit_s =
      least_seconds(1, [&] { measured = solve::measure_gloss(photographs, *base, nullptr, 1); });
  if (!measured) return std::move(measured).error();
  const solver::MeasuredLobe& found = measured->lobes.front();
  const solver::Lobe& lobe = found.lobe;
  const bool has_yarn = lobe.family == solver::LobeFamily::kAnisotropicGgx;
  const Result<double> base_us = pixel_us(bounded.patches.front(), *base);
  if (!base_us) return base_us.error();
  Json glossy_us;
  if (found.is_measured()) {
    // The glossy method of one material begins where the standard method leaves it.
    const auto beneath = solver::standard_method();
    const auto glossy =
        solver::glossy_method(*beneath, {{lobe, solver::one_sigma_off(lobe, found.covariance)}},
                              solve::sight_of(photographs), measured->unit);
    const Result<double> timed = pixel_us(bounded.patches.front(), *glossy);
    if (!timed) return timed.error();
    glossy_us = *timed;
  }
  return Json{{"cloth", scene.name},
              {"robust_deg", number(*before, "mean_deg")},
              {"lobe_deg", number(*after, "mean_deg")},
              {"lobe_p95_deg", number(*after, "p95_deg")},
              {"reference_deg", number(*corrected, "mean_deg")},
              {"albedo_rel", number(*after, "albedo_mean_rel")},
              {"said", name_of(found.refusal)},
              {"family", found.is_measured() ? name_of(lobe.family) : ""},
              {"alpha", found.is_measured() ? Json(lobe.alpha) : Json()},
              {"true_alpha", or_null(cloth.truth.alpha)},
              {"along", has_yarn ? Json(lobe.alpha * lobe.along) : Json()},
              {"true_along", or_null(cloth.truth.along)},
              {"f0", found.is_measured() ? Json(lobe.f0) : Json()},
              {"true_f0", or_null(cloth.truth.f0)},
              {"f0_rgb", found.tint ? Json(found.tint->f0) : Json()},
              {"true_f0_rgb", cloth.truth.f0_rgb ? Json(*cloth.truth.f0_rgb) : Json()},
              {"albedo_rel_rgb_before", (*before)["albedo_rel_rgb"]},
              {"albedo_rel_rgb", (*after)["albedo_rel_rgb"]},
              {"changes", solver::change_across(found.parts).has_value()},
              {"fit_s", fit_s},
              {"robust_us", *base_us},
              {"glossy_us", std::move(glossy_us)}};
}

}  // namespace

/// Cloths of each weave whose lobe the solver has a family for, and cloths whose truth is another
/// model. A row each:
/// robust_deg: mean angle to the true normal by the readings that Lambert's law explains best
/// (solver::robust_method). lobe_deg, lobe_p95_deg: by the level robust, with the lobe it found.
/// reference_deg: by the level reference. albedo_rel: mean of |A - B| / B of the level robust.
/// albedo_rel_rgb: of red, green and blue, and before, by the readings that Lambert's law explains best.
/// f0_rgb: by channel, where a tint was found. alpha, along, f0: what was found, beside what is true where
/// that has such numbers. said: measured, or why not. changes: whether alpha is said to change across the
/// frame. fit_s: seconds of finding it on one thread. robust_us, glossy_us: microseconds a pixel of
/// robust_method, and of it and the lobe, on one thread. kUsage where no cloth has the given name.
Result<Rows> gloss_table(const AccuracyTableOptions& options) {
  const int threads = resolved_threads(options.threads);
  Rows rows;
  for (const GlossyCloth& cloth : cloths()) {
    if (!options.scene.empty() && options.scene != cloth.name) continue;
    for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, false)) {
      if (scene.material != "satin" || (cloth.is_level && scene.family != "smooth")) continue;
      if (Result<void> ok = add_row(rows, row_of(scene_of(scene, cloth), cloth, threads)); !ok)
        return ok.error();
    }
  }
  if (!rows.empty()) return rows;
  return Error{ErrorKind::kUsage, "no such cloth", options.scene, "", "leave it out to see them all"};
}

}  // namespace weft::bench
