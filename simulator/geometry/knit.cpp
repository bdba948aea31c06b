// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/knit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::simulator {
namespace {

// The shape of a loop: by how much its head is wider than its neck (of a wale), half its height (of a
// course), and how far its legs come forward and its head goes back (of a yarn's diameter).
constexpr double kWidening = 0.22;
constexpr double kHalfHeight = 1.15;
constexpr double kDepth = 0.35;

/// Courses and wales around the loop over the origin whose loops can be on top there.
constexpr int kCoursesAround = 3;
constexpr int kWalesAround = 2;

constexpr double kPrecision = 1e-13;  // of the parameter t
constexpr int kMostSteps = 60;

}  // namespace

bool loops_reach_their_neighbours_only(const GeometrySettings& g) {
  return g.course_mm >= g.wale_mm / 2 && g.course_mm <= 2 * g.wale_mm;
}

Knit::Knit(const GeometrySettings& g)
    : wale_mm_(g.wale_mm),
      course_mm_(g.course_mm),
      radius_mm_(g.yarn_diameter * g.wale_mm / 2),
      round_mm_(radius_mm_ * std::sin(radians(g.loop_flank_deg))),
      flank_slope_(std::tan(radians(g.loop_flank_deg))) {
  for (int i = 0; i <= kSteps; ++i) steps_.push_back(axis_at(i * kStep));
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) cells_.push_back(stretches_of_cell(column, row));
  }
}

Knit::AxisPoint Knit::axis_at(double t) const {
  const double depth_mm = kDepth * 2 * radius_mm_;
  const double sine = std::sin(t), cosine = std::cos(t);
  const double sine2 = 2 * sine * cosine, cosine2 = 1 - 2 * sine * sine;  // of 2 t
  return {{wale_mm_ * (t / (2 * kPi) + kWidening * sine2), -kHalfHeight * course_mm_ * cosine,
           -depth_mm * (1 + cosine2) - radius_mm_},
          {wale_mm_ * (1 / (2 * kPi) + 2 * kWidening * cosine2), kHalfHeight * course_mm_ * sine,
           2 * depth_mm * sine2}};
}

Knit::AxisPoint Knit::axis_at_step(const Stretch& stretch, int end) const {
  const int step = stretch.step + end;
  const int wale = step >= 0 ? step / kSteps : -((kSteps - 1 - step) / kSteps);
  AxisPoint p = steps_[static_cast<std::size_t>(step - wale * kSteps)];
  p.mm.x += wale * wale_mm_;
  p.mm.y += stretch.course * course_mm_;
  return p;
}

Knit::Ball Knit::ball_at(const AxisPoint& axis, double x_mm, double y_mm) const {
  const double dx = x_mm - axis.mm.x, dy = y_mm - axis.mm.y;
  const double off_axis_mm = std::sqrt(dx * dx + dy * dy);
  const double beyond_mm = std::max(off_axis_mm - round_mm_, 0.0);
  const double u = off_axis_mm - beyond_mm;
  const double z = std::sqrt(radius_mm_ * radius_mm_ - u * u);
  const double fall = beyond_mm > 0 ? flank_slope_ / off_axis_mm : 1 / z;  // slope by distance
  return {axis.mm.z + z - flank_slope_ * beyond_mm,
          axis.by_t.z + fall * (dx * axis.by_t.x + dy * axis.by_t.y), -fall * dx, -fall * dy};
}

