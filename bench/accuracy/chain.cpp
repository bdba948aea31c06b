// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bench/accuracy/accuracy_scenes.h"
#include "bench/accuracy/score.h"
#include "calibration/run/calibrate_camera.h"
#include "calibration/run/calibrate_lights.h"
#include "calibration/run/calibrate_response.h"
#include "core/base/files.h"
#include "core/base/statistics.h"
#include "core/base/temporary_folder.h"
#include "core/image_io/image_io.h"
#include "material/read/compare.h"
#include "simulator/captures.h"
#include "simulator/simulate.h"
#include "solve/run/solve_session.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using simulator::EffectSettings;
using simulator::Scene;

constexpr Size kFrame = {768, 576};
constexpr double kFrame_mm = 200;
constexpr double kYarn_px = 12.5;  // as the accuracy set has it

// The rig under a cloth of the accuracy set, as large as the camera's pixels ask for.
class Cloths {
 public:
  Cloths(Scene rig, std::uint32_t seed)
      : rig_(std::move(rig)), cloths_(accuracy_scenes(SceneSet::kHeldOut, seed, true)) {
    rig_.seed = seed;
    rig_.camera.width = kFrame.width;
    rig_.camera.height = kFrame.height;
    rig_.camera.mm_per_pixel = kFrame_mm / kFrame.width;
    // What each case switches on for itself.
    rig_.effects.spectral = rig_.effects.defocus = false;
  }

  Scene with(const std::string& name) const {
    const auto cloth = std::find_if(cloths_.begin(), cloths_.end(),
                                    [&](const AccuracyScene& scene) { return scene.name == name; });
    Scene scene = rig_;
    scene.fabric = name;
    scene.geometry = cloth->scene.geometry;
    const double scale = kYarn_px * rig_.camera.mm_per_pixel / scene.geometry.warp_pitch_mm;
    scene.geometry.warp_pitch_mm *= scale;
    scene.geometry.weft_pitch_mm *= scale;
    scene.material = cloth->scene.material;
    scene.camera.albedo_at_full = 0.99;
    scene.effects.cast_shadows = scene.effects.interreflection = true;
    scene.effects.reflectance = cloth->scene.effects.reflectance;
    return scene;
  }

  Scene blurred(const std::string& name, double spread_px) const {
    Scene scene = with(name);
    scene.camera.blur.spread_px = spread_px;
    scene.effects.defocus = true;
    return scene;
  }

  Scene turned(const std::string& name, double roll_deg) const {
    Scene scene = with(name);
    scene.camera.pose.roll_deg = roll_deg;
    return scene;
  }

  Scene flickering(Scene scene) const {
    scene.lights.flicker = scene.lights.drift = 0.003;
    scene.effects.led_drift = true;
    return scene;
  }

  Scene dyed_twill() const {
    Scene scene = with("smooth lambert");
    scene.fabric = "dyed twill";
    scene.geometry.kind = simulator::GeometryKind::kTwill;
    scene.material.warp_albedo = {0.6, 0.04, 0.05};
    scene.material.weft_albedo = {0.03, 0.06, 0.45};
    return scene;
  }

  // Nine holes, a tenth of the frame wide, over a white table.
  Scene holed(const std::string& name) const {
    Scene scene = with(name);
    scene.fabric = name + " with holes";
    for (const double x : {-60.0, 0.0, 60.0}) {
      for (const double y : {-40.0, 0.0, 40.0}) {
        simulator::TargetSettings hole;
        hole.pattern = simulator::GreyScaleSettings{.reflectances = {0.85}, .patch_mm = 15, .margin_mm = 0};
        hole.centre_mm = {x, y, -2};
        scene.targets.push_back(std::move(hole));
      }
    }
    return scene;
  }

  // What a real rig has at once: a turned camera, lateral colour, a curved field, a veil, blur, drift.
  Scene everything(const std::string& name) const {
    Scene scene = flickering(blurred(name, 0.4));
    scene.camera.pose.roll_deg = 90;
    scene.camera.chromatic = {.red_px = 0.5, .blue_px = -0.4};
    scene.camera.field.corner_px = 1;
    scene.camera.veil.share = 0.005;
    scene.material.translucency.share = 0.2;
    EffectSettings& on = scene.effects;
    on.chromatic_aberration = on.field_curvature = on.veil = on.translucency = true;
    return scene;
  }

  Scene with_weak_led(const std::string& name) const {
    constexpr std::size_t kWeak = 2;
    Scene scene = with(name);
    for (double& flux : *scene.lights.leds[kWeak].flux_rgb) flux *= 0.25;
    return scene;
  }

