// SPDX-License-Identifier: Apache-2.0
#include "solver/lateral/align.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/solve/solve_record.h"

namespace weft::solver {
namespace {

constexpr std::size_t kGreen = 1;

// A place between pixels, within the frame.
struct Place {
  float x = 0, y = 0;

  Place(Size image, double at_x, double at_y)
      : x(static_cast<float>(std::clamp(at_x, 0.0, image.width - 1.0))),
        y(static_cast<float>(std::clamp(at_y, 0.0, image.height - 1.0))) {}
};

// The site of a phase along an axis that is nearest to a place.
int nearest_site(double place, int phase, int count) {
  const int last = count - 1 - ((count - 1 - phase) & 1);
  return std::clamp(phase + 2 * static_cast<int>(std::lround((place - phase) / 2)), phase, last);
}

// The slope between two neighbours a pixel away, without what only one side shows (monotonized central
// difference, van Leer 1977).
float slope(float before, float at, float after) {
  const float back = at - before, ahead = after - at;
  if (back * ahead <= 0) return 0;
  const float least = std::min({std::abs(0.5F * (back + ahead)), 2 * std::abs(back), 2 * std::abs(ahead)});
  return std::copysign(least, back);
}

int mirrored(int i, int count) {
  if (i < 0) return std::min(-i, count - 1);
  return i < count ? i : std::max(2 * count - 2 - i, 0);
}

Rect rows_around(Rect area, int by, Size image) {
  return {0, std::max(area.y0 - by, 0), image.width, std::min(area.y1 + by, image.height)};
}

// A photosite, and how far from the pixel in question it looks, pixels.
struct Site {
  int x = 0, y = 0;
  float off_x = 0, off_y = 0;
};

// Three planes over rows of the image.
class RowsOfThree {
 public:
  explicit RowsOfThree(Rect rows) : first_(rows.y0), planes_({rows.width(), rows.height()}, 3) {}

  float* row(int plane, int y) { return planes_.plane(plane).row(y - first_); }
  const float* row(int plane, int y) const { return planes_.plane(plane).row(y - first_); }

 private:
  int first_;
  Image<float> planes_;
};

// One area under way.
class Aligner {
 public:
  Aligner(const LateralColor& lateral, const CameraModel& camera, const MosaicRows& from, Rect area,
          const AlignedRows& out, int reach)
      : shifts_{lateral.of(0), lateral.of(1), lateral.of(2)},
        camera_(camera),
        from_(from),
        area_(area),
        out_(out),
        reach_(reach),
        green_rows_(rows_around(area, reach - 2, from.image)),
        green_(green_rows_),
        unsolved_(static_cast<std::size_t>(from.image.width)) {}

  void run() {
    for (int y = green_rows_.y0; y < green_rows_.y1; ++y) interpolate_green(y);
    for (int y = area_.y0; y < area_.y1; ++y) {
      count_unsolved(y);
      int unsolved = 0;  // in the window around x
      for (int x = 0; x < std::min(reach_, from_.image.width); ++x) unsolved += unsolved_of(x);
      for (int x = 0; x < from_.image.width; ++x) {
        unsolved += unsolved_of(x + reach_) - unsolved_of(x - reach_ - 1);
        const bool moves = colour_at(x, y) != kGreen && unsolved == 0 && is_shifted(x, y);
        if (moves) {
          const Site site = site_for(x, y);
          move_albedo(x, y, site);
          move_normal(x, y, site);
        } else {
          keep(x, y);
        }
      }
    }
  }

 private:
  std::size_t colour_at(int x, int y) const { return static_cast<std::size_t>(from_.cfa.channel_at(x, y)); }
  int row_of(int y) const { return y - from_.first_row; }
  int out_row_of(int y) const { return y - out_.first_row; }
  int unsolved_of(int x) const {
    return x < 0 || x >= from_.image.width ? 0 : unsolved_[static_cast<std::size_t>(x)];
  }
  bool is_shifted(int x, int y) const {
    const auto [dx, dy] = shift_at(shifts_[colour_at(x, y)], camera_, x, y);
    return dx != 0 || dy != 0;
  }
  // The photosite of a photosite's colour that looks nearest to it.
  Site site_for(int x, int y) const {
    const auto [dx, dy] = shift_at(shifts_[colour_at(x, y)], camera_, x, y);
    Site site = {.x = nearest_site(x - dx, x & 1, from_.image.width),
                 .y = nearest_site(y - dy, y & 1, from_.image.height)};
    site.off_x = static_cast<float>(std::clamp(site.x + dx - x, -1.0, 1.0));
    site.off_y = static_cast<float>(std::clamp(site.y + dy - y, -1.0, 1.0));
    return site;
  }

  // The normals of green photosites, and between them their mean, bent as the own colour is.
  void interpolate_green(int y) {
    const int width = from_.image.width;
    for (int p = 0; p < 3; ++p) {
      const auto row = [&](int dy) {
        return from_.normal[static_cast<std::size_t>(p)].row(row_of(mirrored(y + dy, from_.image.height)));
      };
      const float *own = row(0), *above = row(-1), *below = row(1), *far_above = row(-2), *far_below = row(2);
      float* to = green_.row(p, y);
      for (int x = 0; x < width; ++x) {
        to[x] = own[x];
        if (colour_at(x, y) == kGreen) continue;
        const float near = above[x] + below[x] + own[mirrored(x - 1, width)] + own[mirrored(x + 1, width)];
        const float far =
            far_above[x] + far_below[x] + own[mirrored(x - 2, width)] + own[mirrored(x + 2, width)];
        to[x] = 0.25F * near + 0.25F * (own[x] - 0.25F * far);
      }
    }
  }

