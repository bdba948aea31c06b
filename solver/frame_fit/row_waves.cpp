// SPDX-License-Identifier: Apache-2.0
#include "solver/frame_fit/row_waves.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <span>

#include "core/base/statistics.h"
#include "core/base/vec.h"

namespace weft::solver {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kFewestRows = 24;
constexpr double kFewestWaves = 2, kShortestPeriod = 3;  // over the frame; rows of cells
constexpr double kWaveWide = 5;                          // sigma; beyond, an error counts as that much
constexpr double kWaveFrom_sigmas = 8;
constexpr double kLeastAlike = 0.88;  // of a wave's power in each column, that which all columns share
constexpr std::size_t kMostTried = 24;
constexpr int kMostHarmonics = 9;
constexpr std::size_t kFewestLitCells = 4;  // cells of a row

// Rows of numbers without what polynomials of the third degree explain.
class Rows {
 public:
  explicit Rows(std::size_t count) : basis_(static_cast<Eigen::Index>(count), 4), window_(count) {
    for (std::size_t y = 0; y < count; ++y) {
      const double t = 2.0 * static_cast<double>(y) / static_cast<double>(count - 1) - 1;
      basis_.row(static_cast<Eigen::Index>(y)) << 1, t, t * t, t * t * t;
      window_[y] =
          0.5 - 0.5 * std::cos(2 * kPi * (static_cast<double>(y) + 0.5) / static_cast<double>(count));
    }
    factor_ = (basis_.transpose() * basis_).inverse() * basis_.transpose();
  }

  void detrend(std::vector<double>& values) const {
    Eigen::Map<Eigen::VectorXd> v(values.data(), basis_.rows());
    v -= basis_ * (factor_ * v);
  }
  // The wave of `waves` periods over the rows, its amplitude as it is.
  Complex wave(std::span<const double> values, double waves) const {
    const double turn = 2 * kPi * waves / static_cast<double>(values.size());
    const Complex step = std::polar(1.0, -turn);
    Complex phase = 1, sum = 0;
    double weight = 0;
    for (std::size_t y = 0; y < values.size(); ++y) {
      sum += window_[y] * values[y] * phase;
      weight += window_[y];
      phase *= step;
    }
    return 2.0 * sum / weight;
  }

 private:
  Eigen::MatrixXd basis_, factor_;
  std::vector<double> window_;
};

bool is_lit(const FrameCells& cells, const CellFit& fit, std::size_t cell, std::size_t k) {
  return cells.value[cell * cells.count + k] > kLitFrom * fit.brightness[cell];
}

// Calls what(row, column, error) for what is lit in a photograph.
template <typename What>
void for_each_error(const FrameCells& cells, const CellFit& fit, std::size_t k, const What& what) {
  const double most = kWaveWide * fit.sigma;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.columns; ++x) {
      const auto cell =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(cells.columns) + static_cast<std::size_t>(x);
      const double error = static_cast<double>(fit.error[cell * cells.count + k]);
      if (std::isfinite(error) && is_lit(cells, fit, cell, k))
        what(static_cast<std::size_t>(y), static_cast<std::size_t>(x), std::clamp(error, -most, most), cell);
    }
  }
}

std::vector<std::vector<double>> mean_errors(const FrameCells& cells, const CellFit& fit, const Rows& rows,
                                             std::span<const std::size_t> strangers) {
  std::vector<std::vector<double>> all;
  for (std::size_t k = 0; k < cells.count; ++k) {
    std::vector<double> sum(static_cast<std::size_t>(cells.rows)), lit(sum.size());
    for_each_error(cells, fit, k,
                   [&](std::size_t y, std::size_t, double error, std::size_t) { sum[y] += error, ++lit[y]; });
    for (std::size_t y = 0; y < sum.size(); ++y) sum[y] = lit[y] >= kFewestLitCells ? sum[y] / lit[y] : 0;
    rows.detrend(sum);
    if (std::ranges::find(strangers, k) != strangers.end()) std::ranges::fill(sum, 0);
    all.push_back(std::move(sum));
  }
  return all;
}

double power(const std::vector<std::vector<double>>& rows_of, const Rows& rows, double waves) {
  double sum = 0;
  for (const std::vector<double>& values : rows_of) sum += std::norm(rows.wave(values, waves));
  return sum;
}

// What the columns of photographs share of their waves: the power of the mean wave over the mean power, that
// of noise, which waves of near periods have too, taken off.
double alikeness(const FrameCells& cells, const CellFit& fit, const Rows& rows, double waves,
                 std::span<const std::size_t> strangers) {
  const std::array<double, 4> near = {waves - 4, waves - 3, waves + 3, waves + 4};
  double shared = 0, each = 0;
  std::vector<double> noise(near.size());
  for (std::size_t k = 0; k < cells.count; ++k) {
    if (std::ranges::find(strangers, k) != strangers.end()) continue;
    std::vector<std::vector<double>> columns(static_cast<std::size_t>(cells.columns),
                                             std::vector<double>(static_cast<std::size_t>(cells.rows)));
    for_each_error(cells, fit, k,
                   [&](std::size_t y, std::size_t x, double error, std::size_t) { columns[x][y] = error; });
    Complex mean = 0;
    for (std::vector<double>& column : columns) {
      rows.detrend(column);
      const Complex wave = rows.wave(column, waves);
      mean += wave / static_cast<double>(columns.size());
      each += std::norm(wave) / static_cast<double>(columns.size());
      for (std::size_t i = 0; i < near.size(); ++i)
        noise[i] += std::norm(rows.wave(column, std::abs(near[i]))) / static_cast<double>(columns.size());
    }
    shared += std::norm(mean);
  }
  const double of_wave = each - std::min(std::ranges::min(noise), 0.8 * each);
  return of_wave > 0 ? std::sqrt(shared / of_wave) : 0;
}

