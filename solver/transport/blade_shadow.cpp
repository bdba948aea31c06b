// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/blade_shadow.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace weft::solver {
namespace {

constexpr int kMostBlocks = 128;        // along the longer side, in which the edge is sought
constexpr double kReach_mm = 5;         // to either side of the edge
constexpr int kStrips = 24;             // along the edge
constexpr int kFewestStrips = 8;        // that show the edge
constexpr double kLeastContrast = 0.6;  // of the shadow's depth
constexpr double kRises = 0.01;         // by which the blade itself is brighter than its shadow
constexpr double kBetweenYarns = 0.02;  // of the light, which yarns throw at each other and no cloth spreads
constexpr double kHuber = 2;            // sigma
constexpr int kRounds = 40;

struct Point {
  double x = 0, y = 0;
};

// The edge of the shadow: at `offset` from the origin along the normal, which points to the lit side.
struct Edge {
  double normal_rad = 0, offset = 0;

  Point normal() const { return {std::cos(normal_rad), std::sin(normal_rad)}; }
  double distance(Point p) const { return normal().x * p.x + normal().y * p.y - offset; }
  double along(Point p) const { return normal().x * p.y - normal().y * p.x; }
};

Error no_shadow(std::string why) {
  return {ErrorKind::kBadData, "the picture with the blade cannot be used", "", std::move(why),
          "lay a straight opaque edge some millimetres above the cloth, so that the edge of its shadow "
          "crosses the middle of the picture beside the blade"};
}

// Light with the blade over that without, in blocks of `side` cells; NaN where half of them say nothing.
Image<float> block_ratios(const BladeCells& cells, int side) {
  const Size size = cells.plain.size();
  Image<float> ratios({(size.width + side - 1) / side, (size.height + side - 1) / side});
  for (int y = 0; y < ratios.height(); ++y) {
    for (int x = 0; x < ratios.width(); ++x) {
      double plain = 0, bladed = 0;
      int count = 0;
      for (int v = y * side; v < std::min((y + 1) * side, size.height); ++v) {
        for (int u = x * side; u < std::min((x + 1) * side, size.width); ++u) {
          const double p = cells.plain(u, v), b = cells.bladed(u, v);
          if (!std::isfinite(p) || !std::isfinite(b)) continue;
          plain += p, bladed += b, ++count;
        }
      }
      const bool says = 2 * count >= side * side && plain > 0;
      ratios(x, y) = says ? static_cast<float>(bladed / plain) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return ratios;
}

// The straight line that most of the light's rise away from the LED agrees on, in blocks.
std::optional<Edge> likeliest_edge(const Image<float>& ratios, Point away) {
  constexpr int kTurns = 90, kStep = 2;  // of 2 degrees, blocks
  constexpr double kAgrees = 0.95;       // cosine between rise and normal
  const int far = ratios.width() + ratios.height();
  Image<double> votes({2 * far + 1, kTurns});
  const double middle = std::atan2(away.y, away.x) - std::numbers::pi / 2;
  const auto normal_of = [&](int turn) { return middle + std::numbers::pi * (turn + 0.5) / kTurns; };
  for (int y = kStep; y < ratios.height() - kStep; ++y) {
    for (int x = kStep; x < ratios.width() - kStep; ++x) {
      const double gx = ratios(x + kStep, y) - ratios(x - kStep, y);
      const double gy = ratios(x, y + kStep) - ratios(x, y - kStep);
      const double rise = std::hypot(gx, gy);
      if (!(rise > 0.1)) continue;
      for (int turn = 0; turn < kTurns; ++turn) {
        const Point n = Edge{normal_of(turn), 0}.normal();
        if (gx * n.x + gy * n.y < kAgrees * rise) continue;
        const auto at = static_cast<int>(std::lround(n.x * x + n.y * y)) + far;
        votes(at, turn) += std::min(rise, 1.0);
      }
    }
  }
  double most = 0;
  Edge best;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (int at = 0; at <= 2 * far; ++at) {
      if (votes(at, turn) <= most) continue;
      most = votes(at, turn);
      best = {normal_of(turn), static_cast<double>(at - far)};
    }
  }
  if (most < 0.25 * std::min(ratios.width(), ratios.height())) return std::nullopt;
  return best;
}

// Light at like distances from the edge within one strip along it.
struct Bin {
  int strip = 0;
  double across = 0, along = 0;  // mm
  double plain = 0, bladed = 0;

  double ratio() const { return bladed / plain; }
};

// Bins of a cell's width to kReach_mm on either side, strip by strip.
std::vector<Bin> bins_of(const BladeCells& cells, const Edge& edge) {
  const Size size = cells.plain.size();
  double first = std::numeric_limits<double>::max(), last = -first;
  const auto each_cell = [&](auto&& take) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const Point at = {cells.cell_mm * x, cells.cell_mm * y};
        const double across = edge.distance(at);
        if (std::abs(across) < kReach_mm) take(x, y, across, edge.along(at));
      }
    }
  };
  each_cell([&](int, int, double across, double along) {
    if (std::abs(across) > cells.cell_mm) return;
    first = std::min(first, along), last = std::max(last, along);
  });
  if (!(last > first)) return {};
  const int half = static_cast<int>(std::floor(kReach_mm / cells.cell_mm));
  const double strip_mm = (last - first) / kStrips;
  std::vector<Bin> all(static_cast<std::size_t>(kStrips * (2 * half + 1)));
  std::vector<int> counts(all.size());
  each_cell([&](int x, int y, double across, double along) {
    const double p = cells.plain(x, y), b = cells.bladed(x, y);
    const int strip = static_cast<int>(std::floor((along - first) / strip_mm));
    const int place = static_cast<int>(std::lround(across / cells.cell_mm)) + half;
    if (!std::isfinite(p) || !std::isfinite(b) || strip < 0 || strip >= kStrips || place < 0 ||
        place > 2 * half)
      return;
    const auto i = static_cast<std::size_t>(strip * (2 * half + 1) + place);
    Bin& bin = all[i];
    bin.strip = strip;
    bin.across += across, bin.along += along, bin.plain += p, bin.bladed += b;
    ++counts[i];
  });
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (counts[i] == 0 || !(all[i].plain > 0)) continue;
    all[i].across /= counts[i], all[i].along /= counts[i];
    bins.push_back(all[i]);
  }
  return bins;
}