  void count_unsolved(int y) {
    std::fill(unsolved_.begin(), unsolved_.end(), 0);
    const Rect rows = rows_around({0, y, 0, y + 1}, reach_, from_.image);
    for (int j = rows.y0; j < rows.y1; ++j) {
      const std::uint16_t* status = from_.status.row(row_of(j));
      for (std::size_t x = 0; x < unsolved_.size(); ++x)
        unsolved_[x] += (status[x] & kNoSolution) != 0 ? 1 : 0;
    }
  }

  void keep(int x, int y) const {
    const std::size_t colour = colour_at(x, y);
    const int from = row_of(y), to = out_row_of(y);
    for (std::size_t p = 0; p < 3; ++p) out_.normal[p](x, to) = from_.normal[p](x, from);
    out_.rho(x, to) = from_.albedo[colour](x, from);
    out_.sigma_rho(x, to) = from_.sigma_albedo[colour](x, from);
    out_.sigma_normal_deg(x, to) = from_.sigma_normal_deg(x, from);
    out_.residual(x, to) = from_.residual(x, from);
    out_.status(x, to) = from_.status(x, from);
  }

  void move_albedo(int x, int y, const Site& site) const {
    const View<const float>& albedo = from_.albedo[colour_at(x, y)];
    const int row = row_of(site.y), above = row_of(mirrored(site.y - 1, from_.image.height)),
              below = row_of(mirrored(site.y + 1, from_.image.height));
    const int left = mirrored(site.x - 1, from_.image.width), right = mirrored(site.x + 1, from_.image.width);
    const float at = albedo(site.x, row);
    out_.rho(x, out_row_of(y)) = at - site.off_x * slope(albedo(left, row), at, albedo(right, row)) -
                                 site.off_y * slope(albedo(site.x, above), at, albedo(site.x, below));
    out_.sigma_rho(x, out_row_of(y)) = from_.sigma_albedo[colour_at(x, y)](site.x, row);
  }

  // Green at a place, linearly between pixels.
  float green_at(int plane, Place at) const {
    const int x0 = static_cast<int>(at.x), y0 = static_cast<int>(at.y);
    const int x1 = std::min(x0 + 1, from_.image.width - 1), y1 = std::min(y0 + 1, from_.image.height - 1);
    const float u = at.x - static_cast<float>(x0), v = at.y - static_cast<float>(y0);
    const float *above = green_.row(plane, y0), *below = green_.row(plane, y1);
    return (1 - v) * ((1 - u) * above[x0] + u * above[x1]) + v * ((1 - u) * below[x0] + u * below[x1]);
  }

  void move_normal(int x, int y, const Site& site) const {
    const Size image = from_.image;
    const double looks_x = x + static_cast<double>(site.off_x), looks_y = y + static_cast<double>(site.off_y);
    const Place left(image, looks_x - 1, looks_y), right(image, looks_x + 1, looks_y),
        above(image, looks_x, looks_y - 1), below(image, looks_x, looks_y + 1);
    const int row = row_of(site.y), to = out_row_of(y);
    std::array<float, 3> n = {};
    for (std::size_t p = 0; p < 3; ++p) {
      const int plane = static_cast<int>(p);
      const float at = from_.normal[p](site.x, row);
      n[p] = at - site.off_x * slope(green_at(plane, left), at, green_at(plane, right)) -
             site.off_y * slope(green_at(plane, above), at, green_at(plane, below));
    }
    const float per_length = 1 / std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (std::size_t p = 0; p < 3; ++p) out_.normal[p](x, to) = per_length * n[p];
    out_.sigma_normal_deg(x, to) = from_.sigma_normal_deg(site.x, row);
    out_.residual(x, to) = from_.residual(site.x, row);
    out_.status(x, to) = from_.status(site.x, row);
  }

  std::array<RadialShift, 3> shifts_;
  const CameraModel& camera_;
  const MosaicRows& from_;
  Rect area_;
  const AlignedRows& out_;
  int reach_;
  Rect green_rows_;
  RowsOfThree green_;
  std::vector<int> unsolved_;  // by column, over the rows that the row under way looks at
};

int most_shift_px(const LateralColor& lateral, const CameraModel& camera) {
  double most = 0;
  for (RadialShift shift : {lateral.red, lateral.blue}) {
    shift.scale = std::abs(shift.scale), shift.cubic = std::abs(shift.cubic);
    most = std::max(most, std::abs(shift_at_corner(shift, camera)));
  }
  return static_cast<int>(std::ceil(most));
}

}  // namespace

LateralAlignment::LateralAlignment(const LateralColor& lateral, const CameraModel& camera)
    : lateral_(lateral), camera_(camera), most_px_(most_shift_px(lateral, camera)) {}

void LateralAlignment::align(const MosaicRows& from, Rect area, const AlignedRows& out) const {
  Aligner(lateral_, camera_, from, area, out, reach()).run();
}

}  // namespace weft::solver
