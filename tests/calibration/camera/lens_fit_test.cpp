// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/lens_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/oracles/board_views.h"
#include "bench/oracles/oracle_rig.h"

namespace weft::test {
namespace {

using calibration::BoardView;
using calibration::fit_lens;
using calibration::LensFit;
using calibration::LensOptions;
using calibration::Pose;
using testing::HasSubstr;

double number_of(const LensFit& fit, const std::string& name) {
  const auto& names = fit.covariance.parameters;
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  return at < names.size() ? std::sqrt(fit.covariance.matrix[at * names.size() + at]) : -1;
}

TEST(FitLens, IsExactWithoutNoise) {
  const BoardRig rig;
  const auto fit = fit_lens(views_of(rig, 0, 1), rig.camera.size, {.thickness_mm = rig.thickness_mm});
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_NEAR(fit->camera.fx / rig.camera.fx, 1, 1e-6);
  EXPECT_NEAR(fit->camera.fy / rig.camera.fy, 1, 1e-6);
  EXPECT_NEAR(fit->camera.cx, rig.camera.cx, 1e-2);
  EXPECT_NEAR(fit->camera.cy, rig.camera.cy, 1e-2);
  EXPECT_NEAR(fit->camera.k1, rig.camera.k1, 1e-5);
  for (const auto& [x, y] : {std::pair{0, 0}, {2463, 0}, {0, 1631}, {1200, 900}}) {
    const Vec3 truth = point_on_plane(rig.camera, x, y, 0);
    EXPECT_LT(length(point_on_plane(fit->camera, x, y, 0) - truth), 1e-4) << x << ", " << y;
  }
}

TEST(FitLens, ErrsAsItsCovarianceSays) {
  // Squared errors over their predicted variances, 8 seeds.
  const BoardRig rig;
  constexpr int kSeeds = 8;
  double focal = 0, principal = 0, height = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto fit = fit_lens(views_of(rig, 0.1, seed), rig.camera.size, {.thickness_mm = rig.thickness_mm});
    ASSERT_TRUE(fit) << fit.error().message();
    EXPECT_NEAR(fit->corner_sigma_px, 0.1, 0.006);
    focal += std::pow((fit->camera.fx - rig.camera.fx) / number_of(*fit, "fx"), 2) / kSeeds;
    principal += std::pow((fit->camera.cx - rig.camera.cx) / number_of(*fit, "cx"), 2) / kSeeds;
    height += std::pow((fit->camera.camera_from_rig_translation_mm.z -
                        rig.camera.camera_from_rig_translation_mm.z) /
                           number_of(*fit, "camera_from_rig_translation_mm.z"),
                       2) /
              kSeeds;
  }
  // Chi-square of 8 degrees of freedom over 8: 0.1 to 3.3 in 998 of 1000 cases.
  for (const double value : {focal, principal, height}) {
    EXPECT_GT(value, 0.1);
    EXPECT_LT(value, 3.3);
  }
}

TEST(FitLens, TakesTangentialTermsOnlyWhereTheLensHasThem) {
  BoardRig rig;
  const auto without = fit_lens(views_of(rig, 0.1, 3), rig.camera.size, {});
  ASSERT_TRUE(without) << without.error().message();
  EXPECT_EQ(without->camera.p1, 0);
  EXPECT_EQ(without->camera.p2, 0);
  rig.camera.p1 = 2e-3;
  rig.camera.p2 = -1e-3;
  const auto with = fit_lens(views_of(rig, 0.1, 3), rig.camera.size, {});
  ASSERT_TRUE(with) << with.error().message();
  EXPECT_NE(with->camera.p1, 0);
  EXPECT_LT(with->rms_px, 0.16);
  const auto chosen =
      std::find_if(with->trials.begin(), with->trials.end(), [](const auto& t) { return t.chosen; });
  ASSERT_NE(chosen, with->trials.end());
  EXPECT_EQ(chosen->terms, "k1 k2 p1 p2");
  EXPECT_LT(chosen->held_out_px, with->trials.front().held_out_px);
}

/// Boards whose print is longer by this share down than across, in the same mean size.
std::vector<BoardView> views_of_stretched(const BoardRig& rig, double share, int seed) {
  std::vector<BoardView> views = views_of(rig, 0.1, seed);
  const double half = std::sqrt(1 + share);
  for (BoardView& view : views) {  // what was told of a place is off, what is seen is not
    for (auto& corner : view.corners) corner.u_mm *= half, corner.v_mm /= half;
  }
  return views;
}

TEST(FitLens, FindsThePrintsStretchAndTheFocalLengthBehindIt) {
  const BoardRig rig;
  for (const double share : {0.005, -0.005, 0.01}) {
    const auto fit = fit_lens(views_of_stretched(rig, share, 4), rig.camera.size, {});
    ASSERT_TRUE(fit) << fit.error().message();
    ASSERT_TRUE(fit->print.is_used) << "found " << fit->print.share << ", sigma " << fit->print.sigma;
    EXPECT_NEAR(fit->print.share, share, 4 * fit->print.sigma);
    EXPECT_LT(fit->print.sigma, 5e-4);
    EXPECT_LT(std::abs(fit->camera.fx - rig.camera.fx), 4 * number_of(*fit, "fx")) << "stretch " << share;
    EXPECT_NEAR(fit->corner_sigma_px, 0.1, 0.006);
    EXPECT_EQ(number_of(*fit, "log_stretch"), -1) << "a camera's covariance has the camera's parameters";
  }
}

TEST(FitLens, LeavesAPrintThatIsNotStretchedAsItWasTold) {
  double squares = 0;
  constexpr int kSeeds = 10;
  BoardRig rig;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    if (seed > kSeeds / 2) rig.camera.p1 = 2e-3, rig.camera.p2 = -1e-3;
    const auto fit = fit_lens(views_of(rig, 0.1, seed), rig.camera.size, {});
    ASSERT_TRUE(fit) << fit.error().message();
    EXPECT_FALSE(fit->print.is_used) << "seed " << seed << ": " << fit->print.share << ", sigma "
                                     << fit->print.sigma;
    squares += std::pow(fit->print.share / fit->print.sigma, 2) / kSeeds;
  }
  // Chi-square of 10 degrees of freedom over 10: 0.15 to 3 in 998 of 1000 cases.
  EXPECT_GT(squares, 0.15);
  EXPECT_LT(squares, 3);
}