// The same of all strips together, as if the edge had been found exactly.
std::vector<Bin> pooled(const std::vector<Bin>& bins, double cell_mm) {
  std::map<long, Bin> by_place;
  for (const Bin& bin : bins) {
    Bin& pool = by_place[std::lround(bin.across / cell_mm)];
    pool.across += bin.plain * bin.across;
    pool.plain += bin.plain, pool.bladed += bin.bladed;
  }
  std::vector<Bin> pools;
  for (auto& [place, pool] : by_place) {
    pool.across /= pool.plain;
    pools.push_back(pool);
  }
  return pools;
}

double mean_ratio(const std::vector<Bin>& bins, int strip, double from_mm, double to_mm) {
  double plain = 0, bladed = 0;
  for (const Bin& bin : bins) {
    if ((strip >= 0 && bin.strip != strip) || bin.across < from_mm || bin.across > to_mm) continue;
    plain += bin.plain, bladed += bin.bladed;
  }
  return plain > 0 ? bladed / plain : std::numeric_limits<double>::quiet_NaN();
}

// Those strips in which the shadow is dark and what lies beside it is lit, of `near_mm` to either side.
std::vector<Bin> strips_with_edge(std::vector<Bin> bins, double near_mm) {
  std::vector<bool> shows(kStrips);
  for (int strip = 0; strip < kStrips; ++strip) {
    const double lit = mean_ratio(bins, strip, near_mm, 2 * near_mm);
    const double dark = mean_ratio(bins, strip, -2 * near_mm, -near_mm);
    shows[static_cast<std::size_t>(strip)] = lit > 0 && dark < (1 - kLeastContrast) * lit;
  }
  std::erase_if(bins, [&](const Bin& bin) { return !shows[static_cast<std::size_t>(bin.strip)]; });
  return bins;
}

int strips_in(const std::vector<Bin>& bins) {
  std::array<bool, kStrips> seen = {};
  for (const Bin& bin : bins) seen[static_cast<std::size_t>(bin.strip)] = true;
  return static_cast<int>(std::ranges::count(seen, true));
}

