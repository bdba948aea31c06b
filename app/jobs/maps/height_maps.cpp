// SPDX-License-Identifier: Apache-2.0
// Height, and what the relief hides of the sky.
#include <utility>

#include "app/jobs/maps/map_work.h"
#include "core/solve_record.h"
#include "core/statistics.h"
#include "solver/height/tiled_height.h"

namespace weft::app {
namespace {

using material::Surface;

// Half of the pixels that have a sigma have less.
double usual_sigma(const Surface& surface) {
  std::vector<double> some;
  for (int y = 0; y < surface.size().height; y += 7) {
    for (int x = 0; x < surface.size().width; x += 7) {
      if ((surface.status(x, y) & kNoSolution) == 0)
        some.push_back(static_cast<double>(surface.sigma_deg(x, y)));
    }
  }
  return some.empty() ? 1 : median(some);
}

// The slopes as normals, which solvers of heights read; pixels without a solution have no weight.
solver::NormalRows normals_of(const Surface& surface, bool weighs_by_sigma) {
  const double usual = weighs_by_sigma ? usual_sigma(surface) : 1;
  const auto read = [&surface, weighs_by_sigma, usual](int y0, const std::array<View<float>, 3>& normal,
                                                       View<std::uint8_t> weight) -> Result<void> {
    for (int y = 0; y < weight.height(); ++y) {
      for (int x = 0; x < weight.width(); ++x) {
        normal[0](x, y) = -surface.slope(x, y0 + y, 0);
        normal[1](x, y) = -surface.slope(x, y0 + y, 1);
        normal[2](x, y) = 1;
        const bool is_solved = (surface.status(x, y0 + y) & kNoSolution) == 0;
        const std::uint8_t by_sigma =
            weighs_by_sigma ? solver::weight_of_sigma(surface.sigma_deg(x, y0 + y), usual) : std::uint8_t{1};
        weight(x, y) = is_solved ? by_sigma : std::uint8_t{0};
      }
    }
    return {};
  };
  return {surface.size(), read};
}

}  // namespace

Result<void> find_height(MapWork& work) {
  if (!work.height_mm.empty()) return {};
  solver::TiledHeightOptions options;
  options.height.method = work.options.height;
  options.height.mm_per_pixel = work.surface.mm_per_pixel;
  options.height.threads = work.context.threads;
  Result<solver::TiledHeight> height =
      solver::tiled_height(normals_of(work.surface, work.options.weighs_by_sigma), options);
  if (!height) return std::move(height).error();
  work.height_mm = std::move(height->height_mm);
  return {};
}

Result<void> make_height(MapWork& work) {
  if (Result<void> ok = find_height(work); !ok) return ok;
  return write_map(work, {.name = "height", .file = "height.exr", .unit = "mm", .channels = {"height"}},
                   {work.height_mm.plane()});
}

}  // namespace weft::app
