// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/translucent_cloth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/rig/camera.h"
#include "core/rig/veil.h"
#include "solve/conditions/bladed_frame.h"
#include "solve/conditions/cloth_windows.h"
#include "solver/gates/told_spread.h"
#include "solver/transport/cloth_spread.h"

namespace weft::solve {
namespace {

constexpr int kRowsAtATime = 64;
constexpr double kLeastDistance_px = 2;  // nearer than that cells do not carry the light

std::optional<double> pixel_mm(const Exposures& exposures) {
  const Photographs& photographs = exposures.photographs;
  if (!photographs.camera) return exposures.plan.input.mm_per_pixel;
  const double x = photographs.size.width / 2.0, y = photographs.size.height / 2.0;
  const double height_mm = photographs.field->cloth_height_mm();
  return length(point_on_plane(*photographs.camera, x + 1, y, height_mm) -
                point_on_plane(*photographs.camera, x, y, height_mm));
}

CoarseLight light_of(const Frames& frames, const Planes& planes, Size size, std::size_t k, int side) {
  CoarseLight light(size, side);
  Image<float> scratch({size.width, kRowsAtATime});
  for (int y0 = 0; y0 < size.height; y0 += kRowsAtATime) {
    const Rect rows = {0, y0, size.width, std::min(y0 + kRowsAtATime, size.height)};
    const auto views = readings_of(frames, k, rows, scratch.plane());
    for (int plane = 0; plane < planes.count; ++plane) {
      for (int y = rows.y0; y < rows.y1; ++y) {
        const float* row = views[static_cast<std::size_t>(plane)].row(y - rows.y0);
        for (int x = 0; x < size.width; ++x) light.add(x, y, planes.channel_at(plane, x, y), row[x]);
      }
    }
  }
  return light;
}

// The mean of each cell; of cells without light that of all.
Image<float> means_of(const CoarseLight& light) {
  const Size cells = light.cells();
  Image<float> means(cells, 3);
  for (int c = 0; c < 3; ++c) {
    double sum = 0, count = 0;
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) sum += light.sum(x, y, c), count += light.count(x, y, c);
    }
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) {
        const double here = light.count(x, y, c);
        means(x, y, c) =
            static_cast<float>(here > 0 ? light.sum(x, y, c) / here : sum / std::max(count, 1.0));
      }
    }
  }
  return means;
}

// The middle of each colour's photosites within a cell.
std::array<solver::SeenAt, 3> seen_at(const Planes& planes, int side) {
  std::array<solver::SeenAt, 3> places;
  for (int c = 0; planes.count == 1 && c < 3; ++c) {
    int sites = 0;
    solver::SeenAt sum;
    for (const int y : {0, 1}) {
      for (const int x : {0, 1}) {
        if (planes.cfa.channel_at(x, y) != c) continue;
        sum = {sum.x + x - 0.5, sum.y + y - 0.5};
        ++sites;
      }
    }
    if (sites > 0) places[static_cast<std::size_t>(c)] = {sum.x / sites / side, sum.y / sites / side};
  }
  return places;
}

BesideLight beside_light(const Frames& frames, const Planes& planes, Size size, double share, double mean_px,
                         const JobContext& context) {
  BesideLight beside = {share, {}};
  const int side = solver::side_of_spread_cells(mean_px, planes.count == 1);
  const std::size_t count = std::visit([](const auto& kind) { return kind.count(); }, frames);
  const std::array<solver::SeenAt, 3> places = seen_at(planes, side);
  std::vector<Image<float>> lights(count);
  parallel_for(count, context.threads, [&](std::size_t k, int) {
    const Image<float> seen = means_of(light_of(frames, planes, size, k, side));
    lights[k] = solver::light_from_beside(seen, places, share, mean_px / side, 1);
  });
  for (Image<float>& light : lights) beside.frames.emplace_back(side, std::move(light));
  return beside;
}

// How the cloth spreads light, as it is said, and how sure slopes are once it is undone.
struct Spreading {
  ClothSpreadFacts facts;
  double mean_px = 0;      // 0: there is nothing to undo
  double sigma_slope = 0;  // share of them
};

// What the blade's shadow tells; none where it cannot be read, which is said.
std::optional<Spreading> told_by_blade(const Exposures& exposures, double mm) {
  const Result<solver::BladeShadow> shadow = read_bladed_frame(exposures, mm);
  if (!shadow) {
    const Error& error = shadow.error();
    exposures.photographs.conditions.of_frames.push_back(
        {"BLADE_SHADOW",
         fmt::format("How the cloth spreads light was not measured: {}, in {}", error.why, error.where),
         error.remedy});
    return std::nullopt;
  }
  const double share = shadow->spread.share, mean_mm = shadow->spread.mean_mm;
  Spreading spreading;
  spreading.facts = {.said = "not_observable",
                     .share = share,
                     .share_sigma = shadow->share_sigma,
                     .led = exposures.plan.blade->led};
  if (!shadow->tells() || mean_mm < kLeastDistance_px * mm) return spreading;
  spreading.facts.said = "measured";
  spreading.facts.mean_mm = mean_mm;
  spreading.facts.mean_sigma_mm = shadow->mean_sigma_mm;
  spreading.mean_px = mean_mm / mm;
  // What is spread far has no slope, and all else keeps the rest of the share.
  spreading.sigma_slope = shadow->share_sigma / (1 - share);
  return spreading;
}

