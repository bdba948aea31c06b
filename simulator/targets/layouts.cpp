// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "simulator/targets/pattern.h"
#include "simulator/targets/range.h"

// Each kind of target as rectangles.

namespace weft::simulator {
namespace {

// Markers and boards as OpenCV defines them (cv::aruco), in cells instead of pixels.

/// The cells of a square marker, black border included, by rows from the top.
struct Marker {
  int side = 0;  ///< cells
  std::vector<bool> is_black;
};

/// The square of a ChArUco board that holds a marker: columns from the left, rows from the top.
struct MarkerPlace {
  int id;
  int column;
  int row;
};

using Dictionary = cv::Ptr<cv::aruco::Dictionary>;

constexpr std::array<std::pair<const char*, cv::aruco::PREDEFINED_DICTIONARY_NAME>, 21> kDictionaries = {{
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
}};

Result<Dictionary> dictionary_of(const std::string& name) {
  for (const auto& [known, number] : kDictionaries) {
    if (name == known) return cv::aruco::getPredefinedDictionary(number);
  }
  return Error{ErrorKind::kBadData, "OpenCV has no such dictionary of markers", "dictionary",
               fmt::format("\"{}\" is not one of its names", name),
               "use a name like DICT_5X5_100 or DICT_APRILTAG_36h11"};
}

Error too_few(const std::string& name, const cv::aruco::Dictionary& dictionary, std::string wanted) {
  return {ErrorKind::kBadData, "the dictionary has too few markers", "dictionary",
          fmt::format("{} has ids 0 to {}, and {} is wanted", name, dictionary.bytesList.rows - 1, wanted),
          "use a dictionary with more markers or ask for fewer"};
}

/// kBadData if OpenCV has no such dictionary or the dictionary no such marker.
Result<Marker> marker(const std::string& dictionary, int id) {
  const auto known = dictionary_of(dictionary);
  if (!known) return known.error();
  if (id < 0 || id >= (*known)->bytesList.rows) return too_few(dictionary, **known, fmt::format("{}", id));

  constexpr int kBorderCells = 1;
  Marker marker = {(*known)->markerSize + 2 * kBorderCells, {}};
  cv::Mat cells;
  (*known)->drawMarker(id, marker.side, cells, kBorderCells);  // a pixel a cell
  for (int row = 0; row < marker.side; ++row) {
    for (int column = 0; column < marker.side; ++column)
      marker.is_black.push_back(cells.at<unsigned char>(row, column) == 0);
  }
  return marker;
}

/// Where cv::aruco::CharucoBoard puts its markers. kBadData as above.
Result<std::vector<MarkerPlace>> charuco_markers(const std::string& dictionary, int squares_x,
                                                 int squares_y) {
  const auto known = dictionary_of(dictionary);
  if (!known) return known.error();
  const int markers = squares_x * squares_y / 2;
  if (markers > (*known)->bytesList.rows) return too_few(dictionary, **known, fmt::format("{}", markers - 1));

  const auto board = cv::aruco::CharucoBoard::create(squares_x, squares_y, 1.0F, 0.5F, *known);
  std::vector<MarkerPlace> places;
  for (std::size_t i = 0; i < board->ids.size(); ++i) {
    const cv::Point3f corner = board->objPoints[i][0];
    places.push_back(
        {board->ids[i], static_cast<int>(std::floor(corner.x)), static_cast<int>(std::floor(corner.y))});
  }
  return places;
}

using Rectangles = std::vector<Rectangle>;

constexpr Range kSize_mm = {0.1, 1e4};
constexpr Range kGap_mm = {0, 1e3};

Rectangle whole_sheet(double width_mm, double height_mm) {
  return {-width_mm / 2, -height_mm / 2, width_mm / 2, height_mm / 2, kWhiteInk};
}

/// Cells of equal size in a grid around the centre, with `step_mm` from one to the next.
struct Grid {
  int columns;
  int rows;
  double cell_mm;
  double step_mm;

