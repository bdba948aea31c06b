// SPDX-License-Identifier: Apache-2.0
#include "material/maps/flatten.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"

namespace weft::material {
namespace {

/// Slopes as a surface has them, and which of them are any.
struct SlopeMap {
  View<const float> right, up;
  View<const std::uint16_t> status;

  bool has_slope(int x, int y) const {
    return (status.empty() || (status(x, y) & kNoSolution) == 0) && std::isfinite(right(x, y)) &&
           std::isfinite(up(x, y));
  }
};

/// Standard deviation of a Gaussian over the wavelength that it halves.
const double kSigmaAWavelength = std::sqrt(std::log(2.0) / 2) / kPi;
constexpr int kFactSide = 33;  ///< places a side that facts are read at

Error unusable_slopes(ErrorKind kind, const char* why, const char* remedy) {
  return {kind, "slow slopes cannot be told", "", why, remedy};
}

Result<void> check(const SlopeMap& map, const FlattenOptions& options) {
  const Size size = map.right.size();
  if (size.width <= 0 || size.height <= 0 || map.up.size() != size ||
      (!map.status.empty() && map.status.size() != size)) {
    return unusable_slopes(ErrorKind::kUsage, "slopes and status differ in size, or are empty",
                           "give maps of one surface");
  }
  if (!(options.mm_per_pixel > 0) || options.degree < 1 || options.degree > SlopePolynomial::kMostDegree ||
      !(options.sigma_deg >= 0)) {
    return unusable_slopes(ErrorKind::kUsage, "mm_per_pixel, degree or sigma is out of range",
                           "give millimetres a pixel, and a degree from 1 to 5");
  }
  if (options.method == FlattenMethod::kHighPass && !(options.cut_mm >= 4 * options.mm_per_pixel)) {
    return unusable_slopes(ErrorKind::kUsage, "a high pass needs a cut of four pixels or more",
                           "give the wavelength in millimetres of which half is to go");
  }
  if (options.method == FlattenMethod::kRepeat && !options.repeat) {
    return unusable_slopes(ErrorKind::kUsage, "a window of whole repeats needs the repeat",
                           "give it, or leave the method out");
  }
  return {};
}

/// What a column counts, and what a row.
struct FitWindow {
  std::vector<double> across, down;
};

std::vector<double> hann(int length) {
  std::vector<double> window(static_cast<std::size_t>(length));
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double s = std::sin(kPi * (static_cast<double>(i) + 0.5) / length);
    window[i] = s * s;
  }
  return window;
}

// The mean over `width` places about each, parts of places included.
std::vector<double> averaged(const std::vector<double>& values, double width) {
  if (width <= 1) return values;
  const int whole = static_cast<int>((width - 1) / 2), reach = whole + 1;
  const double end = (width - 1) / 2 - whole;
  const auto count = static_cast<int>(values.size());
  std::vector<double> out(values.size());
  for (int i = 0; i < count; ++i) {
    for (int k = -reach; k <= reach; ++k) {
      const int at = i + k;
      if (at < 0 || at >= count) continue;
      out[static_cast<std::size_t>(i)] +=
          (std::abs(k) == reach ? end : 1) / width * values[static_cast<std::size_t>(at)];
    }
  }
  return out;
}

// 1 in the middle, falling to 0 at the border as a mean over the repeat, and once more over the repeat, lets
// it: each takes the pattern out of what leaks in through the border.
std::vector<double> falling_over_repeats(int length, double first, double second) {
  constexpr int kTimes = 2;
  const double margin = kTimes * (first + second) / 2;
  std::vector<double> window(static_cast<std::size_t>(length));
  for (int i = 0; i < length; ++i) {
    window[static_cast<std::size_t>(i)] = i >= margin && i <= length - 1 - margin ? 1 : 0;
  }
  for (int time = 0; time < kTimes; ++time) window = averaged(averaged(window, first), second);
  return window;
}

/// Nothing where the vectors span nothing, and where a frame does not hold kLeastRepeats of them either way.
std::optional<FitWindow> window_of_repeats(Size size, const Repeat& r) {
  constexpr int kLeastRepeats = 6;
  const double ax = std::abs(r.first_x), ay = std::abs(r.first_y), bx = std::abs(r.second_x),
               by = std::abs(r.second_y);
  const bool spans = std::abs(r.first_x * r.second_y - r.first_y * r.second_x) >= 1;
  if (!spans || !(kLeastRepeats * (ax + bx) <= size.width) || !(kLeastRepeats * (ay + by) <= size.height)) {
    return std::nullopt;
  }
  return FitWindow{falling_over_repeats(size.width, ax, bx), falling_over_repeats(size.height, ay, by)};
}

SlopeFit::RowMoments moments_of_row(const SlopeMap& map, int y, const std::vector<double>& window,
                                    const std::vector<SlopePolynomial::Axis>& columns, std::size_t terms) {
  SlopeFit::RowMoments row;
  for (std::size_t x = 0; x < columns.size(); ++x) {
    const int column = static_cast<int>(x);
    if (!map.has_slope(column, y)) continue;
    const double right = static_cast<double>(map.right(column, y)),
                 up = static_cast<double>(map.up(column, y));
    for (std::size_t i = 0; i < terms; ++i) {
      const double weighted = window[x] * columns[x][i];
      for (std::size_t k = 0; k < terms; ++k) row.products[i][k] += weighted * columns[x][k];
      row.right[i] += weighted * right;
      row.up[i] += weighted * up;
    }
  }
  return row;
}

bool fit_under(const FitWindow& window, const SlopeMap& map, int threads, SlopePolynomial& polynomial) {
  constexpr int kFitRows = 32;
  const Size size = map.right.size();
  std::vector<SlopePolynomial::Axis> columns;
  for (int x = 0; x < size.width; ++x) columns.push_back(polynomial.at_column(x));
  const auto terms = static_cast<std::size_t>(polynomial.degree()) + 1;
  std::vector<SlopeFit> fits(static_cast<std::size_t>((size.height + kFitRows - 1) / kFitRows),
                             SlopeFit(polynomial.degree()));
  parallel_for(fits.size(), threads, [&](std::size_t task, int) {
    const int y0 = static_cast<int>(task) * kFitRows, y1 = std::min(y0 + kFitRows, size.height);
    for (int y = y0; y < y1; ++y) {
      fits[task].add_row(moments_of_row(map, y, window.across, columns, terms), polynomial.at_row(y),
                         window.down[static_cast<std::size_t>(y)]);
    }
  });
  SlopeFit all(polynomial.degree());
  for (const SlopeFit& fit : fits) all.add(fit);
  return all.solve(polynomial);
}

// Whether a field takes at least half of its own energy off the slopes, all pixels counting alike. One that
// follows folds which it cannot hold swings out where its window counts little, and adds more than it takes.
bool takes_what_it_holds(const SlopePolynomial& field, const SlopeMap& map, int threads) {
  struct Sums {
    double shared = 0, own = 0;
  };
  const Size size = map.right.size();
  std::vector<Sums> rows(static_cast<std::size_t>(size.height));
  parallel_for(rows.size(), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    std::vector<float> right(static_cast<std::size_t>(size.width)), up(right.size());
    field.read(y, right.data(), up.data());
    for (int x = 0; x < size.width; ++x) {
      if (!map.has_slope(x, y)) continue;
      const double r = static_cast<double>(right[static_cast<std::size_t>(x)]);
      const double u = static_cast<double>(up[static_cast<std::size_t>(x)]);
      rows[row].shared += r * static_cast<double>(map.right(x, y)) + u * static_cast<double>(map.up(x, y));
      rows[row].own += r * r + u * u;
    }
  });
  Sums all;
  for (const Sums& row : rows) {
    all.shared += row.shared;
    all.own += row.own;
  }
  return 2 * all.shared - all.own >= 0.5 * all.own;
}