 private:
  Scene rig_;
  std::vector<AccuracyScene> cloths_;
};

// The mean of |A - B| / B over all pixels and channels, once the medians agree if no scale is known.
double albedo_error(const Image<float>& albedo, const Image<float>& truth, bool is_relative) {
  std::vector<double> ratios;
  for (int c = 0; c < truth.planes(); ++c) {
    for (int y = 0; y < truth.height(); ++y) {
      for (int x = 0; x < truth.width(); ++x) {
        const double ratio = static_cast<double>(albedo(x, y, c)) / static_cast<double>(truth(x, y, c));
        if (std::isfinite(ratio)) ratios.push_back(ratio);
      }
    }
  }
  const double scale = is_relative ? 1 / median(ratios) : 1;
  double sum = 0;
  for (const double ratio : ratios) sum += std::abs(scale * ratio - 1);
  return sum / static_cast<double>(ratios.size());
}

// Takes from sheet.toml what the paper reflects.
Result<void> forget_paper(const fs::path& sheet) {
  const Result<std::string> text = read_text(sheet);
  if (!text) return text.error();
  const std::size_t begin = text->find("reflectance");
  return write_file(sheet, text->substr(0, begin) + text->substr(text->find('\n', begin) + 1));
}

// One case after the other, in a folder of their own. Cases on the same rig share its calibration.
class Chain {
 public:
  Chain(const AccuracyTableOptions& options, std::vector<std::string> levels)
      : context_{options.threads}, levels_(std::move(levels)) {
    simulate_.tiles.threads = options.threads;
  }

  Result<Rows> run(const ChainCase& one) {
    const Result<fs::path> calibration = calibrated(one);
    if (!calibration) return calibration.error();
    Scene cloth = one.scene;
    if (!cloth.effects.led_drift) {  // without white patches, which tell the drift
      std::erase_if(cloth.targets, [](const simulator::TargetSettings& target) {
        return kind_of(target.pattern) != simulator::TargetKind::kGreyScale;
      });
    }
    const fs::path session = scratch_.path() / "cloth.weft";
    const auto simulated = simulate_session(cloth, session, simulate_);
    if (!simulated) return simulated.error();
    Rows rows;
    for (const std::string& level : levels_) {
      const Result<Json> row = score(session, *calibration, level, !one.knows_paper);
      if (!row) return row.error();
      rows.push_back({{"case", one.name}});
      rows.back().update(*row);
    }
    fs::remove_all(session);
    return rows;
  }

 private:
  // What `weft calibrate` makes of the captures that this rig takes.
  Result<fs::path> calibrated(const ChainCase& one) {
    Scene bare = one.scene;
    bare.fabric.clear();
    bare.geometry = {};
    bare.material = {};
    const std::string key = simulator::to_toml(bare) + (one.knows_paper ? "" : "paper unknown");
    if (const auto known = calibrations_.find(key); known != calibrations_.end()) return known->second;
    const fs::path folder = scratch_.path() / fmt::format("rig{}", calibrations_.size());
    simulator::CapturesOptions options;
    options.simulate = simulate_;
    // The chart of the response fits the long side of the frame alone, and what it tells does not turn.
    Scene straight = one.scene;
    straight.camera.pose.roll_deg = 0;
    options.parts = {"response"};
    const auto chart = simulator::simulate_captures(straight, folder, options);
    if (!chart) return chart.error();
    options.parts = {"camera", "lights"};
    const auto captures = simulator::simulate_captures(one.scene, folder, options);
    if (!captures) return captures.error();
    if (!one.knows_paper) {
      if (Result<void> ok = forget_paper(folder / "lights" / "sheet.toml"); !ok) return std::move(ok).error();
    }
    calibration::CalibrateCameraOptions boards;
    boards.input = folder / "camera";
    boards.output = folder / "with camera";
    boards.rig = "virtual rig";
    const auto camera = calibrate_camera(boards, context_);
    if (!camera) return camera.error();
    const auto response = calibration::calibrate_response(
        {folder / "response", boards.output, folder / "with response", {}}, context_);
    if (!response) return response.error();
    const fs::path whole = folder / "whole";
    const auto lights =
        calibration::calibrate_lights({folder / "lights", folder / "with response", whole}, context_);
    if (!lights) return lights.error();
    return calibrations_[key] = whole;
  }

