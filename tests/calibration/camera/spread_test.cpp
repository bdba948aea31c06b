// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/spread.h"

#include <gtest/gtest.h>

#include "simulator/camera/optics.h"
#include "tests/calibration/camera/frames.h"

namespace weft::calibration {
namespace {

using simulator::BlurSettings;

// A board of 9 x 6 squares of 50 pixels, turned by 7 degrees.
simulator::Scene board_behind(const BlurSettings& blur) {
  simulator::Scene scene = test::board_scene();
  scene.camera.blur = blur;
  simulator::TargetSettings& board = scene.targets.emplace_back();
  board.pattern = simulator::CheckerboardSettings{.squares_x = 9, .squares_y = 6, .square_mm = 15};
  board.rotation_deg = 7;
  return scene;
}

TEST(EdgeSpread, IsTheSimulatorsBlurToATenthOfAPixel) {
  const Board board = {BoardKind::kCheckerboard, 9, 6, 15, 0, ""};
  for (const BlurSettings& blur : {BlurSettings{.defocus_px = 0.5, .spread_px = 0.4}, {.spread_px = 0.8}}) {
    const simulator::Scene scene = board_behind(blur);
    const std::vector<BoardEdge> seen =
        find_edges(test::photographed(scene), test::camera_of(scene), test::pose_of(scene.targets[0]), board);
    const std::optional<PointSpread> spread = median_spread(seen);
    ASSERT_TRUE(spread) << seen.size() << " edges";
    for (const double sigma_px : spread->sigma_px) EXPECT_NEAR(sigma_px, spread_px(blur), 0.1);
  }
}

TEST(EdgeSpread, SaysNothingOfAFewEdges) {
  BoardEdge edge;
  edge.seen.fill(SeenEdge{.sigma_px = 0.5});
  EXPECT_FALSE(median_spread(std::vector<BoardEdge>(39, edge)));
  EXPECT_TRUE(median_spread(std::vector<BoardEdge>(40, edge)));
}

}  // namespace
}  // namespace weft::calibration
