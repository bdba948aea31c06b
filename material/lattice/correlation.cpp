// SPDX-License-Identifier: Apache-2.0
#include "material/lattice/correlation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/image/fourier.h"
#include "core/solve/solve_record.h"
#include "material/cubic.h"
#include "material/smooth_map.h"

namespace weft::material {
namespace {

using Complex = std::complex<float>;

constexpr double kTrend_px = 64, kSmoothing_px = 0.8, kDarkest = 1e-4;

bool is_solved(const Surface& surface, int x, int y) {
  return (surface.status(x, y) & kNoSolution) == 0;
}

float channel_value(const Surface& surface, int channel, int x, int y) {
  if (channel < 2) return surface.slope(x, y, channel);
  double luminance = 0;
  for (int p = 0; p < surface.albedo.planes(); ++p) luminance += static_cast<double>(surface.albedo(x, y, p));
  return static_cast<float>(std::log(std::max(luminance / surface.albedo.planes(), kDarkest)));
}

// One channel of the crop, without what changes slowly.
Image<float> detail_of(const Surface& surface, int channel, Rect crop, int threads) {
  const Size size = {crop.width(), crop.height()};
  Image<float> value(size), trend(size), solved(size);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const bool counts = is_solved(surface, crop.x0 + x, crop.y0 + y);
      solved(x, y) = counts;
      value(x, y) = counts ? channel_value(surface, channel, crop.x0 + x, crop.y0 + y) : 0;
      trend(x, y) = value(x, y);
    }
  });
  smooth(trend.plane(), kTrend_px, threads);
  smooth(solved.plane(), kTrend_px, threads);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const bool counts = is_solved(surface, crop.x0 + x, crop.y0 + y);
      value(x, y) = counts ? value(x, y) - trend(x, y) / std::max(solved(x, y), 1e-3F) : 0;
    }
  });
  return value;
}

bool has_small_factors(int n) {
  for (const int factor : {2, 3, 5}) {
    while (n % factor == 0) n /= factor;
  }
  return n == 1;
}

// The power of two real planes that a complex one holds, the second times i; what noise adds is damped.
void to_power(View<Complex> spectrum, int threads) {
  const int w = spectrum.width(), h = spectrum.height();
  const auto damping = [](int k, int n) {
    const double cycles = static_cast<double>(std::min(k, n - k)) / n;
    return std::exp(-2 * kPi * kPi * kSmoothing_px * kSmoothing_px * cycles * cycles);
  };
  parallel_for(static_cast<std::size_t>(h / 2 + 1), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row), back_y = (h - y) % h;
    for (int x = 0; x < w; ++x) {
      const int back_x = (w - x) % w;
      if (y == back_y && x > back_x) continue;
      const std::complex<double> here = spectrum(x, y), there = std::conj(spectrum(back_x, back_y));
      const double damped = damping(x, w) * damping(y, h);
      const std::complex<double> power = {std::norm(here + there) / 4, std::norm(here - there) / 4};
      // Both are even; the conjugate makes the forward transform the inverse one.
      spectrum(x, y) = spectrum(back_x, back_y) = Complex(damped * std::conj(power));
    }
  });
}

// Correlations of two planes by one transform: real parts of the first, imaginary parts of the second.
Image<Complex> products_of(const Image<float>& first, const Image<float>* second, int threads) {
  const auto padded = [](int n) {  // so that lags of half the size meet nothing of the next period
    int smooth = n + n / 2 + 1;
    while (!has_small_factors(smooth)) ++smooth;
    return smooth;
  };
  Image<Complex> plane({padded(first.width()), padded(first.height())});
  for (int y = 0; y < first.height(); ++y) {
    for (int x = 0; x < first.width(); ++x) plane(x, y) = {first(x, y), second ? (*second)(x, y) : 0};
  }
  transform_plane(plane.plane(), threads);
  to_power(plane.plane(), threads);
  transform_plane(plane.plane(), threads);
  return plane;
}

// What a plane's products by lag say of it, and its variance.
struct Correlated {
  Correlation correlation;
  double variance;
};

Correlated correlated(const Image<Complex>& products, bool second, Size size) {
  const auto value = [&](int x, int y) {  // lags, y up
    const int w = products.width(), h = products.height();
    const Complex sum = products((x + w) % w, (h - y) % h);
    const double overlap =
        static_cast<double>(size.width - std::abs(x)) * static_cast<double>(size.height - std::abs(y));
    return static_cast<double>(second ? -sum.imag() : sum.real()) / overlap;
  };
  const int reach = std::min(size.width, size.height) / 2;
  const double variance = value(0, 0);
  Image<float> out({2 * reach + 1, 2 * reach + 1});
  for (int y = -reach; y <= reach && variance > 0; ++y) {
    for (int x = -reach; x <= reach; ++x)
      out(reach + x, reach - y) = static_cast<float>(value(x, y) / variance);
  }
  return {Correlation(std::move(out)), variance};
}

