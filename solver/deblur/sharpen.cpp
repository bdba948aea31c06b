// SPDX-License-Identifier: Apache-2.0
#include "solver/deblur/sharpen.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/solve_record.h"

namespace weft::solver {
namespace {

constexpr float kRadian = 0.017453292F;  // a degree

struct Vec3f {
  float x, y, z;

  friend Vec3f operator+(Vec3f a, Vec3f b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3f operator-(Vec3f a, Vec3f b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3f operator*(float s, Vec3f a) { return {s * a.x, s * a.y, s * a.z}; }
};

float dot(Vec3f a, Vec3f b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Rect grown(Rect area, int by, Size image) {
  return {std::max(area.x0 - by, 0), std::max(area.y0 - by, 0), std::min(area.x1 + by, image.width),
          std::min(area.y1 + by, image.height)};
}

// A plane of floats over a part of the image.
class Part {
 public:
  explicit Part(Rect area) : area_(area), values_(static_cast<std::size_t>(area.pixels())) {}

  Rect area() const { return area_; }
  int stride() const { return area_.width(); }
  float* at(int x, int y) {
    return values_.data() + static_cast<std::ptrdiff_t>(y - area_.y0) * stride() + (x - area_.x0);
  }
  const float* at(int x, int y) const { return const_cast<Part*>(this)->at(x, y); }
  float operator()(int x, int y) const { return *at(x, y); }

 private:
  Rect area_;
  std::vector<float> values_;
};

using Weights = std::array<float, kDeblurReach + 1>;

Weights squared(Weights weights) {
  for (float& w : weights) w *= w;
  return weights;
}

// Weighted sum of n samples in a row, each with its neighbours `step` apart.
void convolve(const Weights& weights, const float* from, std::ptrdiff_t step, int n, float* to) {
  for (int i = 0; i < n; ++i) {
    float sum = weights[0] * from[i];
    for (int k = 1; k <= kDeblurReach; ++k)
      sum += weights[static_cast<std::size_t>(k)] * (from[i - k * step] + from[i + k * step]);
    to[i] = sum;
  }
}

// Sums over squares of 2 kShareReach + 1 pixels a side, of what lies in the part.
Part summed(const Part& part) {
  const Rect area = part.area();
  Part across(area), sums(area);
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const int end = std::min(x + kShareReach + 1, area.x1);
      for (int i = std::max(x - kShareReach, area.x0); i < end; ++i) *across.at(x, y) += part(i, y);
    }
  }
  for (int y = area.y0; y < area.y1; ++y) {
    const int end = std::min(y + kShareReach + 1, area.y1);
    for (int j = std::max(y - kShareReach, area.y0); j < end; ++j) {
      for (int x = area.x0; x < area.x1; ++x) *sums.at(x, y) += across(x, j);
    }
  }
  return sums;
}

// An area of the image on its way to being sharp, and as far around it as shares are measured.
class Sharpening {
 public:
  Sharpening(const SolvedRows& rows, const std::array<DeblurFilter, 3>& filters, Rect area)
      : rows_(rows),
        filters_(filters),
        area_(area),
        around_(grown(area, kShareReach, rows.image)),
        share_(around_) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) filtered_.push_back(filter(c, k));
    }
    measure_shares();
    leave_out_the_unsolved();
  }

  double write(const SharpenedRows& out) const {
    double sum = 0;
    for (int y = area_.y0; y < area_.y1; ++y) {
      for (int x = area_.x0; x < area_.x1; ++x) {
        sum += static_cast<double>(share_(x, y));
        for (std::size_t c = 0; c < 3; ++c) write(out, c, x, y);
      }
    }
    return sum;
  }

 private:
  // Row of the views that holds row y of the image; beyond the image its first or last.
  int row_of(int y) const { return std::clamp(y, 0, rows_.image.height - 1) - rows_.first_row; }

  Vec3f normal_at(int x, int y) const {
    const int row = y - rows_.first_row;
    return {rows_.normal[0](x, row), rows_.normal[1](x, row), rows_.normal[2](x, row)};
  }
  float albedo_at(std::size_t colour, int x, int y) const {
    return rows_.albedo[colour](x, y - rows_.first_row);
  }

  // Albedo times normal, filtered.
  Vec3f filtered_at(std::size_t colour, int x, int y) const {
    return {filtered_[3 * colour](x, y), filtered_[3 * colour + 1](x, y), filtered_[3 * colour + 2](x, y)};
  }
  Vec3f correction_at(std::size_t colour, int x, int y) const {
    return filtered_at(colour, x, y) - albedo_at(colour, x, y) * normal_at(x, y);
  }

  // Component k of albedo times normal in a colour, filtered.
  Part filter(std::size_t colour, std::size_t k) const {
    return convolved(filters_[colour].weights,
                     [&](int x, int row) { return rows_.albedo[colour](x, row) * rows_.normal[k](x, row); });
  }

  // Variance of albedo times normal across the normal. What was measured in another colour also has the error
  // of the albedo that was put in its place.
  float variance_at(std::size_t colour, int x, int row) const {
    const float turned = rows_.albedo[colour](x, row) * rows_.sigma_normal_deg(x, row) * kRadian;
    if (rows_.own_colour(x, row + rows_.first_row) == colour) return turned * turned;
    const float put = rows_.sigma_albedo[colour](x, row);
    return turned * turned + put * put;
  }

