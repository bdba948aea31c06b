// SPDX-License-Identifier: Apache-2.0
#include "solver/frame_fit/row_waves.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <span>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/vec.h"
#include "solver/frame_fit/tilt_law.h"

namespace weft::solver {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kFewestRows = 24;
constexpr double kFewestWaves = 2, kShortestPeriod = 3;  // over the frame; rows of cells
constexpr double kWaveWide = 5;                          // sigma; beyond, an error counts as that much
constexpr double kWaveFrom_sigmas = 8;
// What all columns share of a wave, of its power in each: where cloth explains most of the light of rows;
// where it does not; and where it explains next to nothing of a line that stands out by kStandsOut_sigmas.
constexpr double kLeastAlike = 0.88, kLeastAlikeBeyondCloth = 0.75, kLeastAlikeOfLamps = 0.45;
constexpr double kStandsOut_sigmas = 12;
// A share of a line's power, that no function of tilt explains: of a lamp's where cloth explains most of the
// light of rows (where it does not, tilt may be of the flicker itself); and of one that all columns share so
// much that it is a lamp's even so.
constexpr double kLeastBeyondTilt = 0.03, kSurelyBeyondTilt = 0.2, kAlikeOfAll = 0.95;
constexpr double kWidthOfLine = 2.5;  // waves over the frame, by the window
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

// Numbers of every row of every photograph.
using RowsOf = std::vector<std::vector<double>>;

// Calls what(row, column, cell, error) for what is lit in a photograph.
template <typename What>
void for_each_error(const FrameCells& cells, const CellFit& fit, std::size_t k, const What& what) {
  const double most = kWaveWide * fit.sigma;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.columns; ++x) {
      const std::size_t cell = cells.cell_at(x, y);
      const double error = static_cast<double>(fit.error[cell * cells.count + k]);
      if (std::isfinite(error) && is_lit(cells, fit, cell, k))
        what(static_cast<std::size_t>(y), static_cast<std::size_t>(x), cell, std::clamp(error, -most, most));
    }
  }
}