// Cuts off the blade itself, which begins where the shadow ends: it has a brightness of its own.
void cut_off_blade(std::vector<Bin>& bins, double cell_mm) {
  const double lit = mean_ratio(bins, -1, 0.5 * kReach_mm, kReach_mm);
  double least = std::numeric_limits<double>::max(), end = -kReach_mm;
  for (double d = -cell_mm; d > -kReach_mm; d -= cell_mm) {
    const double here = mean_ratio(bins, -1, d - cell_mm, d + cell_mm);
    if (!std::isfinite(here)) continue;
    if (here > least + kRises * lit) {
      end = d + 3 * cell_mm;
      break;
    }
    least = std::min(least, here);
  }
  std::erase_if(bins, [&](const Bin& bin) { return bin.across < end; });
}

// What is fitted. Lengths are logarithms of millimetres.
enum Unknown { kShift, kTurn, kBlur, kLength, kLit, kSpread, kFloor, kUnknowns };
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

double normal_below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

// The share of a Gaussian of `blur` and an exponential of `length` to both sides that lies below `d`.
double spread_below(double d, double blur, double length) {
  const double a = blur / length, z = d / blur;
  const auto tail = [&](double side) {
    const double below = normal_below(side * z - a);
    return below > 0 ? std::exp(0.5 * a * a - side * d / length) * below : 0;
  };
  return normal_below(z) - 0.5 * (tail(1) - tail(-1));
}

// The same of two Gaussians of that mean distance, which spread light as far and have no peak where it
// enters.
double smoothly_below(double d, double blur, double length) {
  constexpr double kShare = 0.853553, kNarrow = 1.038279, kWide = 2.506628;  // nodes of Gauss and Laguerre
  return kShare * normal_below(d / std::hypot(blur, kNarrow * length)) +
         (1 - kShare) * normal_below(d / std::hypot(blur, kWide * length));
}

using SpreadBelow = double (*)(double d, double blur, double length);

double model(SpreadBelow below, const Vector& p, const Bin& bin) {
  const double d = bin.across - p[kShift] - p[kTurn] * bin.along;
  const double blur = std::exp(p[kBlur]), sharp = normal_below(d / blur);
  return p[kFloor] + p[kLit] * sharp + p[kSpread] * (below(d, blur, std::exp(p[kLength])) - sharp);
}

Vector slopes(SpreadBelow below, const Vector& p, const Bin& bin) {
  Vector slope;
  for (int i = 0; i < kUnknowns; ++i) {
    constexpr double kStep = 1e-5;
    Vector up = p, down = p;
    up[i] += kStep, down[i] -= kStep;
    slope[i] = (model(below, up, bin) - model(below, down, bin)) / (2 * kStep);
  }
  return slope;
}

// Normal equations of one strip.
struct Sums {
  Matrix square = Matrix::Zero();
  Vector toward = Vector::Zero();
};

// A fit, and how good it is.
struct Fit {
  Vector p = Vector::Zero();
  std::vector<double> weights;  // of the bins
  double cost = 0;
};

double share_of(const Fit& fit) {
  return fit.p[kSpread] / fit.p[kLit];
}
double mean_of(const Fit& fit) {
  return 0.5 * std::numbers::pi * std::exp(fit.p[kLength]);
}

class EdgeFit {
 public:
  EdgeFit(SpreadBelow below, const std::vector<Bin>& bins, double cell_mm)
      : below_(below), bins_(bins), cell_mm_(cell_mm) {
    for (const Bin& bin : bins) mean_ += bin.plain / static_cast<double>(bins.size());
  }

  // From the best of some blurs and distances.
  Fit from_anywhere() const {
    Fit best;
    best.cost = std::numeric_limits<double>::max();
    for (const double blur : {1.0, 2.0, 4.0}) {
      for (const double length : {1.5, 4.0, 10.0}) {
        Fit fit = start(blur * cell_mm_, length * cell_mm_);
        descend(fit, kRounds);
        if (fit.cost < best.cost) best = std::move(fit);
      }
    }
    return best;
  }

