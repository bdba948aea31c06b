// SPDX-License-Identifier: Apache-2.0
#include "solver/height/height.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "solver/height/grid.h"
#include "solver/height/islands.h"
#include "solver/height/poisson.h"
#include "solver/height/row_bands.h"
#include "solver/height/slopes.h"

namespace weft::solver {
namespace {

// Two Jacobi steps with the roots of the Chebyshev polynomial over 0.4 to 2, the part of the spectrum that a
// coarser level cannot hold and a little more: the pair damps it 3.5-fold at least, before the cycle and
// after it. Unlike Gauss-Seidel it has no order, so bytes do not depend on threads, and it leaves the cycle
// symmetric.
constexpr float kDampings[2] = {0.5664f, 1.5763f};

// One V(2,2) cycle for the level's source, from height 0.
void v_cycle(std::vector<GridLevel>& levels, std::size_t l, int threads) {
  GridLevel& level = levels[l];
  relax_from_zero(level, kDampings[0], threads);
  relax(level, kDampings[1], threads);
  if (l + 1 == levels.size()) return;
  find_residual(level, threads);
  restrict_residual(level, levels[l + 1], threads);
  v_cycle(levels, l + 1, threads);
  add_from_coarse(levels[l + 1], level, threads);
  for (const float damping : kDampings) relax(level, damping, threads);
}

void fill_finest(const Slopes& slopes, const SlopeSurvey& survey, GridLevel& level, int threads) {
  const int width = slopes.size().width;
  for_each_band(slopes.size().height, threads, [&](int y0, int y1, int) {
    std::vector<double> source(static_cast<std::size_t>(width));
    StepWalk walk(slopes, survey, y0);
    for (int y = y0; y < y1; ++y) {
      if (y > y0) walk.advance();
      walk.source(source.data());
      std::transform(source.begin(), source.end(), level.source.row(y),
                     [](double v) { return static_cast<float>(v); });
      // The last of the row and all of the last row are 0, as the frame around the planes is.
      std::copy_n(walk.here().right_weight.begin(), width, level.left_weight.row(y) + 1);
      std::copy_n(walk.here().down_weight.begin(), width, level.upper_weight.row(y + 1));
    }
  });
}

double dot_of(const PaddedPlane& a, const PaddedPlane& b, int threads) {
  return sum_over_bands(a.size().height, threads, [&](int y0, int y1) {
    double sum = 0;
    for (int y = y0; y < y1; ++y) {
      const float *u = a.row(y), *v = b.row(y);
      for (int x = 0; x < a.size().width; ++x) sum += double{u[x]} * v[x];
    }
    return sum;
  });
}

// direction = height + keep * direction
void turn(const GridLevel& level, double keep, PaddedPlane& direction, int threads) {
  const auto factor = static_cast<float>(keep);
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      const float* z = level.height.row(y);
      float* p = direction.row(y);
      for (int x = 0; x < level.size().width; ++x) p[x] = z[x] + factor * p[x];
    }
  });
}

// scratch = A direction
void apply(GridLevel& level, const PaddedPlane& direction, int threads) {
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) apply_row(level, direction, y, level.scratch.row(y));
  });
}

// solution += step * direction, source -= step * scratch
void advance(GridLevel& level, const PaddedPlane& direction, double step, View<float> solution, int threads) {
  const auto factor = static_cast<float>(step);
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      const float *p = direction.row(y), *ap = level.scratch.row(y);
      float *h = solution.row(y), *r = level.source.row(y);
      for (int x = 0; x < level.size().width; ++x) {
        h[x] += factor * p[x];
        r[x] -= factor * ap[x];
      }
    }
  });
}

struct RelaxationOptions {
  int relaxations = 200;          ///< iterations a level: "until convergence" in the paper
  bool signs_as_printed = false;  ///< guess from the right and lower neighbour by adding the slope
};

// Dx, Dy and which pixels have them, of one level.
struct SlopeLevel {
  explicit SlopeLevel(Size size) : right(size), down(size), weight(size) {}
  Size size() const { return right.size(); }
  PaddedPlane right, down, weight;
};

SlopeLevel finest_slopes(const Slopes& slopes, const SlopeSurvey& survey, int threads) {
  SlopeLevel level(slopes.size());
  for_each_band(slopes.size().height, threads, [&](int y0, int y1, int) {
    SlopeRow row;
    for (int y = y0; y < y1; ++y) {
      slopes.read(y, row);
      for (int x = 0; x < slopes.size().width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        if (row.weight[i] == 0) continue;
        level.right.row(y)[x] = row.right[i] - survey.mean_right;
        level.down.row(y)[x] = row.down[i] - survey.mean_down;
        level.weight.row(y)[x] = 1;
      }
    }
  });
  return level;
}

