// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/reduce.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/parallel.h"

namespace weft::exchange {
namespace {

constexpr float kLeastZ = 0.001F;

// The pixels of the finer line that one of the coarser line covers, and the share of the first and the last.
struct Span {
  int first = 0, last = 0;
  double first_share = 1, last_share = 1;

  double share(int i) const {
    return i == first && i == last ? first_share + last_share - 1
           : i == first            ? first_share
           : i == last             ? last_share
                                   : 1;
  }
};

Span span_of(int i, int coarse, int fine) {
  const double begin = static_cast<double>(i) * fine / coarse,
               end = static_cast<double>(i + 1) * fine / coarse;
  Span span = {static_cast<int>(std::floor(begin)), static_cast<int>(std::ceil(end - 1e-9)) - 1, 1, 1};
  span.last = std::clamp(span.last, span.first, fine - 1);
  span.first_share = span.first + 1 - begin;
  span.last_share = end - span.last;
  return span;
}

std::vector<Span> spans_of(int coarse, int fine) {
  std::vector<Span> spans;
  for (int i = 0; i < coarse; ++i) spans.push_back(span_of(i, coarse, fine));
  return spans;
}

// The weighted mean of change(x, y) over each coarse pixel.
template <typename Value>
void average(Size fine, Size coarse, int threads, View<float> to, const Value& value) {
  const std::vector<Span> columns = spans_of(coarse.width, fine.width);
  parallel_for(static_cast<std::size_t>(coarse.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    const Span rows = span_of(y, coarse.height, fine.height);
    for (int x = 0; x < coarse.width; ++x) {
      const Span& across = columns[static_cast<std::size_t>(x)];
      double sum = 0, weights = 0;
      for (int j = rows.first; j <= rows.last; ++j) {
        for (int i = across.first; i <= across.last; ++i) {
          const double weight = rows.share(j) * across.share(i);
          sum += weight * static_cast<double>(value(i, j));
          weights += weight;
        }
      }
      to(x, y) = static_cast<float>(sum / weights);
    }
  });
}

template <typename Value>
double mean_of(Size size, const Value& value) {
  double sum = 0;
  for (int y = 0; y < size.height; ++y) {
    double row = 0;
    for (int x = 0; x < size.width; ++x) row += static_cast<double>(value(x, y));
    sum += row;
  }
  return sum / static_cast<double>(size.pixels());
}

}  // namespace

void reduce(View<const float> from, Averaging averaging, int threads, View<float> to) {
  const Size fine = from.size(), coarse = to.size();
  if (averaging == Averaging::kNearest) {
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        to(x, y) = from(static_cast<int>((x + 0.5) * fine.width / coarse.width),
                        static_cast<int>((y + 0.5) * fine.height / coarse.height));
      }
    }
    return;
  }
  if (averaging == Averaging::kMean) {
    average(fine, coarse, threads, to, [&](int x, int y) { return from(x, y); });
    return;
  }
  average(fine, coarse, threads, to, [&](int x, int y) { return from(x, y) * from(x, y); });
  for (int y = 0; y < coarse.height; ++y) {
    for (int x = 0; x < coarse.width; ++x) to(x, y) = std::sqrt(to(x, y));
  }
}

void reduce_normals(const std::array<View<const float>, 3>& from, int threads,
                    const std::array<View<float>, 3>& to) {
  for (std::size_t c = 0; c < 2; ++c) {
    average(from[c].size(), to[c].size(), threads, to[c],
            [&, c](int x, int y) { return from[c](x, y) / std::max(from[2](x, y), kLeastZ); });
  }
  for (int y = 0; y < to[2].height(); ++y) {
    for (int x = 0; x < to[2].width(); ++x) {
      const float sx = to[0](x, y), sy = to[1](x, y);
      const float z = 1 / std::sqrt(sx * sx + sy * sy + 1);
      to[0](x, y) = sx * z;
      to[1](x, y) = sy * z;
      to[2](x, y) = z;
    }
  }
}

double mean_luminance(const std::array<View<const float>, 3>& rgb) {
  return mean_of(rgb[0].size(), [&](int x, int y) {
    return 0.2126F * rgb[0](x, y) + 0.7152F * rgb[1](x, y) + 0.0722F * rgb[2](x, y);
  });
}

std::array<double, 2> mean_slope(const std::array<View<const float>, 3>& normal) {
  const auto slope = [&](std::size_t c) {
    return mean_of(normal[0].size(),
                   [&](int x, int y) { return -normal[c](x, y) / std::max(normal[2](x, y), kLeastZ); });
  };
  return {slope(0), slope(1)};
}

}  // namespace weft::exchange