  Result<Json> score(const fs::path& session, const fs::path& calibration, const std::string& level,
                     bool is_relative) {
    const Result<solve::SolveReport> solved = solve(session, calibration, level);
    if (!solved) return solved.error();
    const Result<solve::SolveReport> exact = solve(session, {}, level);
    if (!exact) return exact.error();
    const fs::path truth = session / "truth";
    const auto angles = material::compare_normals(solved->folder / "normal.exr", truth / "normal.exr", {});
    if (!angles) return angles.error();
    const auto best = material::compare_normals(exact->folder / "normal.exr", truth / "normal.exr", {});
    if (!best) return best.error();
    const auto albedo = read_image(solved->folder / "albedo.exr");
    if (!albedo) return albedo.error();
    const auto true_albedo = read_image(truth / "albedo.exr");
    if (!true_albedo) return true_albedo.error();
    return Json{{"level", level},
                {"mean_deg", angles->mean_deg},
                {"p95_deg", angles->p95_deg},
                {"exact_deg", best->mean_deg},
                {"albedo_rel", albedo_error(albedo->planes, true_albedo->planes, is_relative)},
                {"seconds", solved->seconds.total}};
  }

  Result<solve::SolveReport> solve(const fs::path& session, const fs::path& calibration,
                                   const std::string& level) {
    solve::SolveOptions options;
    options.method = level;
    options.previews = false;
    return solve::solve_session({session, calibration, {}}, options, context_);
  }

  JobContext context_;
  std::vector<std::string> levels_;
  simulator::SimulateOptions simulate_;
  TemporaryFolder scratch_;
  std::map<std::string, fs::path> calibrations_;  // by what their rig is
};

}  // namespace

Result<std::vector<ChainCase>> chain_cases(const fs::path& rig, std::uint32_t seed) {
  Result<Scene> scene = simulator::read_scene(rig);
  if (!scene) return std::move(scene).error();
  const Cloths cloths(std::move(*scene), seed);
  return std::vector<ChainCase>{{"smooth", cloths.with("smooth lambert")},
                                {"plain", cloths.with("plain lambert")},
                                {"plain, blur 0.4 px", cloths.blurred("plain lambert", 0.4)},
                                {"plain, blur 0.7 px", cloths.blurred("plain lambert", 0.7)},
                                {"plain, flicker and drift", cloths.flickering(cloths.with("plain lambert"))},
                                {"plain, one LED weak", cloths.with_weak_led("plain lambert")},
                                {"deep, camera turned by 10", cloths.turned("deep lambert", 10)},
                                {"deep, camera turned by 90", cloths.turned("deep lambert", 90)},
                                {"deep, camera turned by 180", cloths.turned("deep lambert", 180)},
                                {"deep, paper unknown", cloths.with("deep lambert"), false},
                                {"smooth satin", cloths.with("smooth satin")},
                                {"plain satin", cloths.with("plain satin")},
                                {"plain velvet", cloths.with("plain velvet")},
                                {"dyed twill", cloths.dyed_twill()},
                                {"plain, holes", cloths.holed("plain lambert")},
                                {"plain cotton, everything", cloths.everything("plain cotton")}};
}

/// Every case by the product's own steps: captures are simulated as a rig takes them, `weft calibrate` makes
/// a calibration of camera, response and lights from them, a session is photographed, and `weft solve` makes
/// its maps: conditions, registration, levels. A row a case and level:
/// mean_deg, p95_deg: angle of the published normals to the truth. exact_deg: the mean by the same level with
/// the calibration that the simulator knows, which is what is left when nothing has to be measured.
/// albedo_rel: mean of |A - B| / B, of a relative scale once the medians agree. seconds: of the whole solve.
/// kUsage where no case or level has the given name. About 300 MB of disk, and a minute a case.
Result<Rows> chain_table(const AccuracyTableOptions& options) {
  const Result<std::vector<ChainCase>> cases = chain_cases(options.scenes / "rig.toml", options.seed);
  if (!cases) return cases.error();
  std::vector<std::string> names, levels = level_names();
  levels.erase(levels.begin());  // a preview has a quarter of the truth's pixels
  for (const ChainCase& one : *cases) names.push_back(one.name);
  if (!options.scene.empty() && std::count(names.begin(), names.end(), options.scene) == 0)
    return no_such("case", options.scene, names);
  for (const std::string& level : options.methods) {
    if (std::count(levels.begin(), levels.end(), level) == 0) return no_such("level", level, levels);
  }
  if (!options.methods.empty()) levels = options.methods;
  Chain chain(options, levels);
  Rows table;
  for (const ChainCase& one : *cases) {
    if (!options.scene.empty() && one.name != options.scene) continue;
    Result<Rows> rows = chain.run(one);
    if (!rows) {
      Error error = std::move(rows).error();
      error.where = fmt::format("case {}: {}", one.name, error.where);
      return error;
    }
    std::move(rows->begin(), rows->end(), std::back_inserter(table));
  }
  return table;
}

}  // namespace weft::bench
