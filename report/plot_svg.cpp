// SPDX-License-Identifier: Apache-2.0
#include "report/plot_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/text.h"

namespace weft::bench {
namespace {

constexpr double kWidth = 760, kHeight = 520;
constexpr double kLeft = 64, kRight = 740, kTop = 66, kBottom = 466;  // of the field
constexpr double kFontSize = 12, kMark = 4.5;
constexpr double kLetter = 0.56 * kFontSize;  // mean width of a sans-serif letter
constexpr double kMargin = 0.06;              // of the field, between it and the outermost points

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

bool is_shown(const PlotPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && p.x > 0 && p.y > 0;
}

// A logarithmic axis from `low` to `high`, drawn from `from` to `to`.
struct Axis {
  double low, high, from, to;

  static Axis around(double least, double most, double from, double to) {
    const double spread = std::max(std::log10(most / least), 0.3);
    const double pad = std::pow(10, kMargin * spread);
    return {least / pad, most * pad, from, to};
  }
  double at(double value) const { return from + (to - from) * std::log(value / low) / std::log(high / low); }
  /// Whole digits where the axis spans a decade, 1, 2 and 5 of a few decades, powers of ten of many.
  std::vector<double> ticks() const {
    static const std::vector<double> kAll = {1, 1.5, 2, 3, 4, 5, 6, 8}, kSome = {1, 2, 5}, kOne = {1};
    const std::vector<double>& digits = high / low < 20 ? kAll : high / low < 1e3 ? kSome : kOne;
    std::vector<double> values;
    for (int decade = static_cast<int>(std::floor(std::log10(low))); std::pow(10, decade) <= high; ++decade) {
      for (const double digit : digits) {
        const double value = digit * std::pow(10, decade);
        if (value >= low && value <= high) values.push_back(value);
      }
    }
    return values;
  }
};

// A mark of the series by its number: disc, ring, square, diamond, triangle.
std::string mark(std::size_t series, double x, double y) {
  switch (series % 5) {
    case 0:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}'/>", x, y, kMark);
    case 1:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}' fill='white' stroke='black'/>", x, y, kMark);
    case 2:
      return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{}' height='{}'/>", x - kMark, y - kMark,
                         2 * kMark, 2 * kMark);
    case 3:
      return fmt::format("<path d='M{:.1f} {:.1f}l{} {}l-{} {}l-{} -{}z'/>", x, y - 1.3 * kMark, 1.3 * kMark,
                         1.3 * kMark, 1.3 * kMark, 1.3 * kMark, 1.3 * kMark, 1.3 * kMark);
    default:
      return fmt::format("<path d='M{:.1f} {:.1f}l{} {}h-{}z'/>", x, y - 1.2 * kMark, 1.2 * kMark,
                         2.2 * kMark, 2.4 * kMark);
  }
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    double x0 = std::numeric_limits<double>::infinity(), x1 = 0, y0 = x0, y1 = 0;
    for (const PlotSeries& series : plot.series) {
      for (const PlotPoint& p : series.points) {
        if (!is_shown(p)) continue;
        x0 = std::min(x0, p.x);
        x1 = std::max(x1, p.x);
        y0 = std::min(y0, p.y);
        y1 = std::max(y1, p.y);
      }
    }
    const bool nothing = x1 == 0;
    x_ = nothing ? Axis{1, 10, kLeft, kRight} : Axis::around(x0, x1, kLeft, kRight);
    y_ = nothing ? Axis{1, 10, kBottom, kTop} : Axis::around(y0, y1, kBottom, kTop);
  }

  std::string draw() {
    out_ = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' font-family='sans-serif' "
        "font-size='{}'>\n<rect width='{}' height='{}' fill='white'/>\n",
        kWidth, kHeight, kFontSize, kWidth, kHeight);
    add_axes();
    if (plot_.frontier) add_frontier();
    add_legend();
    for (std::size_t s = 0; s < plot_.series.size(); ++s) add_lines(plot_.series[s]);
    for (std::size_t s = plot_.series.size(); s-- > 0;) add_marks(s);  // the first on top
    for (const PlotSeries& series : plot_.series) {
      for (const PlotPoint& p : series.points) add_label(p);
    }
    return out_ + "</svg>\n";
  }

 private:
  void text(double x, double y, const char* anchor, const std::string& words, const char* more = "") {
    out_ += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'{}>{}</text>\n", x, y, anchor, more,
                        escape_markup(words));
  }
  void line(double x0, double y0, double x1, double y1, const char* style) {
    out_ +=
        fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' {}/>\n", x0, y0, x1, y1, style);
  }

  void add_axes() {
    for (const double value : x_.ticks()) {
      line(x_.at(value), kTop, x_.at(value), kBottom, "stroke='#ddd'");
      text(x_.at(value), kBottom + 18, "middle", fmt::format("{:g}", value));
    }
    for (const double value : y_.ticks()) {
      line(kLeft, y_.at(value), kRight, y_.at(value), "stroke='#ddd'");
      text(kLeft - 8, y_.at(value) + 4, "end", fmt::format("{:g}", value));
    }
    out_ += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='black'/>\n", kLeft,
                        kTop, kRight - kLeft, kBottom - kTop);
    text(kLeft, kTop - 40, "start", plot_.title, " font-weight='bold'");
    text((kLeft + kRight) / 2, kBottom + 40, "middle", plot_.x_label);
    const double middle = (kTop + kBottom) / 2;
    text(18, middle, "middle", plot_.y_label, fmt::format(" transform='rotate(-90 18 {})'", middle).c_str());
  }

  void add_frontier() {
    std::string path;
    std::optional<double> height;
    for (const PlotPoint& p : frontier_of(plot_.series)) {
      const double x = x_.at(p.x), y = y_.at(p.y);
      path += height ? fmt::format("H{:.1f}V{:.1f}", x, y) : fmt::format("M{:.1f} {:.1f}V{:.1f}", x, kTop, y);
      height = y;
    }
    if (height) path += fmt::format("H{:.1f}", kRight);
    out_ += fmt::format("<path d='{}' fill='none' stroke='#999' stroke-dasharray='5 4'/>\n", path);
  }

  // What each mark stands for, in a row under the title.
  void add_legend() {
    double x = kLeft + kMark;
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const std::string& name = plot_.series[s].name;
      out_ += mark(s, x, kTop - 18) + '\n';
      text(x + 2 * kMark, kTop - 14, "start", name);
      x += kLetter * static_cast<double>(name.size()) + 32;
    }
  }

  void add_lines(const PlotSeries& series) {
    if (!series.joined) return;
    std::string points;
    for (const PlotPoint& p : series.points) {
      if (is_shown(p)) points += fmt::format("{:.1f},{:.1f} ", x_.at(p.x), y_.at(p.y));
    }
    out_ += fmt::format("<polyline points='{}' fill='none' stroke='#555'/>\n", points);
  }

  void add_marks(std::size_t series) {
    for (const PlotPoint& p : plot_.series[series].points) {
      if (!is_shown(p)) continue;
      const double x = x_.at(p.x), y = y_.at(p.y);
      out_ += mark(series, x, y) + '\n';
      taken_.push_back({x - kMark, y - kMark, x + kMark, y + kMark});
    }
  }

  // Beside its mark, at the first of eight places that nothing takes yet.
  void add_label(const PlotPoint& p) {
    if (!is_shown(p) || p.label.empty()) return;
    const double x = x_.at(p.x), y = y_.at(p.y), width = kLetter * static_cast<double>(p.label.size());
    const double near = kMark + 3, up = kMark + 4 + kFontSize / 2;
    const std::array<std::array<double, 2>, 8> places = {{{near, 0},
                                                          {-near - width, 0},
                                                          {-width / 2, -up},
                                                          {-width / 2, up},
                                                          {near, -up},
                                                          {near, up},
                                                          {-near - width, -up},
                                                          {-near - width, up}}};
    const auto box_at = [&](const std::array<double, 2>& place) {
      return Box{x + place[0], y + place[1] - kFontSize / 2, x + place[0] + width,
                 y + place[1] + kFontSize / 2};
    };
    const auto is_free = [&](const Box& box) {
      return box.x0 > kLeft && box.x1 < kRight && box.y0 > kTop && box.y1 < kBottom &&
             std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) { return other.meets(box); });
    };
    const auto place = std::find_if(places.begin(), places.end(),
                                    [&](const auto& candidate) { return is_free(box_at(candidate)); });
    const Box best = box_at(place == places.end() ? places.front() : *place);
    taken_.push_back(best);
    text(best.x0, best.y1 - 2, "start", p.label);
  }

  const Plot& plot_;
  Axis x_ = {}, y_ = {};
  std::vector<Box> taken_;
  std::string out_;
};

}  // namespace

std::string plot_svg(const Plot& plot) {
  return Drawing(plot).draw();
}

Json plot_json(const Plot& plot) {
  Json series = Json::array();
  for (const PlotSeries& s : plot.series) {
    Json points = Json::array();
    for (const PlotPoint& p : s.points) points.push_back({{"label", p.label}, {"x", p.x}, {"y", p.y}});
    series.push_back({{"name", s.name}, {"joined", s.joined}, {"points", std::move(points)}});
  }
  return {{"schema", "weft.plot/1"},
          {"title", plot.title},
          {"x", plot.x_label},
          {"y", plot.y_label},
          {"series", std::move(series)}};
}

std::vector<PlotPoint> frontier_of(const std::vector<PlotSeries>& series) {
  std::vector<PlotPoint> points, frontier;
  for (const PlotSeries& s : series)
    std::copy_if(s.points.begin(), s.points.end(), std::back_inserter(points), is_shown);
  std::stable_sort(points.begin(), points.end(), [](const PlotPoint& a, const PlotPoint& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  for (const PlotPoint& p : points) {
    if (frontier.empty() || p.y < frontier.back().y) frontier.push_back(p);
  }
  return frontier;
}

}  // namespace weft::bench