GaussianGrid slow_plane(const SlopeMap& map, View<const float> plane, const FlattenOptions& options) {
  Image<std::uint8_t> counts(plane.size());
  for (int y = 0; y < counts.height(); ++y) {
    for (int x = 0; x < counts.width(); ++x) counts(x, y) = map.has_slope(x, y);
  }
  return {plane,
          counts.plane(),
          {options.cut_mm / options.mm_per_pixel * kSigmaAWavelength, false, options.threads}};
}

using SlopesAt = std::vector<std::array<double, 2>>;  ///< kFactSide rows of right and up

// Heights along the middle row and then columns, and the other way about, halved: of a field that belongs to
// a surface both are that surface.
double bow_of(const SlopesAt& slopes, double step_x_mm, double step_y_mm) {
  const auto at = [&](int x, int y) { return slopes[static_cast<std::size_t>(y * kFactSide + x)]; };
  constexpr int kMiddle = kFactSide / 2;
  const auto across = [&](int to, int y) {
    double sum = 0;
    const int sign = to < kMiddle ? -1 : 1;
    for (int x = kMiddle; x != to; x += sign) sum += sign * (at(x, y)[0] + at(x + sign, y)[0]) / 2;
    return sum * step_x_mm;
  };
  const auto upwards = [&](int to, int x) {
    double sum = 0;
    const int sign = to < kMiddle ? -1 : 1;
    for (int y = kMiddle; y != to; y += sign) sum -= sign * (at(x, y)[1] + at(x, y + sign)[1]) / 2;
    return sum * step_y_mm;
  };
  double lowest = 0, highest = 0;
  for (int y = 0; y < kFactSide; ++y) {
    for (int x = 0; x < kFactSide; ++x) {
      const double height = (across(x, kMiddle) + upwards(y, x) + upwards(y, kMiddle) + across(x, y)) / 2;
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
  }
  return highest - lowest;
}

}  // namespace

