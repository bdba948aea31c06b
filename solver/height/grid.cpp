// SPDX-License-Identifier: Apache-2.0
#include "solver/height/grid.h"

#include <limits>
#include <utility>

#include "solver/height/row_bands.h"

namespace weft::solver {
namespace {

// A small level is done before a second thread has woken.
int threads_for(Size size, int threads) {
  return size.pixels() < 1 << 14 ? 1 : threads;
}

struct Weights {
  const float *left, *upper, *lower;

  Weights(const GridLevel& level, int y)
      : left(level.left_weight.row(y)),
        upper(level.upper_weight.row(y)),
        lower(level.upper_weight.row(y + 1)) {}
  float diagonal(int x) const { return left[x] + left[x + 1] + upper[x] + lower[x]; }
};

// In differences, which floats hold to their last digit where heights are large and slopes small.
struct Neighbourhood {
  const float *here, *above, *below;

  Neighbourhood(const PaddedPlane& h, int y) : here(h.row(y)), above(h.row(y - 1)), below(h.row(y + 1)) {}
  float outflow(const Weights& w, int x) const {
    const float h = here[x];
    return (w.left[x] * (h - here[x - 1]) + w.left[x + 1] * (h - here[x + 1])) +
           (w.upper[x] * (h - above[x]) + w.lower[x] * (h - below[x]));
  }
};

// Written as selections of values, not of operations, so that compilers make vector code of it.
float over(float damping, float diagonal) {
  return damping / (diagonal > 0 ? diagonal : std::numeric_limits<float>::infinity());
}
float quarter_if(float way) {
  return way > 0 ? 0.25f : 0.0f;
}

void relax_row(const Weights& w, const Neighbourhood& h, const float* source, float damping, int width,
               float* __restrict out) {
  for (int x = 0; x < width; ++x) {
    out[x] = h.here[x] + over(damping, w.diagonal(x)) * (source[x] - h.outflow(w, x));
  }
}

// A quarter of the way from each cell of a row to its left and to its right neighbour, if there is a way.
void spread_row(const float* h, const float* way_left, int width, float* __restrict out) {
  for (int cell = 0; 2 * cell < width; ++cell) {
    out[2 * cell] = h[cell] + quarter_if(way_left[cell]) * (h[cell - 1] - h[cell]);
    out[2 * cell + 1] = h[cell] + quarter_if(way_left[cell + 1]) * (h[cell + 1] - h[cell]);
  }
}

// The transpose of spread_row.
void gather_row(const float* fine, const float* way_left, int width, float* __restrict out) {
  for (int cell = 0; cell < width; ++cell) {
    const float* f = fine + 2 * cell;
    const float from_left = quarter_if(way_left[cell]) * (f[-1] - f[0]);
    const float from_right = quarter_if(way_left[cell + 1]) * (f[2] - f[1]);
    out[cell] = (f[0] + f[1]) + (from_left + from_right);
  }
}

// A quarter of the way from row to beyond where there is one.
void add_between(const float* row, const float* beyond, const float* way, int width, float* __restrict out) {
  for (int x = 0; x < width; ++x) out[x] += row[x] + quarter_if(way[x / 2]) * (beyond[x] - row[x]);
}

// The rows of the finer level that draw on a row of cells, summed with their shares: the transpose of
// add_between.
void gather_rows(const PaddedPlane& fine, const Weights& w, int row, int width, float* __restrict out) {
  const float *above = fine.row(2 * row - 1), *upper = fine.row(2 * row), *lower = fine.row(2 * row + 1),
              *below = fine.row(2 * row + 2);
  for (int x = 0; x < width; ++x) {
    const float from_above = quarter_if(w.upper[x / 2]) * (above[x] - upper[x]);
    const float from_below = quarter_if(w.lower[x / 2]) * (below[x] - lower[x]);
    out[x] = (upper[x] + lower[x]) + (from_above + from_below);
  }
}

template <typename Body>
void for_each_row(Size size, int threads, const Body& body) {
  for_each_band(size.height, threads_for(size, threads), [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) body(y);
  });
}

GridLevel coarser(const GridLevel& fine, int threads) {
  GridLevel level(Size{(fine.size().width + 1) / 2, (fine.size().height + 1) / 2});
  for_each_row(level.size(), threads, [&](int y) {
    const float *left = fine.left_weight.row(2 * y), *left_below = fine.left_weight.row(2 * y + 1);
    const float* upper = fine.upper_weight.row(2 * y);
    for (int x = 0; x < level.size().width; ++x) {
      level.left_weight.row(y)[x] = (left[2 * x] + left_below[2 * x]) / 2;
      level.upper_weight.row(y)[x] = (upper[2 * x] + upper[2 * x + 1]) / 2;
    }
  });
  return level;
}

}  // namespace

