// SPDX-License-Identifier: Apache-2.0
// Height, and what the relief hides of the sky.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/statistics.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve_record.h"
#include "material/finish/periodic_height.h"
#include "material/maps/cavity.h"
#include "material/maps/curl.h"
#include "material/maps/occlusion.h"
#include "material/maps/specular_occlusion.h"
#include "material/maps/visibility.h"
#include "material/run/derived_maps.h"
#include "material/run/surface_files.h"
#include "solver/height/tiled_height.h"

namespace weft::material {
namespace {

// Less hidden than this is hidden from nobody who looks.
constexpr double kOpenFrom = 0.995;

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
solver::NormalRows normal_rows_of(const Surface& surface, bool weighs_by_sigma) {
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

void scale(View<float> plane, double factor) {
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x)
      plane(x, y) = static_cast<float>(factor * static_cast<double>(plane(x, y)));
  }
}

// What of a highlight comes through the cone of bent_normal.exr: the same table for every cloth.
Result<void> write_cone_table(MapWork& work) {
  const SpecularOcclusion table;
  Image<float> share({SpecularOcclusion::kCones, SpecularOcclusion::kRoughness * SpecularOcclusion::kAngles});
  const float* next = table.values().data();
  for (int y = 0; y < share.height(); ++y, next += share.width())
    std::copy_n(next, share.width(), share.plane().row(y));
  MapFacts facts = {
      .name = "specular_occlusion", .file = "specular_occlusion.exr", .unit = "share", .channels = {"share"}};
  measure(facts, share.plane());
  facts.more = {
      {"width", share.width()},
      {"height", share.height()},
      {"columns", "cone_deg from 0 to 90"},
      {"rows", "angle of bent normal and mirror direction from 0 to 90 degrees; in each alpha from 0 to 1"}};
  const WriteOptions options = {.type = SampleType::kHalf,
                                .attributes = attributes_of(facts, stated_mm(work))};
  if (Result<void> ok = write_image(work.folder / facts.file, planes_of(share), facts.channels, options); !ok)
    return ok;
  work.made.push_back(std::move(facts));
  return {};
}

}  // namespace

Result<void> find_height(MapWork& work) {
  if (!work.height_mm.empty()) return {};
  if (work.surface.is_tile && work.options.height == solver::HeightMethod::kAutomatic) {
    PeriodicHeight periodic = periodic_height(work.surface.slope, work.context.threads);
    scale(periodic.height.plane(), work.surface.mm_per_pixel);
    work.height_mm = std::move(periodic.height);
    return {};
  }
  solver::TiledHeightOptions options;
  options.height.method = work.options.height;
  options.height.mm_per_pixel = work.surface.mm_per_pixel;
  options.height.threads = work.context.threads;
  Result<solver::TiledHeight> height =
      solver::tiled_height(normal_rows_of(work.surface, work.options.weighs_by_sigma), options);
  if (!height) return std::move(height).error();
  work.height_mm = std::move(height->height_mm);
  return {};
}

Result<void> make_height(MapWork& work) {
  if (Result<void> ok = find_height(work); !ok) return ok;
  return write_map(work, {.name = "height", .file = "height.exr", .unit = "mm", .channels = {"height"}},
                   {work.height_mm.plane()});
}

Result<void> make_curl(MapWork& work) {
  const Surface& surface = work.surface;
  CurlOptions options;
  options.yarn_px = work.yarn_px;
  options.is_tile = surface.is_tile;
  options.threads = work.context.threads;
  const Result<Curl> curl = material::curl(surface.slope.plane(0), surface.slope.plane(1),
                                           surface.sigma_deg.plane(), surface.status.plane(), options);
  if (!curl) return curl.error();
  MapFacts facts = {.name = "curl", .file = "curl.exr", .unit = "sigma", .channels = {"curl"}};
  facts.more = {{"frame_median", curl->frame_median},     {"limit", kCurlLimit},
                {"flagged_share", curl->flagged_share},   {"specular_share", curl->specular_share},
                {"shadowed_share", curl->shadowed_share}, {"window_px", curl->window_px}};
  if (curl->is_of_no_surface()) {
    work.verdicts.push_back(
        {"NO_SURFACE",
         fmt::format(
             "these normals are of no surface: around half of the pixels their slopes do not close by "
             "over {:.1f} sigma; of those {:.0f} percent are SPECULAR, {:.0f} percent SHADOWED",
             curl->frame_median, 100 * curl->specular_share, 100 * curl->shadowed_share),
         work.level == "reference" || work.level == "robust"
             ? "scan the cloth again, flat, and with crossed polarisers if it shines"
             : "solve the session with --quality robust"});
  }
  return write_map(work, std::move(facts), {curl->median.plane()});
}