// What a person said of it; none where it is nothing, or too near, which is said.
std::optional<Spreading> told_by_person(const Exposures& exposures, double mm) {
  const solver::ClothSpread& spread = *exposures.plan.cloth_spread;
  const double mean_px = spread.mean_mm / mm;
  if (spread.share == 0) return std::nullopt;
  if (mean_px >= kLeastDistance_px)
    return Spreading{{.share = spread.share, .mean_mm = spread.mean_mm}, mean_px, 0};
  exposures.photographs.conditions.warnings.push_back(
      fmt::format("light leaves the cloth {:.2g} pixels from where it entered; of less than {} pixels it is "
                  "left as it is",
                  mean_px, kLeastDistance_px));
  return std::nullopt;
}

// What its own photographs tell of it; none where they tell of none.
std::optional<Spreading> told_by_cloth(const Exposures& exposures, std::optional<double> mm) {
  const int threads = exposures.context.threads;
  const ClothWindows cloth = cloth_windows(exposures.photographs, threads);
  const std::optional<solver::ToldSpread> told = solver::told_spread(cloth.windows, threads);
  if (!told) return std::nullopt;
  const double mean_px = std::max(told->mean_cells * cloth.cell_px, kLeastDistance_px);
  Spreading spreading = {
      {.said = "told", .share = told->share, .share_sigma = told->sigma_share}, mean_px, told->sigma_slope};
  if (mm) spreading.facts.mean_mm = mean_px * *mm;
  return spreading;
}

// The mean of both by how sure they are, where they agree; else what the blade measured.
Spreading joined(const Spreading& blade, const Spreading& cloth, double mm) {
  constexpr double kAgree = 2.5;  // sigma
  const double of_blade = blade.facts.share_sigma.value_or(0), of_cloth = cloth.facts.share_sigma.value_or(0);
  const double apart = std::abs(blade.facts.share - cloth.facts.share);
  if (!(of_blade > 0 && of_cloth > 0) || apart > kAgree * std::hypot(of_blade, of_cloth)) return blade;
  const double weight = 1 / (1 + std::pow(of_blade / of_cloth, 2));  // of the blade
  const auto between = [&](double a, double b) { return weight * a + (1 - weight) * b; };
  Spreading both = blade;
  both.facts.share = between(blade.facts.share, cloth.facts.share);
  both.facts.share_sigma = of_blade * std::sqrt(weight);
  both.mean_px = std::exp(between(std::log(blade.mean_px), std::log(cloth.mean_px)));
  both.facts.mean_mm = both.mean_px * mm;
  both.sigma_slope = std::min(blade.sigma_slope, cloth.sigma_slope);
  return both;
}

Result<std::optional<Spreading>> told_spreading(const Exposures& exposures) {
  const SolvePlan& plan = exposures.plan;
  const std::optional<double> mm = pixel_mm(exposures);
  if ((plan.cloth_spread && plan.cloth_spread->share > 0) || plan.blade) {
    if (!mm) {
      return Error{ErrorKind::kUsage, "light that spreads in the cloth cannot be taken off", plan.where,
                   "nothing says how large a pixel is on the cloth", "say it with --mm-per-pixel"};
    }
  }
  if (plan.cloth_spread) return mm ? told_by_person(exposures, *mm) : std::optional<Spreading>();
  const std::optional<Spreading> blade = plan.blade ? told_by_blade(exposures, *mm) : std::nullopt;
  if (blade && blade->mean_px == 0) return blade;
  const std::optional<Spreading> cloth = told_by_cloth(exposures, mm);
  return blade && cloth ? std::optional(joined(*blade, *cloth, *mm)) : blade ? blade : cloth;
}

}  // namespace

Result<void> take_off_spread_light(const Exposures& exposures) {
  const Result<std::optional<Spreading>> told = told_spreading(exposures);
  if (!told) return told.error();
  if (!*told) return {};
  const Spreading& spreading = **told;
  Photographs& photographs = exposures.photographs;
  photographs.conditions.facts.cloth_spread = spreading.facts;
  photographs.sigma_slope = spreading.sigma_slope;
  if (spreading.mean_px == 0) return {};
  photographs.conditions.facts.cloth_spread->mean_px = spreading.mean_px;
  const auto take_off = [&](Frames& frames) {
    take_off_beside(beside_light(frames, photographs.planes(), photographs.size, spreading.facts.share,
                                 spreading.mean_px, exposures.context),
                    frames);
  };
  take_off(photographs.frames);
  if (photographs.parallel) take_off(*photographs.parallel);
  return {};
}

}  // namespace weft::solve
