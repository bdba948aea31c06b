// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/run/balls.h"
#include "core/image_io/image_io.h"
#include "report/drawing.h"
#include "report/preview.h"

namespace weft::calibration {
namespace {

constexpr int kPanelSide = 640;
constexpr double kAround = 1.15;  // of the radius that a ball's panel shows
constexpr report::Colour kCircleInk{0.2F, 1, 0.4F}, kSpotInk{1, 0.45F, 0.1F};

/// Part of a picture, in pixels of shots, on a panel.
struct PanelView {
  double x0, y0, scale;  ///< panel pixels a pixel of shots
  Size size;

  int column(double x) const { return static_cast<int>(std::lround((x + 0.5 - x0) * scale - 0.5)); }
  int row(double y) const { return static_cast<int>(std::lround((y + 0.5 - y0) * scale - 0.5)); }
};

report::Picture panel_of(const Image<float>& greatest, const PanelView& view) {
  report::Picture panel = report::blank_picture(view.size);
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const int sx = static_cast<int>(std::floor((x + 0.5) / view.scale + view.x0));
      const int sy = static_cast<int>(std::floor((y + 0.5) / view.scale + view.y0));
      if (sx < 0 || sy < 0 || sx >= greatest.width() || sy >= greatest.height()) continue;
      for (int c = 0; c < 3; ++c) panel(x, y, c) = report::srgb_from_linear(greatest(sx, sy));
    }
  }
  return panel;
}

void draw_circle(report::Picture& panel, const PanelView& view, const Circle& c) {
  const int points = std::max(60, static_cast<int>(8 * c.radius * view.scale));
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * kPi * i / points;
    const int x = view.column(c.x + c.radius * std::cos(angle)),
              y = view.row(c.y + c.radius * std::sin(angle));
    report::fill(panel, {x, y, x + 1, y + 1}, kCircleInk);
  }
}

void draw_spot(report::Picture& panel, const PanelView& view, double x, double y, const std::string& number) {
  const int px = view.column(x), py = view.row(y);
  report::fill(panel, {px - 5, py, px + 6, py + 1}, kSpotInk);
  report::fill(panel, {px, py - 5, px + 1, py + 6}, kSpotInk);
  report::draw_text(panel, px + 7, py - report::kGlyphHeight, number, kSpotInk, 1);
}

/// The greatest value of all shots at each pixel.
Image<float> greatest_of(const std::vector<Image<float>>& shots) {
  Image<float> greatest(shots.front().size());
  for (int y = 0; y < greatest.height(); ++y) {
    for (int x = 0; x < greatest.width(); ++x) {
      for (const Image<float>& shot : shots)
        greatest(x, y) = std::max(greatest(x, y), std::min(shot(x, y), 1.0F));
    }
  }
  return greatest;
}

}  // namespace

Result<void> write_ball_picture(const std::filesystem::path& file, const std::vector<Image<float>>& shots,
                                const BallLights& lights, int by) {
  const Image<float> greatest = greatest_of(shots);
  const double longest = std::max(greatest.width(), greatest.height()), whole = kPanelSide / longest;
  const PanelView all = {0,
                         0,
                         whole,
                         {static_cast<int>(std::lround(greatest.width() * whole)),
                          static_cast<int>(std::lround(greatest.height() * whole))}};
  const double shift = (by - 1) / 2.0;
  std::vector<report::Panel> panels;
  panels.push_back({"All photographs", "greatest value", panel_of(greatest, all)});
  int number = 0;
  for (const FoundBall& ball : lights.balls) {
    const Circle& in_file = ball.outline.circle;
    const Circle c = {(in_file.x - shift) / by, (in_file.y - shift) / by, in_file.radius / by};
    draw_circle(panels[0].picture, all, c);
    const double half = kAround * c.radius;
    const PanelView near = {
        c.x + 0.5 - half, c.y + 0.5 - half, kPanelSide / (2 * half), {kPanelSide, kPanelSide}};
    report::Picture panel = panel_of(greatest, near);
    draw_circle(panel, near, c);
    for (std::size_t k = 0; k < ball.lamps.size(); ++k) {
      const LampOnBall& lamp = ball.lamps[k];
      if (lamp.found)
        draw_spot(panel, near, (lamp.x - shift) / by, (lamp.y - shift) / by, fmt::format("{}", k + 1));
    }
    panels.push_back({fmt::format("Ball {}", ++number),
                      fmt::format("{}, {:.1f} {:.1f}, radius {:.1f} pixels", name_of(ball.kind), in_file.x,
                                  in_file.y, in_file.radius),
                      std::move(panel)});
  }
  const report::Picture sheet = report::contact_sheet("Lights from a ball", panels);
  const std::array<View<const float>, 3> planes = {sheet.plane(0), sheet.plane(1), sheet.plane(2)};
  return write_image(file, planes, {"R", "G", "B"}, {.type = SampleType::kUint8});
}

}  // namespace weft::calibration