void SlowSlopes::read_found(int y, float* right, float* up) const {
  if (const auto* polynomial = std::get_if<SlopePolynomial>(&field_)) return polynomial->read(y, right, up);
  const Grids& grids = std::get<Grids>(field_);
  grids.right.read(y, right);
  grids.up.read(y, up);
}

void SlowSlopes::read(int y, float* right, float* up) const {
  if (acts) return read_found(y, right, up);
  std::fill_n(right, size_.width, 0.0f);
  std::fill_n(up, size_.width, 0.0f);
}

void SlowSlopes::state_facts(const FlattenOptions& options) {
  SlopesAt slopes;
  std::vector<float> right(static_cast<std::size_t>(size_.width)), up(right.size());
  std::array<double, 2> mean = {};
  for (int i = 0; i < kFactSide; ++i) {
    read_found(static_cast<int>(std::lround(i / (kFactSide - 1.0) * (size_.height - 1))), right.data(),
               up.data());
    for (int k = 0; k < kFactSide; ++k) {
      const auto x = static_cast<std::size_t>(std::lround(k / (kFactSide - 1.0) * (size_.width - 1)));
      slopes.push_back({static_cast<double>(right[x]), static_cast<double>(up[x])});
      for (std::size_t p = 0; p < 2; ++p) mean[p] += slopes.back()[p] / (kFactSide * kFactSide);
    }
  }
  tilt_deg = degrees(std::atan(std::hypot(mean[0], mean[1])));
  for (auto& slope : slopes) {
    for (std::size_t p = 0; p < 2; ++p) slope[p] -= mean[p];
    range_deg = std::max(range_deg, degrees(std::atan(std::hypot(slope[0], slope[1]))));
  }
  bow_mm = bow_of(slopes, (size_.width - 1) * options.mm_per_pixel / (kFactSide - 1),
                  (size_.height - 1) * options.mm_per_pixel / (kFactSide - 1));
  const bool is_there = options.method == FlattenMethod::kHighPass || degree > 0;
  acts = is_there && std::max(tilt_deg, range_deg) > options.sigma_deg;
}

Result<SlowSlopes> slow_slopes(View<const float> right, View<const float> up,
                               View<const std::uint16_t> status, const FlattenOptions& options) {
  const SlopeMap map = {right, up, status};
  if (Result<void> good = check(map, options); !good) return std::move(good).error();
  SlowSlopes slow;
  slow.size_ = right.size();
  slow.method = options.method;
  if (options.method == FlattenMethod::kHighPass) {
    slow.field_ = SlowSlopes::Grids{slow_plane(map, right, options), slow_plane(map, up, options)};
  } else {
    std::optional<FitWindow> window;
    if (options.method == FlattenMethod::kRepeat) window = window_of_repeats(right.size(), *options.repeat);
    slow.lacks_repeats = options.method == FlattenMethod::kRepeat && !window;
    if (slow.lacks_repeats) slow.method = FlattenMethod::kHann;
    if (!window) window = FitWindow{hann(right.size().width), hann(right.size().height)};
    SlopePolynomial polynomial;
    for (slow.degree = options.degree; slow.degree > 0; --slow.degree) {
      polynomial = SlopePolynomial(right.size(), slow.degree);
      if (!fit_under(*window, map, options.threads, polynomial))
        return unusable_slopes(ErrorKind::kBadData, "too few pixels have slopes", "look at the status map");
      if (takes_what_it_holds(polynomial, map, options.threads)) break;
    }
    slow.field_ = std::move(polynomial);
  }
  slow.state_facts(options);
  return slow;
}

void flatten(const SlowSlopes& slow, View<const std::uint16_t> status, View<float> right, View<float> up,
             int threads) {
  const auto width = static_cast<std::size_t>(slow.size().width);
  parallel_for(static_cast<std::size_t>(slow.size().height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    std::vector<float> of_right(width), of_up(width);
    slow.read(y, of_right.data(), of_up.data());
    for (std::size_t x = 0; x < width; ++x) {
      const int column = static_cast<int>(x);
      if (!status.empty() && (status(column, y) & kNoSolution) != 0) continue;
      right(column, y) -= of_right[x];
      up(column, y) -= of_up[x];
    }
  });
}

Image<float> removed_slopes(const SlowSlopes& slow, int threads) {
  Image<float> map(slow.size(), 2);
  parallel_for(static_cast<std::size_t>(map.height()), threads, [&](std::size_t y, int) {
    slow.read(static_cast<int>(y), map.plane(0).row(static_cast<int>(y)),
              map.plane(1).row(static_cast<int>(y)));
  });
  return map;
}

}  // namespace weft::material
