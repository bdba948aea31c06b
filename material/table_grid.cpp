// SPDX-License-Identifier: Apache-2.0
#include "material/table_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/solve/solve_record.h"
#include "material/cubic.h"

namespace weft::material {
namespace {

using Planes = std::array<double, kMostPlanes>;

constexpr int kMostSide = 32768;
constexpr int kMostStretch = 64;
constexpr double kRounding_px = 1e-6;

bool in_frame(const CameraModel& camera, Vec3 point_mm) {
  const Vec3 p = project(camera, point_mm);
  return p.z > 0 && p.x >= -kRounding_px && p.y >= -kRounding_px &&
         p.x <= camera.size.width - 1 + kRounding_px && p.y <= camera.size.height - 1 + kRounding_px;
}

// Whether the grid's border lies in the frame, looked at 64 times a side.
bool lies_in_frame(const CameraModel& camera, const TableGrid& grid) {
  constexpr int kPlaces = 64;
  const double right = grid.size.width - 1, bottom = grid.size.height - 1;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = right * i / kPlaces, y = bottom * i / kPlaces;
    for (const auto& [px, py] : {std::array{x, 0.0}, {x, bottom}, {0.0, y}, {right, y}}) {
      if (!in_frame(camera, grid.point_mm(px, py))) return false;
    }
  }
  return true;
}

// The widest grid around the centre of `grid` that lies in the frame, in mm between its outermost pixels.
double widest_mm(const CameraModel& camera, TableGrid grid, double proportion) {
  grid.size = {1025, static_cast<int>(std::lround(1024 * proportion)) + 1};
  double fits_mm = 0, exceeds_mm = 1;
  const auto fits = [&](double width_mm) {
    grid.mm_per_pixel = width_mm / (grid.size.width - 1);
    return lies_in_frame(camera, grid);
  };
  while (exceeds_mm < 1e6 && fits(exceeds_mm)) exceeds_mm *= 2;
  for (int i = 0; i < 50; ++i) {
    const double middle_mm = (fits_mm + exceeds_mm) / 2;
    (fits(middle_mm) ? fits_mm : exceeds_mm) = middle_mm;
  }
  return fits_mm;
}

// Photographed pixels that one output pixel is made of, along one axis.
struct Taps {
  int first = 0, count = 0;
  std::array<double, 4 * kMostStretch + 2> weight;

  Taps(double at, double stretch, int size) {
    const int from = static_cast<int>(std::ceil(at - 2 * stretch)),
              to = static_cast<int>(std::floor(at + 2 * stretch));
    first = std::max(from, 0);
    count = std::max(0, std::min(to, size - 1) - first + 1);
    for (int i = 0; i < count; ++i)
      weight[static_cast<std::size_t>(i)] = cubic_weight((first + i - at) / stretch);
  }
};

// Photographed pixels from one output pixel to the next, where that is over 1.
struct Stretch {
  double x = 1, y = 1;
};

Stretch stretch_at(const CameraModel& camera, const TableGrid& grid, double x, double y) {
  const Vec3 here = project(camera, grid.point_mm(x, y));
  const Vec3 right = project(camera, grid.point_mm(x + 1, y)),
             down = project(camera, grid.point_mm(x, y + 1));
  const auto span = [](double a, double b) {
    return std::clamp(std::hypot(a, b), 1.0, double{kMostStretch});
  };
  return {span(right.x - here.x, down.x - here.x), span(right.y - here.y, down.y - here.y)};
}

// Weighted sums over the pixels around a place of the frame.
struct Mean {
  double all = 0, valid = 0,
         balance = 0;  // of all weights' sizes, of those of valid pixels, of the latter signed
  double weight = 0;   // what the sums are divided by
  Planes sum = {};

  // Where most of what is positive is missing, the rest would be divided by next to nothing.
  bool is_solved() const { return valid > 0.5 * all && balance > 0.25 * all; }
};

Mean mean_at(Vec3 at, Stretch stretch, MapKind kind, std::span<const View<const float>> map,
             View<const std::uint16_t> status) {
  const Taps across(at.x, stretch.x, status.width()), down(at.y, stretch.y, status.height());
  Mean mean;
  for (int j = 0; j < down.count; ++j) {
    const int y = down.first + j;
    for (int i = 0; i < across.count; ++i) {
      const int x = across.first + i;
      double w = across.weight[static_cast<std::size_t>(i)] * down.weight[static_cast<std::size_t>(j)];
      mean.all += std::abs(w);
      bool valid = (status(x, y) & kNoSolution) == 0;
      for (const auto& plane : map) valid = valid && std::isfinite(plane(x, y));
      if (!valid) continue;
      mean.valid += std::abs(w);
      mean.balance += w;
      if (kind == MapKind::kSigma) w *= w;
      mean.weight += w;
      for (std::size_t p = 0; p < map.size(); ++p) {
        const double value = static_cast<double>(map[p](x, y));
        mean.sum[p] += w * (kind == MapKind::kSigma ? value * value : value);
      }
    }
  }
  return mean;
}

struct PixelAt {
  int x, y;
};
PixelAt nearest(Vec3 at, Size size) {
  return {static_cast<int>(std::lround(std::clamp(at.x, 0.0, size.width - 1.0))),
          static_cast<int>(std::lround(std::clamp(at.y, 0.0, size.height - 1.0)))};
}

}  // namespace

