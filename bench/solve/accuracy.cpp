// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/solve_studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bench/base/bound.h"
#include "bench/base/measured_rig.h"
#include "bench/base/solved_maps.h"
#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "material/read/compare.h"
#include "simulator/camera/cloth_movement.h"
#include "simulator/effects/random_key.h"
#include "simulator/reflectance/presets.h"
#include "simulator/sampling/random.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "solve/bands/bands.h"
#include "solve/files/normal_comparison.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solve/levels/shifts.h"
#include "solve/run/solve_session.h"
#include "solver/method.h"
#include "solver/normals/seed.h"

namespace weft::bench {
namespace {

using simulator::GeometryKind;
using simulator::Scene;

Scene scene_of(GeometryKind kind, Size size) {
  Scene scene;
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  scene.geometry.kind = kind;
  scene.effects.near_light = true;
  return scene;
}

Vec3 at(const Image<double>& planes, int x, int y) {
  return {planes(x, y, 0), planes(x, y, 1), planes(x, y, 2)};
}

Json error_row(const char* kind, const char* name, const char* input, const std::vector<double>& angles) {
  double sum = 0, most = 0;
  for (const double a : angles) {
    sum += a;
    most = std::max(most, a);
  }
  return {{kind, name},
          {"input", input},
          {"pixels", angles.size()},
          {"mean_deg", sum / static_cast<double>(angles.size())},
          {"max_deg", most}};
}

// Errors of a method on rendered readings as floats, one plane a light (a mosaic) or three.
Json float_row(const simulator::Rendering& truth, const LightField& field, int planes) {
  const Size size = truth.normal.size();
  const auto lights = static_cast<int>(field.count());
  const CfaPattern cfa;
  Image<float> readings(size, lights * planes);
  std::vector<View<const float>> views;
  for (int k = 0; k < lights; ++k) {
    for (int p = 0; p < planes; ++p) {
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          const int c = planes == 1 ? cfa.channel_at(x, y) : p;
          readings(x, y, k * planes + p) = static_cast<float>(truth.readings(x, y, 3 * k + c));
        }
      }
      views.emplace_back(readings.plane(k * planes + p));
    }
  }
  SolvedMaps maps(size);
  solver::fast_method()->solve({{0, 0, size.width, size.height}, planes, cfa, views, &field, std::nullopt},
                               maps.output({0, 0, size.width, size.height}));
  std::vector<double> angles;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x)
      angles.push_back(angle_deg(maps.normal_at(x, y), at(truth.normal, x, y)));
  }
  return error_row("quality", "fast", planes == 1 ? "twill, float mosaic" : "twill, float RGB", angles);
}

Json seed_row(const simulator::Rendering& truth, const LightField& field) {
  std::vector<double> angles;
  std::vector<solver::PixelRow> rows(field.count());
  for (int y = 0; y < truth.normal.height(); y += 2) {
    for (int x = 0; x < truth.normal.width(); x += 2) {
      for (std::size_t k = 0; k < rows.size(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
          const LightField::Light light = field.at(k, static_cast<int>(c), x, y);
          rows[k].direction = light.direction;
          rows[k].strength[c] = light.strength;
          rows[k].reading[c] = truth.readings(x, y, static_cast<int>(3 * k + c));
        }
      }
      angles.push_back(angle_deg(solver::solve_seed_pixel(rows).n[3], at(truth.normal, x, y)));
    }
  }
  return error_row("method", "seed", "plane, double RGB", angles);
}

Result<LightField> field_of(const Scene& scene) {
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();
  const Calibration exact = simulator::exact_calibration(scene, *rig);
  return LightField::make(*exact.lights, exact.camera, {scene.camera.width, scene.camera.height},
                          scene.geometry.cloth_height_mm);
}

