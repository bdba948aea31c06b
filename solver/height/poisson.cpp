// SPDX-License-Identifier: Apache-2.0
#include "solver/height/poisson.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/vec.h"
#include "solver/height/cosine_transform.h"
#include "solver/height/row_bands.h"

namespace weft::solver {
namespace {

/// Columns a task: whole cache lines, many enough for the rows they come from to be read in pieces of 512
/// bytes.
constexpr int kColumns = 128;

// One transform a worker, made when it is first needed.
class Transforms {
 public:
  Transforms(int length, int threads)
      : length_(static_cast<std::size_t>(length)),
        of_worker_(static_cast<std::size_t>(resolved_threads(threads))) {}
  CosineTransform& of(int worker) {
    auto& transform = of_worker_[static_cast<std::size_t>(worker)];
    if (!transform) transform.emplace(length_);
    return *transform;
  }

 private:
  std::size_t length_;
  std::vector<std::optional<CosineTransform>> of_worker_;
};

void transform_sources(const Slopes& slopes, const SlopeSurvey& survey, Transforms& transforms,
                       View<float> spectrum, int threads) {
  const Size size = slopes.size();
  for_each_band(size.height, threads, [&](int y0, int y1, int worker) {
    std::vector<double> rows[2];
    for (auto& row : rows) row.resize(static_cast<std::size_t>(size.width));
    StepWalk walk(slopes, survey, y0);
    for (int y = y0; y < y1; y += 2) {
      const int count = std::min(2, y1 - y);
      for (int i = 0; i < count; ++i) {
        if (y + i > y0) walk.advance();
        walk.source(rows[i].data());
      }
      transforms.of(worker).forward(rows[0].data(), rows[1].data());
      for (int i = 0; i < count; ++i) {
        std::transform(rows[i].begin(), rows[i].end(), spectrum.row(y + i),
                       [](double v) { return static_cast<float>(v); });
      }
    }
  });
}

void transform_back(Transforms& transforms, View<float> spectrum, int threads) {
  for_each_band(spectrum.height(), threads, [&](int y0, int y1, int worker) {
    std::vector<double> rows[2];
    for (auto& row : rows) row.resize(static_cast<std::size_t>(spectrum.width()));
    for (int y = y0; y < y1; y += 2) {
      const int count = std::min(2, y1 - y);
      for (int i = 0; i < count; ++i) {
        std::copy_n(spectrum.row(y + i), spectrum.width(), rows[i].begin());
      }
      transforms.of(worker).inverse(rows[0].data(), rows[1].data());
      for (int i = 0; i < count; ++i) {
        std::transform(rows[i].begin(), rows[i].end(), spectrum.row(y + i),
                       [](double v) { return static_cast<float>(v); });
      }
    }
  });
}

// For the frequencies x0 <= k < x1 of the rows: -f(y - 1) + (e_k + 2) f(y) - f(y + 1) = source(y) down the
// columns, e_k = 4 sin^2(pi k / (2 width)), by elimination (Thomas) from the top. The factors of the
// elimination tend to a limit and are kept until they have reached it, after as many rows as waves of this
// length reach far.
void solve_columns(View<float> f, int x0, int x1) {
  const int width = f.width(), height = f.height();
  const auto count = static_cast<std::size_t>(x1 - x0);
  std::vector<double> eigenvalue(count), state(count, 0.0), factors(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const double half_angle = kPi * static_cast<double>(static_cast<std::size_t>(x0) + i) / (2.0 * width);
    eigenvalue[i] = 4 * std::sin(half_angle) * std::sin(half_angle);
  }
  // factors[(y + 1) * count + i] belongs to row y, as long as they change.
  bool settled = false;
  const auto factors_of = [&](int y) {
    const std::size_t row = static_cast<std::size_t>(y + 1) * count;
    return factors.data() + std::min(row, factors.size() - count);
  };
  for (int y = 0; y + 1 < height; ++y) {
    if (!settled) {
      factors.resize(factors.size() + count);
      const double* above = factors_of(y - 1);
      double* here = factors_of(y);
      double change = 0;
      for (std::size_t i = 0; i < count; ++i) {
        here[i] = 1 / (eigenvalue[i] + (y > 0 ? 2 : 1) - above[i]);
        change = std::max(change, std::abs(here[i] - above[i]));
      }
      settled = change < 1e-15;
    }
    const double* factor = factors_of(y);
    float* row = f.row(y) + x0;
    for (std::size_t i = 0; i < count; ++i) {
      state[i] = (row[i] + state[i]) * factor[i];
      row[i] = static_cast<float>(state[i]);
    }
  }
  float* last = f.row(height - 1) + x0;
  const double* factor = factors_of(height - 2);
  for (std::size_t i = 0; i < count; ++i) {
    const double pivot = eigenvalue[i] + (height > 1 ? 1 : 0) - factor[i];
    state[i] = static_cast<std::size_t>(x0) + i > 0 ? (last[i] + state[i]) / pivot : 0;  // the mean is free
    last[i] = static_cast<float>(state[i]);
  }
  for (int y = height - 2; y >= 0; --y) {
    factor = factors_of(y);
    float* row = f.row(y) + x0;
    for (std::size_t i = 0; i < count; ++i) {
      state[i] = row[i] + factor[i] * state[i];
      row[i] = static_cast<float>(state[i]);
    }
  }
}

// The mean of the picture is the mean of the first column of its spectrum.
void remove_mean(View<float> spectrum) {
  double sum = 0;
  for (int y = 0; y < spectrum.height(); ++y) sum += spectrum(0, y);
  const auto mean = static_cast<float>(sum / spectrum.height());
  for (int y = 0; y < spectrum.height(); ++y) spectrum(0, y) -= mean;
}

}  // namespace

void solve_whole_frame(const Slopes& slopes, const SlopeSurvey& survey, View<float> height, int threads) {
  const int width = height.width();
  Transforms transforms(width, threads);
  transform_sources(slopes, survey, transforms, height, threads);
  const int tasks = (width + kColumns - 1) / kColumns;
  parallel_for(static_cast<std::size_t>(tasks), threads, [&](std::size_t task, int) {
    const int x0 = static_cast<int>(task) * kColumns;
    solve_columns(height, x0, std::min(x0 + kColumns, width));
  });
  remove_mean(height);
  transform_back(transforms, height, threads);
}

}  // namespace weft::solver
