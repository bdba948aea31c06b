// SPDX-License-Identifier: Apache-2.0
#include "material/maps/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "material/maps/line_sweep.h"

namespace weft::material {
namespace {

constexpr int kLinesATask = 64;
constexpr int kBlock = 64;  ///< pixels side by side, for vector code
constexpr int kSums = 4;    ///< hidden share, and what is hidden of the bent normal along x, y down and z
constexpr float kLeastOpen = 1e-6f;  ///< below that floats cannot tell what is left

using Block = std::array<float, kBlock>;

/// One direction of a sweep, of the map as it lies or of its transpose.
struct SweepDirection {
  float along_x = 1, along_y = 0;  ///< unit, y down the rows
};

/// Pixels between two lines: where they are, their slopes, and their horizons to both sides.
struct LinePixels {
  std::array<int, kBlock> y = {};
  Block p = {}, q = {};  ///< slopes to the right and down the rows
  Block forward = {}, backward = {};
  std::array<Block, kSums> sums = {};
};

// arctan on [0, 1] to 2e-8 (Abramowitz and Stegun 4.4.49).
inline float arctan(float t) {
  const float u = t * t;
  return t *
         (1 + u * (-0.3333314528f +
                   u * (0.1999355085f +
                        u * (-0.1420889944f +
                             u * (0.1065626393f +
                                  u * (-0.0752896400f +
                                       u * (0.0429096138f + u * (-0.0161657367f + u * 0.0028662257f))))))));
}

// Angle of a point of the upper half plane, (cosine, sine).
inline float upper_angle(float c, float s) {
  const float side = std::abs(c);
  const bool is_steep = s > side;
  const float a = arctan((is_steep ? side : s) / (is_steep ? s : side));
  const float acute = is_steep ? static_cast<float>(kPi / 2) - a : a;
  return c < 0 ? static_cast<float>(kPi) - acute : acute;
}

/// What one side hides: its share, and the hidden part of the bent normal away from the pixel and upwards.
struct Hidden {
  float share, outward, upward;
};

// `horizon` is a slope, `n_a` the normal's part towards this side.
inline Hidden hidden_by(float horizon, float n_a, float n_z) {
  const float to_unit = 1 / std::sqrt(n_a * n_a + n_z * n_z);
  const float scale = to_unit / std::sqrt(1 + horizon * horizon);
  const float s = (horizon * n_z + n_a) * scale, c = (n_z - horizon * n_a) * scale;
  const float angle = upper_angle(c, std::max(s, 1e-30f));
  const float c3 = c * c * c;
  const float along = n_z * (1 - c3) / 3 + n_a * s * s * s / 3;           // the tangent, outward
  const float across = n_z * s * s * s / 3 + n_a * (2 - 3 * c + c3) / 3;  // the normal's part in the plane
  const bool hides = s > 0;
  return {hides ? 0.5f * (n_z * s * s + n_a * (angle - s * c)) : 0,
          hides ? to_unit * (along * n_z + across * n_a) : 0,
          hides ? to_unit * (across * n_z - along * n_a) : 0};
}

void add_hidden(const SweepDirection& direction, LinePixels& pixels) {
  const float dx = direction.along_x, dy = direction.along_y;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const float p = pixels.p[i], q = pixels.q[i];
    const float n_z = 1 / std::sqrt(1 + p * p + q * q), n_a = -n_z * (p * dx + q * dy);
    const Hidden ahead = hidden_by(pixels.forward[i], n_a, n_z);
    const Hidden behind = hidden_by(pixels.backward[i], -n_a, n_z);
    const float outward = ahead.outward - behind.outward;
    pixels.sums[0][i] += ahead.share + behind.share;
    pixels.sums[1][i] += outward * dx;
    pixels.sums[2][i] += outward * dy;
    pixels.sums[3][i] += ahead.upward + behind.upward;
  }
}

/// Heights in pixels with a rule for what lies beyond the border.
struct HeightField {
  View<const float> height;
  bool is_tile = false;

  int neighbour(int i, int count) const {
    if (is_tile) return i < 0 ? i + count : (i >= count ? i - count : i);
    return std::clamp(i, 0, count - 1);
  }
  // Height a pixel from a to b about `here`, of those that are there.
  static float slope(float a, float here, float b, float pixels) {
    if (!std::isfinite(a)) a = here, pixels -= 1;
    if (!std::isfinite(b)) b = here, pixels -= 1;
    return pixels > 0 ? (b - a) / pixels : 0.0f;
  }
  /// To the right and down the rows.
  std::array<float, 2> slopes(int x, int y) const {
    const float here = height(x, y);
    if (!std::isfinite(here)) return {0, 0};
    const int left = neighbour(x - 1, height.width()), right = neighbour(x + 1, height.width());
    const int above = neighbour(y - 1, height.height()), below = neighbour(y + 1, height.height());
    const auto steps = [this](int from, int at, int to) {
      return is_tile ? 2.0f : static_cast<float>((from != at) + (to != at));
    };
    return {slope(height(left, y), here, height(right, y), steps(left, x, right)),
            slope(height(x, above), here, height(x, below), steps(above, y, below))};
  }
};

/// A place between two lines.
struct Between {
  const LineHorizons& upper;
  const LineHorizons& lower;
  std::size_t column;
  float part;  ///< of the way from the upper line to the lower one

