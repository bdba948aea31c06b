// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/accuracy_scenes.h"
#include "bench/accuracy/score.h"
#include "bench/base/bound.h"
#include "bench/base/measured_rig.h"
#include "bench/base/solved_maps.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "simulator/camera/sensor.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "solve/files/pictures.h"
#include "solve/levels/frame.h"
#include "solve/run/explain.h"
#include "solve/run/solve_session.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::bench {
namespace {

constexpr std::size_t kTenths = 10;

struct Coverage {
  double median = 0, beyond = 0;

  explicit Coverage(std::span<const StatedError> pixels) {
    std::vector<double> ratios;
    for (const StatedError& p : pixels) {
      ratios.push_back(static_cast<double>(p.error_deg) / static_cast<double>(p.sigma_deg));
      beyond += ratios.back() > 3;
    }
    beyond /= static_cast<double>(pixels.size());
    median = weft::median(std::move(ratios));
  }
  double off() const { return std::abs(std::log(median)); }
  bool has_median() const { return median >= kLeastMedian && median <= kMostMedian; }
};

// Errors of the rows of a band.
class Gatherer {
 public:
  Gatherer(const ClothPatch& patch, Size maps)
      : patch_(patch),
        scale_(patch.size().width / maps.width),
        normal_(maps, 3),
        sigma_(maps),
        status_(maps) {}

  Result<void> operator()(const solve::MapBand& band) {
    const int width = band.rows.width();
    for (int y = 0; y < band.rows.height(); ++y) {
      for (int c = 0; c < 3; ++c) {
        std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), width,
                    normal_.plane(c).row(band.rows.y0 + y));
      }
      std::copy_n(band.status.row(y), width, status_.plane().row(band.rows.y0 + y));
    }
    for (int y = 0; y < band.albedo_rows.height(); ++y) {
      for (int x = 0; x < width; ++x) {
        sigma_(x, band.albedo_rows.y0 + y) =
            std::hypot(band.sigma_normal_deg(x, y), band.model_normal_deg(x, y));
      }
    }
    return {};
  }

  std::vector<StatedError> errors() const {
    std::vector<StatedError> errors;
    const Rect part = patch_.measured();
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        const int u = x / scale_, v = y / scale_;
        if (status_(u, v) & kNoSolution) continue;
        const double off =
            angle_deg({normal_(u, v, 0), normal_(u, v, 1), normal_(u, v, 2)},
                      {patch_.normal(x, y, 0), patch_.normal(x, y, 1), patch_.normal(x, y, 2)});
        errors.push_back({static_cast<float>(off), sigma_(u, v), status_(u, v)});
      }
    }
    return errors;
  }

 private:
  const ClothPatch& patch_;
  int scale_;
  Image<float> normal_, sigma_;
  Image<std::uint16_t> status_;
};

Result<std::vector<const solver::MethodName*>> levels_named(const std::vector<std::string>& names) {
  std::vector<const solver::MethodName*> levels;
  std::vector<std::string> known;
  for (const solver::MethodName& method : solver::method_names()) {
    if (!method.level) continue;
    known.emplace_back(method.name);
    if (names.empty() || std::ranges::count(names, method.name) > 0) levels.push_back(&method);
  }
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) == 0) return no_such("level", name, known);
  }
  return levels;
}

}  // namespace

Json coverage_of(std::span<const StatedError> pixels) {
  std::vector<StatedError> counted(pixels.begin(), pixels.end());
  const auto flagged =
      std::ranges::count_if(pixels, [](const StatedError& p) { return p.status & kNotCounted; });
  const double share = static_cast<double>(flagged) / static_cast<double>(pixels.size());
  const bool left_out = flagged > 0 && share <= kMostFlagged;
  if (left_out) std::erase_if(counted, [](const StatedError& p) { return p.status & kNotCounted; });
  std::ranges::stable_sort(counted, {}, &StatedError::sigma_deg);
  const std::span<const StatedError> all = counted;
  const Coverage whole(all);
  Coverage farthest = whole;
  double most_beyond = 0;
  bool each_holds = true;
  for (std::size_t i = 0; i < kTenths; ++i) {
    const std::size_t from = i * all.size() / kTenths, to = (i + 1) * all.size() / kTenths;
    const Coverage tenth(all.subspan(from, to - from));
    if (i == 0 || tenth.off() > farthest.off()) farthest = tenth;
    most_beyond = std::max(most_beyond, tenth.beyond);
    each_holds &= tenth.has_median();
  }
  return {{"pixels", all.size()},
          {"median_over_sigma", whole.median},
          {"beyond_3", whole.beyond},
          {"worst_tenth", farthest.median},
          {"worst_tenth_beyond_3", most_beyond},
          {"flagged", share},
          {"left_out", left_out},
          {"holds", whole.has_median() && whole.beyond < kMostBeyond},
          {"each_tenth_holds", each_holds}};
}

