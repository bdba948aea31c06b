// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "app/jobs/session_input.h"
#include "core/image_io/image_io.h"
#include "core/temporary_folder.h"
#include "core/vec.h"
#include "pipeline/bands.h"
#include "pipeline/shifts.h"
#include "simulator/camera/movement.h"
#include "simulator/effects/random_key.h"
#include "simulator/reflectance/presets.h"
#include "simulator/simulate.h"
#include "solver/method.h"

namespace weft::bench {
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
    const simulator::Preset preset = *simulator::preset(cloth.preset);
    scene.material.reflectance = preset.reflectance;
    scene.material.albedo = preset.albedo;
    e.reflectance = true;
  }
  return scene;
}

Result<pipeline::Photographs> photograph(const simulator::Scene& scene, const std::filesystem::path& folder,
                                         const JobContext& context) {
  const auto simulated = simulator::simulate_session(
      scene, folder, {.tiles = {.threads = context.threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();
  app::SessionOptions options;
  options.folder = folder;
  const auto plan = app::plan_session(options);
  if (!plan) return plan.error();
  Result<app::LoadedSession> loaded = app::load_session(*plan, context);
  if (!loaded) return std::move(loaded).error();
  return std::move(loaded->photographs);
}

struct NormalError {
  double mean_deg = 0, rms_deg = 0;
};

Result<NormalError> error_of(const pipeline::Photographs& photographs, solver::Level level,
                             const Image<float>& truth, const JobContext& context) {
  double sum = 0, square = 0, count = 0;
  const auto measure = [&](const pipeline::MapBand& band) -> Result<void> {
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
  const auto solved = pipeline::solve_bands(photographs, *solver::method_of(level).make(),
                                            pipeline::kSolveTile, context, measure);
  if (!solved) return solved.error();
  return NormalError{sum / count, std::sqrt(square / count)};
}

// The errors of some levels, in their order.
using LevelErrors = std::vector<NormalError>;
Result<LevelErrors> level_errors(const pipeline::Photographs& photographs,
                                 std::span<const solver::Level> levels, const Image<float>& truth,
                                 const JobContext& context) {
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
  pipeline::SessionShifts shifts;
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
      {"left_out", f.shifts.with(pipeline::ShiftVerdict::kLeftOut).size()},
      {"flagged", f.shifts.with(pipeline::ShiftVerdict::kFlagged).size()},
      {"seconds", f.seconds}};
}

// Adds a row a level: of a cloth that lies still, or lay elsewhere in shot kMoved.
Result<void> add_rows(const Swatch& cloth, bool moves, std::span<const solver::Level> levels,
                      const JobContext& context, Rows& rows) {
  const TemporaryFolder scratch;
  Result<pipeline::Photographs> cloth_shots =
      photograph(scene_of(cloth, false), scratch.path() / "still.weft", context);
  if (!cloth_shots) return std::move(cloth_shots).error();
  const Result<LoadedImage> truth = read_image(scratch.path() / "still.weft" / "truth" / "normal.exr");
  if (!truth) return truth.error();
  const Result<LevelErrors> unmoved = level_errors(*cloth_shots, levels, truth->planes, context);
  if (!unmoved) return unmoved.error();

  Finding finding;
  if (moves) {
    const simulator::Scene scene = scene_of(cloth, true);
    Result<pipeline::Photographs> moved = photograph(scene, scratch.path() / "moved.weft", context);
    if (!moved) return std::move(moved).error();
    std::swap(cloth_shots->mosaics()->frames[kMoved], moved->mosaics()->frames[kMoved]);
    const simulator::ClothMovement m = simulator::movement_of_shot(
        scene.camera.movement, static_cast<int>(kMoved) + 1, simulator::random_key(scene));
    finding.dx_px = m.x_mm / cloth.mm_per_pixel;
    finding.dy_px = -m.y_mm / cloth.mm_per_pixel;
  }
  const Result<LevelErrors> alone = level_errors(*cloth_shots, levels, truth->planes, context);
  if (!alone) return alone.error();
  Result<pipeline::SessionShifts> found = pipeline::register_shots(*cloth_shots, context);
  if (!found) return std::move(found).error();
  finding.seconds = least_seconds(3, [&] { (void)pipeline::register_shots(*cloth_shots, context); });
  finding.shifts = std::move(*found);
  const std::vector<std::size_t> left_out = finding.shifts.with(pipeline::ShiftVerdict::kLeftOut);
  if (Result<void> ok = pipeline::leave_out(left_out, *cloth_shots); !ok) return ok;
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
/// and the mean error without movement, with registration off and with it on (pipeline/shifts.h).
/// `taken_back` is the share of the damage that registration undoes, `predicted_deg` cost_deg of the shot,
/// `real_deg` what the movement adds to the rms error.
Result<Rows> registration(const StudyOptions& options) {
  constexpr std::array kOfMoved = {solver::Level::kFast, solver::Level::kStandard, solver::Level::kRobust};
  constexpr std::array kOfStill = {solver::Level::kStandard, solver::Level::kRobust};
  JobContext context;
  context.threads = options.threads;
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
