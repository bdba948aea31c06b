// SPDX-License-Identifier: Apache-2.0
#include "material/run/yarn_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "material/run/surface_files.h"
#include "report/preview.h"

namespace weft::app {
namespace {

using material::Lattice;
using material::Surface;
using material::Vec2;
using report::Picture;

constexpr int kYarnsShown = 28, kYarnsApart = 4, kSide = 720;
constexpr report::Colour kAcross{1.0F, 0.3F, 0.2F}, kUp{0.2F, 0.7F, 1.0F};

// Some yarns around the middle.
Rect middle_of(const Surface& surface, const Lattice& lattice) {
  const Size size = surface.size();
  const int side = static_cast<int>(kYarnsShown * std::max(lattice.yarn_x_px, lattice.yarn_y_px));
  const int w = std::min(side, size.width), h = std::min(side, size.height);
  const int x0 = (size.width - w) / 2, y0 = (size.height - h) / 2;
  return {x0, y0, x0 + w, y0 + h};
}

Picture relit(const Surface& surface, Rect part) {
  Image<float> slope({part.width(), part.height()}, 2), albedo(slope.size(), 3);
  for (int y = 0; y < part.height(); ++y) {
    for (int x = 0; x < part.width(); ++x) {
      for (int p = 0; p < 2; ++p) slope(x, y, p) = surface.slope(part.x0 + x, part.y0 + y, p);
      for (int p = 0; p < 3; ++p)
        albedo(x, y, p) = surface.albedo(part.x0 + x, part.y0 + y, std::min(p, surface.albedo.planes() - 1));
    }
  }
  return report::relit_picture(albedo, normals_of(slope), report::display_scale(albedo));
}

// Each pixel of the picture stands for one of `of`, `times` as large or small.
Picture resized(const Picture& of, double times) {
  const Size size = {static_cast<int>(times * of.width()), static_cast<int>(times * of.height())};
  Picture out(size, of.planes());
  for (int p = 0; p < of.planes(); ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x)
        out(x, y, p) = of(static_cast<int>(x / times), static_cast<int>(y / times), p);
    }
  }
  return out;
}

// Lines along a way, `apart` pixels of the picture from each other, one through its middle.
void draw_lines(Picture& picture, Vec2 way, double apart, report::Colour colour) {
  constexpr double kHalfWidth = 1.2;
  const Vec2 along = (1 / length(way)) * way;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const Vec2 from_middle = {x - picture.width() / 2.0, picture.height() / 2.0 - y};
      if (std::abs(std::remainder(cross(along, from_middle), apart)) < kHalfWidth)
        report::fill(picture, {x, y, x + 1, y + 1}, colour);
    }
  }
}

}  // namespace

Picture yarn_picture(const Surface& surface, const Lattice& lattice) {
  const Rect part = middle_of(surface, lattice);
  const double times = static_cast<double>(kSide) / std::max(part.width(), part.height());
  Picture picture = resized(relit(surface, part), times);
  draw_lines(picture, lattice.axes.a, kYarnsApart * times * lattice.yarn_y_px, kAcross);
  draw_lines(picture, lattice.axes.b, kYarnsApart * times * lattice.yarn_x_px, kUp);
  return picture;
}

}  // namespace weft::app
