// SPDX-License-Identifier: Apache-2.0
#include "solver/deblur/sharpen.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/solve/solve_record.h"

namespace weft::solver {
namespace {

constexpr int kFrequencies = 256;  // from 0 to Nyquist's

double square(double x) {
  return x * x;
}

// Sum of squares of the weights along one axis.
double energy(const DeblurFilter& filter) {
  double sum = square(static_cast<double>(filter.weights[0]));
  for (std::size_t i = 1; i < filter.weights.size(); ++i)
    sum += 2 * square(static_cast<double>(filter.weights[i]));
  return sum;
}

double centre(const DeblurFilter& filter) {
  return square(static_cast<double>(filter.weights[0]));
}

// Weights of a Gaussian at whole pixels, at 0 and beyond; sum 1 with those at the other side.
using Taps = std::array<double, 4 * kDeblurReach + 1>;

Taps sampled_gaussian(double width_px) {
  Taps taps = {1};
  double sum = 1;
  for (std::size_t k = 1; k < taps.size(); ++k) {
    taps[k] = std::exp(-0.5 * square(static_cast<double>(k) / width_px));
    sum += 2 * taps[k];
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

double variance(const Taps& taps) {
  double sum = 0;
  for (std::size_t k = 1; k < taps.size(); ++k) sum += 2 * taps[k] * square(static_cast<double>(k));
  return sum;
}

// The sampled Gaussian with a standard deviation, narrower samples having a smaller one.
Taps taps_of(double sigma_px) {
  double narrow = 0.01, wide = kDeblurReach;
  for (int i = 0; i < 40; ++i) {
    const double middle = (narrow + wide) / 2;
    (variance(sampled_gaussian(middle)) < square(sigma_px) ? narrow : wide) = middle;
  }
  return sampled_gaussian(wide);
}

// What a blur leaves of a frequency, radians a pixel.
double left_at(const Taps& taps, double frequency) {
  double sum = taps[0];
  for (std::size_t k = 1; k < taps.size(); ++k)
    sum += 2 * taps[k] * std::cos(static_cast<double>(k) * frequency);
  return sum;
}

constexpr float kRadian = 0.017453292F;  // a degree

using Weights = std::array<float, kDeblurReach + 1>;

Weights squared(Weights weights) {
  for (float& w : weights) w *= w;
  return weights;
}

Rect grown(Rect area, int by) {
  return {area.x0 - by, area.y0 - by, area.x1 + by, area.y1 + by};
}
Rect within(Rect area, Size image) {
  return {std::max(area.x0, 0), std::max(area.y0, 0), std::min(area.x1, image.width),
          std::min(area.y1, image.height)};
}

// Zeros over a part of the plane of the image, also beyond it.
class Part {
 public:
  explicit Part(Rect area) : area_(area), values_(static_cast<std::size_t>(area.pixels())) {}

  int stride() const { return area_.width(); }
  float* at(int x, int y) {
    return values_.data() + static_cast<std::ptrdiff_t>(y - area_.y0) * stride() + (x - area_.x0);
  }
  const float* at(int x, int y) const {
    return values_.data() + static_cast<std::ptrdiff_t>(y - area_.y0) * stride() + (x - area_.x0);
  }

 private:
  Rect area_;
  std::vector<float> values_;
};

// Weighted sum of n samples in a row, each with its neighbours `step` apart.
void convolve(const Weights& weights, const float* from, std::ptrdiff_t step, int n, float* to) {
  for (int i = 0; i < n; ++i) {
    float sum = weights[0] * from[i];
    for (int k = 1; k <= kDeblurReach; ++k)
      sum += weights[static_cast<std::size_t>(k)] * (from[i - k * step] + from[i + k * step]);
    to[i] = sum;
  }
}

// Sum of the 3 x 3 samples around one.
float sum_around(const float* at, std::ptrdiff_t stride) {
  static_assert(kShareReach == 1);
  const auto row = [](const float* middle) { return middle[-1] + middle[0] + middle[1]; };
  return row(at - stride) + row(at) + row(at + stride);
}

// An area of the image on its way to being sharp, and as far around it as shares are measured.
class Sharpening {
 public:
  Sharpening(const RowsToSharpen& rows, const std::array<DeblurFilter, 3>& filters, Rect area)
      : rows_(rows),
        filters_(filters),
        area_(area),
        around_(within(grown(area, kShareReach), rows.image)),
        share_(area),
        turned_(grown(area, kShareReach)),
        noise_(grown(area, kShareReach)) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) filtered_.push_back(filtered(c, k));
    }
    for (std::size_t c = 0; c < 3; ++c) measure(c);
    for (int y = area_.y0; y < area_.y1; ++y) {
      for (int x = area_.x0; x < area_.x1; ++x) {
        *share_.at(x, y) = best_share(sum_around(turned_.at(x, y), turned_.stride()),
                                      sum_around(noise_.at(x, y), noise_.stride()));
      }
    }
    leave_out_the_unsolved();
  }