SlopeLevel halved(const SlopeLevel& fine, int threads) {
  SlopeLevel level({(fine.size().width + 1) / 2, (fine.size().height + 1) / 2});
  const auto sum_of_four = [](const PaddedPlane& p, int x, int y) {
    const float *upper = p.row(2 * y) + 2 * x, *lower = p.row(2 * y + 1) + 2 * x;
    return (upper[0] + upper[1]) + (lower[0] + lower[1]);
  };
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      for (int x = 0; x < level.size().width; ++x) {
        const float count = sum_of_four(fine.weight, x, y);
        if (count == 0) continue;
        level.right.row(y)[x] = 2 * sum_of_four(fine.right, x, y) / count;
        level.down.row(y)[x] = 2 * sum_of_four(fine.down, x, y) / count;
        level.weight.row(y)[x] = 1;
      }
    }
  });
  return level;
}

// The guesses L, R, U and D of a pixel are its neighbours' heights plus steps: their mean is a Jacobi step of
// damping 1 for weights 1 and the sum of the steps as source.
GridLevel system_of(const SlopeLevel& slopes, bool signs_as_printed, int threads) {
  const Size size = slopes.size();
  GridLevel level(size);
  const float back = signs_as_printed ? 1.0f : -1.0f;
  for_each_band(size.height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      const float *here = slopes.weight.row(y), *above = slopes.weight.row(y - 1),
                  *below = slopes.weight.row(y + 1);
      const float *dx = slopes.right.row(y), *dy = slopes.down.row(y), *dy_above = slopes.down.row(y - 1);
      float *left_weight = level.left_weight.row(y), *upper_weight = level.upper_weight.row(y);
      for (int x = 0; x < size.width; ++x) {
        left_weight[x] = here[x] * here[x - 1];
        upper_weight[x] = here[x] * above[x];
        level.source.row(y)[x] = here[x] * (here[x - 1] * dx[x - 1] + here[x + 1] * back * dx[x] +
                                            above[x] * dy_above[x] + below[x] * back * dy[x]);
      }
    }
  });
  return level;
}

GridLevel height_from_slopes(const SlopeLevel& slopes, const RelaxationOptions& options, int threads) {
  if (slopes.size().pixels() == 1) return GridLevel(slopes.size());
  const GridLevel coarse = height_from_slopes(halved(slopes, threads), options, threads);
  GridLevel level = system_of(slopes, options.signs_as_printed, threads);
  add_from_coarse(coarse, level, threads);
  for (int i = 0; i < options.relaxations; ++i) relax(level, 1, threads);
  return level;
}

/// Heights in pixels by relaxation from coarse to fine (seed 001, Algorithm 5): HeightMethod::kSeed.
///
/// Departures: R and D subtract the slope, without which nothing fits (printed: they add). A coarser level
/// has slopes twice as large, being between pixels twice as far apart, where the paper takes them as they
/// are. The mean slope is taken out first. Where a neighbour is missing, at the border or in the mask, the
/// mean is over those that are there.
void solve_as_seed(const Slopes& slopes, const SlopeSurvey& survey, const RelaxationOptions& options,
                   View<float> height, int threads) {
  const GridLevel level = height_from_slopes(finest_slopes(slopes, survey, threads), options, threads);
  for (int y = 0; y < height.height(); ++y) {
    std::copy_n(level.height.row(y), height.width(), height.row(y));
  }
}

Error usage(std::string why, std::string remedy) {
  return {ErrorKind::kUsage, "no height from these normals", "", std::move(why), std::move(remedy)};
}

Result<void> check(const std::array<View<const float>, 3>& normal, View<const std::uint8_t> mask,
                   const HeightOptions& options) {
  const Size size = normal[0].size();
  if (size.width <= 0 || size.height <= 0) return usage("the normal map is empty", "give a normal map");
  if (normal[1].size() != size || normal[2].size() != size || (!mask.empty() && mask.size() != size)) {
    return usage("X, Y, Z and mask differ in size", "give planes of one size");
  }
  if (!(options.mm_per_pixel > 0 && options.mm_per_pixel <= 1e6)) {
    return usage("mm_per_pixel is not between 0 and a million", "give the millimetres a pixel covers");
  }
  if (!(options.steepest_deg > 0 && options.steepest_deg < 90)) {
    return usage("the steepest slope is not between 0 and 90 degrees", "set it below 90, such as 85");
  }
  if (!(options.tolerance >= 0) || options.most_cycles < 1 || options.seed_relaxations < 1) {
    return usage("a tolerance is negative or a count below 1", "leave them as they are by default");
  }
  return {};
}

struct Misfit {
  double squares = 0, weight = 0;
  friend Misfit operator+(Misfit a, Misfit b) { return {a.squares + b.squares, a.weight + b.weight}; }
};

// Rms of h(b) - h(a) less the step wanted, over all pairs of neighbours.
double slope_residual_rms(const Slopes& slopes, const SlopeSurvey& survey, View<const float> height,
                          int threads) {
  const int width = height.width();
  const Misfit misfit = sum_over_bands(height.height(), threads, [&](int y0, int y1) {
    Misfit sum;
    StepWalk walk(slopes, survey, y0);
    for (int y = y0; y < y1; ++y) {
      if (y > y0) walk.advance();
      const StepRow& step = walk.here();
      const float* h = height.row(y);
      const float* below = height.row(std::min(y + 1, height.height() - 1));
      const auto add = [&sum](double rise, float wanted, double weight) {
        sum.squares += weight * (rise - wanted) * (rise - wanted);
        sum.weight += weight;
      };
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        if (x + 1 < width) add(double{h[x + 1]} - h[x], step.right[i], step.right_weight[i]);
        add(double{below[x]} - h[x], step.down[i], step.down_weight[i]);
      }
    }
    return sum;
  });
  return misfit.weight > 0 ? std::sqrt(misfit.squares / misfit.weight) : 0;
}

