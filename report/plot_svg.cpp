// SPDX-License-Identifier: Apache-2.0
#include "report/plot_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/text.h"

namespace weft::report {
namespace {

constexpr double kMargin = 0.06;          // of the axis, between its ends and the outermost values
constexpr double kLeastDecades = 0.3;     // that the margin of a logarithmic axis is reckoned from
constexpr double kFewestDigits = 3;       // high over low from which the digits of decades serve as ticks
constexpr double kMostSteps = 8;          // of a linear axis
constexpr double kLeastMagnitude = 1e-3;  // that the margin of a single value is reckoned from

std::vector<double> linear_ticks(double low, double high) {
  double step = std::pow(10, std::floor(std::log10((high - low) / 3)));
  for (const double factor : {2.0, 2.5}) {
    if ((high - low) / step > kMostSteps) step *= factor;
  }
  const double first = std::ceil(low / step);
  std::vector<double> values;
  for (int i = 0; (first + i) * step <= high; ++i) values.push_back((first + i) * step);
  return values;
}

std::vector<double> logarithmic_ticks(double low, double high) {
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

constexpr double kWidth = 760, kHeight = 520, kFlatHeight = 372, kLargeWidth = 420, kLargeHeight = 300;
constexpr double kLeft = 64, kBeside = 20, kAbove = 14, kBelow = 54;  // around the field
constexpr double kTitleHeight = 26, kLegendHeight = 26, kLegendLine = 18, kLegendGap = 18.5;
constexpr double kFontSize = 12, kLetter = 0.56 * kFontSize;  // mean width of a sans-serif letter
constexpr double kMark = 4.5, kSmallMark = 2.2;               // half the size of a mark
constexpr std::size_t kMostLarge = 24;                        // marks of a series
constexpr std::size_t kMarks = 5;                             // kinds of them
constexpr std::array<const char*, 4> kDashes = {"none", "6 3", "2 3", "8 3 2 3"};
constexpr double kSample = 24;  // length of a line in the legend

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

// A mark of the series by its number: disc, ring, square, diamond, triangle.
std::string mark(std::size_t series, double x, double y, double r) {
  switch (series % kMarks) {
    case 0:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}'/>", x, y, r);
    case 1:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}' fill='white' stroke='black'/>", x, y, r);
    case 2:
      return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{}' height='{}'/>", x - r, y - r, 2 * r, 2 * r);
    case 3:
      return fmt::format("<path d='M{:.1f} {:.1f}l{} {}l-{} {}l-{} -{}z'/>", x, y - 1.3 * r, 1.3 * r, 1.3 * r,
                         1.3 * r, 1.3 * r, 1.3 * r, 1.3 * r);
    default:
      return fmt::format("<path d='M{:.1f} {:.1f}l{} {}h-{}z'/>", x, y - 1.2 * r, 1.2 * r, 2.2 * r, 2.4 * r);
  }
}

// Marks come round again after kMarks series; from then on dashes tell lines apart.
std::string stroke(std::size_t series) {
  const std::size_t dash = series / kMarks % kDashes.size();
  return dash == 0 ? "stroke='#555'" : fmt::format("stroke='#555' stroke-dasharray='{}'", kDashes[dash]);
}

// Without the points that the plot cannot show.
Plot reduced_to_shown(Plot plot) {
  const PlotAxis x = {.log = plot.log_x}, y = {.log = plot.log_y};
  for (PlotSeries& series : plot.series) {
    std::erase_if(series.points, [&](const PlotPoint& p) { return !x.takes(p.x) || !y.takes(p.y); });
  }
  return plot;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot)
      : plot_(reduced_to_shown(plot)),
        width_(plot.large ? kLargeWidth : kWidth),
        right_(width_ - kBeside),
        height_(plot.large           ? kLargeHeight
                : plot.title.empty() ? kFlatHeight
                                     : kHeight),
        bottom_(height_ - kBelow) {
    place_legend();
    top_ = kAbove + (plot.title.empty() ? 0 : kTitleHeight) +
           (legend_.empty() ? 0 : kLegendHeight + kLegendLine * legend_.back().line);
    std::vector<double> x, y;
    for (const PlotSeries& series : plot_.series) {
      for (const PlotPoint& p : series.points) {
        x.push_back(p.x);
        y.push_back(p.y);
      }
    }
    x_ = PlotAxis::around(x, plot.log_x, kLeft, right_);
    y_ = PlotAxis::around(y, plot.log_y, bottom_, top_);
  }

  std::string draw() {
    out_ = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' font-family='sans-serif' "
        "font-size='{}'>\n<rect width='{}' height='{}' fill='white'/>\n",
        width_, height_, kFontSize, width_, height_);
    add_axes();
    if (plot_.frontier) add_frontier();
    add_legend();
    for (std::size_t s = 0; s < plot_.series.size(); ++s) add_lines(s);
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
  void line(double x0, double y0, double x1, double y1, const std::string& style) {
    out_ +=
        fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' {}/>\n", x0, y0, x1, y1, style);
  }

