// SPDX-License-Identifier: Apache-2.0
#include "solver/gates/told_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/image/fourier.h"
#include "solver/transport/cloth_spread.h"

namespace weft::solver {
namespace {

using Complex = std::complex<float>;

// Chosen on bench/cloths and on scenes at six resolutions: by a look the misfit falls by 0.0024
// and 4.3 sigma at most without spread, by 0.0026 and 5.5 sigma at least with it.
constexpr double kLeastGain = 0.0025, kLeastSure = 5;
// A look that costs little comes first.
// Looks that cost little come first; a second one where a first gains so much.
struct Look {
  double share, mean;
  bool is_second = false;
};
constexpr std::array<Look, 3> kLooks = {{{0.1, 6.5}, {0.15, 3.0}, {0.3, 6.5, true}}};
constexpr double kHardly = 5e-4;
constexpr std::array kShares = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
// No cloth spreads more: reflectance that departs from Lambert's law passes for it.
constexpr double kMostShare = 0.75;
constexpr std::array kMeans = {2.0, 3.0, 4.5, 6.5, 9.0};
constexpr std::array<std::size_t, 2> kFirstMeans = {1, 3};  // that all shares are tried with
constexpr double kLeastMean = 2.5;  // nearer, yarns of a few cells that are not resolved pass for spread
constexpr double kBeside = 0.15;    // of a share
// Beside what trials differ by, share and slopes are off by this, and slopes by this share of how far they
// are turned up (as the logarithm of the factor).
constexpr double kSigmaOfModel = 0.02, kSigmaOfGain = 0.12;
// Rms; steeper cloth hides light from itself, which passes for spread. The lesser direction over the other.
constexpr double kLeastSlope = 0.04, kMostSlope = 0.55, kLeastAcross = 0.25;
constexpr int kBorder = 20, kReach = 16, kDirections = 8, kEdge = 8, kBlock = 24;
constexpr double kOutlier = 1.5;  // of the median step
constexpr double kLeastUp = 0.1;  // of a normal

struct Steps {
  std::vector<float> length, hidden;  // of log length and of u, from cell to cell
  std::vector<int> block;             // that each is in
  double slope2 = 0;                  // mean
};

struct Trial {
  double share = 0, mean = 0;
  std::vector<double> misfit;  // of each block
  double slope2 = 0;

  double sum() const {
    double all = 0;
    for (const double m : misfit) all += m;
    return all;
  }
};

// Two real planes as one complex one.
void spread_pair(View<Complex> pair, double share, double mean, bool undo) {
  const int width = pair.width(), height = pair.height();
  transform_plane(pair, 1);
  const double scale = 1 / (static_cast<double>(width) * height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double seen = seen_of_wave(share, mean, std::hypot(frequency(x, width), frequency(y, height)));
      // Conjugate before the second transform, which makes it the inverse one.
      pair.row(y)[x] = std::conj(pair.row(y)[x]) * static_cast<float>(scale * (undo ? 1 / seen : seen));
    }
  }
  transform_plane(pair, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) pair.row(y)[x] = std::conj(pair.row(y)[x]);
  }
}

// Vectors with a mirrored border.
struct Field {
  Image<Complex> xy, z;

  explicit Field(Size size) : xy(size), z(size) {}
  void spread(double share, double mean, bool undo) {
    spread_pair(xy.plane(), share, mean, undo);
    spread_pair(z.plane(), share, mean, undo);
  }
  double length(int x, int y) const {
    return std::hypot(std::abs(static_cast<double>(xy(x, y).real())), static_cast<double>(xy(x, y).imag()),
                      static_cast<double>(z(x, y).real()));
  }
  void set(int x, int y, const std::array<double, 3>& v) {
    xy(x, y) = {static_cast<float>(v[0]), static_cast<float>(v[1])};
    z(x, y) = {static_cast<float>(v[2]), 0};
  }
  std::array<double, 3> at(int x, int y) const {
    return {static_cast<double>(xy(x, y).real()), static_cast<double>(xy(x, y).imag()),
            static_cast<double>(z(x, y).real())};
  }
};

