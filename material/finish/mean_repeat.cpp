// SPDX-License-Identifier: Apache-2.0
#include "material/finish/mean_repeat.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/solve_record.h"

namespace weft::material {
namespace {

// Sums of a plane by place in the repeat.
class Bins {
 public:
  Bins(double repeat_x, double repeat_y)
      : repeat_x_(repeat_x),
        repeat_y_(repeat_y),
        columns_(std::max(1, static_cast<int>(std::ceil(repeat_x)))),
        rows_(std::max(1, static_cast<int>(std::ceil(repeat_y)))),
        count_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
        sum_(count_.size()) {}

  void add(int x, int y, double value) {
    const std::size_t i = index(x, y);
    count_[i] += 1;
    sum_[i] += value;
  }
  double mean(int x, int y) const {
    const std::size_t i = index(x, y);
    return count_[i] > 0 ? sum_[i] / count_[i] : 0;
  }
  double squares() const {
    double all = 0;
    for (std::size_t i = 0; i < sum_.size(); ++i) all += count_[i] > 0 ? sum_[i] * sum_[i] / count_[i] : 0;
    return all;
  }
  double filled() const {
    return static_cast<double>(std::ranges::count_if(count_, [](double n) { return n > 0; }));
  }

 private:
  std::size_t index(int x, int y) const {
    const auto place = [](int i, double repeat, int bins) {
      const double phase = i / repeat - std::floor(i / repeat);
      return static_cast<std::size_t>(std::min(static_cast<int>(phase * bins), bins - 1));
    };
    return place(y, repeat_y_, rows_) * static_cast<std::size_t>(columns_) + place(x, repeat_x_, columns_);
  }

  double repeat_x_, repeat_y_;
  int columns_, rows_;
  std::vector<double> count_, sum_;
};

}  // namespace

Image<float> without_mean_repeat(View<const float> plane, double repeat_x, double repeat_y) {
  Bins bins(repeat_x, repeat_y);
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) bins.add(x, y, static_cast<double>(plane(x, y)));
  }
  Image<float> out(plane.size());
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x)
      out(x, y) = static_cast<float>(static_cast<double>(plane(x, y)) - bins.mean(x, y));
  }
  return out;
}

double repeating_share(const Surface& surface, double repeat_x, double repeat_y) {
  double between = 0, total = 0;
  for (int p = 0; p < 2; ++p) {
    Bins bins(repeat_x, repeat_y);
    double n = 0, sum = 0, squares = 0;
    for (int y = 0; y < surface.size().height; ++y) {
      for (int x = 0; x < surface.size().width; ++x) {
        if ((surface.status(x, y) & kNoSolution) != 0) continue;
        const double value = static_cast<double>(surface.slope(x, y, p));
        bins.add(x, y, value);
        n += 1;
        sum += value;
        squares += value * value;
      }
    }
    const double filled = bins.filled();
    if (n <= filled) return 0;
    const double within = (squares - bins.squares()) / (n - filled);
    between += std::max(bins.squares() - sum * sum / n - (filled - 1) * within, 0.0);
    total += squares - sum * sum / n;
  }
  return total > 0 ? between / total : 0;
}

}  // namespace weft::material