  void add_axes() {
    for (const double value : x_.ticks()) {
      line(x_.at(value), top_, x_.at(value), bottom_, "stroke='#ddd'");
      text(x_.at(value), bottom_ + 18, "middle", fmt::format("{:g}", value));
    }
    for (const double value : y_.ticks()) {
      line(kLeft, y_.at(value), right_, y_.at(value), "stroke='#ddd'");
      text(kLeft - 8, y_.at(value) + 4, "end", fmt::format("{:g}", value));
    }
    out_ += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='black'/>\n", kLeft,
                        top_, right_ - kLeft, bottom_ - top_);
    if (!plot_.title.empty()) text(kLeft, kTitleHeight, "start", plot_.title, " font-weight='bold'");
    text((kLeft + right_) / 2, bottom_ + 40, "middle", plot_.x_label);
    const double middle = (top_ + bottom_) / 2;
    text(18, middle, "middle", plot_.y_label, fmt::format(" transform='rotate(-90 18 {})'", middle).c_str());
  }

  void add_frontier() {
    std::string path;
    std::optional<double> height;
    for (const PlotPoint& p : frontier_of(plot_.series)) {
      const double x = x_.at(p.x), y = y_.at(p.y);
      path += height ? fmt::format("H{:.1f}V{:.1f}", x, y) : fmt::format("M{:.1f} {:.1f}V{:.1f}", x, top_, y);
      height = y;
    }
    if (height) path += fmt::format("H{:.1f}", right_);
    out_ += fmt::format("<path d='{}' fill='none' stroke='#999' stroke-dasharray='5 4'/>\n", path);
  }

  // Whether the mark alone does not tell the series.
  bool has_sample(std::size_t s) const {
    return plot_.series[s].joined && (!plot_.series[s].marked || s >= kMarks);
  }

  // What each mark and dash stands for, in rows under the title.
  void place_legend() {
    double x = kLeft;
    int row = 0;
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const double before = (has_sample(s) ? kSample : 2 * kMark) + kMark;  // its name
      const double width = before + kLetter * static_cast<double>(plot_.series[s].name.size());
      if (x > kLeft && x + width > right_) {
        x = kLeft;
        ++row;
      }
      legend_.push_back({x, x + before, row});
      x += width + kLegendGap;
    }
  }

  void add_legend() {
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const LegendEntry& at = legend_[s];
      const double y = top_ - 14 - kLegendLine * (legend_.back().line - at.line);
      if (has_sample(s)) line(at.x, y - 4, at.x + kSample, y - 4, stroke(s));
      const double centre = at.x + (has_sample(s) ? kSample / 2 : kMark);
      if (plot_.series[s].marked) out_ += mark(s, centre, y - 4, kMark) + '\n';
      text(at.text_x, y, "start", plot_.series[s].name);
    }
  }

  void add_lines(std::size_t s) {
    const PlotSeries& series = plot_.series[s];
    if (!series.joined) return;
    std::string points;
    for (const PlotPoint& p : series.points) points += fmt::format("{:.1f},{:.1f} ", x_.at(p.x), y_.at(p.y));
    out_ += fmt::format("<polyline points='{}' fill='none' {}/>\n", points, stroke(s));
  }

  void add_marks(std::size_t s) {
    const PlotSeries& series = plot_.series[s];
    if (!series.marked) return;
    const double r = series.points.size() > kMostLarge ? kSmallMark : kMark;
    for (const PlotPoint& p : series.points) {
      const double x = x_.at(p.x), y = y_.at(p.y);
      out_ += mark(s, x, y, r) + '\n';
      taken_.push_back({x - r, y - r, x + r, y + r});
    }
  }

  // Beside its mark, at the first of eight places that nothing takes yet.
  void add_label(const PlotPoint& p) {
    if (p.label.empty()) return;
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
      return box.x0 > kLeft && box.x1 < right_ && box.y0 > top_ && box.y1 < bottom_ &&
             std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) { return other.meets(box); });
    };
    const auto place = std::find_if(places.begin(), places.end(),
                                    [&](const auto& candidate) { return is_free(box_at(candidate)); });
    const Box best = box_at(place == places.end() ? places.front() : *place);
    taken_.push_back(best);
    text(best.x0, best.y1 - 2, "start", p.label);
  }

  struct LegendEntry {
    double x, text_x;  // where its mark and its name begin
    int line;          // from 0
  };

  const Plot plot_;
  const double width_, right_, height_, bottom_;
  double top_ = 0;
  std::vector<LegendEntry> legend_;  // one a series
  PlotAxis x_ = {}, y_ = {};
  std::vector<Box> taken_;
  std::string out_;
};

}  // namespace

PlotAxis PlotAxis::around(std::span<const double> values, bool log, double from, double to) {
  PlotAxis axis = {log ? 1.0 : 0.0, log ? 10.0 : 1.0, from, to, log};
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : values) {
    if (!axis.takes(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  if (least > most) return axis;
  if (log) {
    const double pad = std::pow(10, kMargin * std::max(std::log10(most / least), kLeastDecades));
    axis.low = least / pad;
    axis.high = most * pad;
  } else {
    const double pad =
        most > least ? kMargin * (most - least) : std::max(std::abs(most), kLeastMagnitude) / 2;
    axis.low = least - pad;
    axis.high = most + pad;
  }
  return axis;
}

bool PlotAxis::takes(double value) const {
  return std::isfinite(value) && (!log || value > 0);
}

double PlotAxis::at(double value) const {
  const double share = log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return from + (to - from) * share;
}

std::vector<double> PlotAxis::ticks() const {
  return log && high / low >= kFewestDigits ? logarithmic_ticks(low, high) : linear_ticks(low, high);
}

std::string plot_svg(const Plot& plot) {
  return Drawing(plot).draw();
}

std::vector<PlotPoint> frontier_of(const std::vector<PlotSeries>& series) {
  std::vector<PlotPoint> points, frontier;
  for (const PlotSeries& s : series) points.insert(points.end(), s.points.begin(), s.points.end());
  std::stable_sort(points.begin(), points.end(), [](const PlotPoint& a, const PlotPoint& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  for (const PlotPoint& p : points) {
    if (frontier.empty() || p.y < frontier.back().y) frontier.push_back(p);
  }
  return frontier;
}

}  // namespace weft::report