  double write(const SharpenedRows& out) const {
    double sum = 0;
    for (int y = area_.y0; y < area_.y1; ++y) {
      for (std::size_t c = 0; c < 3; ++c) write(out, c, y);
      for (int x = area_.x0; x < area_.x1; ++x) sum += static_cast<double>(*share_.at(x, y));
    }
    return sum;
  }

 private:
  // Row of the views that holds row y of the image; beyond the image its first or last.
  int row_of(int y) const { return std::clamp(y, 0, rows_.image.height - 1) - rows_.first_row; }

  // A row of albedo, normal and what the filter makes of their product, in one colour; column 0 is the
  // image's.
  struct Row {
    const float *albedo, *x, *y, *z, *to_x, *to_y, *to_z;
  };
  Row row_at(std::size_t colour, int y) const {
    const int row = row_of(y);
    const auto to = [&](std::size_t k) { return filtered_[3 * colour + k].at(0, y); };
    return {rows_.albedo[colour].row(row),
            rows_.normal[0].row(row),
            rows_.normal[1].row(row),
            rows_.normal[2].row(row),
            to(0),
            to(1),
            to(2)};
  }

  // What `fill(row, x0, n, to)` gives of the rows around each pixel of around_, summed with these weights
  // along x and y. Beyond the image its outermost pixels are repeated.
  template <typename Fill>
  Part convolved(const Weights& weights, const Fill& fill) const {
    const Rect seen = within(grown(around_, kDeblurReach), rows_.image);
    Part across({around_.x0, around_.y0 - kDeblurReach, around_.x1, around_.y1 + kDeblurReach}), out(around_);
    std::vector<float> line(static_cast<std::size_t>(around_.width() + 2 * kDeblurReach));
    const int left = seen.x0 - around_.x0 + kDeblurReach, n = seen.width();
    for (int y = around_.y0 - kDeblurReach; y < around_.y1 + kDeblurReach; ++y) {
      fill(y, seen.x0, n, line.data() + left);
      std::fill(line.begin(), line.begin() + left, line[static_cast<std::size_t>(left)]);
      std::fill(line.begin() + left + n, line.end(), line[static_cast<std::size_t>(left + n - 1)]);
      convolve(weights, line.data() + kDeblurReach, 1, around_.width(), across.at(around_.x0, y));
    }
    for (int y = around_.y0; y < around_.y1; ++y)
      convolve(weights, across.at(around_.x0, y), across.stride(), around_.width(), out.at(around_.x0, y));
    return out;
  }

  // Component k of albedo times normal in a colour, filtered.
  Part filtered(std::size_t colour, std::size_t k) const {
    return convolved(filters_[colour].weights, [&](int y, int x0, int n, float* to) {
      const float *albedo = rows_.albedo[colour].row(row_of(y)) + x0,
                  *normal = rows_.normal[k].row(row_of(y)) + x0;
      for (int i = 0; i < n; ++i) to[i] = albedo[i] * normal[i];
    });
  }