TEST(FitLens, TakesABoardOnTheTableThatMissesByAnEighthOfAPixel) {
  const BoardRig rig;
  std::vector<BoardView> views = views_of(rig, 0.02, 1);
  for (auto& corner : views[0].corners) corner.px.x += 3e-5 * corner.u_mm * corner.u_mm;
  const auto fit = fit_lens(views, rig.camera.size, {});
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_TRUE(fit->boards[0].used);
  for (auto& corner : views[0].corners) corner.px.x += 3e-4 * corner.u_mm * corner.u_mm;
  const auto bent = fit_lens(views, rig.camera.size, {});
  ASSERT_FALSE(bent);
  EXPECT_THAT(bent.error().message(), HasSubstr("lay the board flat"));
}

TEST(FitLens, PutsTheTableBelowTheBoardByItsThickness) {
  const BoardRig rig;
  const auto thin = fit_lens(views_of(rig, 0, 1), rig.camera.size, {.thickness_mm = 0});
  const auto thick = fit_lens(views_of(rig, 0, 1), rig.camera.size, {.thickness_mm = 3});
  ASSERT_TRUE(thin && thick);
  EXPECT_NEAR(thick->camera.camera_from_rig_translation_mm.z - thin->camera.camera_from_rig_translation_mm.z,
              3, 1e-3);
  EXPECT_NEAR(thick->boards[0].rig_from_board.translation_mm.z, 3, 1e-9);
}

TEST(FitLens, LeavesOutABentBoardByName) {
  const BoardRig rig;
  std::vector<BoardView> views = views_of(rig, 0.1, 1);
  for (auto& corner : views[6].corners) corner.px.x += 3e-4 * corner.u_mm * corner.u_mm;
  const auto fit = fit_lens(views, rig.camera.size, {});
  ASSERT_TRUE(fit) << fit.error().message();
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(fit->boards[i].used, i != 6) << views[i].name;
  EXPECT_GT(fit->boards[6].rms_px, 0.3);
  EXPECT_NEAR(fit->camera.fx / rig.camera.fx, 1, 1e-3);
}

