// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/board_grid.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calibration/camera/picture.h"

#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr double kLeastWindow_px = 2.5;  // around a corner, to either side
constexpr double kMostWindow_px = 16;
constexpr double kNearlyAll = 0.95;
constexpr double kLeastCornerContrast = 10;  // of 255

// How wide the edge between two neighbouring corners is: contrast from the middle of one square to that of
// the other over the steepest slope near the edge.
std::optional<double> edge_width(View<const std::uint8_t> grey, PixelPoint a, PixelPoint b) {
  const double side = distance(a, b);
  const double nx = -(b.y - a.y) / side, ny = (b.x - a.x) / side;
  const PixelPoint middle = {(a.x + b.x) / 2, (a.y + b.y) / 2};
  const double reach = 0.5 * side;
  if (side < 4 || !is_inside(grey, middle.x, middle.y, reach + 1)) return std::nullopt;
  double darkest = 255, brightest = 0, steepest = 0;
  for (double t = -reach; t <= reach; t += 0.5) {
    const auto value = [&](double s) { return sample(grey, middle.x + s * nx, middle.y + s * ny); };
    darkest = std::min(darkest, value(t)), brightest = std::max(brightest, value(t));
    if (std::abs(t) < 0.25 * side) steepest = std::max(steepest, std::abs(value(t + 0.5) - value(t - 0.5)));
  }
  if (steepest <= 0) return std::nullopt;
  return (brightest - darkest) / steepest;
}

// The blurrier of the edges along rows and those along columns: a camera shakes in one direction.
double edge_width(View<const std::uint8_t> grey, Grid& grid) {
  std::vector<double> along_rows, along_columns;
  for (int j = 1; j <= grid.rows(); ++j) {
    for (int i = 1; i <= grid.columns(); ++i) {
      const auto add = [&](int i2, int j2, std::vector<double>& widths) {
        if (!grid.has(i, j) || !grid.has(i2, j2)) return;
        if (const auto width = edge_width(grey, *grid(i, j), *grid(i2, j2))) widths.push_back(*width);
      };
      add(i + 1, j, along_rows);
      add(i, j + 1, along_columns);
    }
  }
  const auto typical = [](std::vector<double> widths) {
    return widths.empty() ? 0 : median(std::move(widths));
  };
  return std::max(typical(std::move(along_rows)), typical(std::move(along_columns)));
}

// A side on which the corners end although the frame would show more: there are no such squares. Only where
// nearly all corners up to there were found: a blurred board misses some anywhere.
std::string missing_side(View<const std::uint8_t> grey, Grid& grid) {
  std::vector<cv::Point2d> places, seen;
  int left = grid.columns(), right = 1, top = grid.rows(), bottom = 1;
  for (int j = 1; j <= grid.rows(); ++j) {
    for (int i = 1; i <= grid.columns(); ++i) {
      if (!grid.has(i, j)) continue;
      places.emplace_back(i, j);
      seen.emplace_back(grid(i, j)->x, grid(i, j)->y);
      left = std::min(left, i), right = std::max(right, i), top = std::min(top, j),
      bottom = std::max(bottom, j);
    }
  }
  if (grid.found() < std::max(8.0, kNearlyAll * (right - left + 1) * (bottom - top + 1))) return "";
  const cv::Mat homography = cv::findHomography(places, seen);
  if (homography.empty()) return "";
  const auto would_be_seen = [&](int i, int j) {
    const PixelPoint p = through(homography, i, j), next = through(homography, i + 1, j);
    return is_inside(grey, p.x, p.y, 0.5 * distance(p, next));
  };
  const auto row_is_seen = [&](int j) { return would_be_seen(left, j) && would_be_seen(right, j); };
  const auto column_is_seen = [&](int i) { return would_be_seen(i, top) && would_be_seen(i, bottom); };
  if (bottom < grid.rows() && row_is_seen(bottom + 1)) return "below";
  if (top > 1 && row_is_seen(top - 1)) return "above";
  if (right < grid.columns() && column_is_seen(right + 1)) return "on the right";
  if (left > 1 && column_is_seen(left - 1)) return "on the left";
  return "";
}

}  // namespace