  // Variance of albedo times normal across the normal. What was measured in another colour also has the error
  // of the albedo that was put in its place.
  void fill_variance(std::size_t colour, int y, int x0, int n, float* to) const {
    const int row = row_of(y);
    const float *albedo = rows_.albedo[colour].row(row) + x0, *put = rows_.sigma_albedo[colour].row(row) + x0,
                *angle = rows_.sigma_normal_deg.row(row) + x0;
    const auto is_put = [&](int x) {
      return rows_.own_colour(x, row + rows_.first_row) == colour ? 0.F : 1.F;
    };
    const std::array<float, 2> by_phase = {is_put(x0), is_put(x0 + 1)};
    for (int i = 0; i < n; ++i) {
      const float turned = albedo[i] * angle[i] * kRadian;
      to[i] = turned * turned + by_phase[static_cast<std::size_t>(i & 1)] * put[i] * put[i];
    }
  }

  // Calls `body(x)` for the pixels of row y from x0 to x1 that were measured in this colour.
  template <typename Body>
  void for_each_own(std::size_t colour, int y, int x0, int x1, const Body& body) const {
    for (int phase = 0; phase < 2; ++phase) {
      if (rows_.own_colour(x0 + phase, y) != colour) continue;
      for (int x = x0 + phase; x < x1; x += 2) body(x);
    }
  }

  // How far the correction turns each normal measured in this colour, squared, and what noise makes of that.
  void measure(std::size_t colour) {
    const DeblurFilter& filter = filters_[colour];
    const Part from_around = convolved(squared(filter.weights), [&](int y, int x0, int n, float* to) {
      fill_variance(colour, y, x0, n, to);
    });
    const auto of_own =
        static_cast<float>(filter.added_variance() + filter.added_covariance() - filter.kept_variance());
    for (int y = around_.y0; y < around_.y1; ++y) {
      const Row r = row_at(colour, y);
      const float* angle = rows_.sigma_normal_deg.row(row_of(y));
      float *turned = turned_.at(0, y), *noise = noise_.at(0, y);
      const float* variance = from_around.at(0, y);
      for_each_own(colour, y, around_.x0, around_.x1, [&](int x) {
        const float a = r.albedo[x], per_albedo = a > 0 ? 1 / a : 0;
        const float bx = per_albedo * r.to_x[x] - r.x[x], by = per_albedo * r.to_y[x] - r.y[x],
                    bz = per_albedo * r.to_z[x] - r.z[x];
        const float along = bx * r.x[x] + by * r.y[x] + bz * r.z[x], own = angle[x] * kRadian;
        turned[x] = a > 0 ? bx * bx + by * by + bz * bz - along * along : 0;
        noise[x] = a > 0 ? per_albedo * per_albedo * variance[x] + of_own * own * own : 0;
      });
    }
  }

  void leave_out_the_unsolved() {
    const Rect seen = within(grown(area_, kDeblurReach), rows_.image);
    for (int y = seen.y0; y < seen.y1; ++y) {
      const std::uint16_t* status = rows_.status.row(y - rows_.first_row);
      for (int x = seen.x0; x < seen.x1; ++x) {
        if ((status[x] & kNoSolution) == 0) continue;
        const Rect reached = grown({x, y, x + 1, y + 1}, kDeblurReach);
        for (int j = std::max(reached.y0, area_.y0); j < std::min(reached.y1, area_.y1); ++j) {
          for (int i = std::max(reached.x0, area_.x0); i < std::min(reached.x1, area_.x1); ++i)
            *share_.at(i, j) = 0;
        }
      }
    }
  }