  double width_mm() const { return (columns - 1) * step_mm + cell_mm; }
  double height_mm() const { return (rows - 1) * step_mm + cell_mm; }
  /// Rows from the top.
  Rectangle cell(int column, int row, int ink) const {
    const double u = column * step_mm - width_mm() / 2;
    const double v = height_mm() / 2 - row * step_mm;
    // An edge that two cells share is the same number in both.
    const double u_end = step_mm > cell_mm ? u + cell_mm : (column + 1) * step_mm - width_mm() / 2;
    const double v_end = step_mm > cell_mm ? v - cell_mm : height_mm() / 2 - (row + 1) * step_mm;
    return {u, v_end, u_end, v, ink};
  }
  Rectangle sheet(double margin_mm) const {
    return whole_sheet(width_mm() + 2 * margin_mm, height_mm() + 2 * margin_mm);
  }
};

/// Adds the black cells of a marker that fills a square around (u, v).
void add_marker(const Marker& marker, double u_mm, double v_mm, double side_mm, Rectangles& rectangles) {
  const auto edge = [&](double centre, int cell) {
    return centre + side_mm * (static_cast<double>(cell) / marker.side - 0.5);
  };
  auto is_black = marker.is_black.begin();
  for (int up = marker.side - 1; up >= 0; --up) {
    for (int column = 0; column < marker.side; ++column) {
      if (!*is_black++) continue;
      rectangles.push_back(
          {edge(u_mm, column), edge(v_mm, up), edge(u_mm, column + 1), edge(v_mm, up + 1), kBlackInk});
    }
  }
}

Rectangles checkerboard(const Grid& squares, double margin_mm) {
  Rectangles rectangles = {squares.sheet(margin_mm)};
  for (int row = 0; row < squares.rows; ++row) {
    for (int column = row % 2; column < squares.columns; column += 2)
      rectangles.push_back(squares.cell(column, row, kBlackInk));
  }
  return rectangles;
}

Rectangles mirrored(Rectangles rectangles) {
  for (Rectangle& r : rectangles) r = {-r.u1_mm, r.v0_mm, -r.u0_mm, r.v1_mm, r.ink};
  return rectangles;
}

Result<Rectangles> lay_out(const PaperSettings& paper) {
  if (auto ok = check({{"width_mm", paper.width_mm, kSize_mm}, {"height_mm", paper.height_mm, kSize_mm}});
      !ok)
    return ok.error();
  return Rectangles{whole_sheet(paper.width_mm, paper.height_mm)};
}

Result<Rectangles> lay_out(const CheckerboardSettings& board) {
  if (auto ok = check({{"squares_x", static_cast<double>(board.squares_x), {1, 100}},
                       {"squares_y", static_cast<double>(board.squares_y), {1, 100}},
                       {"square_mm", board.square_mm, kSize_mm},
                       {"margin_mm", board.margin_mm, kGap_mm}});
      !ok)
    return ok.error();
  return checkerboard({board.squares_x, board.squares_y, board.square_mm, board.square_mm}, board.margin_mm);
}

Result<Rectangles> lay_out(const CharucoSettings& board) {
  if (auto ok = check({{"squares_x", static_cast<double>(board.squares_x), {2, 100}},
                       {"squares_y", static_cast<double>(board.squares_y), {2, 100}},
                       {"square_mm", board.square_mm, kSize_mm},
                       {"marker_share", board.marker_share, {0.1, 0.95}},
                       {"margin_mm", board.margin_mm, kGap_mm}});
      !ok)
    return ok.error();
  const Grid squares = {board.squares_x, board.squares_y, board.square_mm, board.square_mm};
  Rectangles rectangles = checkerboard(squares, board.margin_mm);
  const auto places = charuco_markers(board.dictionary, board.squares_x, board.squares_y);
  if (!places) return places.error();
  for (const MarkerPlace& place : *places) {
    const auto cells = marker(board.dictionary, place.id);
    if (!cells) return cells.error();
    const Rectangle square = squares.cell(place.column, place.row, kWhiteInk);
    add_marker(*cells, (square.u0_mm + square.u1_mm) / 2, (square.v0_mm + square.v1_mm) / 2,
               board.marker_share * board.square_mm, rectangles);
  }
  return board.mirrored ? mirrored(std::move(rectangles)) : rectangles;
}

Result<Rectangles> lay_out(const GreyScaleSettings& scale) {
  const int patches = static_cast<int>(std::min(scale.reflectances.size(), std::size_t{1000}));
  if (auto ok = check({{"number of reflectances", static_cast<double>(patches), {1, 100}},
                       {"patch_mm", scale.patch_mm, kSize_mm},
                       {"gap_mm", scale.gap_mm, kGap_mm},
                       {"margin_mm", scale.margin_mm, kGap_mm}});
      !ok)
    return ok.error();
  const Grid grid = {patches, 1, scale.patch_mm, scale.patch_mm + scale.gap_mm};
  Rectangles rectangles = {grid.sheet(scale.margin_mm)};
  for (int i = 0; i < patches; ++i) rectangles.push_back(grid.cell(i, 0, kFirstPatchInk + i));
  return rectangles;
}

Result<Rectangles> lay_out(const ChartSettings& chart) {
  if (auto ok = check({{"patch_mm", chart.patch_mm, kSize_mm},
                       {"gap_mm", chart.gap_mm, kGap_mm},
                       {"frame_mm", chart.frame_mm, kGap_mm}});
      !ok)
    return ok.error();
  const Grid grid = {6, 4, chart.patch_mm, chart.patch_mm + chart.gap_mm};
  Rectangles rectangles = {grid.sheet(chart.frame_mm)};
  rectangles.front().ink = kBlackInk;
  for (int i = 0; i < grid.columns * grid.rows; ++i) {
    rectangles.push_back(grid.cell(i % grid.columns, i / grid.columns, kFirstPatchInk + i));
  }
  return rectangles;
}

Result<Rectangles> lay_out(const TagSettings& tag) {
  if (auto ok = check({{"side_mm", tag.side_mm, kSize_mm}, {"margin_mm", tag.margin_mm, kGap_mm}}); !ok)
    return ok.error();
  const auto cells = marker(tag.dictionary, tag.id);
  if (!cells) return cells.error();
  const double side_mm = tag.side_mm + 2 * tag.margin_mm;
  Rectangles rectangles = {whole_sheet(side_mm, side_mm)};
  add_marker(*cells, 0, 0, tag.side_mm, rectangles);
  return rectangles;
}

}  // namespace

Result<Pattern> make_pattern(const PatternSettings& settings) {
  const auto rectangles = std::visit([](const auto& pattern) { return lay_out(pattern); }, settings);
  if (!rectangles) return rectangles.error();
  return Pattern(*rectangles);
}

}  // namespace weft::simulator
