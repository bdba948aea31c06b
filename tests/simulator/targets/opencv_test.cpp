// SPDX-License-Identifier: Apache-2.0
// OpenCV as the judge of the targets: what it finds in pinhole pictures of them, against where they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>
#include <span>
#include <vector>

#include "simulator/spectra/observer.h"
#include "simulator/targets/target.h"
#include "tests/core/places.h"

namespace weft::simulator {
namespace {

const std::filesystem::path kTables = source_folder() / "testdata/spectra";

/// A pinhole 600 mm above the table, upright: x to the right, y up.
struct Pinhole {
  int width = 640;
  int height = 480;
  double focal_px = 1500;
  double height_mm = 600;
  double centre_x() const { return width / 2.0 - 7.3; }
  double centre_y() const { return height / 2.0 + 4.1; }

  ViewRay ray(int x, int y) const {
    return {{0, 0, height_mm},
            {(x - centre_x()) / focal_px, -(y - centre_y()) / focal_px, -1},
            {1 / focal_px, 0, 0},
            {0, -1 / focal_px, 0}};
  }
  cv::Point2f pixel_of(Vec3 p) const {
    const double depth = height_mm - p.z;
    return {static_cast<float>(centre_x() + focal_px * p.x / depth),
            static_cast<float>(centre_y() - focal_px * p.y / depth)};
  }
};

Target target_of(const TargetSettings& settings) {
  auto target = Target::make(settings, 1, 0);
  EXPECT_TRUE(target) << target.error().message();
  return target ? *std::move(target) : *Target::make({}, 1, 0);
}

std::vector<Rgb> albedo_of_inks(const TargetSettings& settings, std::span<const Spectrum> chart = {}) {
  const auto inks = inks_of(settings, chart);
  EXPECT_TRUE(inks) << inks.error().message();
  std::vector<Rgb> albedo;
  for (const Spectrum& ink : *inks) albedo.push_back(rec709_albedo(ink));
  return albedo;
}

/// Blue, green, red in 8 bits, linear, in even light.
cv::Mat picture(const Pinhole& camera, const Target& target, std::span<const Rgb> albedo_of_ink) {
  constexpr double kTable = 0.3;
  cv::Mat image(camera.height, camera.width, CV_8UC3);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Rgb seen = {kTable, kTable, kTable};
      if (const auto hit = target.hit(camera.ray(x, y))) {
        const TargetPoint point = target.at(hit->spot);
        const Rgb albedo = target.average(hit->spot, albedo_of_ink);
        for (std::size_t c = 0; c < 3; ++c)
          seen[c] += point.coverage * (point.brightness * albedo[c] - seen[c]);
      }
      auto& pixel = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[2 - c] = cv::saturate_cast<unsigned char>(255 * seen[static_cast<std::size_t>(c)]);
    }
  }
  return image;
}

cv::Mat grey_picture(const Pinhole& camera, const TargetSettings& settings) {
  cv::Mat grey;
  cv::extractChannel(picture(camera, target_of(settings), albedo_of_inks(settings)), grey, 1);
  cv::GaussianBlur(grey, grey, {}, 0.7);  // as a lens: cornerSubPix is biased by edges as sharp as a pixel
  return grey;
}

