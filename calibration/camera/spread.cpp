// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/spread.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "calibration/camera/picture.h"
#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr double kMostBeside_px = 4;  // from the edge
constexpr double kLeastBeside_px = 2;
constexpr double kBesideMarker_px = 1.5;  // that a marker's own blur takes
constexpr double kMiddle = 0.25;          // of an edge, left out at both of its ends
constexpr double kLeastContrast = 0.1;    // of full scale
constexpr double kNearlyFull = 0.95;
constexpr std::size_t kLeastSamples = 24, kLeastEdges = 40;
constexpr int kSteps = 12;

// A photosite beside an edge.
struct Sample {
  double distance_px;
  double level;  // share of full scale
};

double density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
}
double cumulative(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

// An edge behind a lens and a photosite.
struct Edge {
  double dark = 0, contrast = 0, at_px = 0, sigma_px = 0.5;

  double level(double distance_px) const {
    const auto filled = [&](double x) { return sigma_px * (x * cumulative(x) + density(x)); };
    const auto [from, to] = sides(distance_px);
    return dark + contrast * (filled(to) - filled(from));
  }
  // By the four numbers.
  Eigen::Vector4d slope(double distance_px) const {
    const auto [from, to] = sides(distance_px);
    return {1, (level(distance_px) - dark) / contrast, -contrast * (cumulative(to) - cumulative(from)),
            contrast * (density(to) - density(from))};
  }

 private:
  std::pair<double, double> sides(double distance_px) const {
    return {(distance_px - at_px - 0.5) / sigma_px, (distance_px - at_px + 0.5) / sigma_px};
  }
};

// Gauss-Newton; nothing where it leads away from an edge.
std::optional<Edge> fit_edge(const std::vector<Sample>& samples) {
  if (samples.size() < kLeastSamples) return {};
  const auto [dark, bright] = std::minmax_element(
      samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.level < b.level; });
  const double rise = bright->distance_px > dark->distance_px ? 1 : -1;
  Edge edge = {rise > 0 ? dark->level : bright->level, rise * (bright->level - dark->level)};
  for (int i = 0; i < kSteps; ++i) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Sample& s : samples) {
      const Eigen::Vector4d slope = edge.slope(s.distance_px);
      normal += slope * slope.transpose();
      right += (s.level - edge.level(s.distance_px)) * slope;
    }
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    edge.dark += step[0];
    edge.contrast += step[1];
    edge.at_px += step[2];
    edge.sigma_px = std::clamp(edge.sigma_px + step[3], 0.5 * edge.sigma_px, 2 * edge.sigma_px);
    const bool is_edge = std::abs(edge.contrast) > kLeastContrast && std::abs(edge.at_px) < 1 &&
                         edge.sigma_px > 0.02 && edge.sigma_px < kMostBeside_px;
    if (!is_edge) return {};
  }
  return edge;
}

// The photosites beside the middle of the edge from a to b, by colour; none where one is full.
std::array<std::vector<Sample>, 3> samples_beside(const RawFrame& frame, PixelPoint a, PixelPoint b,
                                                  double reach_px) {
  const double side = std::hypot(b.x - a.x, b.y - a.y);
  const double ux = (b.x - a.x) / side, uy = (b.y - a.y) / side;
  const auto low = [&](double p, double q) {
    return static_cast<int>(std::floor(std::min(p, q) - reach_px));
  };
  const auto high = [&](double p, double q) {
    return static_cast<int>(std::ceil(std::max(p, q) + reach_px));
  };
  const int x0 = low(a.x, b.x), x1 = high(a.x, b.x), y0 = low(a.y, b.y), y1 = high(a.y, b.y);
  std::array<std::vector<Sample>, 3> samples;
  if (x0 < 0 || y0 < 0 || x1 >= frame.counts.width() || y1 >= frame.counts.height()) return samples;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double along = ((x - a.x) * ux + (y - a.y) * uy) / side, across = (y - a.y) * ux - (x - a.x) * uy;
      if (along < kMiddle || along > 1 - kMiddle || std::abs(across) > reach_px) continue;
      const double black =
          static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
      const double level = (frame.counts(x, y) - black) / (static_cast<double>(frame.white) - black);
      if (level > kNearlyFull) return {};
      samples[static_cast<std::size_t>(frame.cfa.channel_at(x, y))].push_back({across, level});
    }
  }
  return samples;
}

}  // namespace

std::vector<BoardEdge> find_edges(const RawFrame& frame, const CameraModel& camera,
                                  const Pose& rig_from_board, const Board& board) {
  const auto corner = [&](int i, int j) {
    const Vec3 p = project(camera, rig_from_board({(i - board.squares_x / 2.0) * board.width_mm(),
                                                   (board.squares_y / 2.0 - j) * board.height_mm(), 0}));
    return PixelPoint{p.x, p.y};
  };
  const bool has_markers = board.kind == BoardKind::kCharuco;
  const double clear_share = has_markers ? (1 - board.marker_share) / 2 : 0.4;
  std::vector<BoardEdge> edges;
  const auto add_edge = [&](PixelPoint a, PixelPoint b) {
    const double side = distance(a, b);
    const double clear_px = clear_share * side - (has_markers ? kBesideMarker_px : 0);
    if (clear_px < kLeastBeside_px) return;
    const auto samples = samples_beside(frame, a, b, std::min(clear_px, kMostBeside_px));
    BoardEdge edge = {{(a.x + b.x) / 2, (a.y + b.y) / 2}, {-(b.y - a.y) / side, (b.x - a.x) / side}, {}};
    for (std::size_t c = 0; c < 3; ++c) {
      if (const std::optional<Edge> fit = fit_edge(samples[c])) edge.seen[c] = {fit->at_px, fit->sigma_px};
    }
    edges.push_back(edge);
  };
  for (int j = 1; j < board.squares_y; ++j) {
    for (int i = 1; i < board.squares_x; ++i) {
      if (i + 1 < board.squares_x) add_edge(corner(i, j), corner(i + 1, j));
      if (j + 1 < board.squares_y) add_edge(corner(i, j), corner(i, j + 1));
    }
  }
  return edges;
}

std::optional<PointSpread> median_spread(std::span<const BoardEdge> edges) {
  PointSpread spread;
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> all;
    for (const BoardEdge& edge : edges) {
      if (edge.seen[c]) all.push_back(edge.seen[c]->sigma_px);
    }
    if (all.size() < kLeastEdges) return {};
    spread.sigma_px[c] = median(std::move(all));
  }
  return spread;
}

}  // namespace weft::calibration