/// Where between two steps, with the height rising at the first and falling at the second, it is highest:
/// regula falsi on its derivative (Illinois variant, Dowell and Jarratt 1971).
Knit::AxisPoint Knit::crest_in(const Stretch& stretch, double rise0, double rise1, double x_mm,
                               double y_mm) const {
  const auto axis_at_t = [&](double t) {
    AxisPoint p = axis_at(t);
    p.mm.y += stretch.course * course_mm_;
    return p;
  };
  double t0 = stretch.step * kStep, t1 = (stretch.step + 1) * kStep;
  double last = 0;
  for (int i = 0; i < kMostSteps && t1 - t0 > kPrecision && rise0 - rise1 > 0; ++i) {
    const double t = std::clamp(t0 + (t1 - t0) * rise0 / (rise0 - rise1), t0, t1);
    const double rise = ball_at(axis_at_t(t), x_mm, y_mm).by_t;
    if (rise == 0) return axis_at_t(t);
    (rise > 0 ? t0 : t1) = t;
    (rise > 0 ? rise0 : rise1) = rise;
    if (rise * last > 0) (rise > 0 ? rise1 : rise0) /= 2;
    last = rise;
  }
  return axis_at_t(rise0 < -rise1 ? t0 : t1);
}

std::vector<Knit::Stretch> Knit::stretches_of_cell(int column, int row) {
  const double x_mm = (column + 0.5) / kCells * wale_mm_, y_mm = (row + 0.5) / kCells * course_mm_;
  const auto for_each_stretch = [](const auto& body) {
    for (int course = -kCoursesAround; course <= kCoursesAround; ++course) {
      for (int step = -kWalesAround * kSteps; step < (kWalesAround + 1) * kSteps; ++step)
        body(Stretch{course, step});
    }
  };
  const auto height_mm = [&](const Stretch& s) { return ball_at(axis_at_step(s, 0), x_mm, y_mm).height_mm; };
  double top_mm = -std::numeric_limits<double>::infinity();
  for_each_stretch([&](const Stretch& s) { top_mm = std::max(top_mm, height_mm(s)); });

  // How much may change from here to the far end of the stretch, and from the middle of the cell to its rim.
  double climb_mm = 0;
  for (const AxisPoint& p : steps_) {
    climb_mm = std::max(climb_mm, std::abs(p.by_t.z) + flank_slope_ * std::hypot(p.by_t.x, p.by_t.y));
  }
  climb_mm *= 1.1 * kStep;  // between steps the axis is a little faster
  const double change_mm = flank_slope_ * std::hypot(wale_mm_, course_mm_) / (2 * kCells);
  lowest_mm_ = std::min(lowest_mm_, top_mm - change_mm);
  std::vector<Stretch> near;
  for_each_stretch([&](const Stretch& s) {
    if (height_mm(s) + climb_mm >= top_mm - 2 * change_mm) near.push_back(s);
  });
  return near;
}

SurfacePoint Knit::at(double x_mm, double y_mm) const {
  const double wale = std::floor(x_mm / wale_mm_), course = std::floor(y_mm / course_mm_);
  const double x = x_mm - wale * wale_mm_, y = y_mm - course * course_mm_;
  const auto cell_of = [](double at_mm, double period_mm) {
    return static_cast<std::size_t>(std::clamp(at_mm / period_mm * kCells, 0.0, kCells - 1.0));
  };
  AxisPoint top_axis = {};
  Ball top = {-std::numeric_limits<double>::infinity(), 0, 0, 0};
  int top_course = 0;
  const auto offer = [&](const AxisPoint& axis, const Ball& ball, int of_course) {
    if (!(ball.height_mm > top.height_mm)) return;
    top_axis = axis;
    top = ball;
    top_course = of_course;
  };
  for (const Stretch& s : cells_[cell_of(y, course_mm_) * kCells + cell_of(x, wale_mm_)]) {
    const AxisPoint first = axis_at_step(s, 0), second = axis_at_step(s, 1);
    const Ball from = ball_at(first, x, y), to = ball_at(second, x, y);
    if (from.by_t > 0 && to.by_t < 0) {
      const AxisPoint crest = crest_in(s, from.by_t, to.by_t, x, y);
      offer(crest, ball_at(crest, x, y), s.course);
    } else {
      offer(first, from, s.course);
      offer(second, to, s.course);
    }
  }
  return {top.height_mm,
          normal_of_slopes(top.slope_x, top.slope_y),
          {true, static_cast<std::int64_t>(course) + top_course},
          top_axis.by_t.x,
          top_axis.by_t.y};
}

}  // namespace weft::simulator