template <typename At>
void fill(Field& field, const At& at) {
  for (int y = 0; y < field.z.height(); ++y) {
    for (int x = 0; x < field.z.width(); ++x) field.set(x, y, at(x, y));
  }
}

// The shape that a trial makes of a window.
struct Shape {
  Image<float> normal;
  Image<double> length;  // |S(n)|, with the border
};

Shape shape_of(const LambertWindow& window, double share, double mean) {
  constexpr int kRounds = 2;
  const Size inner = window.albedo.size();
  const Size size = {inner.width + 2 * kBorder, inner.height + 2 * kBorder};
  const auto seen = [&](int x, int y) {
    const int u = mirrored(x - kBorder, inner.width), v = mirrored(y - kBorder, inner.height);
    return std::array<double, 3>{static_cast<double>(window.normal(u, v, 0)),
                                 static_cast<double>(window.normal(u, v, 1)),
                                 static_cast<double>(window.normal(u, v, 2))};
  };
  Shape shape = {Image<float>(inner, 3), Image<double>(size)};
  for (int y = 0; y < size.height; ++y) std::fill_n(shape.length.plane().row(y), size.width, 1.0);
  Field field(size);
  for (int round = 0; round < (share > 0 ? kRounds : 1); ++round) {
    fill(field, [&](int x, int y) {
      std::array<double, 3> v = seen(x, y);
      for (double& c : v) c *= shape.length(x, y);
      return v;
    });
    if (share > 0) field.spread(share, mean, true);
    fill(field, [&](int x, int y) {
      std::array<double, 3> v = field.at(x, y);
      const double length = std::max(field.length(x, y), 1e-6);
      for (double& c : v) c /= length;
      return v;
    });
    for (int y = 0; y < inner.height; ++y) {
      for (int x = 0; x < inner.width; ++x) {
        const std::array<double, 3> n = field.at(x + kBorder, y + kBorder);
        for (int c = 0; c < 3; ++c)
          shape.normal(x, y, c) = static_cast<float>(n[static_cast<std::size_t>(c)]);
      }
    }
    if (share == 0) continue;
    field.spread(share, mean, false);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) shape.length(x, y) = std::max(field.length(x, y), 1e-6);
    }
  }
  return shape;
}

// A point that a cell looks at over its relief.
struct LookedAt {
  int dx, dy;
  double distance;
};

// Those of a direction, which points up where `y` is above 0: at every cell first, then at every second.
std::vector<LookedAt> looked_at(double x, double y) {
  std::vector<LookedAt> points;
  for (int r = 1; r < kReach; r += r < kReach / 2 ? 1 : 2) {
    const int dx = static_cast<int>(std::lround(r * x)), dy = -static_cast<int>(std::lround(r * y));
    points.push_back({dx, dy, std::hypot(dx, dy)});
  }
  return points;
}

// F(e) of solver/transport/slices.h up to an elevation of this tangent, halved.
double hemisphere_below(double tangent, double towards, double up) {
  const double square = tangent * tangent;
  return 0.5 * (towards * (std::atan(tangent) + tangent / (1 + square)) + up * square / (1 + square));
}

