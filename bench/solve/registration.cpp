// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/registration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/jobs/session_input.h"
#include "core/image_io/image_io.h"
#include "core/temporary_folder.h"
#include "core/vec.h"
#include "pipeline/bands.h"
#include "pipeline/shifts.h"
#include "simulator/camera/movement.h"
#include "simulator/effects/random_key.h"
#include "simulator/simulate.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

using simulator::Family;

constexpr std::size_t kMoved = 4;  // light, from 0
constexpr double kSigma_px = 0.25;

simulator::Scene scene_of(Family family, double mm_per_pixel, bool moves) {
  simulator::Scene scene;
  scene.camera.width = 512;
  scene.camera.height = 384;
  scene.camera.mm_per_pixel = mm_per_pixel;
  scene.camera.movement = {kSigma_px * mm_per_pixel, 0};
  scene.geometry = simulator::family_settings(family);
  simulator::EffectSettings& e = scene.effects;
  e.near_light = e.relief = e.cast_shadows = e.interreflection = e.defocus = e.noise = true;
  e.movement = moves;
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

Result<NormalError> error_of(const pipeline::Photographs& photographs, const Image<float>& truth,
                             const JobContext& context) {
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
  const auto solved =
      pipeline::solve_bands(photographs, *solver::fast_method(), pipeline::kSolveTile, context, measure);
  if (!solved) return solved.error();
  return NormalError{sum / count, std::sqrt(square / count)};
}

Result<Json> row_of(const char* name, Family family, double mm_per_pixel, const JobContext& context) {
  const TemporaryFolder scratch;
  const simulator::Scene scene = scene_of(family, mm_per_pixel, true);
  Result<pipeline::Photographs> still =
      photograph(scene_of(family, mm_per_pixel, false), scratch.path() / "still.weft", context);
  if (!still) return std::move(still).error();
  Result<pipeline::Photographs> moved = photograph(scene, scratch.path() / "moved.weft", context);
  if (!moved) return std::move(moved).error();
  const Result<LoadedImage> truth = read_image(scratch.path() / "still.weft" / "truth" / "normal.exr");
  if (!truth) return truth.error();

  const Result<NormalError> unmoved = error_of(*still, truth->planes, context);
  if (!unmoved) return unmoved.error();
  const auto untouched = pipeline::register_shots(*still, context);
  if (!untouched) return untouched.error();
  const auto corrected_still =
      std::ranges::count(untouched->shots, pipeline::ShiftVerdict::kCorrected, &pipeline::ShotShift::verdict);

  std::swap(still->mosaics()->frames[kMoved], moved->mosaics()->frames[kMoved]);
  const Result<NormalError> alone = error_of(*still, truth->planes, context);
  if (!alone) return alone.error();
  Result<pipeline::SessionShifts> found = pipeline::register_shots(*still, context);
  if (!found) return std::move(found).error();
  still->shifts = found->corrections;
  const Result<NormalError> corrected = error_of(*still, truth->planes, context);
  if (!corrected) return corrected.error();
  const double seconds = least_seconds(3, [&] { (void)pipeline::register_shots(*still, context); });

  const simulator::ClothMovement m = simulator::movement_of_shot(
      scene.camera.movement, static_cast<int>(kMoved) + 1, simulator::random_key(scene));
  const double dx_px = m.x_mm / mm_per_pixel, dy_px = -m.y_mm / mm_per_pixel;
  double square = 0;
  for (std::size_t k = 0; k < found->shots.size(); ++k) {
    const solver::ClothShift& s = found->shots[k].measured.shift;
    square +=
        std::pow(s.dx_px - (k == kMoved ? dx_px : 0), 2) + std::pow(s.dy_px - (k == kMoved ? dy_px : 0), 2);
  }
  return Json{
      {"cloth", name},
      {"pixels_per_yarn", scene.geometry.warp_pitch_mm / mm_per_pixel},
      {"shift_px", std::hypot(dx_px, dy_px)},
      {"rms_error_px", std::sqrt(square / (2.0 * static_cast<double>(found->shots.size())))},
      {"sigma_px", found->shots[kMoved].measured.sigma_px},
      {"unmoved_deg", unmoved->mean_deg},
      {"moved_deg", alone->mean_deg},
      {"registered_deg", corrected->mean_deg},
      {"predicted_deg", found->shots[kMoved].measured.cost_deg},
      {"real_deg", std::sqrt(std::max(0.0, std::pow(alone->rms_deg, 2) - std::pow(unmoved->rms_deg, 2)))},
      {"corrected",
       std::ranges::count(found->shots, pipeline::ShiftVerdict::kCorrected, &pipeline::ShotShift::verdict)},
      {"corrected_unmoved", corrected_still},
      {"seconds", seconds}};
}

}  // namespace

Result<Rows> registration(int threads) {
  JobContext context;
  context.threads = threads;
  Rows rows;
  for (const auto& [name, family] : {std::pair{"smooth", Family::kSmooth}, std::pair{"plain", Family::kPlain},
                                     std::pair{"deep", Family::kDeep}}) {
    for (const double mm_per_pixel : {0.04, 0.08}) {
      Result<Json> row = row_of(name, family, mm_per_pixel, context);
      if (!row) return std::move(row).error();
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

}  // namespace weft::bench
