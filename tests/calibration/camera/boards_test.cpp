// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/boards.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calibration/camera/markers.h"
#include "tests/calibration/camera/frames.h"

namespace weft::test {
namespace {

using calibration::Board;
using calibration::BoardCorner;
using calibration::BoardFault;
using calibration::BoardKind;
using calibration::BoardSighting;
using calibration::find_board;
using calibration::PixelPoint;
using testing::HasSubstr;

Board charuco() {
  return {BoardKind::kCharuco, 9, 6, 13, 0.7, "DICT_5X5_100"};
}
Board checkerboard() {
  return {BoardKind::kCheckerboard, 10, 7, 12, 0, ""};
}

simulator::TargetSettings printed(const Board& board) {
  simulator::TargetSettings target;
  if (board.kind == BoardKind::kCharuco) {
    target.pattern = simulator::CharucoSettings{board.squares_x,    board.squares_y,  board.square_mm,
                                                board.marker_share, board.dictionary, 8};
  } else {
    target.pattern = simulator::CheckerboardSettings{board.squares_x, board.squares_y, board.square_mm, 8};
  }
  target.centre_mm = {2, -3, 5};
  target.tilt_deg = 18;
  target.azimuth_deg = 110;
  target.rotation_deg = 6;
  return target;
}

simulator::Scene scene_of(const Board& board) {
  simulator::Scene scene = board_scene();
  scene.targets.push_back(printed(board));
  return scene;
}

Image<std::uint8_t> grey_of(const simulator::Scene& scene) {
  return calibration::grey_picture(photographed(scene));
}

Offsets errors_of(const simulator::Scene& scene, const BoardSighting& sighting) {
  std::vector<PixelPoint> differences;
  for (const BoardCorner& corner : sighting.corners) {
    const PixelPoint truth = seen_at(scene, 0, corner.u_mm, corner.v_mm);
    differences.push_back({corner.px.x - truth.x, corner.px.y - truth.y});
  }
  return offsets_of(differences);
}

TEST(FindBoard, PutsCornersOfBothKindsWithinAFewHundredthsOfAPixel) {
  for (const Board& board : {charuco(), checkerboard()}) {
    for (const double rotation_deg : {6.0, 171.0, -97.0}) {
      simulator::Scene scene = scene_of(board);
      scene.targets[0].rotation_deg = rotation_deg;
      if (rotation_deg < -90) scene.camera.mm_per_pixel = 0.4;  // upright in a frame that is wide
      const BoardSighting sighting = find_board(grey_of(scene).plane(), board);
      ASSERT_EQ(sighting.fault, BoardFault::kNone) << name_of(sighting.fault) << ": " << sighting.why;
      EXPECT_EQ(sighting.corners.size(), static_cast<std::size_t>(board.corners()));
      EXPECT_FALSE(sighting.old_pattern);
      const Offsets offsets = errors_of(scene, sighting);
      EXPECT_NEAR(offsets.mean_x, 0, 0.015);
      EXPECT_NEAR(offsets.mean_y, 0, 0.015);
      EXPECT_LT(offsets.rms, 0.06) << "rotation " << rotation_deg;
      EXPECT_LT(offsets.farthest, 0.25);
      EXPECT_LT(sighting.edge_px, 4.5);
    }
  }
}

/// A board as OpenCV drew it before 4.6, straight from above: white at the upper left where rows are even.
cv::Mat old_charuco(const Board& board, int square_px) {
  cv::Mat picture((board.squares_y + 2) * square_px, (board.squares_x + 2) * square_px, CV_8U,
                  cv::Scalar(255));
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
  const int side = static_cast<int>(std::lround(board.marker_share * square_px)),
            inset = (square_px - side) / 2;
  for (int row = 0, id = 0; row < board.squares_y; ++row) {
    for (int column = 0; column < board.squares_x; ++column) {
      const cv::Rect square((column + 1) * square_px, (row + 1) * square_px, square_px, square_px);
      if ((row + column) % 2 == 1) {
        picture(square).setTo(0);
        continue;
      }
      cv::Mat marker;
      cv::aruco::drawMarker(dictionary, id++, side, marker);
      marker.copyTo(picture(cv::Rect(square.x + inset, square.y + inset, side, side)));
    }
  }
  cv::GaussianBlur(picture, picture, {0, 0}, 0.8);
  return picture;
}

TEST(FindBoard, TakesABoardOfBeforeOpenCv46ByItsIds) {
  for (const auto& [columns, rows] : {std::pair{9, 6}, {11, 8}, {7, 10}, {8, 6}}) {
    Board board = charuco();
    board.squares_x = columns, board.squares_y = rows, board.marker_share = 0.75;
    constexpr int kSquare_px = 60;
    const cv::Mat picture = old_charuco(board, kSquare_px);
    const View<const std::uint8_t> grey(picture.ptr(), {picture.cols, picture.rows}, picture.cols);
    const BoardSighting sighting = find_board(grey, board);
    ASSERT_EQ(sighting.fault, BoardFault::kNone) << columns << " x " << rows << ": " << sighting.why;
    EXPECT_TRUE(sighting.old_pattern);
    ASSERT_EQ(sighting.corners.size(), static_cast<std::size_t>(board.corners()));
    EXPECT_NEAR(sighting.corners[0].px.x, 2 * kSquare_px - 0.5, 0.1) << columns << " x " << rows;
    EXPECT_NEAR(sighting.corners[0].px.y, 2 * kSquare_px - 0.5, 0.1);
  }
}

// A checkerboard as it is sold, tilted a little: `rim` is painted on a picture of a square's side more to
// each side, before the board.
template <typename Rim>
cv::Mat rimmed_checkerboard(const Board& board, const cv::Matx33d& tilt, const Rim& rim) {
  constexpr int kSquare_px = 60;
  const auto squares = [&](cv::Mat& picture, int from_x, int to_x, int from_y, int to_y) {
    for (int row = from_y; row < to_y; ++row) {
      for (int column = from_x; column < to_x; ++column)
        picture(cv::Rect((column + 2) * kSquare_px, (row + 2) * kSquare_px, kSquare_px, kSquare_px))
            .setTo((row + column) % 2 == 0 ? 0 : 255);
    }
  };
  cv::Mat flat((board.squares_y + 4) * kSquare_px, (board.squares_x + 4) * kSquare_px, CV_8U,
               cv::Scalar(255));
  rim(flat, kSquare_px, squares);
  squares(flat, 0, board.squares_x, 0, board.squares_y);
  cv::Mat picture;
  cv::warpPerspective(flat, picture, tilt, flat.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, 128);
  cv::GaussianBlur(picture, picture, {0, 0}, 1.0);
  return picture;
}

TEST(FindBoard, TakesCheckerboardsWithinTheRimsThatSellersPrint) {
  const Board board = checkerboard();
  const int nx = board.squares_x, ny = board.squares_y;
  const auto frame = [](cv::Mat& picture, int from_px, int to_px) {
    picture(cv::Rect(from_px, from_px, picture.cols - 2 * from_px, picture.rows - 2 * from_px)).setTo(0);
    picture(cv::Rect(to_px, to_px, picture.cols - 2 * to_px, picture.rows - 2 * to_px)).setTo(255);
  };
  using Painted =
      std::function<void(cv::Mat&, int, const std::function<void(cv::Mat&, int, int, int, int)>&)>;
  const std::vector<std::pair<std::string, Painted>> rims = {
      {"a line", [&](cv::Mat& p, int side, const auto&) { frame(p, side - 3, side + 3); }},
      {"black about it", [&](cv::Mat& p, int side, const auto&) { frame(p, side, 2 * side); }},
      {"black a quarter away", [&](cv::Mat& p, int side, const auto&) { frame(p, 0, 2 * side - side / 4); }},
      {"half squares",
       [&](cv::Mat& p, int side, const auto& squares) {
         squares(p, -1, nx + 1, -1, ny + 1);
         const cv::Rect inner(3 * side / 2, 3 * side / 2, p.cols - 3 * side, p.rows - 3 * side);
         const cv::Mat kept = p(inner).clone();
         p.setTo(255);
         kept.copyTo(p(inner));
       }},
      {"squares to the edge of the picture",
       [&](cv::Mat& p, int, const auto& squares) { squares(p, -1, nx + 1, -1, ny + 1); }}};
  for (const auto& [name, rim] : rims) {
    for (const cv::Matx33d& tilt :
         {cv::Matx33d::eye(), cv::Matx33d(0.9, 0.05, 10, -0.03, 0.92, 20, 1e-4, 5e-5, 1)}) {
      const cv::Mat picture = rimmed_checkerboard(board, tilt, rim);
      const View<const std::uint8_t> grey(picture.ptr(), {picture.cols, picture.rows}, picture.cols);
      const BoardSighting sighting = find_board(grey, board);
      if (name == "squares to the edge of the picture") {
        EXPECT_EQ(sighting.fault, BoardFault::kWrongSquares) << sighting.why;
        EXPECT_THAT(sighting.why, HasSubstr("11 x 8 corners were found")) << "all of them whole";
        continue;
      }
      ASSERT_EQ(sighting.fault, BoardFault::kNone) << name << ": " << sighting.why;
      ASSERT_EQ(sighting.corners.size(), static_cast<std::size_t>(board.corners())) << name;
      const cv::Vec3d first = tilt * cv::Vec3d(3 * 60 - 0.5, 3 * 60 - 0.5, 1);
      const BoardCorner& corner = sighting.corners.front();
      EXPECT_NEAR(corner.px.x, first[0] / first[2], 0.1) << name;
      EXPECT_NEAR(corner.px.y, first[1] / first[2], 0.1) << name;
    }
  }
}

TEST(FindBoard, NeedsNoneOfTheHalfPixelThatOpenCvsCharucoCornersAreOff) {
  const Board board = charuco();
  const simulator::Scene scene = scene_of(board);
  const Image<std::uint8_t> grey = grey_of(scene);
  const cv::Mat picture(grey.height(), grey.width(), CV_8UC1, const_cast<std::uint8_t*>(grey.plane().row(0)),
                        static_cast<std::size_t>(grey.plane().stride()));
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
  const auto theirs = cv::aruco::CharucoBoard::create(board.squares_x, board.squares_y, 13, 9.1F, dictionary);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids, corner_ids;
  cv::aruco::detectMarkers(picture, dictionary, markers, ids);
  std::vector<cv::Point2f> corners;
  ASSERT_GT(cv::aruco::interpolateCornersCharuco(markers, ids, picture, theirs, corners, corner_ids), 20);
  std::vector<PixelPoint> differences;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const int column = corner_ids[k] % (board.squares_x - 1) + 1,
              row = corner_ids[k] / (board.squares_x - 1) + 1;
    const PixelPoint truth = seen_at(scene, 0, (column - board.squares_x / 2.0) * board.square_mm,
                                     (board.squares_y / 2.0 - row) * board.square_mm);
    differences.push_back(
        {static_cast<double>(corners[k].x) - truth.x, static_cast<double>(corners[k].y) - truth.y});
  }
  const Offsets offsets = offsets_of(differences);
  EXPECT_NEAR(offsets.mean_x, 0.5, 0.05);
  EXPECT_NEAR(offsets.mean_y, 0.5, 0.05);
}

TEST(FindBoard, NamesABlurredPhotograph) {
  for (const Board& board : {charuco(), checkerboard()}) {
    simulator::Scene scene = scene_of(board);
    scene.camera.blur = {.defocus_px = 9, .spread_px = 1};
    const BoardSighting sighting = find_board(grey_of(scene).plane(), board);
    EXPECT_EQ(sighting.fault, BoardFault::kBlurred) << name_of(sighting.fault) << ": " << sighting.why;
    EXPECT_GT(sighting.edge_px, 5);
  }
}

TEST(FindBoard, NamesABoardThatLeavesTheFrame) {
  for (const Board& board : {charuco(), checkerboard()}) {
    simulator::Scene scene = scene_of(board);
    scene.targets[0].centre_mm.x = 62;
    const BoardSighting sighting = find_board(grey_of(scene).plane(), board);
    EXPECT_EQ(sighting.fault, BoardFault::kPartial) << name_of(sighting.fault) << ": " << sighting.why;
  }
}

TEST(FindBoard, NamesAMirroredBoard) {
  const Image<std::uint8_t> grey = grey_of(scene_of(charuco()));
  Image<std::uint8_t> mirrored(grey.size());
  for (int y = 0; y < grey.height(); ++y)
    std::reverse_copy(grey.plane().row(y), grey.plane().row(y) + grey.width(), mirrored.plane().row(y));
  const BoardSighting sighting = find_board(mirrored.plane(), charuco());
  EXPECT_EQ(sighting.fault, BoardFault::kMirrored) << name_of(sighting.fault) << ": " << sighting.why;
}

TEST(FindBoard, NamesABoardOfAnotherNumberOfSquares) {
  for (const Board& board : {charuco(), checkerboard()}) {
    const Image<std::uint8_t> grey = grey_of(scene_of(board));
    for (const auto& [more_x, more_y] : {std::pair{1, 0}, {0, 2}, {0, -1}}) {
      Board other = board;
      other.squares_x += more_x;
      other.squares_y += more_y;
      const BoardSighting sighting = find_board(grey.plane(), other);
      EXPECT_EQ(sighting.fault, BoardFault::kWrongSquares)
          << name_of(sighting.fault) << ": " << sighting.why << " (" << more_x << ", " << more_y << ")";
    }
  }
}

TEST(FindBoard, FindsNoneOnAnEmptyTableNorInNoPicture) {
  const Image<std::uint8_t> grey = grey_of(board_scene());
  const Image<std::uint8_t> black({64, 48});
  for (const Board& board : {charuco(), checkerboard()}) {
    EXPECT_EQ(find_board(grey.plane(), board).fault, BoardFault::kNotFound);
    EXPECT_EQ(find_board(black.plane(), board).fault, BoardFault::kNotFound);
    EXPECT_EQ(find_board(Image<std::uint8_t>({3, 1}).plane(), board).fault, BoardFault::kNotFound);
  }
}

TEST(FindBoard, NeverTakesABoardSeenEdgeOnForAGoodOne) {
  // At 80 degrees squares are a few pixels high: it is refused, or its corners are where they are.
  for (const Board& board : {charuco(), checkerboard()}) {
    for (const double tilt_deg : {65.0, 79.0}) {
      simulator::Scene scene = scene_of(board);
      scene.targets[0].tilt_deg = tilt_deg;
      scene.targets[0].centre_mm.z = 70;
      const BoardSighting sighting = find_board(grey_of(scene).plane(), board);
      if (sighting.fault != BoardFault::kNone) continue;
      EXPECT_LT(errors_of(scene, sighting).farthest, 0.7) << "tilt " << tilt_deg;
    }
  }
}

TEST(CheckBoard, NamesWhatIsOutOfRange) {
  Board board = charuco();
  board.squares_x = 2;
  EXPECT_THAT(check_board(board).error().message(), HasSubstr("squares_x"));
  board = charuco();
  board.square_mm = 0;
  EXPECT_THAT(check_board(board).error().message(), HasSubstr("square_mm"));
  board = charuco();
  board.squares_x = board.squares_y = 30;
  EXPECT_THAT(check_board(board).error().message(), HasSubstr("needs 450"));
  board = charuco();
  board.dictionary = "DICT";
  EXPECT_THAT(check_board(board).error().message(), HasSubstr("DICT"));
  board = checkerboard();
  board.squares_y = board.squares_x;
  EXPECT_THAT(check_board(board).error().message(), HasSubstr("as many rows as columns"));
}

}  // namespace
}  // namespace weft::test