  /// How far the place lies under what both lines make of it: in a crease it is lower than they are.
  float depth(float height) const {
    const float depth = upper.height[column] + part * (lower.height[column] - upper.height[column]) - height;
    return std::isfinite(depth) ? depth : 0;
  }
  /// The horizon as the lines have it, seen from there.
  float horizon(Horizons LineHorizons::*side, float depth) const {
    const Horizons &above = upper.*side, &below = lower.*side;
    const float from_above = above.from(column, depth), from_below = below.from(column, depth);
    if (!(above.inverse[column] > 0)) return from_below;
    return below.inverse[column] > 0 ? from_above + part * (from_below - from_above) : from_above;
  }
};

/// Adds what one direction hides, for the pixels between a line and the next.
class BetweenLines {
 public:
  BetweenLines(const HeightField& field, const SweepLines& lines, const SweepDirection& direction,
               std::array<View<float>, kSums> sums)
      : field_(field),
        lines_(lines),
        direction_(direction),
        a_column_(static_cast<float>(1 / std::sqrt(1 + lines.slope * lines.slope))),
        sums_(sums) {}

  void add(int line, const LineHorizons& upper, const LineHorizons& lower) {
    const int width = field_.height.width();
    for (int x0 = 0; x0 < width; x0 += kBlock) {
      const int count = std::min(kBlock, width - x0);
      if (!gather(line, x0, count, upper, lower)) continue;
      add_hidden(direction_, pixels_);
      scatter(x0, count);
    }
  }

 private:
  bool is_inside(std::size_t i) const { return pixels_.y[i] >= 0 && pixels_.y[i] < field_.height.height(); }

  bool gather(int line, int x0, int count, const LineHorizons& upper, const LineHorizons& lower) {
    bool any = false;
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k), x = static_cast<std::size_t>(x0 + k);
      const double y_line = lines_.y_at(line, x0 + k), y = std::ceil(y_line);
      pixels_.y[i] = static_cast<int>(y);
      if (!is_inside(i)) continue;
      any = true;
      const float height = field_.height(x0 + k, pixels_.y[i]);
      const Between between = {upper, lower, x, static_cast<float>(y - y_line)};
      const bool is_there = std::isfinite(height);
      const float depth = between.depth(height);
      pixels_.forward[i] =
          is_there ? a_column_ * between.horizon(&LineHorizons::to_right, depth) : kOpenHorizon;
      pixels_.backward[i] =
          is_there ? a_column_ * between.horizon(&LineHorizons::to_left, depth) : kOpenHorizon;
      const auto slopes = field_.slopes(x0 + k, pixels_.y[i]);
      pixels_.p[i] = slopes[0];
      pixels_.q[i] = slopes[1];
      for (std::size_t s = 0; s < kSums; ++s) pixels_.sums[s][i] = sums_[s](x0 + k, pixels_.y[i]);
    }
    return any;
  }

  void scatter(int x0, int count) {
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (!is_inside(i)) continue;
      for (std::size_t s = 0; s < kSums; ++s) sums_[s](x0 + k, pixels_.y[i]) = pixels_.sums[s][i];
    }
  }

  const HeightField& field_;
  const SweepLines& lines_;
  SweepDirection direction_;
  float a_column_;  ///< columns a pixel of way
  std::array<View<float>, kSums> sums_;
  LinePixels pixels_;
};

void add_direction(const HeightField& field, double slope, const std::array<View<float>, kSums>& sums,
                   int threads) {
  const SweepLines lines = {field.height, slope, field.is_tile};
  const double way = std::sqrt(1 + slope * slope);
  const SweepDirection direction = {static_cast<float>(1 / way), static_cast<float>(slope / way)};
  const int first = lines.first(), last = lines.last();
  parallel_for(static_cast<std::size_t>((last - first + kLinesATask - 1) / kLinesATask), threads,
               [&](std::size_t task, int) {
                 LineSweep sweep(lines);
                 BetweenLines between(field, lines, direction, sums);
                 LineHorizons upper, lower;
                 const int begin = first + static_cast<int>(task) * kLinesATask;
                 const int end = std::min(begin + kLinesATask, last);
                 sweep.walk(begin, lower);
                 for (int line = begin; line < end; ++line) {
                   std::swap(upper, lower);
                   sweep.walk(line + 1, lower);
                   between.add(line, upper, lower);
                 }
               });
}