Result<std::vector<StatedError>> stated_errors(const ClothPatch& patch, const solver::MethodName& level,
                                               int threads) {
  const bool is_half = level.extent == solver::Extent::kHalfSize;
  Result<solve::Photographs> half = solve::Photographs();
  if (is_half) half = solve::half_size(patch.photographs, threads);
  if (!half) return half.error();
  const solve::Photographs& photographs = is_half ? *half : patch.photographs;
  Gatherer gatherer(patch, photographs.size);
  JobContext context;
  context.threads = threads;
  const Result<solve::FrameFacts> solved =
      solve::solve_frame(photographs, level, solve::kSolveTile, context, std::ref(gatherer));
  if (!solved) return solved.error();
  return gatherer.errors();
}

Result<Rows> coverage_table(const AccuracyTableOptions& options) {
  const int threads = resolved_threads(options.threads);
  const auto levels = levels_named(options.methods);
  if (!levels) return levels.error();
  const Result<std::vector<AccuracyScene>> scenes = chosen_scenes(options);
  if (!scenes) return scenes.error();
  Rows rows;
  for (const AccuracyScene& scene : *scenes) {
    const Result<std::vector<ClothPatch>> patches = render_patches(scene, threads);
    if (!patches) return patches.error();
    for (const solver::MethodName* level : *levels) {
      std::vector<StatedError> pixels;
      for (const ClothPatch& patch : *patches) {
        const Result<std::vector<StatedError>> errors = stated_errors(patch, *level, threads);
        if (!errors) return errors.error();
        pixels.insert(pixels.end(), errors->begin(), errors->end());
      }
      rows.push_back({{"scene", scene.name}, {"level", level->name}, {"seed", options.seed}});
      rows.back().update(coverage_of(pixels));
    }
  }
  return rows;
}

/// What `weft solve --explain` predicts, by `normal_deg` of sigma.exr, against what comes true: a row for
/// each scene and level, with the mean of both angles over all pixels with a solution, and their ratio. A
/// pixel of a preview is held against the four that it stands for.
Result<Rows> explain_table(const AccuracyTableOptions& options) {
  const int threads = resolved_threads(options.threads);
  Rows rows;
  for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, options.quick)) {
    const Result<std::vector<ClothPatch>> patches = render_patches(scene, threads);
    if (!patches) return patches.error();
    for (const solver::MethodName& level : solver::method_names()) {
      if (!level.level) continue;
      double predicted = 0, real = 0, pixels = 0;
      for (const ClothPatch& patch : *patches) {
        const Result<std::vector<StatedError>> errors = stated_errors(patch, level, threads);
        if (!errors) return errors.error();
        for (const StatedError& pixel : *errors) {
          predicted += solver::kMeanOfRms * static_cast<double>(pixel.sigma_deg);
          real += static_cast<double>(pixel.error_deg);
        }
        pixels += static_cast<double>(errors->size());
      }
      rows.push_back({{"scene", scene.name},
                      {"quality", level.name},
                      {"predicted_deg", predicted / pixels},
                      {"true_deg", real / pixels},
                      {"ratio", predicted / real}});
    }
  }
  return rows;
}