// From pixels to millimetres, with the mean slope put back about the middle of the frame.
void finish(const SlopeSurvey& survey, double mm_per_pixel, View<float> height, int threads) {
  const double middle_x = (height.width() - 1) / 2.0, middle_y = (height.height() - 1) / 2.0;
  for_each_band(height.height(), threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      float* row = height.row(y);
      for (int x = 0; x < height.width(); ++x) {
        const double plane = survey.mean_right * (x - middle_x) + survey.mean_down * (y - middle_y);
        row[x] = static_cast<float>((row[x] + plane) * mm_per_pixel);
      }
    }
  });
}

}  // namespace

MultigridReport solve_weighted(const Slopes& slopes, const SlopeSurvey& survey, const Islands& islands,
                               double tolerance, int most_cycles, View<float> height, int threads) {
  std::vector<GridLevel> levels;
  levels.emplace_back(slopes.size());
  fill_finest(slopes, survey, levels.front(), threads);
  add_coarser_levels(levels, threads);
  GridLevel& finest = levels.front();
  PaddedPlane direction(slopes.size());
  const double start = std::sqrt(dot_of(finest.source, finest.source, threads));
  if (start == 0) return {};

  // Conjugate gradients: finest.source is the residual r, finest.height z = M^-1 r, direction p.
  MultigridReport report = {0, 1};
  double rz_before = 0;
  while (report.residual > tolerance && report.cycles < most_cycles) {
    v_cycle(levels, 0, threads);
    // What z holds of an island's free constant answers the rounding of r alone, and would outgrow the rest.
    islands.remove_means(finest.height.view(), threads);
    ++report.cycles;
    const double rz = dot_of(finest.source, finest.height, threads);
    turn(finest, rz_before > 0 ? rz / rz_before : 0, direction, threads);
    rz_before = rz;
    apply(finest, direction, threads);
    const double curvature = dot_of(direction, finest.scratch, threads);
    if (!(rz > 0) || !(curvature > 0)) break;  // nothing is left that floats can hold
    advance(finest, direction, rz / curvature, height, threads);
    report.residual = std::sqrt(dot_of(finest.source, finest.source, threads)) / start;
  }
  return report;
}

Result<Height> height_from_normals(const std::array<View<const float>, 3>& normal,
                                   View<const std::uint8_t> mask, const HeightOptions& options) {
  if (Result<void> good = check(normal, mask, options); !good) return std::move(good).error();
  const int threads = options.threads;
  const double steepest = std::tan(radians(options.steepest_deg));
  const Slopes given(normal, mask, steepest);
  const SlopeSurvey survey = survey_of(given, threads);
  if (survey.pixels == 0) {
    return Error{ErrorKind::kBadData, "no height from these normals", "",
                 "no pixel inside the mask has a normal", "look at the normal map and the mask"};
  }
  if (options.method == HeightMethod::kDct && !survey.all_alike) {
    return usage("the cosine transform needs a whole frame of equal weight", "choose automatic or multigrid");
  }

  const Slopes slopes(normal, survey.all_alike ? View<const std::uint8_t>() : mask, steepest);
  Height result;
  result.height_mm = Image<float>(given.size());
  result.method = options.method;
  if (result.method == HeightMethod::kAutomatic) {
    result.method = survey.all_alike ? HeightMethod::kDct : HeightMethod::kMultigrid;
  }
  result.pixels = survey.pixels;
  result.clamped = survey.clamped;
  std::optional<Islands> islands;  // a whole frame is one, and the cosine transform gives it mean 0
  if (result.method != HeightMethod::kDct) islands.emplace(slopes);
  result.islands = islands ? islands->count() : 1;
  const View<float> height = result.height_mm.plane();
  if (result.method == HeightMethod::kDct) {
    solve_whole_frame(slopes, survey, height, threads);
  } else if (result.method == HeightMethod::kSeed) {
    solve_as_seed(slopes, survey, {options.seed_relaxations, options.seed_signs_as_printed}, height, threads);
  } else {
    const MultigridReport report =
        solve_weighted(slopes, survey, *islands, options.tolerance, options.most_cycles, height, threads);
    result.cycles = report.cycles;
    result.residual = report.residual;
  }
  result.slope_residual_rms = slope_residual_rms(slopes, survey, height, threads);
  finish(survey, options.mm_per_pixel, height, threads);
  if (islands) {
    islands->remove_means(height, threads);
    islands->clear_outside(height, threads);
  }
  return result;
}

}  // namespace weft::solver
