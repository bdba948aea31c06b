// SPDX-License-Identifier: Apache-2.0
#include "solver/height/height.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/vec.h"
#include "solver/height/islands.h"
#include "solver/height/multigrid.h"
#include "solver/height/poisson.h"
#include "solver/height/row_bands.h"
#include "solver/height/seed_relaxation.h"
#include "solver/height/slopes.h"

namespace weft::solver {
namespace {

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
