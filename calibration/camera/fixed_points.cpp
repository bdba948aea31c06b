// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/fixed_points.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/sha256.h"

namespace weft::calibration {
namespace {

constexpr int kMostCellsASide = 1640;
constexpr double kReach_mm = 8;
constexpr int kMostReach = 60;
constexpr int kSide = kPointCells;
constexpr int kInner = 10;  // the middle of a window, where its texture is
constexpr int kPlay = 2;    // cells that a point may seem to move by between pictures of a still rig
constexpr double kHalf = kSide / 2.0 + kPlay;  // of what is to lie beside the sheet
constexpr int kTiles = 16;                     // a side of the frame, each with one candidate
constexpr double kLike = 0.8;                  // correlation of a point that is found again
constexpr double kStill = 0.9;                 // of one that does not change between pictures
constexpr double kRival = 0.85;      // of the best correlation: what comes near is another one like it
constexpr double kMostSigma = 0.15;  // cells
constexpr double kSubcell = 0.01;    // cells that a parabola is off by
constexpr std::size_t kMostPoints = 24;
constexpr std::size_t kFewestLooks = 2;

/// Cells without their mean, of length 1; nothing where they are all alike.
using Pattern = std::array<float, static_cast<std::size_t>(kSide) * kSide>;

std::optional<Pattern> normalized_pattern(Pattern cells) {
  const double mean = std::accumulate(cells.begin(), cells.end(), 0.0) / static_cast<double>(cells.size());
  double squares = 0;
  for (float& cell : cells) {
    cell -= static_cast<float>(mean);
    squares += static_cast<double>(cell) * static_cast<double>(cell);
  }
  if (!(squares > 0)) return std::nullopt;
  for (float& cell : cells) cell /= static_cast<float>(std::sqrt(squares));
  return cells;
}

Pattern window_at(const Image<float>& cells, int x0, int y0) {
  Pattern window;
  for (int y = 0; y < kSide; ++y)
    std::copy_n(cells.plane().row(y0 + y) + x0, kSide,
                window.begin() + static_cast<std::ptrdiff_t>(y) * kSide);
  return window;
}

int hex_digit(char c) {
  return c <= '9' ? c - '0' : c - 'a' + 10;
}

std::optional<Pattern> pattern_of(const FixedPoint& point) {
  Pattern pattern;
  if (point.grey.size() != 2 * pattern.size()) return std::nullopt;
  for (std::size_t i = 0; i < pattern.size(); ++i)
    pattern[i] = static_cast<float>(16 * hex_digit(point.grey[2 * i]) + hex_digit(point.grey[2 * i + 1]));
  return normalized_pattern(pattern);
}

std::string hex_of(const Pattern& pattern) {
  const auto [least, most] = std::ranges::minmax(pattern);
  std::string text;
  for (const float cell : pattern)
    text += fmt::format("{:02x}", std::lround(255 * (cell - least) / (most - least)));
  return text;
}

/// The correlation of the pattern with each window.
Image<float> correlations(const Pattern& pattern, const Image<float>& cells) {
  Image<float> all({cells.width() - kSide + 1, cells.height() - kSide + 1});
  for (int y0 = 0; y0 < all.height(); ++y0) {
    for (int x0 = 0; x0 < all.width(); ++x0) {
      // About the first cell, for precision.
      const float about = cells(x0, y0);
      float sum = 0, squares = 0, product = 0;
      for (int y = 0; y < kSide; ++y) {
        const float* row = cells.plane().row(y0 + y) + x0;
        const float* like = pattern.data() + static_cast<std::ptrdiff_t>(y) * kSide;
        for (int x = 0; x < kSide; ++x) {
          const float value = row[x] - about;
          sum += value, squares += value * value, product += value * like[x];
        }
      }
      const float length = std::sqrt(std::max(squares - sum * sum / (kSide * kSide), 0.0F));
      all(x0, y0) = length > 0 ? product / length : 0;
    }
  }
  return all;
}

/// The highest correlation, to parts of a cell.
struct Peak {
  double x = 0, y = 0;
  double like = 0;
  double sigma = 0;  ///< cells
};

/// The parabola through the peak at whole cells (x, y), which is not at the border.
std::optional<Peak> peak_about(const Image<float>& all, int x, int y) {
  const auto at = [&](int dx, int dy) { return static_cast<double>(all(x + dx, y + dy)); };
  const double like = at(0, 0);
  const double gx = (at(1, 0) - at(-1, 0)) / 2, gy = (at(0, 1) - at(0, -1)) / 2;
  const double cxx = 2 * like - at(1, 0) - at(-1, 0), cyy = 2 * like - at(0, 1) - at(0, -1);
  const double cxy = -(at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / 4;
  const double determinant = cxx * cyy - cxy * cxy;
  if (!(determinant > 0) || !(cxx > 0) || !(like > 0)) return std::nullopt;
  const double dx = (cyy * gx - cxy * gy) / determinant, dy = (cxx * gy - cxy * gx) / determinant;
  if (std::max(std::abs(dx), std::abs(dy)) > 1) return std::nullopt;
  // What is left of least squares is 1 - like^2, half its second derivative like times the curvature.
  const double variance = std::max(1 - like * like, 0.0) / (kSide * kSide - 4) / like;
  const double trace = cxx + cyy, apart = std::hypot(cxx - cyy, 2 * cxy);
  const double least_curvature = determinant / ((trace + apart) / 2);
  return Peak{x + dx, y + dy, like, std::sqrt(variance / least_curvature)};
}

std::optional<Peak> peak_of(const Image<float>& all) {
  int best_x = 0, best_y = 0;
  for (int y = 0; y < all.height(); ++y) {
    for (int x = 0; x < all.width(); ++x) {
      if (all(x, y) > all(best_x, best_y)) best_x = x, best_y = y;
    }
  }
  const bool is_at_border =
      best_x == 0 || best_y == 0 || best_x == all.width() - 1 || best_y == all.height() - 1;
  return is_at_border ? std::nullopt : peak_about(all, best_x, best_y);
}

/// Whether something half a window away or more looks like it as well.
bool has_rival(const Image<float>& all, const Peak& peak) {
  for (int y = 0; y < all.height(); ++y) {
    for (int x = 0; x < all.width(); ++x) {
      if (std::max(std::abs(x - peak.x), std::abs(y - peak.y)) >= kSide / 2.0 &&
          static_cast<double>(all(x, y)) > kRival * peak.like)
        return true;
    }
  }
  return false;
}

/// Whether an edge of the sheet, which is convex, parts all of it from a square of 2 `half_px` a side.
bool is_beside(std::span<const PixelPoint> sheet, double x_px, double y_px, double half_px) {
  PixelPoint middle;
  const auto n = static_cast<double>(sheet.size());
  for (const PixelPoint& p : sheet) middle.x += p.x / n, middle.y += p.y / n;
  for (std::size_t i = 0; i < sheet.size(); ++i) {
    const PixelPoint &a = sheet[i], &b = sheet[(i + 1) % sheet.size()];
    const double nx = b.y - a.y, ny = a.x - b.x;
    const double side = nx * (middle.x - a.x) + ny * (middle.y - a.y) > 0 ? -1 : 1;
    if (side * (nx * (x_px - a.x) + ny * (y_px - a.y)) > half_px * (std::abs(nx) + std::abs(ny))) return true;
  }
  return sheet.empty();
}

Image<float> cut(const Image<float>& cells, Rect part) {
  Image<float> out({part.width(), part.height()});
  for (int y = 0; y < out.height(); ++y)
    std::copy_n(cells.plane().row(part.y0 + y) + part.x0, out.width(), out.plane().row(y));
  return out;
}

/// How well the middle of each window can be located: the smaller eigenvalue of its structure tensor (Shi and
/// Tomasi 1994) over its light, which photon noise goes by.
class Texture {
 public:
  explicit Texture(const Image<float>& cells) : sums_({cells.width() + 1, cells.height() + 1}, 4) {
    for (int y = 1; y + 1 < cells.height(); ++y) {
      std::array<double, 4> row = {};
      for (int x = 1; x + 1 < cells.width(); ++x) {
        const double gx = static_cast<double>(cells(x + 1, y) - cells(x - 1, y)) / 2,
                     gy = static_cast<double>(cells(x, y + 1) - cells(x, y - 1)) / 2;
        const std::array<double, 4> here = {gx * gx, gy * gy, gx * gy, static_cast<double>(cells(x, y))};
        for (int i = 0; i < 4; ++i) {
          row[static_cast<std::size_t>(i)] += here[static_cast<std::size_t>(i)];
          sums_(x + 1, y + 1, i) = sums_(x + 1, y, i) + row[static_cast<std::size_t>(i)];
        }
      }
    }
  }
  /// For the window at (x0, y0), which is not at the border.
  double at(int x0, int y0) const {
    constexpr int kRim = (kSide - kInner) / 2;
    const int left = x0 + kRim, top = y0 + kRim, right = left + kInner, bottom = top + kInner;
    const auto sum = [&](int i) {
      return sums_(right, bottom, i) - sums_(left, bottom, i) - sums_(right, top, i) + sums_(left, top, i);
    };
    const double xx = sum(0), yy = sum(1), xy = sum(2), light = sum(3);
    return light > 0 ? (xx + yy - std::hypot(xx - yy, 2 * xy)) / 2 / light : 0;
  }

 private:
  Image<double> sums_;
};

}  // namespace

int point_cell_px(Size frame) {
  const int side = std::max(frame.width, frame.height);
  return 2 * ((side + 2 * kMostCellsASide - 1) / (2 * kMostCellsASide));
}

int point_reach_cells(const CameraModel& camera, int cell_px) {
  const double pixels = kReach_mm * camera.fx / std::abs(centre_of(camera).z);
  return std::clamp(static_cast<int>(std::ceil(pixels / cell_px)), kPlay, kMostReach);
}

Rect search_box(const FixedPoint& point, int reach, Size frame) {
  const int cell = point.cell_px;
  const auto first = [&](double middle, int from_middle) {
    return std::max(static_cast<int>(std::lround((middle + 0.5) / cell - kSide / 2.0)) - from_middle, 0) *
           cell;
  };
  const auto last = [&](double middle, int size) {
    return std::min(static_cast<int>(std::lround((middle + 0.5) / cell + kSide / 2.0)) + reach, size / cell) *
           cell;
  };
  const Rect box = {first(point.x_px, reach), first(point.y_px, reach), last(point.x_px, frame.width),
                    last(point.y_px, frame.height)};
  return std::min(box.width(), box.height()) < (kSide + 2) * cell ? Rect() : box;
}

std::optional<PointSighting> find_point(const FixedPoint& point, const Image<float>& cells, Rect box) {
  const std::optional<Pattern> pattern = pattern_of(point);
  if (!pattern) return std::nullopt;
  const Image<float> all = correlations(*pattern, cells);
  const std::optional<Peak> peak = peak_of(all);
  if (!peak || peak->like < kLike || has_rival(all, *peak)) return std::nullopt;
  const double cell = point.cell_px;
  return PointSighting{point.id, box.x0 + cell * (peak->x + kSide / 2.0) - 0.5,
                       box.y0 + cell * (peak->y + kSide / 2.0) - 0.5,
                       cell * std::hypot(peak->sigma, kSubcell)};
}

/// A window that may be a point.
struct FixedPointFinder::Candidate {
  std::string id;                     ///< of a known point
  std::optional<Pattern> pattern;     ///< its
  int x0 = 0, y0 = 0;                 ///< of the window, cells
  Image<float> around = {};           ///< as far as a search goes
  std::vector<Image<float>> looks{};  ///< with kPlay cells on all sides

