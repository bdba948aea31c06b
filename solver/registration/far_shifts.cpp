// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/far_shifts.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/image/fourier.h"

namespace weft::solver {
namespace {

using Spectrum = Image<std::complex<float>>;

constexpr int kMeanRadius = 8;
constexpr int kMostSearches = 5;
constexpr std::size_t kFewestShots = 5;
// A weave repeats: a peak is as good as another if it is lower by less than this share of what a peak may
// lack, and the nearest one is taken.
constexpr double kAsGood = 0.02, kLack = 0.1;
// Shots that lie within so many pixels of each other lie at one place.
constexpr int kOnePlace_px = 1;

// Sums over rectangles of a picture and of its squares.
class AreaSums {
 public:
  explicit AreaSums(View<const float> picture)
      : width_(picture.width() + 1), sums_(static_cast<std::size_t>(width_ * (picture.height() + 1))) {
    for (int y = 0; y < picture.height(); ++y) {
      Pair row = {};
      for (int x = 0; x < picture.width(); ++x) {
        const double v = static_cast<double>(picture(x, y));
        row = {row[0] + v, row[1] + v * v};
        const Pair& above = at(x + 1, y);
        at(x + 1, y + 1) = {above[0] + row[0], above[1] + row[1]};
      }
    }
  }
  using Pair = std::array<double, 2>;
  Pair over(Rect r) const {
    const Pair &a = at(r.x0, r.y0), &b = at(r.x1, r.y0), &c = at(r.x0, r.y1), &d = at(r.x1, r.y1);
    return {d[0] - b[0] - c[0] + a[0], d[1] - b[1] - c[1] + a[1]};
  }

 private:
  Pair& at(int x, int y) { return sums_[static_cast<std::size_t>(y * width_ + x)]; }
  const Pair& at(int x, int y) const { return sums_[static_cast<std::size_t>(y * width_ + x)]; }
  int width_;
  std::vector<Pair> sums_;
};

// Without what is not finite and without its means over the neighbourhood.
Image<float> detail_of(const Image<float>& picture) {
  const Size size = picture.size();
  double sum = 0;
  std::int64_t count = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (!std::isfinite(picture(x, y))) continue;
      sum += static_cast<double>(picture(x, y));
      ++count;
    }
  }
  const auto mean = static_cast<float>(count > 0 ? sum / static_cast<double>(count) : 0);
  Image<float> detail(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) detail(x, y) = std::isfinite(picture(x, y)) ? picture(x, y) : mean;
  }
  const AreaSums sums(detail.plane());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Rect around = {std::max(0, x - kMeanRadius), std::max(0, y - kMeanRadius),
                           std::min(size.width, x + kMeanRadius + 1),
                           std::min(size.height, y + kMeanRadius + 1)};
      detail(x, y) -= static_cast<float>(sums.over(around)[0] / static_cast<double>(around.pixels()));
    }
  }
  return detail;
}

struct Offset {
  int x = 0, y = 0;
  friend bool operator==(const Offset&, const Offset&) = default;
  int square() const { return x * x + y * y; }
};

// Where a shot fits its prediction, and how well.
struct Match {
  Offset at;
  double z = 0, z_unmoved = 0;
};

class Search {
 public:
  Search(std::span<const Image<float>> shots, std::span<const Vec3> lights, int threads)
      : size_(shots.front().size()),
        reach_(static_cast<int>(kFarReach * std::min(size_.width, size_.height))),
        inner_{reach_, reach_, size_.width - reach_, size_.height - reach_},
        threads_(threads),
        details_(shots.size()),
        spectra_(shots.size()),
        offsets_(shots.size()),
        placed_(shots.size(), 1) {
    for (const Vec3& l : lights) lights_.emplace_back(l.x, l.y, l.z);
    parallel_for(shots.size(), threads, [&](std::size_t k, int) { details_[k] = detail_of(shots[k]); });
    for (std::size_t k = 0; k < shots.size(); ++k) {
      spectra_[k] = spectrum_of(details_[k].plane(), Offset());
      sums_.emplace_back(details_[k].plane());
    }
  }

