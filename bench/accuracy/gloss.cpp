// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/gloss.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bench/accuracy/contenders.h"
#include "bench/accuracy/scenes.h"
#include "bench/accuracy/score.h"
#include "core/parallel.h"
#include "pipeline/gloss.h"
#include "simulator/reflectance/presets.h"
#include "solver/reflectance/glossy_method.h"

namespace weft::bench {
namespace {

using namespace simulator;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct TrueLobe {
  double alpha = kNone, along = kNone, f0 = kNone;
};

/// A material, and what the solver should find of it; without numbers where its truth is another model.
struct GlossyCloth {
  const char* name;
  Reflectance reflectance;
  double albedo;  ///< grey
  TrueLobe truth;
  std::function<void(Scene&)> change = {};  ///< what else is not as it should be
  bool is_level = false;                    ///< without relief, and one row for all families
};

Rgb grey(double value) {
  return {value, value, value};
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
  const TrueLobe of_velvet = {0.3, kNone, 0.04}, of_wool = {0.7, kNone, 0.04};
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
      {"level ggx 0.60, pair", ggx(0.60), 0.4, {0.60, kNone, 0.04}, with_films, true},
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
  const std::vector<GlossyCloth> more = cloths_with_more_light();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

AccuracyScene scene_of(AccuracyScene scene, const GlossyCloth& cloth) {
  scene.name = scene.family + " " + cloth.name;
  scene.scene.effects.reflectance = true;
  scene.scene.material = {};
  scene.scene.material.reflectance = cloth.reflectance;
  scene.scene.material.albedo = grey(cloth.albedo);
  if (cloth.is_level) {
    scene.name = cloth.name;
    scene.scene.geometry = {};
  }
  if (cloth.change) cloth.change(scene.scene);
  return scene;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Json or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Result<Json> row_of(const AccuracyScene& scene, const GlossyCloth& cloth, int threads) {
  Result<std::vector<Patch>> patches = render_patches(scene, threads);
  if (!patches) return std::move(patches).error();
  const BoundedPatches bounded = with_bounds(std::move(*patches), threads);
  const Contender robust = {"robust alone", as_product(solver::robust_method())};
  const Contender level = {"robust", by_level(solver::method_of(solver::Level::kRobust))};
  const Result<Json> before = score(robust, bounded, threads), after = score(level, bounded, threads);
  const Contender reference = {"reference", by_level(solver::method_of(solver::Level::kReference))};
  const Result<Json> corrected = score(reference, bounded, threads);
  if (!corrected) return corrected.error();
  if (!before) return before.error();
  if (!after) return after.error();

  const pipeline::Photographs& photographs = bounded.patches.front().photographs;
  const auto base = solver::robust_method();
  Result<std::vector<solver::MeasuredLobe>> measured = Error{};
  const double fit_s =
      seconds_of([&] { measured = pipeline::measure_gloss(photographs, *base, nullptr, 1); });
  if (!measured) return std::move(measured).error();
  const solver::MeasuredLobe& found = measured->front();
  const solver::Lobe& lobe = found.lobe;
  const bool has_yarn = lobe.family == solver::LobeFamily::kAnisotropicGgx;
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
              {"fit_s", fit_s}};
}

}  // namespace

Result<Rows> gloss_table(const GlossOptions& options) {
  const int threads = resolved_threads(options.threads);
  Rows rows;
  for (const GlossyCloth& cloth : cloths()) {
    if (!options.cloth.empty() && options.cloth != cloth.name) continue;
    for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, false)) {
      if (scene.material != "satin" || (cloth.is_level && scene.family != "smooth")) continue;
      Result<Json> row = row_of(scene_of(scene, cloth), cloth, threads);
      if (!row) return std::move(row).error();
      rows.push_back(std::move(*row));
    }
  }
  if (!rows.empty()) return rows;
  return Error{ErrorKind::kUsage, "no such cloth", options.cloth, "", "leave it out to see them all"};
}

}  // namespace weft::bench