PixelPoint through(const cv::Mat& homography, double x, double y) {
  const auto* h = homography.ptr<double>();
  const double w = h[6] * x + h[7] * y + h[8];
  return {(h[0] * x + h[1] * y + h[2]) / w, (h[3] * x + h[4] * y + h[5]) / w};
}

double chequer(View<const std::uint8_t> grey, PixelPoint at, PixelPoint along, PixelPoint down,
               double share) {
  const auto quarter = [&](double s, double t) {
    return sample(grey, at.x + share * (s * along.x + t * down.x), at.y + share * (s * along.y + t * down.y));
  };
  const double a = quarter(-1, -1), b = quarter(1, -1), c = quarter(1, 1), d = quarter(-1, 1);
  const double contrast = std::max({a, b, c, d}) - std::min({a, b, c, d});
  return contrast < kLeastCornerContrast ? 0 : std::abs(a + c - b - d) / (2 * contrast);
}

std::optional<PixelPoint> saddle_near(View<const std::uint8_t> grey, PixelPoint rough,
                                      const Surroundings& around) {
  double clear_px = std::numeric_limits<double>::infinity();
  for (const double sign : {-1.0, 1.0}) {
    const double x = around.clear * (around.along.x + sign * around.down.x);
    const double y = around.clear * (around.along.y + sign * around.down.y);
    clear_px = std::min(clear_px, std::max(std::abs(x), std::abs(y)));
  }
  const int half = static_cast<int>(std::min(0.85 * clear_px, kMostWindow_px));
  const double reach =
      around.clear * (std::hypot(around.along.x, around.along.y) + std::hypot(around.down.x, around.down.y));
  const auto is_seen = [&](PixelPoint p) {
    return is_inside(grey, p.x, p.y, std::max(half + 3.0, reach + 1));
  };
  if (0.85 * clear_px < kLeastWindow_px || !is_seen(rough)) return std::nullopt;
  std::vector<cv::Point2f> corner = {{static_cast<float>(rough.x), static_cast<float>(rough.y)}};
  cv::cornerSubPix(mat_of(grey), corner, {half, half}, {-1, -1},
                   {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 1e-3});
  const PixelPoint fine = {static_cast<double>(corner[0].x), static_cast<double>(corner[0].y)};
  if (distance(fine, rough) > clear_px || !is_seen(fine)) return std::nullopt;
  if (chequer(grey, fine, around.along, around.down, 0.6 * around.clear) < kChequer) return std::nullopt;
  return fine;
}

BoardSighting faulty(BoardFault fault, std::string why) {
  return {fault, std::move(why), {}, 0};
}

BoardSighting judged(View<const std::uint8_t> grey, Grid& grid, const BoardLimits& limits) {
  const Board& board = grid.board;
  BoardSighting sighting;
  for (int j = 1; j <= grid.rows(); ++j) {
    for (int i = 1; i <= grid.columns(); ++i) {
      if (!grid.has(i, j)) continue;
      sighting.corners.push_back({(i - board.squares_x / 2.0) * board.square_mm,
                                  (board.squares_y / 2.0 - j) * board.square_mm, *grid(i, j)});
    }
  }
  sighting.edge_px = edge_width(grey, grid);
  const auto fault = [&](BoardFault kind, std::string why) {
    sighting.fault = kind;
    sighting.why = std::move(why);
    return sighting;
  };
  if (sighting.edge_px > limits.most_edge_px) {
    return fault(BoardFault::kBlurred, fmt::format("its edges are {:.1f} pixels wide, and {:.1f} are allowed",
                                                   sighting.edge_px, limits.most_edge_px));
  }
  if (const std::string side = missing_side(grey, grid); !side.empty()) {
    return fault(BoardFault::kWrongSquares,
                 fmt::format("more squares of {} x {} would be in the frame {}, and are not there",
                             board.squares_x, board.squares_y, side));
  }
  if (grid.found() < limits.least_corner_share * board.corners()) {
    return fault(BoardFault::kPartial,
                 fmt::format("{} of its {} corners are in sight", grid.found(), board.corners()));
  }
  return sighting;
}

}  // namespace weft::calibration
