// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/guidance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "bench/oracles/board_views.h"

namespace weft::test {
namespace {

using calibration::Board;
using calibration::BoardGuidance;
using calibration::BoardPose;
using calibration::BoardView;
using calibration::guide_board;
using calibration::Pose;

constexpr double kNoise_px = 0.1;

/// A person who does what is asked, a little differently each time.
struct Operator {
  BoardRig rig;
  Board board;
  CameraModel start;
  std::mt19937 random{5};
  std::vector<BoardView> views;

  Operator() {
    board.squares_x = 18, board.squares_y = 12, board.square_mm = 9;
    start = overhead_camera(rig.camera.size, 610, 0.083);
    photograph({Pose().rotation, {0, 0, rig.thickness_mm}});
  }
  calibration::GuidanceOptions asked;
  BoardGuidance asks() const { return guide_board(board, rig.thickness_mm, start, views, 0, asked); }
  /// Corners are 0.1 pixel off.
  void photograph(const Pose& rig_from_board) {
    views.push_back(views_of(rig, {rig_from_board}, kNoise_px, static_cast<int>(random() % 1000)).front());
  }
  void takes(BoardPose pose) {
    std::normal_distribution<double> degrees(0, 2), mm(0, 3);
    pose.tilt_deg = std::max(0.0, pose.tilt_deg + degrees(random));
    pose.azimuth_deg += degrees(random);
    pose.x_mm += mm(random), pose.y_mm += mm(random);
    photograph(board_pose(board, rig.camera, pose).rig_from_board);
  }
};

TEST(GuideBoard, AsksForTheTableFirst) {
  const Operator person;
  const BoardGuidance first = guide_board(person.board, 2, person.start, {}, {});
  EXPECT_FALSE(first.next);
  EXPECT_FALSE(first.is_done);
  EXPECT_GT(first.now.focal_percent, 1) << "a data sheet and one flat board tell a focal length";
}

TEST(GuideBoard, KnowsTheCameraAfterSixPhotographs) {
  Operator person;
  for (int i = 0; i < 5; ++i) {
    const BoardGuidance guidance = person.asks();
    ASSERT_TRUE(guidance.next) << i;
    person.takes(*guidance.next);
  }
  const BoardGuidance guidance = person.asks();
  EXPECT_LE(guidance.now.focal_percent, 0.02);
  EXPECT_LE(guidance.now.place_mm, 0.02);
  EXPECT_NEAR(guidance.camera.fx / person.rig.camera.fx, 1, 0.0008);
}

/// A pose up to 40 degrees from level at any place where the board is whole in the frame.
BoardPose anyhow(Operator& person) {
  std::uniform_real_distribution<double> part(0, 1);
  const Size size = person.rig.camera.size;
  while (true) {
    BoardPose pose;
    pose.tilt_deg = 40 * part(person.random), pose.azimuth_deg = 360 * part(person.random);
    pose.x_mm = 100 * (part(person.random) - 0.5), pose.y_mm = 70 * (part(person.random) - 0.5);
    pose.height_mm = 60 * part(person.random);
    pose = board_pose(person.board, person.rig.camera, pose);
    if (std::all_of(pose.outline_px.begin(), pose.outline_px.end(), [&](const calibration::PixelPoint& p) {
          return p.x > 30 && p.y > 30 && p.x < size.width - 30 && p.y < size.height - 30;
        }))
      return pose;
  }
}

TEST(GuideBoard, TellsAsMuchByFivePhotographsAsFifteenTakenAnyhow) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Operator guided, unguided;
    unguided.random.seed(seed);
    guided.asked.asked_focal_percent = 0.005;
    for (int i = 0; i < 5; ++i) guided.takes(*guided.asks().next);
    for (int i = 0; i < 15; ++i) unguided.photograph(anyhow(unguided).rig_from_board);
    EXPECT_LE(guided.asks().now.focal_percent, unguided.asks().now.focal_percent) << "seed " << seed;
  }
}