// Means over the lit cells of each row of number(cell, k, error), what is smooth taken off; a row without
// such cells is like the one before.
template <typename Number>
RowsOf row_means(const FrameCells& cells, const CellFit& fit, const Rows& rows, const Number& number) {
  RowsOf all;
  for (std::size_t k = 0; k < cells.count; ++k) {
    std::vector<double> sum(static_cast<std::size_t>(cells.rows)), lit(sum.size());
    for_each_error(cells, fit, k, [&](std::size_t y, std::size_t, std::size_t cell, double error) {
      sum[y] += number(cell, k, error);
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

// What rows are over what the other photographs predict, a share of their light.
RowsOf row_errors(const FrameCells& cells, const CellFit& fit, const Rows& rows) {
  return row_means(cells, fit, rows, [&](std::size_t cell, std::size_t k, double error) {
    return error * static_cast<double>(fit.brightness[cell] / cells.value[cell * cells.count + k]);
  });
}

// The same where light is any function of how a cell leans.
RowsOf row_errors_by_tilt(const FrameCells& cells, const CellFit& fit, const Rows& rows, int threads) {
  CellFit by_tilt = fit;
  parallel_for(cells.count, threads, [&](std::size_t k, int) {
    const std::vector<float> errors = errors_by_tilt(cells, fit, k);
    for (std::size_t cell = 0; cell < errors.size(); ++cell)
      by_tilt.error[cell * cells.count + k] = errors[cell];
  });
  return row_errors(cells, by_tilt, rows);
}

// The logarithm of their light; the cloth is in it.
RowsOf row_light(const FrameCells& cells, const CellFit& fit, const Rows& rows) {
  return row_means(cells, fit, rows, [&](std::size_t cell, std::size_t k, double) {
    return std::log(static_cast<double>(cells.value[cell * cells.count + k]));
  });
}

double power(const RowsOf& values_of, const Rows& rows, double waves) {
  double sum = 0;
  for (const std::vector<double>& values : values_of) sum += std::norm(rows.wave(values, waves));
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
                   [&](std::size_t y, std::size_t x, std::size_t, double error) { columns[x][y] = error; });
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

// The most likely number of waves near `waves`, by golden sections.
double refined(const RowsOf& errors, const Rows& rows, double waves) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 30;
  double low = waves - 1, high = waves + 1;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double power_a = power(errors, rows, a), power_b = power(errors, rows, b);
  for (int step = 0; step < kSteps; ++step) {
    if (power_a > power_b) {
      high = b, b = a, power_b = power_a;
      a = high - kGolden * (high - low), power_a = power(errors, rows, a);
    } else {
      low = a, a = b, power_a = power_b;
      b = low + kGolden * (high - low), power_b = power(errors, rows, b);
    }
  }
  return (low + high) / 2;
}

// How strong a period is in the light of rows: what albedo and tilt of the cloth explain of it, to first
// order, and what they do not. Amplitudes, without what near periods have of them.
struct InLight {
  double by_cloth = 0, rest = 0;
  double near = 0;  ///< what cloth explains of near periods

  // A weave along the rows has errors that are the same in all columns, too, but the light of all lamps has
  // its yarns.
  bool is_weave() const { return rest < kOfCloth * by_cloth; }
  bool is_of_lamps() const { return rest > kBeyondCloth * by_cloth; }
  double least_alike(double sigmas) const {
    if (is_of_lamps() && sigmas > kStandsOut_sigmas) return kLeastAlikeOfLamps;
    return rest > by_cloth ? kLeastAlikeBeyondCloth : kLeastAlike;
  }
  // Whether the light of rows says what each lamp does: little of cloth is in it.
  bool tells_lamps() const { return near < kMostNear * rest && rest > by_cloth; }

  static constexpr double kOfCloth = 0.5, kBeyondCloth = 2, kMostNear = 0.4;
};

// The light of rows, and what of it one albedo and one tilt a row would explain.
class LightOfCloth {
 public:
  LightOfCloth(const FrameCells& cells, const CellFit& fit, const Rows& rows)
      : light_(row_light(cells, fit, rows)), rows_(rows) {
    Eigen::MatrixXd cloth(static_cast<Eigen::Index>(cells.count), kClothTerms);
    for (std::size_t k = 0; k < cells.count; ++k) {
      Vec3 sum;
      for (std::size_t cell = 0; cell < cells.cells(); ++cell)
        sum = sum + cells.direction[cell * cells.count + k];
      const double height = std::max(sum.z, kLeastHeight * static_cast<double>(cells.cells()));
      cloth.row(static_cast<Eigen::Index>(k)) << 1, sum.x / height, sum.y / height;
    }
    explains_ = cloth * (cloth.transpose() * cloth).completeOrthogonalDecomposition().pseudoInverse() *
                cloth.transpose();
  }

  InLight of(double waves) const {
    const auto [by_cloth, rest] = powers(waves);
    const double around = near(waves);
    return {std::sqrt(std::max(0.0, by_cloth - around)), std::sqrt(rest), std::sqrt(around)};
  }

  // What lamps that flicker have most likely of a period, by photograph: cloth and lamps are as strong as
  // their light shows, and a lamp's phase says nothing of another's.
  std::vector<Complex> of_lamps(double waves, const std::vector<bool>& flickers) const {
    const Eigen::VectorXcd light = waves_of(waves), explained = explains_ * light;
    const auto count = static_cast<double>(light.size());
    Eigen::VectorXd may(light.size());
    for (Eigen::Index k = 0; k < may.size(); ++k) may[k] = flickers[static_cast<std::size_t>(k)] ? 1 : 0;
    const double share = may.sum() / count;
    const double lamp = (light - explained).squaredNorm() / ((count - kClothTerms) * share);
    const double by_chance = kClothTerms * lamp * share;
    constexpr double kMostByChance = 4;
    const bool is_of_weave = explained.squaredNorm() - near(waves) > kMostByChance * by_chance;
    const double cloth = (is_of_weave ? explained.squaredNorm() - by_chance : near(waves)) / kClothTerms;
    constexpr double kNoise = 1e-3;  // of a lamp's power
    Eigen::MatrixXd variance = cloth * explains_;
    variance.diagonal() += lamp * may + Eigen::VectorXd::Constant(may.size(), kNoise * lamp);
    const Eigen::VectorXcd likely =
        lamp * may.asDiagonal() * variance.ldlt().solve(light.real()) +
        Complex(0, 1) * (lamp * may.asDiagonal() * variance.ldlt().solve(light.imag()));
    return {likely.data(), likely.data() + likely.size()};
  }

 private:
  double near(double waves) const {
    std::vector<double> all;
    for (const double off : {-4, -3, 3, 4}) all.push_back(powers(std::abs(waves + off)).first);
    return median(std::move(all));
  }
  std::pair<double, double> powers(double waves) const {
    const Eigen::VectorXcd light = waves_of(waves), explained = explains_ * light;
    return {explained.squaredNorm(), (light - explained).squaredNorm()};
  }
  Eigen::VectorXcd waves_of(double waves) const {
    Eigen::VectorXcd all(explains_.rows());
    for (std::size_t k = 0; k < light_.size(); ++k)
      all[static_cast<Eigen::Index>(k)] = rows_.wave(light_[k], waves);
    return all;
  }

  static constexpr Eigen::Index kClothTerms = 3;
  static constexpr double kLeastHeight = 0.01;  // of a light over the table

  RowsOf light_;
  const Rows& rows_;
  Eigen::MatrixXd explains_;
};

FrameCells divided_by(const FrameCells& cells, const RowsOf& logs) {
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
  bool follow(const CellFit& fit, const LightOfCloth& light) {
    constexpr double kFits = 0.5, kIsEven = 0.25;  // of the power of the errors
    constexpr int kTimes = 3;
    constexpr double kStep = 0.8;
    const RowsOf before = row_errors(cells_, fit, rows_);
    for (const double number : numbers_) add(light.of_lamps(number, flickers_), number, 1);
    RowsOf left = errors_left();
    if (power_of(left) > kFits * power_of(before)) {
      for (std::vector<double>& log : logs_) std::ranges::fill(log, 0);
      left = before;
    }
    for (int i = 0; i < kTimes; ++i) {
      for (const double number : numbers_) add(waves_of(left, number), number, kStep);
      left = errors_left();
    }
    return power_of(left) < kIsEven * power_of(before);
  }

  double amplitude(std::size_t k) const { return std::abs(rows_.wave(logs_[k], numbers_.front())); }
  std::vector<float> gain(std::size_t k) const {
    std::vector<float> gain;
    for (const double log : logs_[k]) gain.push_back(static_cast<float>(std::exp(log)));
    return gain;
  }

 private:
  RowsOf errors_left() const {
    const FrameCells even = divided_by(cells_, logs_);
    return row_errors(even, fit_cells(even, threads_), rows_);
  }

  double power_of(const RowsOf& errors) const {
    double sum = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      for (const double number : numbers_) sum += flickers_[k] ? std::norm(rows_.wave(errors[k], number)) : 0;
    }
    return sum;
  }

  std::vector<Complex> waves_of(const RowsOf& values, double number) const {
    std::vector<Complex> all;
    for (const std::vector<double>& each : values) all.push_back(rows_.wave(each, number));
    return all;
  }

  void add(const std::vector<Complex>& waves, double number, double share) {
    const Complex step = std::polar(1.0, 2 * kPi * number / static_cast<double>(cells_.rows));
    for (std::size_t k = 0; k < waves.size(); ++k) {
      Complex phase = flickers_[k] ? share * waves[k] : 0;
      for (double& log : logs_[k]) log += phase.real(), phase *= step;
    }
  }

  const FrameCells& cells_;
  const Rows& rows_;
  std::vector<double> numbers_;  // of waves over the frame: the first, and its multiples that are there
  std::vector<bool> flickers_;   // by photograph
  int threads_;
  RowsOf logs_;  // of the light of rows
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

Spectrum spectrum_of(const RowsOf& errors, const Rows& rows, std::size_t most) {
  Spectrum spectrum;
  spectrum.powers.resize(most + 1);
  for (std::size_t waves = 1; waves <= most; ++waves)
    spectrum.powers[waves] = power(errors, rows, static_cast<double>(waves));
  spectrum.floor = median(std::vector(spectrum.powers.begin() + 1, spectrum.powers.end()));
  return spectrum;
}

// Whether a number of waves is that of a line, or a multiple of it, as far as the window tells.
bool is_of(double line, double waves) {
  const double times = std::max(1.0, std::round(waves / line));
  return std::abs(waves - times * line) < kWidthOfLine;
}

// A number of waves that stands out of the errors.
struct Line {
  double waves = 0;
  double sigmas = 0;  // of its amplitude
  InLight in_light;
  double beyond_tilt = 0;  // of its power: what no function of tilt explains
  double alike = 0;        // 0: not looked at

  bool is_weave() const {
    if (in_light.is_weave()) return alike <= kAlikeOfAll;
    return in_light.rest < in_light.by_cloth && beyond_tilt < kLeastBeyondTilt;
  }
  bool is_of_lamps() const { return alike >= in_light.least_alike(sigmas); }
  bool tells_lamps() const {
    return in_light.tells_lamps() && (alike > kLeastAlike || in_light.is_of_lamps());
  }
};

// Looks at lines of errors, the strongest first.
class Lines {
 public:
  Lines(const FrameCells& cells, const CellFit& fit, std::span<const std::size_t> strangers, int threads)
      : cells_(cells),
        fit_(fit),
        strangers_(strangers),
        threads_(threads),
        rows_(static_cast<std::size_t>(cells.rows)),
        errors_(row_errors(cells, fit, rows_)),
        cloth_(cells, fit, rows_) {
    forget_strangers(errors_);
    spectrum_ = spectrum_of(errors_, rows_, static_cast<std::size_t>(most()));
  }

  // That of lamps, if there is one.
  std::optional<Line> of_lamps() {
    std::vector<double> weave;  // lines of it
    for (const std::size_t number : spectrum_.strongest()) {
      const auto waves = static_cast<double>(number);
      if (!stands_out(number)) break;
      if (waves < kFewestWaves || std::ranges::any_of(weave, [&](double line) { return is_of(line, waves); }))
        continue;
      const Line line = look_at(number);
      if (line.is_weave())
        weave.push_back(waves);
      else if (line.is_of_lamps())
        return line;
    }
    return std::nullopt;
  }

  RowWaves follow(const Line& line) const {
    RowWaves found;
    const double first = refined(errors_, rows_, line.waves);
    found.period_rows = static_cast<double>(cells_.rows) / first;
    found.sigma = std::sqrt(spectrum_.floor / static_cast<double>(cells_.count));
    std::vector<bool> flickers;
    for (const std::vector<double>& each : errors_)
      flickers.push_back(std::abs(rows_.wave(each, first)) > kWaveFrom_sigmas * found.sigma);
    Waves light(cells_, rows_, with_harmonics(first, found.sigma), flickers, threads_);
    found.are_even = light.follow(fit_, cloth_) && line.tells_lamps();
    for (std::size_t k = 0; k < cells_.count; ++k) {
      found.amplitude.push_back(flickers[k] ? light.amplitude(k) : 0);
      found.gain.push_back(flickers[k] ? light.gain(k) : std::vector<float>());
    }
    return found;
  }

 private:
  double most() const { return static_cast<double>(cells_.rows) / kShortestPeriod; }
  double rms(double power_of_wave) const {
    return std::sqrt(power_of_wave / static_cast<double>(cells_.count));
  }
  bool stands_out(std::size_t number) const {
    const double own = spectrum_.powers[number];
    return own >= kWaveFrom_sigmas * kWaveFrom_sigmas * spectrum_.floor && rms(own) >= kLeastWave;
  }
  void forget_strangers(RowsOf& values) const {
    for (const std::size_t k : strangers_) std::ranges::fill(values[k], 0);
  }

  Line look_at(std::size_t number) {
    const double own = spectrum_.powers[number];
    Line line;
    line.waves = static_cast<double>(number);
    line.sigmas = std::sqrt(own / spectrum_.floor);
    line.in_light = cloth_.of(line.waves);
    if (by_tilt_.empty()) {
      by_tilt_ = row_errors_by_tilt(cells_, fit_, rows_, threads_);
      forget_strangers(by_tilt_);
    }
    line.beyond_tilt = power(by_tilt_, rows_, line.waves) / own;
    const bool may_be_of_lamps = !line.in_light.is_weave() || line.beyond_tilt > kSurelyBeyondTilt;
    if (may_be_of_lamps) line.alike = alikeness(cells_, fit_, rows_, line.waves, strangers_);
    return line;
  }

  std::vector<double> with_harmonics(double first, double sigma) const {
    std::vector<double> numbers = {first};
    for (int n = 2; n <= kMostHarmonics && n * first <= most(); ++n) {
      const double own = rms(power(errors_, rows_, n * first));
      if (own > std::max(kWaveFrom_sigmas * sigma, 0.25 * kLeastWave)) numbers.push_back(n * first);
    }
    return numbers;
  }

  const FrameCells& cells_;
  const CellFit& fit_;
  std::span<const std::size_t> strangers_;
  int threads_;
  Rows rows_;
  RowsOf errors_, by_tilt_;
  LightOfCloth cloth_;
  Spectrum spectrum_;
};

}  // namespace

std::optional<RowWaves> find_row_waves(const FrameCells& cells, const CellFit& fit,
                                       std::span<const std::size_t> strangers, int threads) {
  if (static_cast<std::size_t>(cells.rows) < kFewestRows) return std::nullopt;
  Lines lines(cells, fit, strangers, threads);
  const std::optional<Line> line = lines.of_lamps();
  if (!line) return std::nullopt;
  return lines.follow(*line);
}

}  // namespace weft::solver