  // A row of the maps in one colour, with the normals that were measured in it.
  void write(const SharpenedRows& out, std::size_t colour, int y) const {
    const Row r = row_at(colour, y);
    const int from = row_of(y), to = y - out.first_row;
    const float *share = share_.at(0, y), *sigma = rows_.sigma_albedo[colour].row(from),
                *angle = rows_.sigma_normal_deg.row(from);
    float *albedo_to = out.albedo[colour].row(to), *sigma_to = out.sigma_albedo[colour].row(to);
    const auto covariance = static_cast<float>(2 * filters_[colour].added_covariance()),
               variance = static_cast<float>(filters_[colour].added_variance());
    const auto gain = [&](int x) { return std::sqrt(1 + share[x] * (covariance + share[x] * variance)); };
    const auto mixed = [&](int x, const float* normal, const float* filtered) {
      const float was = r.albedo[x] * normal[x];
      return was + share[x] * (filtered[x] - was);
    };
    for (int x = area_.x0; x < area_.x1; ++x) {
      const float bx = mixed(x, r.x, r.to_x), by = mixed(x, r.y, r.to_y), bz = mixed(x, r.z, r.to_z);
      albedo_to[x] = share[x] > 0 ? std::sqrt(bx * bx + by * by + bz * bz) : r.albedo[x];
      sigma_to[x] = gain(x) * sigma[x];
    }
    for_each_own(colour, y, area_.x0, area_.x1, [&](int x) {
      const float length = albedo_to[x];
      const bool is_kept = !(share[x] > 0 && length > 0);
      const float per_length = is_kept ? 1 : 1 / length;
      const float turned = is_kept ? angle[x] : gain(x) * r.albedo[x] * per_length * angle[x];
      out.normal[0].row(to)[x] = is_kept ? r.x[x] : per_length * mixed(x, r.x, r.to_x);
      out.normal[1].row(to)[x] = is_kept ? r.y[x] : per_length * mixed(x, r.y, r.to_y);
      out.normal[2].row(to)[x] = is_kept ? r.z[x] : per_length * mixed(x, r.z, r.to_z);
      out.sigma_normal_deg.row(to)[x] = std::min(turned, 180.F);
    });
  }

  const RowsToSharpen& rows_;
  const std::array<DeblurFilter, 3>& filters_;
  Rect area_, around_;
  std::vector<Part> filtered_;  // over around_: colours by components
  Part share_, turned_, noise_;
};

}  // namespace

double DeblurFilter::kept_variance() const {
  return square(energy(*this));
}

double DeblurFilter::added_variance() const {
  return kept_variance() - 2 * centre(*this) + 1;
}

double DeblurFilter::added_covariance() const {
  return centre(*this) - 1;
}

DeblurFilter deblur_filter(double sigma_px, double noise) {
  constexpr int kWeights = kDeblurReach + 1;
  using Weights = Eigen::Matrix<double, kWeights, 1>;
  Eigen::Matrix<double, kWeights, kWeights> normal = Eigen::Matrix<double, kWeights, kWeights>::Zero();
  Weights right = Weights::Zero(), at_zero = Weights::Constant(2);
  at_zero[0] = 1;
  const Taps blur = taps_of(sigma_px);
  for (int i = 0; i < kFrequencies; ++i) {
    const double w = std::numbers::pi * (i + 0.5) / kFrequencies;
    const double left = left_at(blur, w);
    Weights cosines;
    for (int k = 0; k < kWeights; ++k) cosines[k] = at_zero[k] * std::cos(k * w);
    normal += (left * left + noise) * cosines * cosines.transpose();
    right += left * cosines;
  }
  // Least squares under the constraint that the weights sum to 1.
  const auto solver = normal.ldlt();
  const Weights free = solver.solve(right), towards = solver.solve(at_zero);
  const Weights weights = free + (1 - at_zero.dot(free)) / at_zero.dot(towards) * towards;
  DeblurFilter filter;
  for (int k = 0; k < kWeights; ++k)
    filter.weights[static_cast<std::size_t>(k)] = static_cast<float>(weights[k]);
  return filter;
}

double sharpen(const RowsToSharpen& rows, const std::array<DeblurFilter, 3>& filters, Rect area,
               const SharpenedRows& out) {
  return Sharpening(rows, filters, area).write(out);
}

}  // namespace weft::solver