  // Places one shot after another, each on what those before say: the next is lit most like one of them.
  void grow() {
    std::ranges::fill(offsets_, Offset());
    std::ranges::fill(placed_, 0);
    placed_[0] = 1;
    for (std::size_t placed = 1; placed < offsets_.size(); ++placed) {
      std::size_t next = 0;
      double nearest = -2;
      for (std::size_t k = 0; k < offsets_.size(); ++k) {
        for (std::size_t j = 0; j < offsets_.size(); ++j) {
          if (placed_[k] || !placed_[j] || lights_[k].dot(lights_[j]) <= nearest) continue;
          nearest = lights_[k].dot(lights_[j]);
          next = k;
        }
      }
      offsets_[next] = match(next).at;
      placed_[next] = 1;
    }
  }

  // Lays each shot on what the others say, until none moves.
  void run() {
    for (int i = 0; i < kMostSearches; ++i) {
      bool moved = false;
      for (std::size_t k = 0; k < offsets_.size(); ++k) {
        const Offset before = std::exchange(offsets_[k], match(k).at);
        moved = moved || !(before == offsets_[k]);
      }
      if (!moved) return;
    }
  }

  FarShifts result() {
    measure_from_most();
    FarShifts result;
    double before = 0, after = 0;
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const Match m = match(k);
      const auto left = [](double z) { return 1 - std::max(z, 0.0) * std::max(z, 0.0); };
      const bool lies_still = offsets_[k] == Offset();
      const double z = lies_still ? m.z_unmoved : correlation(k, offsets_[k]);
      before += left(m.z_unmoved);
      after += left(z);
      result.shots.push_back(
          {offsets_[k].x, offsets_[k].y, lies_still ? 0 : 1 - left(z) / std::max(left(m.z_unmoved), 1e-9)});
    }
    result.explained = before > 0 ? 1 - after / before : 0;
    result.found = is_movement(result);
    return result;
  }

 private:
  Spectrum spectrum_of(View<const float> picture, Offset corner) const {
    Spectrum spectrum(size_);
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) spectrum(corner.x + x, corner.y + y) = picture(x, y);
    }
    transform_plane(spectrum.plane(), threads_);
    return spectrum;
  }

  // What the other shots, as they are laid, predict of one over the inner part.
  Image<float> prediction(std::size_t k) const {
    Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
    for (std::size_t j = 0; j < lights_.size(); ++j) {
      if (j != k && placed_[j]) m += lights_[j] * lights_[j].transpose();
    }
    // The third direction of lights on one ring is known worst; it must not blow up.
    m += 1e-3 * m.trace() * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d of_k = m.inverse() * lights_[k];
    Image<float> predicted({inner_.width(), inner_.height()});
    for (std::size_t j = 0; j < lights_.size(); ++j) {
      if (j == k || !placed_[j]) continue;
      const auto weight = static_cast<float>(lights_[j].dot(of_k));
      for (int y = 0; y < predicted.height(); ++y) {
        const float* from = details_[j].plane().row(inner_.y0 + offsets_[j].y + y);
        for (int x = 0; x < predicted.width(); ++x)
          predicted(x, y) += weight * from[inner_.x0 + offsets_[j].x + x];
      }
    }
    return predicted;
  }

  // Correlation coefficients of a shot with its prediction at every offset within reach.
  Image<float> correlations(std::size_t k) const {
    const Image<float> predicted = prediction(k);
    const auto n = static_cast<double>(inner_.pixels());
    const AreaSums::Pair p = AreaSums(predicted.plane()).over({0, 0, inner_.width(), inner_.height()});
    const double p_variance = p[1] / n - p[0] * p[0] / n / n;
    // conj(P) X, then the inverse transform as the conjugate of the transform of the conjugate.
    Spectrum product = spectrum_of(predicted.plane(), {inner_.x0, inner_.y0});
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) product(x, y) *= std::conj(spectra_[k](x, y));
    }
    transform_plane(product.plane(), threads_);
    Image<float> z({2 * reach_ + 1, 2 * reach_ + 1});
    for (int dy = -reach_; dy <= reach_; ++dy) {
      for (int dx = -reach_; dx <= reach_; ++dx) {
        const AreaSums::Pair s =
            sums_[k].over({inner_.x0 + dx, inner_.y0 + dy, inner_.x1 + dx, inner_.y1 + dy});
        const double variance = s[1] / n - s[0] * s[0] / n / n;
        const int u = (dx + size_.width) % size_.width, v = (dy + size_.height) % size_.height;
        const double product_mean =
            static_cast<double>(product(u, v).real()) / static_cast<double>(size_.pixels()) / n;
        const double covariance = product_mean - p[0] / n * (s[0] / n);
        const double scale = std::sqrt(std::max(p_variance, 0.0) * std::max(variance, 0.0));
        z(dx + reach_, dy + reach_) = static_cast<float>(scale > 0 ? covariance / scale : 0);
      }
    }
    return z;
  }

  double correlation(std::size_t k, Offset at) const {
    return static_cast<double>(correlations(k)(at.x + reach_, at.y + reach_));
  }

  // The nearest of the peaks that are as good as the best.
  Match match(std::size_t k) const {
    const Image<float> z = correlations(k);
    const auto is_peak = [&](int x, int y) {
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, z.height() - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, z.width() - 1); ++u) {
          if (z(u, v) > z(x, y)) return false;
        }
      }
      return true;
    };
    Match best = {{}, static_cast<double>(z(reach_, reach_)), static_cast<double>(z(reach_, reach_))};
    double highest = best.z;
    std::vector<std::pair<Offset, double>> peaks;
    for (int y = 0; y < z.height(); ++y) {
      for (int x = 0; x < z.width(); ++x) {
        if (!is_peak(x, y)) continue;
        peaks.push_back({{x - reach_, y - reach_}, static_cast<double>(z(x, y))});
        highest = std::max(highest, peaks.back().second);
      }
    }
    const double as_good = highest - kAsGood * (kLack + 1 - highest);
    if (best.z > as_good) return best;
    bool any = false;
    for (const auto& [at, height] : peaks) {
      if (height <= as_good || (any && at.square() >= best.at.square())) continue;
      best.at = at;
      best.z = height;
      any = true;
    }
    return best;
  }

  // Takes the place at which most shots lie off all offsets.
  void measure_from_most() {
    Offset place;
    std::ptrdiff_t most = 0;
    for (const Offset& o : offsets_) {
      const std::ptrdiff_t here = std::ranges::count_if(offsets_, [&](const Offset& other) {
        return std::abs(o.x - other.x) <= kOnePlace_px && std::abs(o.y - other.y) <= kOnePlace_px;
      });
      if (here > most || (here == most && o.square() < place.square())) {
        most = here;
        place = o;
      }
    }
    for (Offset& o : offsets_) {
      o = {std::clamp(o.x - place.x, -reach_, reach_), std::clamp(o.y - place.y, -reach_, reach_)};
      if (std::abs(o.x) <= kOnePlace_px && std::abs(o.y) <= kOnePlace_px) o = {};
    }
  }

  bool is_movement(const FarShifts& shifts) const {
    std::size_t still = 0;
    double least_explained = 1;
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const bool lies_still = offsets_[k] == Offset();
      still += lies_still ? 1 : 0;
      if (!lies_still) least_explained = std::min(least_explained, shifts.shots[k].explained);
    }
    const double least = 2 * still >= offsets_.size() ? kFarExplained : kFarExplainedOfAll;
    return still < offsets_.size() && least_explained >= least && shifts.explained >= least;
  }

  Size size_;
  int reach_;
  Rect inner_;
  int threads_;
  std::vector<Eigen::Vector3d> lights_;
  std::vector<Image<float>> details_;
  std::vector<Spectrum> spectra_;
  std::vector<AreaSums> sums_;
  std::vector<Offset> offsets_;
  std::vector<char> placed_;  // shots that predict others
};

}  // namespace

FarShifts find_far_shifts(std::span<const Image<float>> shots, std::span<const Vec3> lights, int threads) {
  constexpr int kLeastSide = 16;
  FarShifts none;
  none.shots.resize(shots.size());
  if (shots.size() < kFewestShots) return none;
  const Size size = shots.front().size();
  if (std::min(size.width, size.height) < kLeastSide) return none;
  Search search(shots, lights, threads);
  search.run();
  if (FarShifts found = search.result(); found.found) return found;
  search.grow();
  search.run();
  return search.result();
}

}  // namespace weft::solver
