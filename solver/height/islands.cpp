// SPDX-License-Identifier: Apache-2.0
#include "solver/height/islands.h"

#include <algorithm>
#include <numeric>

#include "solver/height/row_bands.h"

namespace weft::solver {
namespace {

// Sets that are joined two by two; the root of a set is its smallest member (Galler and Fischer 1964).
class Unions {
 public:
  explicit Unions(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Runs a task of parallel_for.
constexpr std::size_t kBlock = 4096;

template <typename Body>
void for_each_run(std::size_t runs, int threads, const Body& body) {
  parallel_for((runs + kBlock - 1) / kBlock, threads, [&](std::size_t block, int) {
    for (std::size_t i = block * kBlock; i < std::min((block + 1) * kBlock, runs); ++i) body(i);
  });
}

}  // namespace

Islands::Islands(const Slopes& slopes) {
  SlopeRow row;
  for (int y = 0; y < slopes.size().height; ++y) {
    slopes.read(y, row);
    const auto begin = row.weight.begin(), end = row.weight.end();
    const auto inside = [](float weight) { return weight > 0; };
    for (auto x0 = std::find_if(begin, end, inside); x0 != end;) {
      const auto x1 = std::find_if_not(x0, end, inside);
      runs_.push_back({y, static_cast<int>(x0 - begin), static_cast<int>(x1 - begin)});
      x0 = std::find_if(x1, end, inside);
    }
  }

  Unions unions(runs_.size());
  std::size_t above = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i];
    const auto is_past = [&run](const Run& r) {
      return r.y + 1 < run.y || (r.y + 1 == run.y && r.x1 <= run.x0);
    };
    while (is_past(runs_[above])) ++above;
    for (std::size_t j = above; runs_[j].y + 1 == run.y && runs_[j].x0 < run.x1; ++j) {
      unions.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    }
  }
  // A root comes before the rest of its set, so it has its number when they ask for it.
  island_.resize(runs_.size());
  for (std::uint32_t i = 0; i < runs_.size(); ++i) {
    const std::uint32_t root = unions.root(i);
    island_[i] = root == i ? static_cast<std::uint32_t>(count_++) : island_[root];
  }
}

void Islands::remove_means(View<float> height, int threads) const {
  std::vector<double> sum_of_run(runs_.size());
  for_each_run(runs_.size(), threads, [&](std::size_t i) {
    const float* row = height.row(runs_[i].y);
    sum_of_run[i] = std::accumulate(row + runs_[i].x0, row + runs_[i].x1, 0.0);
  });
  std::vector<double> mean(static_cast<std::size_t>(count_)), pixels(mean);
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    mean[island_[i]] += sum_of_run[i];
    pixels[island_[i]] += runs_[i].x1 - runs_[i].x0;
  }
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] /= pixels[i];
  for_each_run(runs_.size(), threads, [&](std::size_t i) {
    float* row = height.row(runs_[i].y);
    const auto less = static_cast<float>(mean[island_[i]]);
    for (int x = runs_[i].x0; x < runs_[i].x1; ++x) row[x] -= less;
  });
}

void Islands::clear_outside(View<float> height, int threads) const {
  for_each_band(height.height(), threads, [&](int y0, int y1, int) {
    auto run = std::lower_bound(runs_.begin(), runs_.end(), y0, [](const Run& r, int y) { return r.y < y; });
    for (int y = y0; y < y1; ++y) {
      float* row = height.row(y);
      int x = 0;
      for (; run != runs_.end() && run->y == y; ++run) {
        std::fill(row + x, row + run->x0, 0.0f);
        x = run->x1;
      }
      std::fill(row + x, row + height.width(), 0.0f);
    }
  });
}

}  // namespace weft::solver