  // What `value(x, row)` gives around each pixel of around_, summed with these weights along x and y.
  template <typename Value>
  Part convolved(const Weights& weights, const Value& value) const {
    const int wide = around_.width() + 2 * kDeblurReach, tall = around_.height() + 2 * kDeblurReach;
    Part across({around_.x0, around_.y0 - kDeblurReach, around_.x1, around_.y1 + kDeblurReach}), out(around_);
    std::vector<float> line(static_cast<std::size_t>(wide));
    for (int j = 0; j < tall; ++j) {
      const int y = around_.y0 - kDeblurReach + j, row = row_of(y);
      for (int i = 0; i < wide; ++i) {
        const int x = std::clamp(around_.x0 - kDeblurReach + i, 0, rows_.image.width - 1);
        line[static_cast<std::size_t>(i)] = value(x, row);
      }
      convolve(weights, line.data() + kDeblurReach, 1, around_.width(), across.at(around_.x0, y));
    }
    for (int y = around_.y0; y < around_.y1; ++y) {
      convolve(weights, across.at(around_.x0, y), across.stride(), around_.width(), out.at(around_.x0, y));
    }
    return out;
  }

  // By the angle that the correction turns a normal, squared, and what noise makes of it.
  void measure_shares() {
    Part turned(around_), noise(around_);
    for (std::size_t c = 0; c < 3; ++c) {
      const DeblurFilter& filter = filters_[c];
      const Part from_around =
          convolved(squared(filter.weights), [&](int x, int row) { return variance_at(c, x, row); });
      const auto of_own =
          static_cast<float>(filter.added_variance() + filter.added_covariance() - filter.kept_variance());
      for (int y = around_.y0; y < around_.y1; ++y) {
        for (int x = around_.x0; x < around_.x1; ++x) {
          const float albedo = albedo_at(c, x, y);
          if (rows_.own_colour(x, y) != c || !(albedo > 0)) continue;
          const Vec3f by = correction_at(c, x, y);
          const float along = dot(by, normal_at(x, y)), scale = 1 / (albedo * albedo);
          *turned.at(x, y) = scale * (dot(by, by) - along * along);
          *noise.at(x, y) = scale * (from_around(x, y) + of_own * variance_at(c, x, y - rows_.first_row));
        }
      }
    }
    const Part turned_around = summed(turned), noise_around = summed(noise);
    for (int y = area_.y0; y < area_.y1; ++y) {
      for (int x = area_.x0; x < area_.x1; ++x)
        *share_.at(x, y) = best_share(turned_around(x, y), noise_around(x, y));
    }
  }

  void leave_out_the_unsolved() {
    const Rect seen = grown(area_, kDeblurReach, rows_.image);
    for (int y = seen.y0; y < seen.y1; ++y) {
      for (int x = seen.x0; x < seen.x1; ++x) {
        if ((rows_.status(x, y - rows_.first_row) & kNoSolution) == 0) continue;
        const Rect reached = grown({x, y, x + 1, y + 1}, kDeblurReach, rows_.image);
        for (int j = std::max(reached.y0, around_.y0); j < std::min(reached.y1, around_.y1); ++j) {
          for (int i = std::max(reached.x0, around_.x0); i < std::min(reached.x1, around_.x1); ++i)
            *share_.at(i, j) = 0;
        }
      }
    }
  }

  void write(const SharpenedRows& out, std::size_t colour, int x, int y) const {
    const int from = y - rows_.first_row, to = y - out.first_row;
    const float share = share_(x, y), albedo = albedo_at(colour, x, y);
    const Vec3f b = albedo * normal_at(x, y) + share * correction_at(colour, x, y);
    const float length = std::sqrt(dot(b, b));
    const bool is_kept = share == 0 || !(length > 0);
    const float gain =
        is_kept ? 1 : static_cast<float>(std::sqrt(filters_[colour].variance_at(static_cast<double>(share))));
    out.albedo[colour](x, to) = is_kept ? albedo : length;
    out.sigma_albedo[colour](x, to) = gain * rows_.sigma_albedo[colour](x, from);
    if (rows_.own_colour(x, y) != colour) return;
    const float widened = is_kept ? 1 : gain * albedo / length;
    out.sigma_normal_deg(x, to) = std::min(widened * rows_.sigma_normal_deg(x, from), 180.F);
    const Vec3f n = is_kept ? normal_at(x, y) : (1 / length) * b;
    out.normal[0](x, to) = n.x;
    out.normal[1](x, to) = n.y;
    out.normal[2](x, to) = n.z;
  }

  const SolvedRows& rows_;
  const std::array<DeblurFilter, 3>& filters_;
  Rect area_, around_;
  std::vector<Part> filtered_;  // over around_: colours by components
  Part share_;
};

}  // namespace

double sharpen(const SolvedRows& rows, const std::array<DeblurFilter, 3>& filters, Rect area,
               const SharpenedRows& out) {
  return Sharpening(rows, filters, area).write(out);
}

}  // namespace weft::solver