  std::optional<FixedPoint> point(int cell_px) const;
};

namespace {

/// What the windows of some looks have in common.
std::optional<Pattern> mean_pattern(const std::vector<const Image<float>*>& looks) {
  Pattern sum = {};
  for (const Image<float>* look : looks) {
    const std::optional<Pattern> each = normalized_pattern(window_at(*look, kPlay, kPlay));
    for (std::size_t i = 0; each && i < sum.size(); ++i) sum[i] += (*each)[i];
  }
  return normalized_pattern(sum);
}

/// Adds the farthest from those that are chosen, again and again (Gonzalez 1985), from the best one on.
void choose_spread(std::vector<FixedPoint> from, double least_px, std::vector<FixedPoint>& chosen) {
  std::ranges::stable_sort(from, {}, &FixedPoint::sigma_px);
  std::vector<double> apart_px(from.size(), std::numeric_limits<double>::infinity());
  const auto keep_off = [&](const FixedPoint& point) {
    for (std::size_t i = 0; i < from.size(); ++i)
      apart_px[i] = std::min(apart_px[i], std::hypot(from[i].x_px - point.x_px, from[i].y_px - point.y_px));
  };
  for (const FixedPoint& point : chosen) keep_off(point);
  while (chosen.size() < kMostPoints) {
    const auto next = std::ranges::max_element(apart_px);
    if (next == apart_px.end() || *next < least_px) break;
    chosen.push_back(from[static_cast<std::size_t>(next - apart_px.begin())]);
    keep_off(chosen.back());
  }
}

/// The peaks in those looks that show the pattern where it was.
struct Still {
  std::vector<const Image<float>*> looks;
  std::vector<Peak> peaks;
};

Still still_looks(const Pattern& pattern, const std::vector<const Image<float>*>& looks) {
  Still still;
  for (const Image<float>* look : looks) {
    const std::optional<Peak> peak = peak_of(correlations(pattern, *look));
    if (!peak || peak->like < kStill || std::hypot(peak->x - kPlay, peak->y - kPlay) > 1) continue;
    still.looks.push_back(look);
    still.peaks.push_back(*peak);
  }
  return still;
}

}  // namespace

std::optional<FixedPoint> FixedPointFinder::Candidate::point(int cell_px) const {
  std::vector<const Image<float>*> all;
  for (const Image<float>& look : looks) all.push_back(&look);
  std::optional<Pattern> like = pattern ? pattern : mean_pattern(all);
  if (!like) return std::nullopt;
  Still still = still_looks(*like, all);
  if (!pattern && still.looks.size() >= kFewestLooks) {
    like = mean_pattern(still.looks);
    still = still_looks(*like, still.looks);
  }
  const std::size_t n = still.peaks.size();
  if (n < kFewestLooks || 3 * n < 2 * looks.size()) return std::nullopt;
  double x = 0, y = 0, variance = 0, scatter = 0;
  const auto count = static_cast<double>(n);
  for (const Peak& peak : still.peaks) {
    x += peak.x / count, y += peak.y / count;
    variance += peak.sigma * peak.sigma / count;
  }
  for (const Peak& peak : still.peaks)
    scatter += ((peak.x - x) * (peak.x - x) + (peak.y - y) * (peak.y - y)) / (2 * (count - 1));
  const double sigma = std::sqrt(std::max(variance, scatter));
  if (sigma > kMostSigma) return std::nullopt;
  const Image<float> places = correlations(*like, around);
  const std::optional<Peak> here = peak_of(places);
  if (!here || has_rival(places, *here)) return std::nullopt;
  FixedPoint found;
  found.x_px = cell_px * (x0 + x - kPlay + kSide / 2.0) - 0.5;
  found.y_px = cell_px * (y0 + y - kPlay + kSide / 2.0) - 0.5;
  found.sigma_px = cell_px * std::hypot(sigma / std::sqrt(count), kSubcell);
  found.cell_px = cell_px;
  found.grey = hex_of(*like);
  found.id = id.empty() ? sha256_of(found.grey).substr(0, 8) : id;
  return found;
}

FixedPointFinder::FixedPointFinder(const CameraModel& camera, std::vector<FixedPoint> known)
    : frame_(camera.size),
      cell_px_(point_cell_px(camera.size)),
      reach_(point_reach_cells(camera, cell_px_)),
      known_(std::move(known)) {
  std::erase_if(known_, [&](const FixedPoint& each) { return each.cell_px != cell_px_; });
}

FixedPointFinder::~FixedPointFinder() = default;
FixedPointFinder::FixedPointFinder(FixedPointFinder&&) noexcept = default;

void FixedPointFinder::add(const Image<float>& cells, std::span<const PixelPoint> sheet) {
  look_for_known(cells, sheet);
  look_for_new(cells, sheet);
  for (Candidate& each : candidates_) {
    if (!is_beside(sheet, cell_px_ * (each.x0 + kSide / 2.0), cell_px_ * (each.y0 + kSide / 2.0),
                   cell_px_ * kHalf))
      continue;
    each.looks.push_back(
        cut(cells, {each.x0 - kPlay, each.y0 - kPlay, each.x0 + kSide + kPlay, each.y0 + kSide + kPlay}));
  }
}

void FixedPointFinder::look_for_known(const Image<float>& cells, std::span<const PixelPoint> sheet) {
  std::erase_if(known_, [&](const FixedPoint& point) {
    const Rect box = search_box(point, reach_, frame_);
    if (box == Rect()) return true;
    const Rect part = {box.x0 / cell_px_, box.y0 / cell_px_, box.x1 / cell_px_, box.y1 / cell_px_};
    Image<float> around = cut(cells, part);
    const std::optional<PointSighting> seen = find_point(point, around, box);
    if (!seen || !is_beside(sheet, seen->x_px, seen->y_px, cell_px_ * kHalf)) return false;
    const int x0 = static_cast<int>(std::lround((seen->x_px + 0.5) / cell_px_ - kSide / 2.0)),
              y0 = static_cast<int>(std::lround((seen->y_px + 0.5) / cell_px_ - kSide / 2.0));
    if (std::min(x0, y0) >= kPlay && x0 + kSide + kPlay <= cells.width() &&
        y0 + kSide + kPlay <= cells.height())
      candidates_.push_back({point.id, pattern_of(point), x0, y0, std::move(around)});
    return true;
  });
}

void FixedPointFinder::look_for_new(const Image<float>& cells, std::span<const PixelPoint> sheet) {
  const Texture texture(cells);
  for (int tile = 0; tile < kTiles * kTiles; ++tile) {
    const int column = tile % kTiles, row = tile / kTiles;
    const int left = column * cells.width() / kTiles, right = (column + 1) * cells.width() / kTiles,
              top = row * cells.height() / kTiles, bottom = (row + 1) * cells.height() / kTiles;
    const auto is_here = [&](const Candidate& each) {
      const int x = each.x0 + kSide / 2, y = each.y0 + kSide / 2;
      return x >= left && x < right && y >= top && y < bottom;
    };
    if (std::ranges::any_of(candidates_, is_here)) continue;
    double best = 0;
    int best_x = 0, best_y = 0;
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        const int x0 = x - kSide / 2, y0 = y - kSide / 2;
        if (std::min(x0, y0) < kPlay || x0 + kSide + kPlay > cells.width() ||
            y0 + kSide + kPlay > cells.height())
          continue;
        const double here = texture.at(x0, y0);
        if (!(here > best) || !is_beside(sheet, cell_px_ * x, cell_px_ * y, cell_px_ * kHalf)) continue;
        best = here, best_x = x0, best_y = y0;
      }
    }
    if (!(best > 0)) continue;
    const Rect around = {std::max(best_x - reach_, 0), std::max(best_y - reach_, 0),
                         std::min(best_x + kSide + reach_, cells.width()),
                         std::min(best_y + kSide + reach_, cells.height())};
    candidates_.push_back({{}, std::nullopt, best_x, best_y, cut(cells, around)});
  }
}

std::vector<FixedPoint> FixedPointFinder::found() const {
  std::vector<FixedPoint> known, others;
  for (const Candidate& each : candidates_) {
    if (std::optional<FixedPoint> point = each.point(cell_px_))
      (each.id.empty() ? others : known).push_back(std::move(*point));
  }
  std::vector<FixedPoint> chosen;
  choose_spread(std::move(known), kSide * cell_px_, chosen);
  choose_spread(std::move(others), kSide * cell_px_, chosen);
  return chosen;
}

}  // namespace weft::calibration
