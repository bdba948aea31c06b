// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/lateral_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "core/base/vec.h"
#include "tests/calibration/camera/frames.h"

namespace weft::calibration {
namespace {

// The edges of a checkerboard that fills the frame, seen by a lens.
std::optional<LateralFit> fit_behind(const simulator::ChromaticSettings& chromatic, bool is_on) {
  simulator::Scene scene = test::board_scene();
  scene.camera.chromatic = chromatic;
  scene.effects.chromatic_aberration = is_on;
  simulator::TargetSettings& board = scene.targets.emplace_back();
  board.pattern = simulator::CheckerboardSettings{.squares_x = 20, .squares_y = 13, .square_mm = 9};
  board.rotation_deg = 7;
  const std::vector<BoardEdge> edges =
      find_edges(test::photographed(scene), test::camera_of(scene), test::pose_of(scene.targets[0]),
                 {BoardKind::kCheckerboard, 20, 13, 9, 0, ""});
  return fit_lateral_color(edges, test::camera_of(scene));
}

TEST(LateralFit, FindsTheSimulatorsDisplacementToAFewHundredthsOfAPixel) {
  const std::optional<LateralFit> fit = fit_behind({.red_px = 0.5, .blue_px = -0.4}, true);
  ASSERT_TRUE(fit && fit->color);
  std::printf("in the corner: red %.4f +- %.4f, blue %.4f +- %.4f pixels\n", fit->corner_px[0],
              fit->sigma_corner_px[0], fit->corner_px[1], fit->sigma_corner_px[1]);
  EXPECT_NEAR(fit->corner_px[0], -0.5, 0.04);
  EXPECT_NEAR(fit->corner_px[1], 0.4, 0.04);
}

TEST(LateralFit, SaysNothingOfALensWithout) {
  const std::optional<LateralFit> fit = fit_behind({}, false);
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->color) << fit->corner_px[0] << " and " << fit->corner_px[1] << " pixels in the corner";
}

// Edges all over a frame, by the model and a noise of 0.05 pixel.
std::vector<BoardEdge> edges_of(const LateralColor& lateral, const CameraModel& camera, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, 0.05);
  std::vector<BoardEdge> edges;
  for (int i = 0; i < 500; ++i) {
    BoardEdge edge;
    edge.middle = {share(random) * camera.size.width, share(random) * camera.size.height};
    const double turn = share(random) * kPi;
    edge.across = {std::cos(turn), std::sin(turn)};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [dx, dy] = shift_at(lateral.of(c), camera, edge.middle.x, edge.middle.y);
      edge.seen[c] = SeenEdge{noise(random) - dx * edge.across.x - dy * edge.across.y, 0.5};
    }
    edges.push_back(edge);
  }
  for (int i = 0; i < 10; ++i)
    edges[static_cast<std::size_t>(i)].seen[0]->at_px += 0.8;  // no edges of the board
  return edges;
}

TEST(LateralFit, AgreesWithItsSigma) {
  const CameraModel camera = overhead_camera({1200, 800}, 600, 0.3);
  const LateralColor truth = {{.scale = -2e-3, .cubic = 8e-3}, {.scale = 6e-4}};
  double squares = 0;
  constexpr unsigned kSeeds = 50;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const std::optional<LateralFit> fit = fit_lateral_color(edges_of(truth, camera, seed), camera);
    ASSERT_TRUE(fit && fit->color) << seed;
    squares += std::pow((fit->color->red.scale - truth.red.scale) / fit->color->red.sigma_scale, 2) +
               std::pow((fit->color->red.cubic - truth.red.cubic) / fit->color->red.sigma_cubic, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / (2 * kSeeds)), 1, 0.25);
}

TEST(LateralFit, WritesNoTermWithinItsNoise) {
  const CameraModel camera = overhead_camera({1200, 800}, 600, 0.3);
  int cubic = 0, any = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto shifted =
        fit_lateral_color(edges_of({{.scale = 1e-3}, {.scale = 1e-3}}, camera, seed), camera);
    ASSERT_TRUE(shifted && shifted->color);
    cubic += (shifted->color->red.cubic != 0) + (shifted->color->blue.cubic != 0);
    any += fit_lateral_color(edges_of({}, camera, seed), camera)->color.has_value();
  }
  EXPECT_LE(cubic, 2) << "of 100";
  EXPECT_LE(any, 1) << "of 50";
}

}  // namespace
}  // namespace weft::calibration