// A flat cloth through DNG files, solved by the whole product.
Result<Json> file_row(Size size, int threads) {
  const TemporaryFolder scratch;
  Scene scene = scene_of(GeometryKind::kFlat, size);
  scene.material.albedo = {0.2, 0.2, 0.2};
  const std::filesystem::path session = scratch.path() / "flat.weft";
  const auto simulated = simulator::simulate_session(
      scene, session, {.tiles = {.threads = threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();
  const JobContext context = {.threads = threads};
  const auto solved = solve::solve_session({session, {}, {}}, {}, context);
  if (!solved) return solved.error();
  const auto compared =
      material::compare_normals(solved->folder / "normal.exr", session / "truth" / "normal.exr", {});
  if (!compared) return compared.error();
  return Json{{"quality", "fast"},
              {"input", "flat, 14-bit DNG to EXR"},
              {"pixels", compared->pixels},
              {"mean_deg", compared->mean_deg},
              {"max_deg", compared->max_deg}};
}

}  // namespace

/// Errors without noise against the simulator's truth: seed on doubles (a plane tilted by 15 degrees),
/// fast on floats as mosaic and as RGB (a twill; in memory, no quantisation), and fast through 14-bit DNG
/// files and EXR maps (a flat cloth of albedo 0.2).
Result<Rows> solve_exactness(const StudyOptions& options) {
  const Size size = bench_size(options.megapixels);
  const Rect all = {0, 0, size.width, size.height};
  // The seed's method knows no shadow: a plane that every light reaches is its truth.
  Scene plane = scene_of(GeometryKind::kTilted, size);
  plane.geometry.tilt_deg = 15;
  const Scene cloth = scene_of(GeometryKind::kTwill, size);
  const Result<LightField> field = field_of(cloth);
  if (!field) return field.error();
  const auto lit = simulator::render_readings(plane, all, {.threads = options.threads});
  if (!lit) return lit.error();
  const auto woven = simulator::render_readings(cloth, all, {.threads = options.threads});
  if (!woven) return woven.error();
  Rows rows = {seed_row(*lit, *field), float_row(*woven, *field, 1), float_row(*woven, *field, 3)};
  Result<Json> files = file_row(size, options.threads);
  if (!files) return std::move(files).error();
  rows.push_back(std::move(*files));
  return rows;
}

namespace {

/// The lights of one pixel's green photosite, the same at every pixel.
Result<LightField> lights_of_pixel(const LightField& field, int x, int y, Size size) {
  DistantLights lights;
  for (std::size_t k = 0; k < field.count(); ++k) {
    const LightField::Light light = field.at(k, 1, x, y);
    lights.lights.push_back({light.direction, {light.strength, light.strength, light.strength}});
  }
  return LightField::make(lights, std::nullopt, size, 0);
}

/// What the sensor reads of grey cloth that faces the camera; every pixel is one trial.
Image<float> noisy_readings(const simulator::Sensor& sensor, const LightField& field, double albedo,
                            double exposure, Size size) {
  Image<float> readings(size, static_cast<int>(field.count()));
  for (std::size_t k = 0; k < field.count(); ++k) {
    const LightField::Light light = field.at(k, 1, 0, 0);
    const double signal = albedo * light.strength * light.direction.z * exposure;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto bits = simulator::philox(
            {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(k), 0},
            {1, 0});
        readings(x, y, static_cast<int>(k)) =
            static_cast<float>(simulator::noisy(sensor, signal, bits) / exposure);
      }
    }
  }
  return readings;
}

Result<Json> noise_row(double albedo, Size size) {
  Scene scene = scene_of(GeometryKind::kFlat, size);
  scene.material.albedo = {albedo, albedo, albedo};
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();
  const Result<LightField> field = field_of(scene);
  if (!field) return field.error();
  const Result<LightField> same = lights_of_pixel(*field, size.width / 2, size.height / 2, size);
  if (!same) return same.error();
  const double exposure = rig->exposure(scene.camera.iso);
  const double e = rig->sensor.electrons_at_white, read = rig->sensor.read_noise_electrons;
  const NoiseModel noise = {1 / (e * exposure), read * read / (e * e * exposure * exposure), 0};
  const Image<float> readings = noisy_readings(rig->sensor, *same, albedo, exposure, size);
  std::vector<View<const float>> views;
  for (int k = 0; k < readings.planes(); ++k) views.emplace_back(readings.plane(k));
  SolvedMaps maps(size);
  const Rect frame = {0, 0, size.width, size.height};
  solver::least_squares_method()->solve({frame, 1, CfaPattern{}, views, &*same, noise}, maps.output(frame));

  const Vec3 normal = {0, 0, 1};
  double square = 0, predicted = 0, albedo_square = 0, albedo_predicted = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      square += std::pow(angle_deg(maps.normal_at(x, y), normal), 2);
      predicted += std::pow(maps.sigma_normal_deg(x, y), 2);
      albedo_square += std::pow(maps.albedo(x, y) - albedo, 2);
      albedo_predicted += std::pow(maps.sigma_albedo(x, y), 2);
    }
  }
  const double rms = std::sqrt(square / static_cast<double>(size.pixels()));
  std::vector<LightField::Light> reaching;
  for (std::size_t k = 0; k < same->count(); ++k) reaching.push_back(same->at(k, 1, 0, 0));
  const double bound = cramer_rao(reaching, normal, albedo, noise).rms_deg();
  return Json{{"method", "least-squares"},
              {"albedo", albedo},
              {"pixels", size.pixels()},
              {"rms_deg", rms},
              {"bound_deg", bound},
              {"ratio_to_bound", rms / bound},
              {"predicted_over_rms", std::sqrt(predicted / square)},
              {"albedo_predicted_over_rms", std::sqrt(albedo_predicted / albedo_square)}};
}

}  // namespace