TEST(FitLens, OfFiveBoardsRefusesThatOneIsBentAndNamesIt) {
  const BoardRig rig;
  std::vector<BoardView> views = views_of(rig, 0.1, 1);
  views.resize(5);
  ASSERT_TRUE(fit_lens(views, rig.camera.size, {}));
  for (auto& corner : views[3].corners) corner.px.x += 3e-4 * corner.u_mm * corner.u_mm;
  const auto fit = fit_lens(views, rig.camera.size, {});
  ASSERT_FALSE(fit) << "board3 used: " << fit->boards[3].used << ", rms " << fit->boards[3].rms_px;
  EXPECT_THAT(fit.error().message(),
              testing::AllOf(HasSubstr("too few"), HasSubstr("4 can be used"), HasSubstr("board3: "),
                             testing::Not(HasSubstr("board2"))));
}

TEST(FitLens, RefusesTooFewBoards) {
  const BoardRig rig;
  std::vector<BoardView> views = views_of(rig, 0.1, 1);
  views.resize(4);
  const auto fit = fit_lens(views, rig.camera.size, {});
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message(), testing::AllOf(HasSubstr("too few"), HasSubstr("4 can be used")));
}

TEST(FitLens, RefusesBoardsTiltedByUnderTwoDegreesAndEndsWithinItsSigmaWhereItIsToldNotTo) {
  for (const double most_tilt_deg : {0.0, 1.0, 2.0}) {
    for (int seed = 1; seed <= 3; ++seed) {
      BoardRig rig;
      rig.tilts_deg = {most_tilt_deg, 0.6 * most_tilt_deg, 0.3 * most_tilt_deg};
      const std::vector<BoardView> views = views_of(rig, 0.1, seed);
      const auto refused = fit_lens(views, rig.camera.size, {});
      ASSERT_FALSE(refused) << "tilts up to " << most_tilt_deg;
      EXPECT_THAT(refused.error().message(), HasSubstr("do not tell focal length from distance"));
      const auto fit = fit_lens(views, rig.camera.size, {.most_focal_sigma = 0.03});
      if (!fit) continue;
      EXPECT_LT(std::abs(fit->camera.fx - rig.camera.fx), 4 * number_of(*fit, "fx"))
          << "tilts up to " << most_tilt_deg;
    }
  }
}

TEST(FitLens, OfOneBoardPoseTakenManyTimesIsRefused) {
  const BoardRig rig;
  std::vector<BoardView> views = views_of(rig, 0.1, 1);
  for (std::size_t i = 1; i < views.size(); ++i) views[i] = views[0];
  const auto fit = fit_lens(views, rig.camera.size, {});
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message(), HasSubstr("do not tell focal length from distance"));
}

TEST(FitLens, OfABoardSeenEdgeOnAmongOthersEndsWithinItsSigma) {
  for (int seed = 1; seed <= 2; ++seed) {
    BoardRig rig;
    rig.tilts_deg = {30, 84, 25};
    const auto fit = fit_lens(views_of(rig, 0.1, seed), rig.camera.size, {});
    ASSERT_TRUE(fit) << fit.error().message();
    EXPECT_LT(std::abs(fit->camera.fx - rig.camera.fx), 4 * number_of(*fit, "fx"));
    EXPECT_LT(std::abs(fit->camera.cx - rig.camera.cx), 4 * number_of(*fit, "cx"));
  }
}

TEST(Propagated, IsTheSigmaOfAParameterAndOfADistance) {
  const BoardRig rig;
  const auto fit = fit_lens(views_of(rig, 0.1, 2), rig.camera.size, {});
  ASSERT_TRUE(fit);
  const auto focal = [](const CameraModel& c) { return c.fx; };
  EXPECT_NEAR(calibration::propagated(fit->camera, fit->covariance, focal), number_of(*fit, "fx"), 1e-6);
  const auto height = [](const CameraModel& c) {
    return inverse(Pose{c.camera_from_rig_rotation, c.camera_from_rig_translation_mm}).translation_mm.z;
  };
  const double sigma = calibration::propagated(fit->camera, fit->covariance, height);
  EXPECT_GT(sigma, 0.5 * number_of(*fit, "camera_from_rig_translation_mm.z"));
  EXPECT_LT(sigma, 2 * number_of(*fit, "camera_from_rig_translation_mm.z"));
}

TEST(CornerCounts, CountEveryCornerOnce) {
  const BoardRig rig;
  const std::vector<BoardView> views = views_of(rig, 0, 1);
  int sum = 0;
  for (const int n : calibration::corner_counts(views, rig.camera.size, 6, 4)) sum += n;
  EXPECT_EQ(sum, static_cast<int>(views.size()) * 17 * 11);
}

}  // namespace
}  // namespace weft::test
