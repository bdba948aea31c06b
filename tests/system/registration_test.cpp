// SPDX-License-Identifier: Apache-2.0
// A cloth that somebody touched between the shots, from raw frames to normals.
#include "pipeline/shifts.h"

#include <gtest/gtest.h>

#include <utility>

#include "app/jobs/facts_json.h"
#include "app/jobs/session_input.h"
#include "core/vec.h"
#include "pipeline/bands.h"
#include "solver/method.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

constexpr Size kClothSize = {256, 192};

class Registration : public testing::Test {
 protected:
  pipeline::Photographs photographs_of(const simulator::Scene& scene, const char* name) {
    simulate(scene, work_ / name);
    app::SessionOptions options;
    options.folder = work_ / name;
    return std::move(app::load_session(*app::plan_session(options), {})->photographs);
  }
  double mean_error_deg(const pipeline::Photographs& photographs, int tile_height = 4, int threads = 1) {
    const LoadedImage truth = *read_image(work_ / "still.weft" / "truth" / "normal.exr");
    double sum = 0;
    JobContext context;
    context.threads = threads;
    (void)pipeline::solve_bands(
        photographs, *solver::fast_method(), {.width = 64, .height = tile_height}, context,
        [&](const pipeline::MapBand& band) -> Result<void> {
          for (int y = band.rows.y0; y < band.rows.y1; ++y) {
            for (int x = 0; x < kClothSize.width; ++x) {
              const int row = y - band.rows.y0;
              sum += angle_deg({band.normal[0](x, row), band.normal[1](x, row), band.normal[2](x, row)},
                               {truth.planes(x, y, 0), truth.planes(x, y, 1), truth.planes(x, y, 2)});
            }
          }
          return {};
        });
    return sum / static_cast<double>(kClothSize.pixels());
  }

  Workspace work_;
  simulator::Scene still_ = [] {
    simulator::Scene scene = scene_named("movement", kClothSize);
    scene.effects.movement = false;
    scene.effects.defocus = true;
    return scene;
  }();
};

TEST_F(Registration, OfOneShotThatMovedTakesMostOfItsCostAway) {
  simulator::Scene moves = still_;
  moves.effects.movement = true;
  moves.camera.movement.sigma_deg = 0;
  pipeline::Photographs session = photographs_of(still_, "still.weft");
  pipeline::Photographs moved = photographs_of(moves, "moved.weft");
  const double unmoved_deg = mean_error_deg(session);
  std::swap(session.mosaics()->frames[4], moved.mosaics()->frames[4]);
  const double moved_deg = mean_error_deg(session);
  const pipeline::SessionShifts shifts = *pipeline::register_shots(session, {});
  EXPECT_EQ(shifts.shots[4].verdict, pipeline::ShiftVerdict::kCorrected) << app::json_of(shifts, {}).dump(1);
  session.shifts = shifts.corrections;
  const double corrected_deg = mean_error_deg(session);
  EXPECT_LT(corrected_deg - unmoved_deg, 0.4 * (moved_deg - unmoved_deg))
      << "unmoved " << unmoved_deg << ", moved " << moved_deg << ", corrected " << corrected_deg;
  EXPECT_EQ(mean_error_deg(session, 17, 2), corrected_deg);
}

TEST_F(Registration, OfASessionWithoutMovementChangesNothing) {
  const pipeline::Photographs session = photographs_of(still_, "still.weft");
  const pipeline::SessionShifts shifts = *pipeline::register_shots(session, {});
  EXPECT_TRUE(shifts.corrections.empty()) << app::json_of(shifts, {}).dump(1);
}

}  // namespace
}  // namespace weft::test
