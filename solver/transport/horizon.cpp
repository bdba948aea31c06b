// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/horizon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/transport/pixel_hash.h"
#include "solver/transport/planes.h"

namespace weft::solver {
namespace {

constexpr int kMostSlices = 64, kMostSteps = 256, kMostRadius_px = 8192;

Result<void> check(const Relief& relief, Rect tile, const Normals& normals, const HorizonSettings& s,
                   const View<float>& openness) {
  if (s.slices < 1 || s.slices > kMostSlices || s.steps < 1 || s.steps > kMostSteps || s.radius_px < 1 ||
      s.radius_px > kMostRadius_px) {
    return bad_transport("horizon",
                         fmt::format("{} slices of {} steps to {} pixels", s.slices, s.steps, s.radius_px),
                         fmt::format("ask for from 1 to {} slices, {} steps and {} pixels", kMostSlices,
                                     kMostSteps, kMostRadius_px));
  }
  if (!holds_pixels(relief.pixels(), tile) || !holds_tile(openness, tile)) {
    return bad_transport("tile", "it is not inside the picture, or the plane is smaller",
                         "ask for a tile inside the picture with a plane of its size");
  }
  return check_normals(normals, tile);
}

/// Between the four pixels around a place inside the relief, in millimetres.
double height_at(const Relief& relief, double x, double y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, relief.height_mm.width() - 1);
  const int bottom = std::min(top + 1, relief.height_mm.height() - 1);
  const double u = x - left, v = y - top;
  const auto z = [&](int column, int row) { return static_cast<double>(relief.height_mm(column, row)); };
  return (1 - v) * ((1 - u) * z(left, top) + u * z(right, top)) +
         v * ((1 - u) * z(left, bottom) + u * z(right, bottom));
}

/// Angle from the vertical to the highest of the steps along a direction; `offset` in [0, 1) moves the steps.
double horizon(const Relief& relief, int x, int y, double along_x, double along_y,
               const HorizonSettings& settings, double offset) {
  const double here_mm = static_cast<double>(relief.height_mm(x, y));
  double mm_a_pixel = -std::numeric_limits<double>::infinity();
  for (int step = 0; step < settings.steps; ++step) {
    const double part = (step + offset) / settings.steps;
    const double distance = 1 + (settings.radius_px - 1) * part * part;
    const double at_x = x + distance * along_x, at_y = y - distance * along_y;
    if (!(at_x >= 0 && at_y >= 0 && at_x <= relief.height_mm.width() - 1 &&
          at_y <= relief.height_mm.height() - 1)) {
      break;
    }
    mm_a_pixel = std::max(mm_a_pixel, (height_at(relief, at_x, at_y) - here_mm) / distance);
  }
  return kPi / 2 - std::atan(mm_a_pixel / relief.mm_per_pixel);
}

double openness_at(const Relief& relief, Vec3 n, int x, int y, const HorizonSettings& settings) {
  constexpr double kToUnit = 0x1p-32;
  const PixelHash hash = hash_of(x, y);
  double sum = 0;
  for (int slice = 0; slice < settings.slices; ++slice) {
    const double turn = kPi * (slice + kToUnit * hash.first) / settings.slices;
    const double c = std::cos(turn), s = std::sin(turn), offset = kToUnit * hash.second;
    const double n_along = n.x * c + n.y * s;
    const double gamma = std::atan2(n_along, n.z);
    const double h1 = std::max(-horizon(relief, x, y, -c, -s, settings, offset), gamma - kPi / 2);
    const double h2 = std::min(horizon(relief, x, y, c, s, settings, offset), gamma + kPi / 2);
    const auto side = [gamma](double h) {
      return std::cos(gamma) - std::cos(2 * h - gamma) + 2 * h * std::sin(gamma);
    };
    sum += std::hypot(n_along, n.z) * (side(h1) + side(h2)) / 4;
  }
  return std::clamp(sum / settings.slices, 0.0, 1.0);
}

}  // namespace

Result<void> scan_openness(const Relief& relief, Rect tile, const Normals& normals,
                           const HorizonSettings& settings, View<float> openness) {
  if (auto checked = check(relief, tile, normals, settings, openness); !checked) return checked;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const Vec3 n = normal_or_up(normals, x - tile.x0, y - tile.y0);
      openness(x - tile.x0, y - tile.y0) = static_cast<float>(openness_at(relief, n, x, y, settings));
    }
  }
  return {};
}

}  // namespace weft::solver