Vec3 TableGrid::point_mm(double x, double y) const {
  const double u = (x - (size.width - 1) / 2.0) * mm_per_pixel,
               v = ((size.height - 1) / 2.0 - y) * mm_per_pixel;
  const double c = std::cos(radians(turn_deg)), s = std::sin(radians(turn_deg));
  return {centre_x_mm + c * u - s * v, centre_y_mm + s * u + c * v, height_mm};
}

Result<TableGrid> table_grid(const CameraModel& camera, const TableGridOptions& options) {
  const auto refused = [](ErrorKind kind, std::string why, std::string remedy) {
    return Error{kind, "maps cannot be put on a grid of the table", "grid", std::move(why),
                 std::move(remedy)};
  };
  const double x = (camera.size.width - 1) / 2.0, y = (camera.size.height - 1) / 2.0;
  const Vec3 centre = point_on_plane(camera, x, y, options.height_mm);
  if (const Vec3 back = project(camera, centre); !(back.z > 0 && std::hypot(back.x - x, back.y - y) < 0.1)) {
    return refused(ErrorKind::kBadData, "the camera does not see the table from above",
                   "calibrate the camera again");
  }
  TableGrid grid = {{2, 2}, options.mm_per_pixel, options.height_mm, options.turn_deg, centre.x, centre.y};
  if (grid.mm_per_pixel == 0) {
    const Vec3 right = point_on_plane(camera, x + 1, y, options.height_mm);
    const Vec3 below = point_on_plane(camera, x, y + 1, options.height_mm);
    grid.mm_per_pixel = std::sqrt(length(cross(right - centre, below - centre)));
  }
  const double step_mm = grid.mm_per_pixel;
  if (!(step_mm > 0 && std::isfinite(step_mm)))
    return refused(ErrorKind::kUsage, "mm_per_pixel is not above 0", "ask for a size above 0");
  const double proportion = (camera.size.height - 1.0) / std::max(camera.size.width - 1.0, 1.0);
  const double fits_mm = widest_mm(camera, grid, proportion);
  const double width = std::floor(fits_mm / step_mm) + 1,
               height = std::floor(fits_mm * proportion / step_mm) + 1;
  if (!(width <= kMostSide && height <= kMostSide && fits_mm > 0)) {
    return refused(
        ErrorKind::kUsage,
        fmt::format("{:.4g} mm a pixel make a picture of {:.0f} x {:.0f} pixels", step_mm, width, height),
        fmt::format("ask for a size that gives 1 to {} pixels a side", kMostSide));
  }
  grid.size = {static_cast<int>(width), static_cast<int>(height)};
  return grid;
}

void rectify_rows(const CameraModel& camera, const TableGrid& grid, MapKind kind,
                  std::span<const View<const float>> map, View<const std::uint16_t> status, int y0,
                  int threads, std::span<const View<float>> out, float no_sigma) {
  const double c = std::cos(radians(grid.turn_deg)), s = std::sin(radians(grid.turn_deg));
  parallel_for(static_cast<std::size_t>(out[0].height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < out[0].width(); ++x) {
      const Vec3 at = project(camera, grid.point_mm(x, y0 + y));
      if (kind == MapKind::kChoice) {
        const auto [i, j] = nearest(at, status.size());
        for (std::size_t p = 0; p < map.size(); ++p) out[p](x, y) = map[p](i, j);
        continue;
      }
      const Mean mean = mean_at(at, stretch_at(camera, grid, x, y0 + y), kind, map, status);
      Planes value = {};
      for (std::size_t p = 0; p < map.size(); ++p) {
        if (mean.is_solved()) value[p] = mean.sum[p] / mean.weight;
        if (kind == MapKind::kSigma)
          value[p] = mean.is_solved() ? std::sqrt(value[p]) : static_cast<double>(no_sigma);
      }
      if (kind == MapKind::kNormal) {
        const double n = std::hypot(value[0], value[1], value[2]);
        value = n > 1e-6 ? Planes{(c * value[0] + s * value[1]) / n, (c * value[1] - s * value[0]) / n,
                                  value[2] / n}
                         : Planes{0, 0, 1};
      }
      for (std::size_t p = 0; p < map.size(); ++p) out[p](x, y) = static_cast<float>(value[p]);
    }
  });
}

void rectify_status_rows(const CameraModel& camera, const TableGrid& grid, View<const std::uint16_t> status,
                         int y0, int threads, View<std::uint16_t> out) {
  parallel_for(static_cast<std::size_t>(out.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < out.width(); ++x) {
      const Vec3 at = project(camera, grid.point_mm(x, y0 + y));
      const auto [i, j] = nearest(at, status.size());
      const bool solved =
          mean_at(at, stretch_at(camera, grid, x, y0 + y), MapKind::kValue, {}, status).is_solved();
      const int bits = solved ? status(i, j) & ~kNoSolution : status(i, j) | kNoSolution;
      out(x, y) = static_cast<std::uint16_t>(bits);
    }
  });
}

CameraModel reduced_camera(CameraModel camera, int factor) {
  camera.size = {camera.size.width / factor, camera.size.height / factor};
  camera.fx /= factor;
  camera.fy /= factor;
  camera.cx = (camera.cx + 0.5) / factor - 0.5;
  camera.cy = (camera.cy + 0.5) / factor - 0.5;
  return camera;
}

}  // namespace weft::material