// The most likely number of waves near `waves`.
double refined(const std::vector<std::vector<double>>& rows_of, const Rows& rows, double waves) {
  double low = waves - 1, high = waves + 1;
  constexpr double kGolden = 0.6180339887498949;
  for (int step = 0; step < 30; ++step) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    (power(rows_of, rows, a) > power(rows_of, rows, b) ? high : low) =
        power(rows_of, rows, a) > power(rows_of, rows, b) ? b : a;
  }
  return (low + high) / 2;
}

// The logarithm of a photograph's light by row, of lit cells; the cloth is in it.
std::vector<std::vector<double>> row_light(const FrameCells& cells, const CellFit& fit, const Rows& rows) {
  std::vector<std::vector<double>> all;
  for (std::size_t k = 0; k < cells.count; ++k) {
    std::vector<double> sum(static_cast<std::size_t>(cells.rows)), lit(sum.size());
    for_each_error(cells, fit, k, [&](std::size_t y, std::size_t, double, std::size_t cell) {
      sum[y] += std::log(static_cast<double>(cells.value[cell * cells.count + k]));
      ++lit[y];
    });
    double last = 0;
    for (std::size_t y = 0; y < sum.size(); ++y)
      last = sum[y] = lit[y] >= kFewestLitCells ? sum[y] / lit[y] : last;
    rows.detrend(sum);
    all.push_back(std::move(sum));
  }
  return all;
}

// Waves of a multiple of the first, by photograph. What photographs share is the cloth's, where it is more
// than what waves of any phase leave in a mean.
std::vector<Complex> harmonic(const std::vector<std::vector<double>>& light, const Rows& rows, double waves) {
  constexpr double kShared = 2;
  std::vector<Complex> all;
  Complex mean = 0;
  double squares = 0;
  for (const std::vector<double>& values : light) {
    all.push_back(rows.wave(values, waves));
    mean += all.back() / static_cast<double>(light.size());
    squares += std::norm(all.back());
  }
  const double by_chance = std::sqrt(squares) / static_cast<double>(light.size());
  if (std::abs(mean) > kShared * by_chance) {
    for (Complex& wave : all) wave -= mean;
  }
  return all;
}

}  // namespace

double RowWaves::largest() const {
  return amplitude.empty() ? 0 : std::ranges::max(amplitude);
}

std::optional<RowWaves> find_row_waves(const FrameCells& cells, const CellFit& fit,
                                       std::span<const std::size_t> strangers) {
  const auto count = static_cast<std::size_t>(cells.rows);
  if (count < kFewestRows) return std::nullopt;
  const Rows rows(count);
  const std::vector<std::vector<double>> errors = mean_errors(cells, fit, rows, strangers);
  const auto most = static_cast<std::size_t>(static_cast<double>(count) / kShortestPeriod);
  std::vector<double> powers(most + 1);
  for (std::size_t waves = 1; waves <= most; ++waves)
    powers[waves] = power(errors, rows, static_cast<double>(waves));
  const double floor = median(std::vector(powers.begin() + 1, powers.end()));

  std::vector<std::size_t> order(powers.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return powers[a] > powers[b]; });
  for (std::size_t i = 0; i < std::min(kMostTried, order.size()); ++i) {
    const std::size_t waves = order[i];
    const double rms = std::sqrt(powers[waves] / static_cast<double>(cells.count));
    if (powers[waves] < kWaveFrom_sigmas * kWaveFrom_sigmas * floor || rms < kLeastWave) break;
    if (static_cast<double>(waves) < kFewestWaves) continue;
    if (alikeness(cells, fit, rows, static_cast<double>(waves), strangers) < kLeastAlike) continue;

    RowWaves found;
    const double first = refined(errors, rows, static_cast<double>(waves));
    found.period_rows = static_cast<double>(count) / first;
    found.sigma = std::sqrt(floor / static_cast<double>(cells.count));
    const std::vector<std::vector<double>> light = row_light(cells, fit, rows);
    std::vector<std::vector<double>> logs(cells.count, std::vector<double>(count));
    for (int n = 1; n <= kMostHarmonics && n * first <= static_cast<double>(most); ++n) {
      // The errors alone tell whether there is such a wave: light has the cloth in it.
      const double rms_of_errors =
          std::sqrt(power(errors, rows, n * first) / static_cast<double>(cells.count));
      if (n > 1 && rms_of_errors < std::max(kWaveFrom_sigmas * found.sigma, 0.25 * kLeastWave)) continue;
      const std::vector<Complex> waves_of = harmonic(light, rows, n * first);
      for (std::size_t k = 0; k < cells.count; ++k) {
        if (n == 1) found.amplitude.push_back(std::abs(waves_of[k]));
        const Complex step = std::polar(1.0, 2 * kPi * n * first / static_cast<double>(count));
        Complex phase = 1;
        for (std::size_t y = 0; y < count; ++y, phase *= step) logs[k][y] += (waves_of[k] * phase).real();
      }
    }
    for (std::size_t k = 0; k < cells.count; ++k) {
      std::vector<float>& gain = found.gain.emplace_back();
      const double own = std::sqrt(std::norm(rows.wave(errors[k], first)));
      if (own < kWaveFrom_sigmas * found.sigma) continue;
      for (const double log : logs[k]) gain.push_back(static_cast<float>(std::exp(log)));
    }
    return found;
  }
  return std::nullopt;
}

}  // namespace weft::solver