/// Scatter of one photosite under photon and read noise, at a frontal normal: rms angle against the
/// Cramer-Rao bound and against the sigma that the method predicted, for three albedos at white exposure.
Result<Rows> solve_noise(const StudyOptions& options) {
  Rows rows;
  for (const double albedo : {0.04, 0.2, 0.9}) {
    if (Result<void> ok = add_row(rows, noise_row(albedo, bench_size(options.megapixels))); !ok)
      return ok.error();
  }
  return rows;
}

namespace {

struct Truth {
  LoadedImage normal, albedo;
};

Result<Truth> read_truth(const std::filesystem::path& session) {
  Result<LoadedImage> normal = read_image(session / "truth" / "normal.exr");
  if (!normal) return std::move(normal).error();
  Result<LoadedImage> albedo = read_image(session / "truth" / "albedo.exr");
  if (!albedo) return std::move(albedo).error();
  return Truth{std::move(*normal), std::move(*albedo)};
}

Result<solve::Photographs> photograph(const simulator::Scene& scene, const std::filesystem::path& folder,
                                      const JobContext& context) {
  const auto simulated = simulator::simulate_session(
      scene, folder, {.tiles = {.threads = context.threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();
  const auto plan = solve::plan_session({folder, {}, {}});
  if (!plan) return plan.error();
  return solve::load_photographs(*plan, context);
}

// Error and time of one order of work.
Result<Json> order_row(const solve::Photographs& photographs, const solver::Method& method,
                       const Truth& truth, const JobContext& context) {
  std::vector<float> angles;
  double albedo_error = 0, albedo_samples = 0;
  const auto measure = [&](const solve::MapBand& band) -> Result<void> {
    for (int y = band.rows.y0; y < band.rows.y1; ++y) {
      for (int x = 0; x < band.rows.x1; ++x) {
        const auto solved = [&](int c) {
          return band.normal[static_cast<std::size_t>(c)](x, y - band.rows.y0);
        };
        const auto real = [&](int c) { return truth.normal.planes(x, y, c); };
        angles.push_back(
            static_cast<float>(angle_deg({solved(0), solved(1), solved(2)}, {real(0), real(1), real(2)})));
      }
    }
    for (int y = band.albedo_rows.y0; y < band.albedo_rows.y1; ++y) {
      for (int x = 0; x < band.albedo_rows.x1; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          const float real = truth.albedo.planes(x, y, static_cast<int>(c));
          albedo_error += std::abs(band.albedo[c](x, y - band.albedo_rows.y0) - real) / real;
          ++albedo_samples;
        }
      }
    }
    return {};
  };
  const Result<double> measured =
      solve::solve_bands(photographs, method, solve::kSolveTile, context, measure);
  if (!measured) return measured.error();
  const double seconds = least_seconds(3, [&] {
    (void)solve::solve_bands(photographs, method, solve::kSolveTile, context,
                             [](const solve::MapBand&) { return Result<void>(); });
  });
  const solve::NormalComparison c = solve::summarize(angles);
  return Json{{"pixels", c.pixels},
              {"mean_deg", c.mean_deg},
              {"median_deg", c.median_deg},
              {"p95_deg", c.p95_deg},
              {"albedo_mean_rel", albedo_error / albedo_samples},
              {"ns_per_pixel", seconds * 1e9 / static_cast<double>(c.pixels)}};
}

// `fast` on photographs that were demosaiced first.
class FastOnRgb : public solver::Method {
 public:
  void solve(const solver::TileInput& input, const solver::TileOutput& output) const override {
    fast_->solve(input, output);
  }
  bool wants_rgb() const override { return true; }

 private:
  std::unique_ptr<solver::Method> fast_ = solver::fast_method();
};

}  // namespace

/// Solving the mosaic and demosaicing the albedo, against demosaicing every photograph and solving RGB: error
/// and time of both on noisy cloth.
Result<Rows> solve_order(const StudyOptions& options) {
  const TemporaryFolder scratch;
  Rows rows;
  for (const auto& [name, kind] :
       {std::pair{"plain", GeometryKind::kPlain}, std::pair{"twill", GeometryKind::kTwill},
        std::pair{"satin", GeometryKind::kSatin}}) {
    Scene scene = scene_of(kind, bench_size(options.megapixels));
    scene.material.warp_albedo = {0.06, 0.08, 0.2};
    scene.material.weft_albedo = {0.6, 0.5, 0.4};
    scene.material.yarn_variation = 0.1;
    scene.effects.noise = true;
    const std::filesystem::path folder = scratch.path() / (std::string(name) + ".weft");
    const JobContext context = {.threads = options.threads};
    const Result<solve::Photographs> photographs = photograph(scene, folder, context);
    if (!photographs) return photographs.error();
    const auto truth = read_truth(folder);
    if (!truth) return truth.error();
    for (const bool after : {true, false}) {
      const std::unique_ptr<solver::Method> method =
          after ? solver::fast_method() : std::unique_ptr<solver::Method>(new FastOnRgb);
      Result<Json> row = order_row(*photographs, *method, *truth, context);
      if (!row) return std::move(row).error();
      Json named = {
          {"quality", "fast"}, {"cloth", name}, {"demosaicing", after ? "after solving" : "before solving"}};
      named.update(*row);
      rows.push_back(std::move(named));
    }
  }
  return rows;
}

namespace {

using simulator::Family;

constexpr std::size_t kMoved = 4;  // light, from 0
constexpr double kSigma_px = 0.25;

struct Swatch {
  const char* name;
  Family family;
  const char* preset;  // whose reflectance it has; none: Lambert
  double pitch_mm;
  double mm_per_pixel;
  std::uint32_t seed;
};
// Sharp as the lens of the defocus effect leaves them.
constexpr Swatch kMatt[] = {
    {"smooth", Family::kSmooth, nullptr, 0.5, 0.04, 1}, {"smooth", Family::kSmooth, nullptr, 0.5, 0.08, 1},
    {"plain", Family::kPlain, nullptr, 0.5, 0.04, 1},   {"plain", Family::kPlain, nullptr, 0.5, 0.08, 1},
    {"deep", Family::kDeep, nullptr, 0.5, 0.04, 1},     {"deep", Family::kDeep, nullptr, 0.5, 0.08, 1}};
// No threshold was chosen on these.
constexpr Swatch kGlossy[] = {{"smooth satin", Family::kSmooth, "satin", 0.86, 0.05, 11},
                              {"smooth satin", Family::kSmooth, "satin", 0.62, 0.06, 12},
                              {"plain satin", Family::kPlain, "satin", 0.84, 0.05, 13},
                              {"plain satin", Family::kPlain, "satin", 0.70, 0.07, 14},
                              {"deep satin", Family::kDeep, "satin", 0.88, 0.05, 15},
                              {"smooth dark satin", Family::kSmooth, "dark-satin", 0.82, 0.05, 16},
                              {"plain dark satin", Family::kPlain, "dark-satin", 0.86, 0.06, 17},
                              {"deep dark satin", Family::kDeep, "dark-satin", 0.90, 0.05, 18},
                              {"smooth velvet", Family::kSmooth, "velvet", 0.84, 0.05, 19},
                              {"plain velvet", Family::kPlain, "velvet", 0.88, 0.06, 20}};

simulator::Scene scene_of(const Swatch& cloth, bool moves) {
  simulator::Scene scene;
  scene.seed = cloth.seed;
  scene.camera.width = 512;
  scene.camera.height = 384;
  scene.camera.mm_per_pixel = cloth.mm_per_pixel;
  scene.camera.movement = {kSigma_px * cloth.mm_per_pixel, 0};
  scene.geometry = simulator::family_settings(cloth.family);
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = cloth.pitch_mm;
  simulator::EffectSettings& e = scene.effects;
  e.near_light = e.relief = e.cast_shadows = e.interreflection = e.defocus = e.noise = true;
  e.movement = moves;
  if (cloth.preset != nullptr) {
    const simulator::ClothPreset preset = *simulator::preset(cloth.preset);
    scene.material.reflectance = preset.reflectance;
    scene.material.albedo = preset.albedo;
    e.reflectance = true;
  }
  return scene;
}

struct NormalError {
  double mean_deg = 0, rms_deg = 0;
};

Result<NormalError> error_of(const solve::Photographs& photographs, solver::Level level,
                             const Image<float>& truth, const JobContext& context) {
  double sum = 0, square = 0, count = 0;
  const auto measure = [&](const solve::MapBand& band) -> Result<void> {
    for (int y = band.rows.y0; y < band.rows.y1; ++y) {
      for (int x = 0; x < band.rows.x1; ++x) {
        const int row = y - band.rows.y0;
        const double angle =
            angle_deg({band.normal[0](x, row), band.normal[1](x, row), band.normal[2](x, row)},
                      {truth(x, y, 0), truth(x, y, 1), truth(x, y, 2)});
        sum += angle;
        square += angle * angle;
        ++count;
      }
    }
    return {};
  };
  const auto solved =
      solve::solve_bands(photographs, *solver::method_of(level).make(), solve::kSolveTile, context, measure);
  if (!solved) return solved.error();
  return NormalError{sum / count, std::sqrt(square / count)};
}

// The errors of some levels, in their order.
using LevelErrors = std::vector<NormalError>;
Result<LevelErrors> level_errors(const solve::Photographs& photographs, std::span<const solver::Level> levels,
                                 const Image<float>& truth, const JobContext& context) {
  LevelErrors errors;
  for (const solver::Level level : levels) {
    const Result<NormalError> error = error_of(photographs, level, truth, context);
    if (!error) return error.error();
    errors.push_back(*error);
  }
  return errors;
}

// What a registration found, beside the cloth's displacement of shot kMoved in pixels.
struct Finding {
  solve::SessionShifts shifts;
  double dx_px = 0, dy_px = 0;
  double seconds = 0;

  double rms_error_px() const {
    double square = 0;
    for (std::size_t k = 0; k < shifts.shots.size(); ++k) {
      const solver::ClothShift& s = shifts.shots[k].measured.shift;
      square +=
          std::pow(s.dx_px - (k == kMoved ? dx_px : 0), 2) + std::pow(s.dy_px - (k == kMoved ? dy_px : 0), 2);
    }
    return std::sqrt(square / (2.0 * static_cast<double>(shifts.shots.size())));
  }
};

Json row_of(const Swatch& cloth, solver::Level level, const Finding& f, const NormalError& unmoved,
            const NormalError& alone, const NormalError& registered) {
  const solver::ShotRegistration& shot = f.shifts.shots[kMoved].measured;
  const double damage_deg = alone.mean_deg - unmoved.mean_deg;
  const Json taken_back = damage_deg > 0 ? Json((alone.mean_deg - registered.mean_deg) / damage_deg) : Json();
  return Json{
      {"cloth", cloth.name},
      {"seed", cloth.seed},
      {"pixels_per_yarn", cloth.pitch_mm / cloth.mm_per_pixel},
      {"level", solver::method_of(level).name},
      {"shift_px", std::hypot(f.dx_px, f.dy_px)},
      {"rms_error_px", f.rms_error_px()},
      {"sigma_px", shot.sigma_px},
      {"unmoved_deg", unmoved.mean_deg},
      {"off_deg", alone.mean_deg},
      {"on_deg", registered.mean_deg},
      {"taken_back", taken_back},
      {"predicted_deg", shot.cost_deg},
      {"real_deg", std::sqrt(std::max(0.0, std::pow(alone.rms_deg, 2) - std::pow(unmoved.rms_deg, 2)))},
      {"left_out", f.shifts.with(solve::ShiftVerdict::kLeftOut).size()},
      {"flagged", f.shifts.with(solve::ShiftVerdict::kFlagged).size()},
      {"seconds", f.seconds}};
}

// Adds a row a level: of a cloth that lies still, or lay elsewhere in shot kMoved.
Result<void> add_rows(const Swatch& cloth, bool moves, std::span<const solver::Level> levels,
                      const JobContext& context, Rows& rows) {
  const TemporaryFolder scratch;
  Result<solve::Photographs> cloth_shots =
      photograph(scene_of(cloth, false), scratch.path() / "still.weft", context);
  if (!cloth_shots) return std::move(cloth_shots).error();
  const Result<LoadedImage> truth = read_image(scratch.path() / "still.weft" / "truth" / "normal.exr");
  if (!truth) return truth.error();
  const Result<LevelErrors> unmoved = level_errors(*cloth_shots, levels, truth->planes, context);
  if (!unmoved) return unmoved.error();

  Finding finding;
  if (moves) {
    const simulator::Scene scene = scene_of(cloth, true);
    Result<solve::Photographs> moved = photograph(scene, scratch.path() / "moved.weft", context);
    if (!moved) return std::move(moved).error();
    std::swap(cloth_shots->mosaics()->frames[kMoved], moved->mosaics()->frames[kMoved]);
    const simulator::ClothMovement m = simulator::movement_of_shot(
        scene.camera.movement, static_cast<int>(kMoved) + 1, simulator::random_key(scene));
    finding.dx_px = m.x_mm / cloth.mm_per_pixel;
    finding.dy_px = -m.y_mm / cloth.mm_per_pixel;
  }
  const Result<LevelErrors> alone = level_errors(*cloth_shots, levels, truth->planes, context);
  if (!alone) return alone.error();
  Result<solve::SessionShifts> found = solve::register_shots(*cloth_shots, context);
  if (!found) return std::move(found).error();
  finding.seconds = least_seconds(3, [&] { (void)solve::register_shots(*cloth_shots, context); });
  finding.shifts = std::move(*found);
  const std::vector<std::size_t> left_out = finding.shifts.with(solve::ShiftVerdict::kLeftOut);
  if (Result<void> ok = solve::leave_out(left_out, *cloth_shots); !ok) return ok;
  const Result<LevelErrors> registered = level_errors(*cloth_shots, levels, truth->planes, context);
  if (!registered) return registered.error();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    rows.push_back(row_of(cloth, levels[i], finding, (*unmoved)[i], (*alone)[i], (*registered)[i]));
  }
  return {};
}

}  // namespace

/// Cloths through DNG files, with shadows, bounces, defocus and noise. In three families of matt weave at two
/// sizes of pixel one shot of ten has moved; in ten glossy cloths none has. How well the shift is measured,
/// and the mean error without movement, with registration off and with it on (solve/levels/shifts.h).
/// `taken_back` is the share of the damage that registration undoes, `predicted_deg` cost_deg of the shot,
/// `real_deg` what the movement adds to the rms error.
Result<Rows> registration(const StudyOptions& options) {
  constexpr std::array kOfMoved = {solver::Level::kFast, solver::Level::kStandard, solver::Level::kRobust};
  constexpr std::array kOfStill = {solver::Level::kStandard, solver::Level::kRobust};
  const JobContext context = {.threads = options.threads};
  Rows rows;
  for (const Swatch& cloth : kMatt) {
    if (Result<void> ok = add_rows(cloth, true, kOfMoved, context, rows); !ok) return std::move(ok).error();
  }
  for (const Swatch& cloth : kGlossy) {
    if (Result<void> ok = add_rows(cloth, false, kOfStill, context, rows); !ok) return std::move(ok).error();
  }
  return rows;
}

}  // namespace weft::bench