  // From what was found of fewer bins.
  Fit from(const Vector& p) const {
    Fit fit = start(1, 1);
    fit.p = p;
    fit.cost = cost_of(fit, p);
    descend(fit, kRounds);
    for (int round = 0; round < 3; ++round) {
      weigh(fit);
      descend(fit, kRounds);
    }
    return fit;
  }

  std::array<Sums, kStrips> sums(const Fit& fit) const {
    std::array<Sums, kStrips> all;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      const Vector slope = slopes(below_, fit.p, bins_[i]);
      Sums& sum = all[static_cast<std::size_t>(bins_[i].strip)];
      sum.square += fit.weights[i] * slope * slope.transpose();
      sum.toward += fit.weights[i] * slope * (bins_[i].ratio() - model(below_, fit.p, bins_[i]));
    }
    return all;
  }

 private:
  Fit start(double blur, double length) const {
    Fit fit;
    fit.p << 0, 0, std::log(blur), std::log(length), 1, 0.2, 0;
    for (const Bin& bin : bins_) fit.weights.push_back(bin.plain / mean_);
    fit.cost = cost_of(fit, fit.p);
    return fit;
  }

  double cost_of(const Fit& fit, const Vector& p) const {
    double cost = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      const double off = bins_[i].ratio() - model(below_, p, bins_[i]);
      cost += fit.weights[i] * off * off;
    }
    return cost;
  }

  // Lengths stay within what cells and reach can tell.
  Vector bounded(Vector p) const {
    p[kBlur] = std::clamp(p[kBlur], std::log(0.3 * cell_mm_), std::log(0.2 * kReach_mm));
    p[kLength] = std::clamp(p[kLength], std::log(0.5 * cell_mm_), std::log(0.4 * kReach_mm));
    return p;
  }

  // Levenberg and Marquardt's.
  void descend(Fit& fit, int rounds) const {
    double damping = 1e-3;
    for (int round = 0; round < rounds; ++round) {
      Sums sum;
      for (const Sums& strip : sums(fit)) sum.square += strip.square, sum.toward += strip.toward;
      Matrix damped = sum.square;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-12;
      const Vector tried = bounded(fit.p + damped.ldlt().solve(sum.toward));
      const double cost = cost_of(fit, tried);
      if (!(cost < fit.cost)) {
        damping *= 10;
        if (damping > 1e6) return;
        continue;
      }
      const bool is_done = cost > (1 - 1e-7) * fit.cost;
      fit.p = tried, fit.cost = cost;
      damping = std::max(damping / 10, 1e-9);
      if (is_done) return;
    }
  }

  // Huber's weights, by the median of the residuals.
  void weigh(Fit& fit) const {
    std::vector<double> off;
    for (const Bin& bin : bins_) off.push_back(std::abs(bin.ratio() - model(below_, fit.p, bin)));
    std::vector<double> sorted = off;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    const double usual = std::max(kHuber * 1.4826 * *middle, 1e-9);
    for (std::size_t i = 0; i < bins_.size(); ++i)
      fit.weights[i] = bins_[i].plain / mean_ * std::min(1.0, usual / std::max(off[i], 1e-12));
    fit.cost = cost_of(fit, fit.p);
  }

  SpreadBelow below_;
  const std::vector<Bin>& bins_;
  double cell_mm_;
  double mean_ = 0;
};

// How share and the logarithm of the distance vary when each strip in its turn is left out, by one step.
struct Spreads {
  double share = 0, length = 0;
};

Spreads jackknife(const std::array<Sums, kStrips>& strips, const Vector& p) {
  Sums all;
  for (const Sums& strip : strips) all.square += strip.square, all.toward += strip.toward;
  std::vector<Point> left_out;  // share, log of the distance
  for (const Sums& strip : strips) {
    if (strip.square.isZero()) continue;
    Matrix rest = all.square - strip.square;
    rest.diagonal().array() += 1e-12;
    const Vector q = p + rest.ldlt().solve(all.toward - strip.toward);
    left_out.push_back({q[kSpread] / q[kLit], q[kLength]});
  }
  const auto n = static_cast<double>(left_out.size());
  Point mean;
  for (const Point& each : left_out) mean = {mean.x + each.x / n, mean.y + each.y / n};
  Spreads spread;
  for (const Point& each : left_out) {
    spread.share += (each.x - mean.x) * (each.x - mean.x);
    spread.length += (each.y - mean.y) * (each.y - mean.y);
  }
  return {std::sqrt((n - 1) / n * spread.share), std::sqrt((n - 1) / n * spread.length)};
}