TEST(TargetsByOpenCv, GiveTheFocalLengthOfTheCameraBackFromCheckerboards) {
  const Pinhole camera;
  const CheckerboardSettings board;
  const cv::Size corners(board.squares_x - 1, board.squares_y - 1);
  std::vector<cv::Point3f> places;
  for (int j = 0; j < corners.height; ++j) {
    for (int i = 0; i < corners.width; ++i)
      places.emplace_back(static_cast<float>(i * board.square_mm), static_cast<float>(j * board.square_mm),
                          0.0F);
  }
  std::vector<std::vector<cv::Point2f>> found;
  for (int i = 0; i < 10; ++i) {
    TargetSettings settings;
    settings.pattern = board;
    settings.centre_mm = {8.0 * (i % 3 - 1), 6.0 * (i % 4 - 1.5), 5.0 * (i % 5)};
    settings.tilt_deg = i == 0 ? 0 : 22 + 2 * (i % 4);
    settings.azimuth_deg = 40.0 * i;
    settings.rotation_deg = 7.0 * (i % 4) - 9;
    const cv::Mat image = grey_picture(camera, settings);
    std::vector<cv::Point2f> at;
    if (!cv::findChessboardCorners(image, corners, at)) continue;
    cv::cornerSubPix(image, at, {7, 7}, {-1, -1},
                     {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 1e-3});
    found.push_back(at);
  }
  ASSERT_GE(found.size(), 8U) << "pictures of 10 in which the board was found";

  cv::Mat matrix;
  cv::Mat distortion;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  const double rms =
      cv::calibrateCamera(std::vector<std::vector<cv::Point3f>>(found.size(), places), found,
                          {camera.width, camera.height}, matrix, distortion, turns, shifts, cv::CALIB_FIX_K3);
  EXPECT_LT(rms, 0.05) << "pixels";
  EXPECT_NEAR(matrix.at<double>(0, 0) / camera.focal_px, 1, 1e-3);
  EXPECT_NEAR(matrix.at<double>(1, 1) / camera.focal_px, 1, 1e-3);
  EXPECT_NEAR(matrix.at<double>(0, 2), camera.centre_x(), 2);
  EXPECT_NEAR(matrix.at<double>(1, 2), camera.centre_y(), 2);
}

/// Largest distance in pixels of the corners that OpenCV finds of a ChArUco board to where they are, and how
/// many it finds.
struct CharucoFound {
  std::size_t corners = 0;
  double farthest_px = 0;
};

CharucoFound find_charuco(const CharucoSettings& board, double tilt_deg, double rotation_deg) {
  const Pinhole camera;
  TargetSettings settings;
  settings.pattern = board;
  settings.tilt_deg = tilt_deg;
  settings.azimuth_deg = 60;
  settings.rotation_deg = rotation_deg;
  const cv::Mat image = grey_picture(camera, settings);

  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
  const auto theirs =
      cv::aruco::CharucoBoard::create(board.squares_x, board.squares_y, static_cast<float>(board.square_mm),
                                      static_cast<float>(board.square_mm * board.marker_share), dictionary);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> marker_ids;
  cv::aruco::detectMarkers(image, dictionary, markers, marker_ids);
  std::vector<cv::Point2f> at;
  std::vector<int> ids;
  if (!marker_ids.empty()) cv::aruco::interpolateCornersCharuco(markers, marker_ids, image, theirs, at, ids);

  // This function alone counts from the upper left corner of a pixel, not from its centre.
  const cv::Point2f upper_left(0.5F, 0.5F);
  const Target target = target_of(settings);
  CharucoFound found = {at.size(), 0};
  for (std::size_t i = 0; i < at.size(); ++i) {
    const cv::Point3f corner = theirs->chessboardCorners[static_cast<std::size_t>(ids[i])];
    const Vec3 place = target.place_mm(corner.x - board.squares_x * board.square_mm / 2,
                                       board.squares_y * board.square_mm / 2 - corner.y);
    found.farthest_px = std::max(found.farthest_px, cv::norm(at[i] - upper_left - camera.pixel_of(place)));
  }
  return found;
}

TEST(TargetsByOpenCv, AreFoundAsCharucoBoardsWithEveryCornerInPlace) {
  for (const auto& [tilt, rotation] : {std::pair{0.0, 0.0}, {0.0, 30.0}, {25.0, -10.0}}) {
    const CharucoFound found = find_charuco(CharucoSettings{}, tilt, rotation);
    EXPECT_EQ(found.corners, 24U) << "tilt " << tilt;
    EXPECT_LT(found.farthest_px, 0.2) << "tilt " << tilt;
  }
}