void add_coarser_levels(std::vector<GridLevel>& levels, int threads) {
  while (levels.back().size().pixels() > 1) levels.push_back(coarser(levels.back(), threads));
}

void relax(GridLevel& level, float damping, int threads) {
  for_each_row(level.size(), threads, [&](int y) {
    relax_row(Weights(level, y), Neighbourhood(level.height, y), level.source.row(y), damping,
              level.size().width, level.scratch.row(y));
  });
  std::swap(level.height, level.scratch);
}

void relax_from_zero(GridLevel& level, float damping, int threads) {
  for_each_row(level.size(), threads, [&](int y) {
    const Weights w(level, y);
    const float* source = level.source.row(y);
    float* __restrict out = level.height.row(y);
    for (int x = 0; x < level.size().width; ++x) out[x] = over(damping, w.diagonal(x)) * source[x];
  });
}

void apply_row(const GridLevel& level, const PaddedPlane& h, int y, float* __restrict out) {
  const Weights w(level, y);
  const Neighbourhood around(h, y);
  for (int x = 0; x < level.size().width; ++x) out[x] = around.outflow(w, x);
}

void find_residual(GridLevel& level, int threads) {
  for_each_row(level.size(), threads, [&](int y) {
    const Weights w(level, y);
    const Neighbourhood h(level.height, y);
    const float* source = level.source.row(y);
    float* __restrict out = level.scratch.row(y);
    for (int x = 0; x < level.size().width; ++x) out[x] = source[x] - h.outflow(w, x);
  });
}

void restrict_residual(const GridLevel& fine, GridLevel& coarse, int threads) {
  const int width = fine.size().width;
  for_each_band(coarse.size().height, threads_for(fine.size(), threads), [&](int y0, int y1, int) {
    std::vector<float> sums(static_cast<std::size_t>(width) + 3, 0.0f);  // framed with zeros, as a Plane
    for (int y = y0; y < y1; ++y) {
      gather_rows(fine.scratch, Weights(coarse, y), y, width, sums.data() + 1);
      gather_row(sums.data() + 1, coarse.left_weight.row(y), coarse.size().width, coarse.source.row(y));
    }
  });
}

void add_from_coarse(const GridLevel& coarse, GridLevel& fine, int threads) {
  const int width = fine.size().width;
  for_each_band(coarse.size().height, threads_for(fine.size(), threads), [&](int y0, int y1, int) {
    std::vector<float> above(static_cast<std::size_t>(width) + 1), here(above), below(above);
    const auto spread = [&](int y, std::vector<float>& out) {
      spread_row(coarse.height.row(y), coarse.left_weight.row(y), width, out.data());
    };
    spread(y0 - 1, here);
    spread(y0, below);
    for (int y = y0; y < y1; ++y) {
      std::swap(above, here);
      std::swap(here, below);
      spread(y + 1, below);
      const Weights w(coarse, y);
      add_between(here.data(), above.data(), w.upper, width, fine.height.row(2 * y));
      if (2 * y + 1 < fine.size().height) {
        add_between(here.data(), below.data(), w.lower, width, fine.height.row(2 * y + 1));
      }
    }
  });
}

}  // namespace weft::solver