// Heights in cells whose slopes come closest to those of the normals (Frankot and Chellappa, PAMI 10(4),
// 1988), of a surface that goes on as a mirror. Differences of neighbours would leave fine relief too flat,
// and less of the sky hidden than is.
Image<float> heights_of(const Image<float>& normal) {
  const Size size = normal.size(), twice = {2 * size.width, 2 * size.height};
  Image<Complex> slopes(twice);
  for (int y = 0; y < twice.height; ++y) {
    for (int x = 0; x < twice.width; ++x) {
      const int u = mirrored(x, size.width), v = mirrored(y, size.height);
      const float up = std::max(normal(u, v, 2), static_cast<float>(kLeastUp));
      const float right = -normal(u, v, 0) / up, down = normal(u, v, 1) / up;
      slopes(x, y) = {u == x ? right : -right, v == y ? down : -down};
    }
  }
  transform_plane(slopes.plane(), 1);
  Image<Complex> heights(twice);
  const double scale = 1 / (static_cast<double>(twice.width) * twice.height);
  for (int y = 0; y < twice.height; ++y) {
    for (int x = 0; x < twice.width; ++x) {
      const double fx = frequency(x, twice.width), fy = frequency(y, twice.height);
      const double square = 2 * std::numbers::pi * (fx * fx + fy * fy);
      if (square == 0) continue;
      const std::complex<double> here(slopes(x, y));
      const std::complex<double> there(
          std::conj(slopes((twice.width - x) % twice.width, (twice.height - y) % twice.height)));
      // The spectra of the two real planes, from that of both.
      const std::complex<double> right = 0.5 * (here + there),
                                 down = std::complex<double>(0, -0.5) * (here - there);
      const std::complex<double> height = std::complex<double>(0, -scale / square) * (fx * right + fy * down);
      heights(x, y) = Complex(std::conj(height));
    }
  }
  transform_plane(heights.plane(), 1);
  Image<float> real(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) real(x, y) = heights(x, y).real();
  }
  return real;
}

// The share of the sky that the relief of a shape hides from each cell. It is that of a few steps from cell
// to cell: nearer than a cell noise would hide the sky.
Image<float> hidden_sky(const Image<float>& normal) {
  const Size size = normal.size();
  const Image<float> solved = heights_of(normal);
  Image<float> height({size.width + 2 * kReach, size.height + 2 * kReach}), hidden(size);
  for (int y = 0; y < height.height(); ++y) {
    for (int x = 0; x < height.width(); ++x)
      height(x, y) = solved(mirrored(x - kReach, size.width), mirrored(y - kReach, size.height));
  }
  for (int direction = 0; direction < kDirections; ++direction) {
    const double turn = 2 * std::numbers::pi * direction / kDirections;
    const double dx = std::cos(turn), dy = std::sin(turn);
    const std::vector<LookedAt> points = looked_at(dx, dy);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto up = static_cast<double>(normal(x, y, 2));
        const double towards =
            static_cast<double>(normal(x, y, 0)) * dx + static_cast<double>(normal(x, y, 1)) * dy;
        const double own = -towards / std::max(up, kLeastUp);
        const auto here = static_cast<double>(height(x + kReach, y + kReach));
        double horizon = own;
        for (const LookedAt& point : points) {
          const auto there = static_cast<double>(height(x + kReach + point.dx, y + kReach + point.dy));
          horizon = std::max(horizon, (there - here) / point.distance);
        }
        hidden(x, y) +=
            static_cast<float>(2.0 / kDirections *
                               (hemisphere_below(horizon, towards, up) - hemisphere_below(own, towards, up)));
      }
    }
  }
  return hidden;
}

double slope2_at(const Image<float>& normal, int x, int y, int axis) {
  const double up = std::max(static_cast<double>(normal(x, y, 2)), kLeastUp);
  return std::pow(static_cast<double>(normal(x, y, axis)) / up, 2);
}

// Its blocks are numbered from `first_block`.
Steps steps_of(const LambertWindow& window, int first_block, double share, double mean) {
  const Shape shape = shape_of(window, share, mean);
  const Image<float> hidden = hidden_sky(shape.normal);
  const Size size = window.albedo.size();
  const auto log_length = [&](int x, int y) {
    return std::log(static_cast<double>(window.albedo(x, y))) -
           std::log(shape.length(x + kBorder, y + kBorder));
  };
  const int across = (size.width - 2 * kEdge + kBlock - 1) / kBlock;
  Steps steps;
  for (int y = kEdge; y < size.height - kEdge; ++y) {
    for (int x = kEdge; x < size.width - kEdge; ++x) {
      steps.slope2 += slope2_at(shape.normal, x, y, 0) + slope2_at(shape.normal, x, y, 1);
      const double here = log_length(x, y), sky = static_cast<double>(hidden(x, y));
      const int block = first_block + (y - kEdge) / kBlock * across + (x - kEdge) / kBlock;
      for (const auto& [dx, dy] : {std::pair{window.step, 0}, {0, window.step}}) {
        steps.length.push_back(static_cast<float>(log_length(x + dx, y + dy) - here));
        steps.hidden.push_back(static_cast<float>(static_cast<double>(hidden(x + dx, y + dy)) - sky));
        steps.block.push_back(block);
      }
    }
  }
  steps.slope2 /= static_cast<double>(steps.block.size() / 2);
  return steps;
}

