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

// What rows of photographs are over what the others predict, by photograph; clipped as errors are.
std::vector<std::vector<double>> row_errors(const FrameCells& cells, const CellFit& fit, const Rows& rows) {
  std::vector<std::vector<double>> all;
  for (std::size_t k = 0; k < cells.count; ++k) {
    std::vector<double> sum(static_cast<std::size_t>(cells.rows)), lit(sum.size());
    for_each_error(cells, fit, k, [&](std::size_t y, std::size_t, double error, std::size_t cell) {
      sum[y] += error * static_cast<double>(fit.brightness[cell] / cells.value[cell * cells.count + k]);
      ++lit[y];
    });
    for (std::size_t y = 0; y < sum.size(); ++y) sum[y] = lit[y] >= kFewestLitCells ? sum[y] / lit[y] : 0;
    rows.detrend(sum);
    all.push_back(std::move(sum));
  }
  return all;
}

FrameCells divided_by(const FrameCells& cells, const std::vector<std::vector<double>>& logs) {
  FrameCells even = cells;
  const std::size_t row = static_cast<std::size_t>(cells.columns) * cells.count;
  for (std::size_t i = 0; i < even.value.size(); ++i)
    even.value[i] *= static_cast<float>(std::exp(-logs[i % cells.count][i / row]));
  return even;
}

// One period, and the light that comes and goes with it.
class Waves {
 public:
  Waves(const FrameCells& cells, const Rows& rows, std::vector<double> numbers, std::vector<bool> flickers,
        int threads)
      : cells_(cells),
        rows_(rows),
        numbers_(std::move(numbers)),
        flickers_(std::move(flickers)),
        threads_(threads),
        logs_(cells.count, std::vector<double>(static_cast<std::size_t>(cells.rows))) {}

  // Whether light evens the errors out. It is told by the rows themselves, as far as that fits the errors,
  // and then by what errors are left.
  bool follow(const CellFit& fit) {
    constexpr double kFits = 0.5, kIsEven = 0.25;  // of the power of the errors
    constexpr int kTimes = 3;
    constexpr double kStep = 0.8;
    const double before = power_of(row_errors(cells_, fit, rows_));
    add(row_light(cells_, fit, rows_), 1, true);
    CellFit even = fit_cells(divided_by(cells_, logs_), threads_);
    if (power_of(row_errors(divided_by(cells_, logs_), even, rows_)) > kFits * before) {
      for (std::vector<double>& log : logs_) std::ranges::fill(log, 0);
      even = fit;
    }
    for (int i = 0; i < kTimes; ++i) {
      add(row_errors(divided_by(cells_, logs_), even, rows_), kStep, false);
      even = fit_cells(divided_by(cells_, logs_), threads_);
    }
    return power_of(row_errors(divided_by(cells_, logs_), even, rows_)) < kIsEven * before;
  }

  double amplitude(std::size_t k) const { return std::abs(rows_.wave(logs_[k], numbers_.front())); }
  std::vector<float> gain(std::size_t k) const {
    std::vector<float> gain;
    for (const double log : logs_[k]) gain.push_back(static_cast<float>(std::exp(log)));
    return gain;
  }

 private:
  double power_of(const std::vector<std::vector<double>>& errors) const {
    double sum = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      for (const double number : numbers_) sum += flickers_[k] ? std::norm(rows_.wave(errors[k], number)) : 0;
    }
    return sum;
  }

  void add(const std::vector<std::vector<double>>& light, double share, bool has_cloth) {
    for (const double number : numbers_) {
      std::vector<Complex> waves;
      if (has_cloth) waves = harmonic(light, rows_, number);
      for (std::size_t k = 0; k < light.size(); ++k) {
        if (!flickers_[k]) continue;
        const Complex wave = share * (has_cloth ? waves[k] : rows_.wave(light[k], number));
        const Complex step = std::polar(1.0, 2 * kPi * number / static_cast<double>(cells_.rows));
        Complex phase = 1;
        for (double& log : logs_[k]) log += (wave * phase).real(), phase *= step;
      }
    }
  }

  const FrameCells& cells_;
  const Rows& rows_;
  std::vector<double> numbers_;  // of waves over the frame: the first, and its multiples that are there
  std::vector<bool> flickers_;   // by photograph
  int threads_;
  std::vector<std::vector<double>> logs_;  // of the light of rows, by photograph
};

// Numbers of waves over the frame that errors have, the strongest first.
struct Spectrum {
  std::vector<double> powers;
  double floor = 0;

  std::vector<std::size_t> strongest() const {
    std::vector<std::size_t> order(powers.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return powers[a] > powers[b]; });
    order.resize(std::min(kMostTried, order.size()));
    return order;
  }
};

Spectrum spectrum_of(const std::vector<std::vector<double>>& errors, const Rows& rows, std::size_t most) {
  Spectrum spectrum;
  spectrum.powers.resize(most + 1);
  for (std::size_t waves = 1; waves <= most; ++waves)
    spectrum.powers[waves] = power(errors, rows, static_cast<double>(waves));
  spectrum.floor = median(std::vector(spectrum.powers.begin() + 1, spectrum.powers.end()));
  return spectrum;
}

}  // namespace

std::optional<RowWaves> find_row_waves(const FrameCells& cells, const CellFit& fit,
                                       std::span<const std::size_t> strangers, int threads) {
  const auto count = static_cast<std::size_t>(cells.rows);
  if (count < kFewestRows) return std::nullopt;
  const Rows rows(count);
  const std::vector<std::vector<double>> errors = mean_errors(cells, fit, rows, strangers);
  const double most = static_cast<double>(count) / kShortestPeriod;
  const Spectrum spectrum = spectrum_of(errors, rows, static_cast<std::size_t>(most));
  for (const std::size_t number : spectrum.strongest()) {
    const auto waves = static_cast<double>(number);
    const double rms = std::sqrt(spectrum.powers[number] / static_cast<double>(cells.count));
    if (spectrum.powers[number] < kWaveFrom_sigmas * kWaveFrom_sigmas * spectrum.floor || rms < kLeastWave)
      break;
    if (waves < kFewestWaves || alikeness(cells, fit, rows, waves, strangers) < kLeastAlike) continue;

    RowWaves found;
    const double first = refined(errors, rows, waves);
    found.period_rows = static_cast<double>(count) / first;
    found.sigma = std::sqrt(spectrum.floor / static_cast<double>(cells.count));
    std::vector<double> numbers = {first};
    for (int n = 2; n <= kMostHarmonics && n * first <= most; ++n) {
      const double own = std::sqrt(power(errors, rows, n * first) / static_cast<double>(cells.count));
      if (own > std::max(kWaveFrom_sigmas * found.sigma, 0.25 * kLeastWave)) numbers.push_back(n * first);
    }
    std::vector<bool> flickers;
    for (const std::vector<double>& each : errors)
      flickers.push_back(std::abs(rows.wave(each, first)) > kWaveFrom_sigmas * found.sigma);
    Waves light(cells, rows, std::move(numbers), flickers, threads);
    found.are_even = light.follow(fit);
    for (std::size_t k = 0; k < cells.count; ++k) {
      found.amplitude.push_back(flickers[k] ? light.amplitude(k) : 0);
      found.gain.push_back(flickers[k] ? light.gain(k) : std::vector<float>());
    }
    return found;
  }
  return std::nullopt;
}

}  // namespace weft::solver