void transpose(View<const float> map, View<float> out, int threads) {
  constexpr int kSide = 32;
  parallel_for(static_cast<std::size_t>((map.height() + kSide - 1) / kSide), threads,
               [&](std::size_t band, int) {
                 const int y0 = static_cast<int>(band) * kSide, y1 = std::min(y0 + kSide, map.height());
                 for (int x0 = 0; x0 < map.width(); x0 += kSide) {
                   for (int x = x0; x < std::min(x0 + kSide, map.width()); ++x) {
                     for (int y = y0; y < y1; ++y) out(y, x) = map(x, y);
                   }
                 }
               });
}

Image<float> in_pixels(View<const float> height_mm, double mm_per_pixel, int threads) {
  Image<float> out(height_mm.size());
  parallel_for(static_cast<std::size_t>(height_mm.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    std::transform(height_mm.row(y), height_mm.row(y) + height_mm.width(), out.plane().row(y),
                   [&](float h) { return static_cast<float>(static_cast<double>(h) / mm_per_pixel); });
  });
  return out;
}

// Directions that are flat or steep in the map: the steep ones are the flat ones of the transpose.
void add_directions(const HeightField& field, bool is_transposed, const OcclusionOptions& options,
                    const std::array<View<float>, kSums>& sums) {
  for (int d = 0; d < options.directions; ++d) {
    const double turn = kPi * (d + 0.5) / options.directions, c = std::cos(turn), s = -std::sin(turn);
    if ((std::abs(s) > std::abs(c)) != is_transposed) continue;
    add_direction(field, is_transposed ? c / s : s / c, sums, options.threads);
  }
}

// Its sums are given back one by one, so that they and the result never stand side by side.
void add_steep_directions(View<const float> height, const OcclusionOptions& options,
                          const std::array<View<float>, kSums>& sums) {
  const Size size = {height.height(), height.width()};
  std::array<Image<float>, kSums> turned_sums;
  std::array<View<float>, kSums> planes;
  for (std::size_t i = 0; i < kSums; ++i) {
    turned_sums[i] = Image<float>(size);
    planes[i] = turned_sums[i].plane();
  }
  {
    Image<float> turned(size);
    transpose(height, turned.plane(), options.threads);
    add_directions({turned.plane(), options.is_tile}, true, options, planes);
  }
  constexpr std::array<std::size_t, kSums> kTurned = {0, 2, 1, 3};  // x and y change places
  for (std::size_t i = 0; i < kSums; ++i) {
    transpose(planes[i], sums[kTurned[i]], options.threads);
    turned_sums[i] = {};
  }
}

// From what is hidden, as sums in the planes of the result, to openness and bent normals.
void finish(const HeightField& field, int directions, int threads, Occlusion& result) {
  const Size size = field.height.size();
  const float share = 1 / static_cast<float>(directions);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const auto [p, q] = field.slopes(x, y);
      const Vec3 normal = normalized({-static_cast<double>(p), -static_cast<double>(q), 1});
      float& openness = result.openness(x, y);
      openness = std::clamp(1 - share * openness, kLeastOpen, 1.0f);
      float &across = result.bent_normal(x, y, 0), &up = result.bent_normal(x, y, 1),
            &towards = result.bent_normal(x, y, 2);
      const Vec3 hidden = {static_cast<double>(share * across), static_cast<double>(share * up),
                           static_cast<double>(share * towards)};
      const Vec3 seen = 2.0 / 3 * normal - hidden;  // y down the rows
      const double seen_length = length(seen);
      const Vec3 bent = seen_length > 1e-6 ? (1 / seen_length) * seen : Vec3{0, 0, 1};
      across = static_cast<float>(bent.x);
      up = static_cast<float>(-bent.y);
      towards = static_cast<float>(bent.z);
    }
  });
}

Error unusable_occlusion(const char* why, const char* remedy) {
  return {ErrorKind::kUsage, "no occlusion of this height map", "", why, remedy};
}

}  // namespace

Result<Occlusion> occlusion(View<const float> height_mm, const OcclusionOptions& options) {
  const Size size = height_mm.size();
  if (size.width <= 0 || size.height <= 0) return unusable_occlusion("it is empty", "give a height map");
  if (!(options.mm_per_pixel > 0)) {
    return unusable_occlusion("mm_per_pixel is not above 0", "give the millimetres a pixel covers");
  }
  if (options.directions < 1 || options.directions > 64) {
    return unusable_occlusion("directions are not from 1 to 64", "leave them at 8");
  }
  const int threads = options.threads;
  const Image<float> height = in_pixels(height_mm, options.mm_per_pixel, threads);
  const HeightField field = {height.plane(), options.is_tile};
  Occlusion result = {Image<float>(size), Image<float>(size, 3)};
  const std::array<View<float>, kSums> sums = {result.openness.plane(), result.bent_normal.plane(0),
                                               result.bent_normal.plane(1), result.bent_normal.plane(2)};
  add_steep_directions(height.plane(), options, sums);
  add_directions(field, false, options, sums);
  finish(field, options.directions, threads, result);
  return result;
}

}  // namespace weft::material