namespace {

namespace fs = std::filesystem;

Result<std::vector<AccuracyScene>> priced_scenes(const fs::path& folder) {
  std::vector<AccuracyScene> scenes;
  for (const char* name : {"demo", "satin_sheen"}) {
    Result<simulator::Scene> scene = simulator::read_scene(folder / (std::string(name) + ".toml"));
    if (!scene) return std::move(scene).error();
    scenes.push_back({name, "", "", std::move(*scene), {}});
  }
  for (AccuracyScene& scene : accuracy_scenes(SceneSet::kHeldOut, 1, true)) {
    if (scene.name == "plain lambert" || scene.name == "deep satin") scenes.push_back(std::move(scene));
  }
  return scenes;
}

Result<void> add_rows(AccuracyScene scene, double megapixels, int threads, Rows& rows) {
  const TemporaryFolder scratch;
  const Size size = bench_size(megapixels);
  scene.scene.camera.width = size.width;
  scene.scene.camera.height = size.height;
  const fs::path session = scratch.path() / "cloth.weft";
  const auto simulated = simulator::simulate_session(
      scene.scene, session, {.tiles = {.threads = threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();
  // A session with a truth is held against it while pictures are drawn, which no price knows.
  const fs::path truth = scratch.path() / "truth";
  fs::rename(session / "truth", truth);
  const solve::SessionOptions input = {.folder = session, .calibration = {}, .leds = {}};
  const JobContext context = {.threads = threads};
  const Result<solve::Ladder> ladder = solve::explain_session(input, {}, {}, context);
  if (!ladder) return ladder.error();
  for (const solve::LevelPrice& price : ladder->levels) {
    solve::SolveOptions options;
    options.method = price.name();
    options.output = scratch.path() / price.name();
    const Result<solve::SolveReport> solved = solve::solve_session(input, options, context);
    if (!solved) return solved.error();
    const double foretold = price.seconds.total(), taken = solved->seconds.total;
    Json row = {{"scene", scene.name},
                {"megapixels", megapixels},
                {"quality", price.name()},
                {"foretold_s", foretold},
                {"taken_s", taken},
                {"seconds_ratio", foretold / taken},
                {"predicted_deg", price.error.total_deg},
                {"predicted_solved", price.error.solved},
                {"solved", solved->expected.solved}};
    if (solved->facts.size == size) {
      const Result<solve::TruthError> error =
          solve::error_against(truth / "normal.exr", options.output / "normal.exr", threads);
      if (!error) return error.error();
      row["true_deg"] = error->normal.mean_deg;
      row["ratio"] = price.error.total_deg / error->normal.mean_deg;
    }
    rows.push_back(std::move(row));
    fs::remove_all(options.output);
  }
  return {};
}

}  // namespace

/// What `weft solve --explain` foretells of whole sessions, the demo and shot silk and two cloths of the set
/// held out, against what the solves then give and take: a row for each scene, size and level, with degrees,
/// the share of the cloth that they hold for, and seconds, each foretold and true, and their ratios.
Result<Rows> price_table(const AccuracyTableOptions& options, const std::vector<double>& sizes) {
  const Result<std::vector<AccuracyScene>> scenes = priced_scenes(options.scenes);
  if (!scenes) return scenes.error();
  Rows rows;
  for (const AccuracyScene& scene : *scenes) {
    for (const double megapixels : sizes) {
      if (Result<void> ok = add_rows(scene, megapixels, options.threads, rows); !ok)
        return std::move(ok).error();
    }
  }
  return rows;
}

namespace {

constexpr Size kTrials = {256, 256};
constexpr int kGreen = 1;

// One albedo and tilt: every pixel is a trial, with an azimuth of its own.
struct Trials {
  double albedo = 0, tilt_deg = 0;
  std::vector<LightField::Light> lights;
  std::optional<LightField> field;
  NoiseModel noise;
  Image<float> readings;

  // A turn of the golden angle a pixel: all azimuths, and no pattern.
  Vec3 normal(int x, int y) const {
    const double azimuth = kPi * (3 - std::sqrt(5.0)) * (y * kTrials.width + x);
    const double tilt = radians(tilt_deg);
    return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
  }
};

Result<Trials> make_trials(double albedo, double tilt_deg, std::uint32_t seed) {
  const simulator::Scene scene;
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();
  Trials trials;
  trials.albedo = albedo;
  trials.tilt_deg = tilt_deg;
  const Result<LightField> near = LightField::make(rig->leds, rig->camera, rig->camera.size, 0);
  if (!near) return near.error();
  DistantLights here;
  for (std::size_t k = 0; k < near->count(); ++k) {
    const LightField::Light light =
        near->at(k, kGreen, rig->camera.size.width / 2, rig->camera.size.height / 2);
    here.lights.push_back({light.direction, {light.strength, light.strength, light.strength}});
    trials.lights.push_back(light);
  }
  Result<LightField> field = LightField::make(here, std::nullopt, kTrials, 0);
  if (!field) return std::move(field).error();
  trials.field = std::move(*field);

  const double exposure = rig->exposure(scene.camera.iso), electrons = rig->sensor.electrons_at_white;
  const double read = rig->sensor.read_noise_electrons / (electrons * exposure);
  trials.noise = {1 / (electrons * exposure), read * read, 0};
  trials.readings = Image<float>(kTrials, static_cast<int>(trials.lights.size()));
  for (std::size_t k = 0; k < trials.lights.size(); ++k) {
    const LightField::Light& light = trials.lights[k];
    for (int y = 0; y < kTrials.height; ++y) {
      for (int x = 0; x < kTrials.width; ++x) {
        const double cosine = dot(trials.normal(x, y), light.direction);
        float& reading = trials.readings(x, y, static_cast<int>(k));
        reading = -std::numeric_limits<float>::infinity();
        if (cosine <= 0) continue;
        const auto bits = simulator::philox(
            {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(k), 0},
            {seed, 0});
        const double signal = albedo * light.strength * cosine * exposure;
        reading = static_cast<float>(simulator::noisy(rig->sensor, signal, bits) / exposure);
      }
    }
  }
  return trials;
}

Result<Json> row_of(const solver::MethodName& name, const Trials& trials, int threads) {
  SolvedMaps maps(kTrials);
  const Result<void> solved =
      solve_images(*name.make(), planes_of(trials.readings), *trials.field, {}, trials.noise, threads, maps);
  if (!solved) return solved.error();
  constexpr double kChiSquare68 = 2.28;
  double square = 0, bound_square = 0, within = 0, albedo_error = 0;
  std::vector<LightField::Light> facing;
  for (int y = 0; y < kTrials.height; ++y) {
    for (int x = 0; x < kTrials.width; ++x) {
      const Vec3 normal = trials.normal(x, y), estimate = maps.normal_at(x, y);
      facing.clear();
      for (const LightField::Light& light : trials.lights) {
        if (dot(normal, light.direction) > 0) facing.push_back(light);
      }
      const TangentCovariance bound = cramer_rao(facing, normal, trials.albedo, trials.noise);
      square += std::pow(angle_deg(estimate, normal), 2);
      bound_square += std::pow(bound.rms_deg(), 2);
      const double claimed = static_cast<double>(maps.sigma_normal_deg(x, y));
      within += bound.chi_square(estimate, claimed) < kChiSquare68 ? 1 : 0;
      albedo_error += static_cast<double>(maps.albedo(x, y)) - trials.albedo;
    }
  }
  const auto pixels = static_cast<double>(kTrials.pixels());
  return Json{{"method", name.name},
              {"albedo", trials.albedo},
              {"tilt_deg", trials.tilt_deg},
              {"pixels", kTrials.pixels()},
              {"rms_deg", std::sqrt(square / pixels)},
              {"bound_deg", std::sqrt(bound_square / pixels)},
              {"ratio_to_bound", std::sqrt(square / bound_square)},
              {"within_68", within / pixels},
              {"albedo_bias_rel", albedo_error / pixels / trials.albedo}};
}

}  // namespace

/// Scatter of one green photosite at the table's centre under photon and read noise alone, at the exposure
/// for white: albedo 0.04, 0.2 and 0.9, tilted by 0, 20 and 45 degrees to all sides. LEDs that the surface
/// does not face are marked as shadowed for every method. A row for each case and method:
/// ratio_to_bound: rms angle over that of the Cramer-Rao bound.
/// within_68: share of pixels with chi-square below 2.28, the 68 percent point for two degrees of freedom.
/// Methods state an rms angle and no directions, so chi-square takes its size from the method's own sigma and
/// its shape from the bound's tangent covariance, which weighted least squares attains.
Result<Rows> accuracy_bound(const AccuracyTableOptions& options) {
  std::vector<solver::MethodName> methods;
  std::vector<std::string> names;
  for (const solver::MethodName& name : solver::method_names()) {
    if (name.make()->wants_rgb()) continue;
    names.emplace_back(name.name);
    if (options.methods.empty() ||
        std::find(options.methods.begin(), options.methods.end(), name.name) != options.methods.end()) {
      methods.push_back(name);
    }
  }
  for (const std::string& asked : options.methods) {
    if (std::find(names.begin(), names.end(), asked) == names.end()) return no_such("method", asked, names);
  }
  Rows rows;
  std::uint32_t seed = 0;
  for (const double albedo : {0.04, 0.2, 0.9}) {
    for (const double tilt_deg : {0.0, 20.0, 45.0}) {
      const Result<Trials> trials = make_trials(albedo, tilt_deg, ++seed);
      if (!trials) return trials.error();
      for (const solver::MethodName& method : methods) {
        if (Result<void> ok = add_row(rows, row_of(method, *trials, options.threads)); !ok) return ok.error();
      }
    }
  }
  return rows;
}

}  // namespace weft::bench