class Cloth {
 public:
  Cloth(std::span<const LambertWindow> windows, int threads) : windows_(windows), threads_(threads) {
    for (const LambertWindow& window : windows) {
      first_block_.push_back(blocks_);
      const auto count = [](int side) { return (side - 2 * kEdge + kBlock - 1) / kBlock; };
      blocks_ += count(window.albedo.width()) * count(window.albedo.height());
    }
  }

  Trial tried(double share, double mean) {
    std::vector<Steps> of_windows(windows_.size());
    parallel_for(windows_.size(), threads_, [&](std::size_t i, int) {
      of_windows[i] = steps_of(windows_[i], first_block_[i], share, mean);
    });
    Trial trial = {share, mean, std::vector<double>(static_cast<std::size_t>(blocks_)), 0};
    for (const Steps& steps : of_windows) {
      trial.slope2 += steps.slope2 / static_cast<double>(windows_.size());
    }
    if (scale_ == 0) scale_ = kOutlier * median_step(of_windows);
    const double c = bounced(of_windows);
    for (const Steps& steps : of_windows) {
      for (std::size_t i = 0; i < steps.length.size(); ++i) {
        trial.misfit[static_cast<std::size_t>(steps.block[i])] += std::log1p(std::pow(off(steps, i, c), 2));
      }
    }
    return trial;
  }

 private:
  static double median_step(const std::vector<Steps>& of_windows) {
    std::vector<double> all;
    for (const Steps& steps : of_windows) {
      for (const float step : steps.length) all.push_back(std::abs(static_cast<double>(step)));
    }
    return std::max(median(std::move(all)), 1e-6);
  }
  double off(const Steps& steps, std::size_t i, double c) const {
    return (static_cast<double>(steps.length[i]) - c * static_cast<double>(steps.hidden[i])) / scale_;
  }
  // c, by weights that are fitted again and again.
  double bounced(const std::vector<Steps>& of_windows) const {
    constexpr int kRounds = 8;
    double c = 0;
    for (int round = 0; round < kRounds; ++round) {
      double both = 0, square = 0;
      for (const Steps& steps : of_windows) {
        for (std::size_t i = 0; i < steps.length.size(); ++i) {
          const double weight = 1 / (1 + std::pow(off(steps, i, c), 2));
          const auto u = static_cast<double>(steps.hidden[i]);
          both += weight * u * static_cast<double>(steps.length[i]);
          square += weight * u * u;
        }
      }
      c = square > 0 ? std::max(both / square, 0.0) : 0;
    }
    return c;
  }

  std::span<const LambertWindow> windows_;
  int threads_;
  std::vector<int> first_block_;
  int blocks_ = 0;
  double scale_ = 0;  // of steps; from the first trial
};

// All shares with a near and a far distance, then all distances with shares beside the best.
std::vector<Trial> tried_around_the_best(Cloth& cloth) {
  std::vector<Trial> trials;
  for (const double share : kShares) {
    for (const std::size_t mean : kFirstMeans) trials.push_back(cloth.tried(share, kMeans[mean]));
  }
  const double best = std::ranges::min_element(trials, {}, &Trial::sum)->share;
  for (const double share : kShares) {
    if (std::abs(share - best) > kBeside) continue;
    for (std::size_t mean = 0; mean < kMeans.size(); ++mean) {
      if (std::ranges::count(kFirstMeans, mean) == 0) trials.push_back(cloth.tried(share, kMeans[mean]));
    }
  }
  return trials;
}