double level_of(const Correlation& correlation) {
  const auto peaks = correlation.peaks(0, 3, 0.5 * correlation.reach());
  if (peaks.size() < 4) return 0;
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += peaks[static_cast<std::size_t>(i)].value / 4;
  return sum;
}

}  // namespace

Correlation::Correlation(Image<float> values) : values_(std::move(values)), reach_(values_.width() / 2) {}

std::optional<double> Correlation::at(Vec2 lag) const {
  const double left = std::floor(lag.x), below = std::floor(lag.y);
  if (!(left > -reach_ && below > -reach_ && left < reach_ - 1 && below < reach_ - 1)) return std::nullopt;
  const int x = static_cast<int>(left), y = static_cast<int>(below);
  double sum = 0;
  for (int j = -1; j <= 2; ++j) {
    double row = 0;
    for (int i = -1; i <= 2; ++i)
      row += cubic_weight(x + i - lag.x) * static_cast<double>(whole(x + i, y + j));
    sum += cubic_weight(y + j - lag.y) * row;
  }
  return sum;
}

Correlation::Peak Correlation::top_of(int x, int y) const {
  const auto value = [&](int dx, int dy) { return static_cast<double>(whole(x + dx, y + dy)); };
  Peak peak = {{static_cast<double>(x), static_cast<double>(y)}, value(0, 0)};
  const auto rise = [&](double before, double after, double& place) {
    const double bend = 2 * value(0, 0) - before - after;
    const double shift = bend > 1e-12 ? std::clamp((after - before) / 2 / bend, -0.6, 0.6) : 0.0;
    place += shift;
    peak.value += shift * (after - before) / 4;
  };
  rise(value(-1, 0), value(1, 0), peak.lag.x);
  rise(value(0, -1), value(0, 1), peak.lag.y);
  return peak;
}

std::optional<Correlation::Peak> Correlation::peak_near(Vec2 lag, double radius) const {
  const int r = std::max(2, static_cast<int>(std::lround(radius)));
  if (!(std::max(std::abs(lag.x), std::abs(lag.y)) + r + 2 < reach_)) return std::nullopt;
  const int cx = static_cast<int>(std::lround(lag.x)), cy = static_cast<int>(std::lround(lag.y));
  int best_x = cx, best_y = cy;
  for (int y = cy + r; y >= cy - r; --y) {
    for (int x = cx - r; x <= cx + r; ++x) {
      if (whole(x, y) > whole(best_x, best_y)) best_x = x, best_y = y;
    }
  }
  if (std::max(std::abs(best_x - cx), std::abs(best_y - cy)) == r) return std::nullopt;
  return top_of(best_x, best_y);
}

std::vector<Correlation::Peak> Correlation::peaks(double least, double nearest, double farthest) const {
  const int far = std::min(static_cast<int>(farthest), reach_ - 3);
  std::vector<Peak> found;
  for (int y = 0; y <= far; ++y) {
    for (int x = y == 0 ? 1 : -far; x <= far; ++x) {
      const double distance = std::hypot(x, y);
      const float here = whole(x, y);
      if (!(distance >= nearest && distance <= farthest && static_cast<double>(here) > least)) continue;
      bool is_top = true;
      for (int j = -2; j <= 2 && is_top; ++j) {
        for (int i = -2; i <= 2; ++i) is_top = is_top && whole(x + i, y + j) <= here;
      }
      if (is_top) found.push_back(top_of(x, y));
    }
  }
  std::ranges::stable_sort(found, [](const Peak& a, const Peak& b) { return a.value > b.value; });
  return found;
}

Correlations correlate(const Surface& surface, Rect crop, int threads) {
  const Size size = {crop.width(), crop.height()};
  Correlations out;
  const auto take = [&](std::size_t channel, Correlated&& found) {
    out.of[channel] = std::move(found.correlation);
    out.variance[channel] = found.variance;
    out.level[channel] = level_of(out.of[channel]);
  };
  {
    const Image<float> right = detail_of(surface, 0, crop, threads),
                       up = detail_of(surface, 1, crop, threads);
    const Image<Complex> products = products_of(right, &up, threads);
    take(0, correlated(products, false, size));
    take(1, correlated(products, true, size));
  }
  take(2, correlated(products_of(detail_of(surface, 2, crop, threads), nullptr, threads), false, size));
  return out;
}

Correlation mean_of(std::span<const Correlation* const> correlations) {
  const int reach = correlations[0]->reach();
  Image<float> mean({2 * reach + 1, 2 * reach + 1});
  const auto count = static_cast<float>(correlations.size());
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      float sum = 0;
      for (const Correlation* each : correlations) sum += std::clamp(each->whole(x, y), -1.0F, 1.0F);
      mean(reach + x, reach - y) = sum / count;
    }
  }
  return Correlation(std::move(mean));
}

}  // namespace weft::material
