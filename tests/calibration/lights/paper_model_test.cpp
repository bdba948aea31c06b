// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/paper_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bench/oracles/paper_oracle.h"

namespace weft::calibration {
namespace {

const Paper kPaper = {{1, 1, 1}, {0.02, -0.03, 0.04, 0.05, -0.01}, 0.1, 100, 70};
const Pose kPose = {rotation_of({0.2, -0.3, 0.4}), {5, -7, 12}};

NearLight led() {
  NearLight light;
  light.position_mm = {180, -90, 320};
  light.aim = normalized({-0.5, 0.2, -0.9});
  light.mu = 1.4;
  return light;
}

LineOfSight sight() {
  return sight_of(overhead_camera({400, 300}, 600, 0.5), 250, 110);
}

double log_value(const NearLight& light, const Paper& paper, const Pose& pose) {
  const auto term = paper_term(sight(), light, paper, pose);
  EXPECT_TRUE(term);
  return term ? term->log_value : 0;
}

// Slope by central differences.
double slope(const std::function<double(double)>& value, double step) {
  return (value(step) - value(-step)) / (2 * step);
}

Vec3 axis(int i) {
  return {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
}

TEST(PaperModel, HasTheDerivativesThatDifferencesGive) {
  const PaperTerm term = *paper_term(sight(), led(), kPaper, kPose);
  for (int i = 0; i < 3; ++i) {
    const auto with_light = [&](auto change) {
      return [=](double h) {
        NearLight light = led();
        change(light, h * axis(i));
        return log_value(light, kPaper, kPose);
      };
    };
    EXPECT_NEAR(dot(term.by_position, axis(i)),
                slope(with_light([](NearLight& l, Vec3 d) { l.position_mm = l.position_mm + d; }), 1e-2),
                1e-9);
    EXPECT_NEAR(dot(term.by_aim, axis(i)),
                slope(with_light([](NearLight& l, Vec3 d) { l.aim = l.aim + d; }), 1e-5), 1e-8);
    const auto with_pose = [&](Vec3 turn, Vec3 shift) {
      return [=](double h) { return log_value(led(), kPaper, moved(kPose, h * turn, h * shift)); };
    };
    EXPECT_NEAR(dot(term.by_turn, axis(i)), slope(with_pose(axis(i), {}), 1e-5), 1e-8) << "axis " << i;
    EXPECT_NEAR(dot(term.by_centre, axis(i)), slope(with_pose({}, axis(i)), 1e-2), 1e-9) << "axis " << i;
  }
  const auto with_mu = [](double h) {
    NearLight l = led();
    l.mu += h;
    return log_value(l, kPaper, kPose);
  };
  EXPECT_NEAR(term.by_mu, slope(with_mu, 1e-4), 1e-9);
  const auto with_delta = [](double h) {
    Paper p = kPaper;
    p.delta += h;
    return log_value(led(), p, kPose);
  };
  EXPECT_NEAR(term.by_delta, slope(with_delta, 1e-4), 1e-8);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto with_albedo = [=](double h) {
      Paper p = kPaper;
      p.log_albedo[i] += h;
      return log_value(led(), p, kPose);
    };
    EXPECT_NEAR(term.by_log_albedo[i], slope(with_albedo, 1e-4), 1e-9);
  }
}

TEST(PaperModel, ReadsWhatTheClosedFormReads) {
  test::PaperRig rig = test::common_rig();
  rig.delta = 0.05;
  rig.vignette = 0;
  test::PaperErrors none;
  none.noise = none.tape_mm = none.turn_deg = none.shift_mm = 0;
  PaperScene scene = test::captures_of(rig, none, 1, 1).start;
  scene.lights = rig.lights;
  scene.paper.delta = rig.delta;
  scene.paper.log_albedo = rig.log_albedo;
  for (std::size_t sheet = 0; sheet < rig.sheets.size(); ++sheet) {
    for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        const auto found = scene.log_reading(sheet, k, c, 1999.25, 310.5);
        const double truth = rig.reading(sheet, k, static_cast<std::size_t>(c), 1999.25, 310.5);
        ASSERT_TRUE(found);
        EXPECT_NEAR(std::exp(*found) / truth, 1, 1e-11) << "sheet " << sheet << ", LED " << k + 1;
      }
    }
  }
}

TEST(PaperModel, HasNothingWhereTheLedShinesFromBehindOrAway) {
  NearLight below = led();
  below.position_mm.z = -300;
  EXPECT_FALSE(paper_term(sight(), below, kPaper, kPose));
  NearLight away = led();
  away.aim = -1.0 * away.aim;
  EXPECT_FALSE(paper_term(sight(), away, kPaper, kPose));
  EXPECT_FALSE(paper_term(sight(), led(), kPaper, {rotation_of({kPi, 0, 0}), {}}));
}

}  // namespace
}  // namespace weft::calibration