// By how much more spreads into the shadow than is lost beside it, a share of all light, half of the
// difference; by one step from a fit of one share. Where the blade hides its own shadow, none does.
double more_in_shadow(const std::vector<Bin>& bins, const Fit& fit) {
  using Wide = Eigen::Matrix<double, kUnknowns + 1, 1>;
  Eigen::Matrix<double, kUnknowns + 1, kUnknowns + 1> square = decltype(square)::Zero();
  Wide toward = Wide::Zero();
  for (std::size_t i = 0; i < bins.size(); ++i) {
    Wide slope;
    slope.head<kUnknowns>() = slopes(spread_below, fit.p, bins[i]);
    slope[kUnknowns] = std::abs(slope[kSpread]);
    square += fit.weights[i] * slope * slope.transpose();
    toward += fit.weights[i] * slope * (bins[i].ratio() - model(spread_below, fit.p, bins[i]));
  }
  square.diagonal().array() += 1e-12;
  const Wide step = square.ldlt().solve(toward);
  return step[kUnknowns] / fit.p[kLit];
}

}  // namespace

Result<BladeShadow> read_blade_shadow(const BladeCells& cells) {
  const Size size = cells.plain.size();
  const int side = std::max(1, (std::max(size.width, size.height) + kMostBlocks - 1) / kMostBlocks);
  const std::optional<Edge> found = likeliest_edge(block_ratios(cells, side), {cells.away_x, cells.away_y});
  if (!found) return no_shadow("no straight edge of a shadow crosses the cloth");
  // The middle of a block, in millimetres.
  const Point normal = found->normal();
  const double middle = 0.5 * (side - 1) * (normal.x + normal.y);
  const Edge edge = {found->normal_rad, cells.cell_mm * (side * found->offset + middle)};
  const double near_mm = 4 * side * cells.cell_mm;
  std::vector<Bin> bins = strips_with_edge(bins_of(cells, edge), std::min(near_mm, 0.4 * kReach_mm));
  const int strips = strips_in(bins);
  if (strips < kFewestStrips) return no_shadow("the edge of the shadow is seen on a short stretch only");
  cut_off_blade(bins, cells.cell_mm);
  const std::vector<Bin> pools = pooled(bins, cells.cell_mm);
  const EdgeFit diffusion(spread_below, bins, cells.cell_mm), smooth(smoothly_below, bins, cells.cell_mm);
  const Fit fit = diffusion.from(EdgeFit(spread_below, pools, cells.cell_mm).from_anywhere().p);
  const Fit other = smooth.from(fit.p);
  const Spreads by_strips = jackknife(diffusion.sums(fit), fit.p);

  const double share = share_of(fit), mean_mm = mean_of(fit);
  if (share > kMostSpread && by_strips.share < 0.5)
    return no_shadow("more light would spread than does in any cloth");
  BladeShadow shadow;
  shadow.spread = {share, mean_mm};
  shadow.share_sigma = std::hypot(std::hypot(by_strips.share, share_of(other) - share, kBetweenYarns),
                                  more_in_shadow(bins, fit));
  shadow.mean_sigma_mm = std::hypot(mean_mm * by_strips.length, mean_of(other) - mean_mm);
  shadow.blur_mm = std::exp(fit.p[kBlur]);
  shadow.floor = fit.p[kFloor] / (fit.p[kFloor] + fit.p[kLit]);
  double first = std::numeric_limits<double>::max(), last = -first, off = 0, weight = 0;
  for (const Bin& bin : bins) {
    first = std::min(first, bin.along), last = std::max(last, bin.along);
    const double residual = bin.ratio() - model(spread_below, fit.p, bin);
    off += bin.plain * residual * residual, weight += bin.plain;
  }
  shadow.length_mm = last - first;
  shadow.residual = std::sqrt(off / weight);
  return shadow;
}

}  // namespace weft::solver