// By how many of its own standard deviations `trial` is worse than `other`, from block to block.
double worse_by(const Trial& trial, const Trial& other) {
  const auto n = static_cast<double>(trial.misfit.size());
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < trial.misfit.size(); ++i) {
    const double difference = trial.misfit[i] - other.misfit[i];
    sum += difference;
    square += difference * difference;
  }
  const double variance = std::max(square - sum * sum / n, 0.0) * n / std::max(n - 1, 1.0);
  return variance > 0 ? sum / std::sqrt(variance) : 0;
}

bool promises(Cloth& cloth, const Trial& none) {
  double most = 0;
  for (const Look& each : kLooks) {
    if (each.is_second && most < kHardly) return false;
    const Trial look = cloth.tried(each.share, each.mean);
    const double gain = 1 - look.sum() / none.sum();
    if (gain > kLeastGain && worse_by(look, none) < -kLeastSure) return true;
    most = std::max(most, gain);
  }
  return false;
}

// Whether slopes lie in two directions, and are steep enough.
bool can_tell(std::span<const LambertWindow> windows) {
  double x2 = 0, y2 = 0, cells = 0;
  for (const LambertWindow& window : windows) {
    for (int y = 0; y < window.albedo.height(); ++y) {
      for (int x = 0; x < window.albedo.width(); ++x) {
        x2 += slope2_at(window.normal, x, y, 0);
        y2 += slope2_at(window.normal, x, y, 1);
        ++cells;
      }
    }
  }
  if (cells == 0) return false;
  const double slope = std::sqrt((x2 + y2) / cells);
  return std::min(x2, y2) > std::pow(kLeastAcross, 2) * std::max(x2, y2) && slope > kLeastSlope &&
         slope < kMostSlope;
}

ToldSpread mean_of(const std::vector<Trial>& trials, const Trial& none, const Trial& best) {
  double weights = 0, share = 0, share2 = 0, log_mean = 0, log_gain = 0, log_gain2 = 0;
  for (const Trial& trial : trials) {
    const double weight = std::exp(-0.5 * std::pow(std::max(worse_by(trial, best), 0.0), 2));
    const double gained = 0.5 * std::log(trial.slope2 / none.slope2);
    weights += weight;
    share += weight * trial.share;
    share2 += weight * trial.share * trial.share;
    log_mean += weight * std::log(trial.mean);
    log_gain += weight * gained;
    log_gain2 += weight * gained * gained;
  }
  share /= weights;
  log_gain /= weights;
  ToldSpread told;
  told.share = share;
  told.mean_cells = std::exp(log_mean / weights);
  told.sigma_share = std::hypot(std::sqrt(std::max(share2 / weights - share * share, 0.0)), kSigmaOfModel);
  told.slope_gain = std::exp(log_gain);
  told.sigma_slope = std::hypot(std::sqrt(std::max(log_gain2 / weights - log_gain * log_gain, 0.0)),
                                kSigmaOfModel, kSigmaOfGain * log_gain);
  told.gain = 1 - best.sum() / none.sum();
  told.sure = -worse_by(best, none);
  return told;
}

}  // namespace

std::optional<ToldSpread> told_spread(std::span<const LambertWindow> windows, int threads) {
  if (windows.empty() || !can_tell(windows)) return {};
  Cloth cloth(windows, threads);
  const Trial none = cloth.tried(0, kMeans.front());
  if (!promises(cloth, none)) return {};
  const std::vector<Trial> trials = tried_around_the_best(cloth);
  const Trial& best = *std::ranges::min_element(trials, {}, &Trial::sum);
  if (best.share > kMostShare) return {};
  const ToldSpread told = mean_of(trials, none, best);
  return told.mean_cells > kLeastMean ? std::optional(told) : std::nullopt;
}

}  // namespace weft::solver