TEST(TargetsByOpenCv, AreTheVeryBoardsThatItDraws) {
  for (const cv::Size squares : {cv::Size{5, 4}, cv::Size{4, 5}, cv::Size{5, 5}, cv::Size{2, 2}}) {
    // 5 x 5 bits and a border are 7 cells: a square of 112 pixels has a marker of 84, 12 a cell.
    const auto theirs =
        cv::aruco::CharucoBoard::create(squares.width, squares.height, 1.0F, 0.75F,
                                        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100));
    cv::Mat drawn;
    theirs->draw(squares * 112, drawn, 0, 1);
    const auto pattern =
        make_pattern(CharucoSettings{squares.width, squares.height, 20, 0.75, "DICT_5X5_100", 0});
    ASSERT_TRUE(pattern) << pattern.error().message();
    int wrong = 0;
    for (int y = 0; y < drawn.rows; y += 4) {
      for (int x = 0; x < drawn.cols; x += 4) {
        const int ink =
            pattern->ink_at((x + 1.5 - drawn.cols / 2.0) / 5.6, (drawn.rows / 2.0 - y - 1.5) / 5.6);
        wrong += (ink == kWhiteInk) != (drawn.at<unsigned char>(y + 1, x + 1) == 255);
      }
    }
    EXPECT_EQ(wrong, 0) << squares << ", of " << drawn.total() / 16 << " places";
  }
}

TEST(TargetsByOpenCv, AreFoundAsTagsAtTheEdgeOfTheFrame) {
  const Pinhole camera;
  TargetSettings settings;
  settings.pattern = TagSettings{"DICT_APRILTAG_36h11", 42, 18, 4};
  settings.centre_mm = {100, -70, 0};
  settings.rotation_deg = 15;
  const cv::Mat image = grey_picture(camera, settings);
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(image, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11), corners,
                           ids, parameters);
  ASSERT_EQ(ids, std::vector{42});
  const Target target = target_of(settings);
  const std::vector<std::pair<double, double>> from_upper_left = {{-9, 9}, {9, 9}, {9, -9}, {-9, -9}};
  cv::Point2f mean_px;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [u, v] = from_upper_left[i];
    const cv::Point2f off_px = corners[0][i] - camera.pixel_of(target.place_mm(u, v));
    EXPECT_LT(cv::norm(off_px), 0.35) << "corner " << i;  // the cells beside it pull it inwards
    mean_px += 0.25 * off_px;
  }
  EXPECT_LT(cv::norm(mean_px), 0.1);
}

TEST(TargetsByOpenCv, AreFoundAsAChartWithItsPatchesInOrder) {
  const auto chart = read_spectra(kTables / "chart", 24);
  ASSERT_TRUE(chart) << chart.error().message();
  TargetSettings settings;
  settings.pattern = ChartSettings{};
  settings.rotation_deg = 4;
  settings.tilt_deg = 6;
  const std::vector<Rgb> albedo = albedo_of_inks(settings, *chart);
  const cv::Mat image = picture(Pinhole{}, target_of(settings), albedo);

  const auto detector = cv::mcc::CCheckerDetector::create();
  ASSERT_TRUE(detector->process(image, cv::mcc::MCC24));
  const cv::Mat read =
      detector->getBestColorChecker()->getChartsRGB();  // R, G, B of each patch; column 1: mean
  ASSERT_EQ(read.rows, 72);
  auto mean = read.begin<double>() + 1;
  for (std::size_t patch = 0; patch < 24; ++patch) {
    for (std::size_t c = 0; c < 3; ++c, mean += read.cols) {
      const double expected = std::clamp(255 * albedo[kFirstPatchInk + patch][c], 0.0, 255.0);
      EXPECT_NEAR(*mean, expected, 0.5 + 0.03 * expected) << "patch " << patch + 1 << ", channel " << c;
    }
  }
}

}  // namespace
}  // namespace weft::simulator