TEST(GuideBoard, ForeseesWhatFurtherPhotographsThenTell) {
  Operator person;
  for (int i = 0; i < 3; ++i) person.takes(*person.asks().next);
  const auto ahead = calibration::forecasts_ahead(person.board, person.rig.thickness_mm, person.start,
                                                  person.views, 0, 4, person.asked);
  ASSERT_EQ(ahead.size(), 5u);
  EXPECT_EQ(ahead[0].focal_percent, person.asks().now.focal_percent);
  for (std::size_t i = 1; i < ahead.size(); ++i) {
    EXPECT_LT(ahead[i].focal_percent, ahead[i - 1].focal_percent) << i;
    EXPECT_LT(ahead[i].place_mm, ahead[i - 1].place_mm) << i;
  }
  const BoardGuidance before = person.asks();
  ASSERT_TRUE(before.next);
  EXPECT_EQ(ahead[1].place_mm, before.then.place_mm);
  for (int i = 0; i < 2 && person.asks().next; ++i) person.takes(*person.asks().next);
  const calibration::LensForecast taken = person.asks().now;
  EXPECT_NEAR(std::log2(ahead[2].focal_percent / taken.focal_percent), 0, 0.5)
      << ahead[2].focal_percent << " foreseen, " << taken.focal_percent;
}

TEST(GuideBoard, TellsWhereInTheFrameCornersMiss) {
  Operator person;
  EXPECT_TRUE(person.asks().mean_residual_px.empty()) << "one view fits no camera";
  for (int i = 0; i < 6; ++i) person.photograph(anyhow(person).rig_from_board);
  const auto largest_px = [&](const BoardGuidance& guidance, bool at_the_left) {
    double most = 0;
    for (std::size_t part = 0; part < guidance.corners.size(); ++part) {
      const bool is_left = part % 8 < 2;
      if (is_left == at_the_left && guidance.corners[part] > 10)
        most = std::max(most, guidance.mean_residual_px[part].y);
    }
    return most;
  };
  const BoardGuidance straight = person.asks();
  EXPECT_LT(largest_px(straight, true), 0.1);
  for (BoardView& view : person.views) {
    for (calibration::BoardCorner& corner : view.corners)
      if (corner.px.x < person.rig.camera.size.width / 4.0) corner.px.y += 1;
  }
  const BoardGuidance bent = person.asks();
  EXPECT_GT(largest_px(bent, true), 0.4) << "what was seen lies below what is predicted";
  EXPECT_LT(largest_px(bent, false), 0.4);
}

TEST(GuideBoard, IsNeverDoneByFlatBoards) {
  Operator person;
  for (int i = 0; i < 12; ++i) {
    BoardPose flat;
    flat.x_mm = 10.0 * (i % 4) - 15, flat.y_mm = 10.0 * (i / 4) - 10;
    person.photograph(board_pose(person.board, person.rig.camera, flat).rig_from_board);
  }
  const BoardGuidance guidance = person.asks();
  EXPECT_FALSE(guidance.is_done);
  EXPECT_GT(guidance.now.focal_percent, 1);
  ASSERT_TRUE(guidance.next);
  EXPECT_GE(guidance.next->tilt_deg, 30);
}

TEST(GuideBoard, IsDoneOnceTheWholeFrameWasSeen) {
  Operator person;
  int taken = 1;
  for (BoardGuidance guidance = person.asks(); guidance.next && taken < 30; guidance = person.asks(), ++taken)
    person.takes(*guidance.next);
  const BoardGuidance guidance = person.asks();
  EXPECT_TRUE(guidance.is_done);
  EXPECT_LE(taken, 12);
  EXPECT_GE(guidance.parts_seen, 44) << "of 48";
}

TEST(GuideBoard, TellsHowEachBoardWasTilted) {
  Operator person;
  const BoardPose pose = *person.asks().next;
  ASSERT_GE(pose.tilt_deg, 15);
  person.photograph(pose.rig_from_board);
  const BoardGuidance guidance = person.asks();
  ASSERT_EQ(guidance.tilt_deg.size(), 2U);
  EXPECT_NEAR(guidance.tilt_deg[0], 0, 1e-9) << "it is the table";
  EXPECT_NEAR(guidance.tilt_deg[1], pose.tilt_deg, 2) << "by a focal length that is not known yet";
  EXPECT_LT(guidance.table_tilt_deg, 2) << "the table of before";
}

TEST(GuideBoard, TellsThePhotographOfBefore) {
  Operator person;
  const BoardPose pose = *person.asks().next;
  person.photograph(pose.rig_from_board);
  person.photograph(pose.rig_from_board);
  const std::vector<double> alike = person.asks().alike;
  EXPECT_LT(alike[1], 0.5);
  EXPECT_GT(alike[2], 0.9);
}

}  // namespace
}  // namespace weft::test