Result<void> find_openness(MapWork& work) {
  if (!work.openness.empty()) return {};
  if (Result<void> ok = find_height(work); !ok) return ok;
  OcclusionOptions options;
  options.mm_per_pixel = work.surface.mm_per_pixel;
  options.directions = work.options.directions;
  options.is_tile = work.surface.is_tile;
  options.threads = work.context.threads;
  Result<Occlusion> found = occlusion(work.height_mm.plane(), options);
  if (!found) return std::move(found).error();
  work.openness = std::move(found->openness);
  work.bent_normal = std::move(found->bent_normal);
  return {};
}

// The sky that a point sees: its share, what reaches the point with the light that its surroundings throw, by
// channel, and the half angle of the cone about the bent normal that is as wide.
Result<void> make_occlusion(MapWork& work) {
  if (Result<void> ok = find_openness(work); !ok) return ok;
  const Surface& surface = work.surface;
  MapFacts facts = {.name = "occlusion", .unit = "share", .channels = {"openness", "R", "G", "B"}};
  measure(facts, work.openness.plane());
  if (facts.least > kOpenFrom) {
    write_constant(work, std::move(facts), 1, "no point sees less than 99.5 percent of the sky");
    return {};
  }
  Image<float> lit(surface.size(), 3), cone(surface.size());
  for (int y = 0; y < lit.height(); ++y) {
    for (int x = 0; x < lit.width(); ++x) {
      const double openness = static_cast<double>(work.openness(x, y));
      for (int c = 0; c < 3; ++c) {
        const double albedo = std::clamp(static_cast<double>(surface.albedo(x, y, c)), 0.0, 1.0);
        lit(x, y, c) = static_cast<float>(lit_share(openness, albedo));
      }
      cone(x, y) = static_cast<float>(cone_angle_deg(openness));
    }
  }
  facts.file = "occlusion.exr";
  facts.more = {{"directions", work.options.directions}};
  Result<void> ok =
      write_map(work, std::move(facts), {work.openness.plane(), lit.plane(0), lit.plane(1), lit.plane(2)});
  if (!ok) return ok;
  MapFacts bent = {.name = "bent_normal", .file = "bent_normal.exr", .channels = {"X", "Y", "Z", "cone_deg"}};
  ok = write_map(
      work, std::move(bent),
      {work.bent_normal.plane(0), work.bent_normal.plane(1), work.bent_normal.plane(2), cone.plane()});
  return ok ? write_cone_table(work) : ok;
}

Result<void> make_cavity(MapWork& work) {
  if (Result<void> ok = find_height(work); !ok) return ok;
  CavityOptions options;
  options.mm_per_pixel = work.surface.mm_per_pixel;
  options.radius_mm = std::max(work.options.cavity_mm, work.surface.mm_per_pixel);
  options.is_tile = work.surface.is_tile;
  options.threads = work.context.threads;
  const Result<Cavity> found = cavity(work.height_mm.plane(), options);
  if (!found) return found.error();
  MapFacts facts = {.name = "cavity", .file = "cavity.exr", .channels = {"cavity"}};
  facts.more = {{"radius_mm", options.radius_mm}, {"range_mm", found->range_mm}};
  return write_map(work, std::move(facts), {found->cavity.plane()});
}

}  // namespace weft::material
