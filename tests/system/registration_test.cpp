// SPDX-License-Identifier: Apache-2.0
// A cloth that somebody touched between the shots, from raw frames to normals.
#include "solve/levels/shifts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "core/describe/field_json.h"
#include "solve/bands/bands.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solve/run/facts_json.h"
#include "solve/run/solve_session.h"
#include "solver/method.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

constexpr Size kClothSize = {256, 192};

class Registration : public testing::Test {
 protected:
  solve::Photographs photographs_of(const simulator::Scene& scene, const char* name) {
    simulate(scene, work_ / name);
    solve::SessionOptions options;
    options.folder = work_ / name;
    return *solve::load_photographs(*solve::plan_session(options), {});
  }
  static solve::MovedShots need_far(const solve::Photographs& photographs) {
    Result<solve::MovedShots> far = solve::find_far_shifts(photographs, {});
    if (!far) throw std::runtime_error(far.error().message());
    return *std::move(far);
  }
  double mean_error_deg(const solve::Photographs& photographs) {
    const LoadedImage truth = *read_image(work_ / "still.weft" / "truth" / "normal.exr");
    double sum = 0;
    (void)solve::solve_bands(
        photographs, *solver::fast_method(), {.width = 64, .height = 4}, {},
        [&](const solve::MapBand& band) -> Result<void> {
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
  solve::Photographs session = photographs_of(still_, "still.weft");
  solve::Photographs moved = photographs_of(moves, "moved.weft");
  const double unmoved_deg = mean_error_deg(session);
  std::swap(session.mosaics()->frames[4], moved.mosaics()->frames[4]);
  const double moved_deg = mean_error_deg(session);
  const solve::SessionShifts shifts = *solve::register_shots(session, {});
  const std::vector<std::size_t> left_out = shifts.with(solve::ShiftVerdict::kLeftOut);
  ASSERT_EQ(left_out, std::vector<std::size_t>{4}) << list_of(solve::facts_of(shifts, {})).dump(1);
  ASSERT_TRUE(solve::leave_out(left_out, session));
  const double registered_deg = mean_error_deg(session);
  EXPECT_LT(registered_deg - unmoved_deg, 0.3 * (moved_deg - unmoved_deg))
      << "unmoved " << unmoved_deg << ", moved " << moved_deg << ", registered " << registered_deg;
}

TEST_F(Registration, OfASessionWithoutMovementChangesNothing) {
  const solve::Photographs session = photographs_of(still_, "still.weft");
  const solve::SessionShifts shifts = *solve::register_shots(session, {});
  EXPECT_EQ(shifts.with(solve::ShiftVerdict::kStill).size(), 10U)
      << list_of(solve::facts_of(shifts, {})).dump(1);
}

TEST_F(Registration, IsLeftOutWhereThatIsAskedFor) {
  simulate(still_, work_ / "still.weft");
  const auto solved = [&](bool registration) {
    solve::SolveOptions options;
    options.registration = registration;
    return solve::solve_session({work_ / "still.weft", {}, {}}, options, {});
  };
  const Result<solve::SolveReport> with = solved(true), without = solved(false);
  ASSERT_TRUE(with && without);
  EXPECT_EQ(with->facts.registration->size(), 10U);
  EXPECT_TRUE(without->facts.registration->empty());
  EXPECT_NE(with->folder, without->folder) << "it is another solve";
}

TEST_F(Registration, TakesNoGlossForMovement) {
  for (const simulator::Family family : {simulator::Family::kSmooth, simulator::Family::kPlain}) {
    simulator::Scene satin = scene_named("satin_sheen", kClothSize);
    satin.geometry = simulator::family_settings(family);
    satin.geometry.warp_pitch_mm = satin.geometry.weft_pitch_mm = 0.8;
    satin.effects.finite_led = satin.effects.cast_shadows = satin.effects.interreflection = false;
    const solve::Photographs session =
        photographs_of(satin, family == simulator::Family::kSmooth ? "smooth.weft" : "plain.weft");
    const solve::SessionShifts shifts = *solve::register_shots(session, {});
    EXPECT_EQ(shifts.with(solve::ShiftVerdict::kStill).size(), 10U)
        << list_of(solve::facts_of(shifts, {})).dump(1);
    double farthest_px = 0;
    for (const solve::ShotShift& shot : shifts.shots)
      farthest_px = std::max(farthest_px, std::abs(shot.measured.shift.dx_px));
    EXPECT_GT(farthest_px, 0.3) << "gloss feigns no movement here";
  }
}

TEST_F(Registration, FindsAPushByManyPixelsAndNoneInGloss) {
  for (const char* name : {"movement", "dyed_twill"}) {
    simulator::Scene still = scene_named(name, kClothSize);
    still.effects.movement = false;
    simulator::Scene pushed = still;
    pushed.effects.movement = true;
    pushed.camera.movement.sigma_mm = 0.6;
    pushed.camera.movement.sigma_deg = 0;
    solve::Photographs session = photographs_of(still, (name + std::string("_still.weft")).c_str());
    solve::Photographs other = photographs_of(pushed, (name + std::string("_pushed.weft")).c_str());
    EXPECT_TRUE(need_far(session).moved.empty()) << name;
    std::swap(session.mosaics()->frames[4], other.mosaics()->frames[4]);
    const solve::MovedShots far = need_far(session);
    EXPECT_EQ(far.moved, std::vector<std::size_t>{4}) << name << ": explained " << far.explained;
    EXPECT_LE(far.most_px, far.reach_px * std::sqrt(2.0)) << name;
  }
  for (const char* name : {"satin_sheen", "velvet"}) {
    simulator::Scene glossy = scene_named(name, kClothSize);
    glossy.effects.finite_led = glossy.effects.cast_shadows = glossy.effects.interreflection = false;
    const solve::MovedShots far = need_far(photographs_of(glossy, name));
    EXPECT_TRUE(far.moved.empty()) << name << ": " << far.most_px << " px, explained " << far.explained;
  }
}

}  // namespace
}  // namespace weft::test
