// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/contenders.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "core/tiles.h"
#include "pipeline/bands.h"
#include "pipeline/frame.h"
#include "pipeline/tile_reader.h"

namespace weft::bench {
namespace {

Result<void> solve_patch(const solver::Method& method, const std::vector<View<const float>>& readings,
                         const Patch& patch, int threads, SolvedMaps& maps) {
  return solve_images(method, readings, patch.field(), patch.photographs.planes().cfa,
                      patch.photographs.noise(), threads, maps);
}

// Puts bands of a frame into maps; albedo in each photosite's own colour where it was measured alone.
pipeline::BandSink keeper_of(const pipeline::Planes& planes, SolvedMaps& maps) {
  maps.planes = planes.count;
  return [planes, &maps](const pipeline::MapBand& band) -> Result<void> {
    for (int y = 0; y < band.rows.height(); ++y) {
      const int row = band.rows.y0 + y;
      for (int c = 0; c < 3; ++c) {
        std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), band.rows.width(),
                    maps.normal.plane(c).row(row));
      }
      std::copy_n(band.status.row(y), band.rows.width(), maps.status.plane().row(row));
    }
    for (int y = 0; y < band.albedo_rows.height(); ++y) {
      const int row = band.albedo_rows.y0 + y;
      for (int x = 0; x < band.albedo_rows.width(); ++x) {
        for (int p = 0; p < planes.count; ++p) {
          const auto c = static_cast<std::size_t>(planes.channel_at(p, x, row));
          maps.albedo(x, row, p) = band.albedo[c](x, y);
          maps.sigma_albedo(x, row, p) = band.sigma_albedo[c](x, y);
        }
        maps.sigma_normal_deg(x, row) = band.sigma_normal_deg(x, y);
      }
    }
    return {};
  };
}

JobContext on_threads(int threads) {
  JobContext context;
  context.threads = threads;
  return context;
}

// Least squares on what each point truly faces and sees.
Result<void> solve_oracle(const Patch& patch, int threads, SolvedMaps& maps) {
  Image<float> seen(patch.size(), patch.readings.planes());
  for (int k = 0; k < seen.planes(); ++k) {
    for (int y = 0; y < seen.height(); ++y) {
      for (int x = 0; x < seen.width(); ++x) {
        seen(x, y, k) =
            patch.visible(x, y, k) > 0 ? patch.readings(x, y, k) : -std::numeric_limits<float>::infinity();
      }
    }
  }
  return solve_patch(*solver::least_squares_method(), planes_of(seen), patch, threads, maps);
}

// Each pixel as four of twice its size.
void enlarge(const SolvedMaps& half, SolvedMaps& maps) {
  const Size size = maps.status.size();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const int u = std::min(x / 2, half.status.width() - 1), v = std::min(y / 2, half.status.height() - 1);
      for (int c = 0; c < 3; ++c) {
        maps.normal(x, y, c) = half.normal(u, v, c);
        maps.albedo(x, y, c) = half.albedo(u, v, c);
        maps.sigma_albedo(x, y, c) = half.sigma_albedo(u, v, c);
      }
      maps.sigma_normal_deg(x, y) = half.sigma_normal_deg(u, v);
      maps.residual(x, y) = half.residual(u, v);
      maps.status(x, y) = half.status(u, v);
    }
  }
}

// Each pixel of a preview stands for the four photosites that it was made of.
Result<void> solve_at_half_size(const Patch& patch, const solver::MethodName& level, int threads,
                                SolvedMaps& maps) {
  const Result<pipeline::Photographs> half = pipeline::half_size(patch.photographs, threads);
  if (!half) return half.error();
  SolvedMaps solved(half->size);
  const Result<pipeline::FrameFacts> facts = solve_level(*half, level, threads, solved);
  if (!facts) return facts.error();
  maps.planes = solved.planes;
  maps.left_out_rel = solved.left_out_rel;
  enlarge(solved, maps);
  return {};
}

}  // namespace

Result<pipeline::FrameFacts> solve_level(const pipeline::Photographs& photographs,
                                         const solver::MethodName& level, int threads, SolvedMaps& maps) {
  Result<pipeline::FrameFacts> facts = solve_frame(
      photographs, level, pipeline::kSolveTile, on_threads(threads), keeper_of(photographs.planes(), maps));
  maps.lobe_seconds = facts && facts->gloss ? facts->gloss->seconds : 0;
  if (facts && facts->left_out) maps.left_out_rel = solver::error_of_all(*facts->left_out).median;
  return facts;
}

SolvePatch as_product(std::shared_ptr<const solver::Method> method) {
  return [method](const Patch& patch, int threads, SolvedMaps& maps) -> Result<void> {
    if (!method->wants_rgb()) {
      return solve_patch(*method, planes_of(patch.readings), patch, threads, maps);
    }
    const TileOptions whole = {.width = patch.size().width, .height = patch.size().height};
    pipeline::TileReader reader(patch.photographs, whole, pipeline::ReadAs::kRgb);
    maps.planes = 3;
    const auto readings = reader.read(patch.area()).readings;
    return solve_patch(*method, {readings.begin(), readings.end()}, patch, threads, maps);
  };
}

SolvePatch by_level(const solver::MethodName& level) {
  return [level](const Patch& patch, int threads, SolvedMaps& maps) {
    if (level.extent == solver::Extent::kHalfSize) return solve_at_half_size(patch, level, threads, maps);
    const Result<pipeline::FrameFacts> facts = solve_level(patch.photographs, level, threads, maps);
    return facts ? Result<void>() : facts.error();
  };
}

SolvePatch by_reference(const pipeline::ReferenceOptions& options) {
  return [options](const Patch& patch, int threads, SolvedMaps& maps) -> Result<void> {
    const auto solved = solve_reference(patch.photographs, pipeline::kSolveTile, options, on_threads(threads),
                                        keeper_of(patch.photographs.planes(), maps));
    return solved ? Result<void>() : solved.error();
  };
}

std::vector<std::string> level_names() {
  std::vector<std::string> names;
  for (const solver::MethodName& name : solver::method_names()) {
    if (name.level) names.emplace_back(name.name);
  }
  return names;
}

std::vector<Contender> contenders() {
  std::vector<Contender> all;
  for (const solver::MethodName& name : solver::method_names()) {
    if (name.level) {
      all.push_back({name.name, by_level(name), true, false, 1});
      continue;
    }
    std::shared_ptr<const solver::Method> method = name.make();
    const int planes = method->wants_rgb() ? 3 : 1;
    all.push_back({name.name, as_product(std::move(method)), false, false, planes});
  }
  all.push_back({"oracle", solve_oracle, false, true, 1});
  return all;
}

Result<std::vector<Contender>> contenders_named(const std::vector<std::string>& names) {
  std::vector<Contender> all = contenders(), chosen;
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const Contender& contender : all) known.push_back(contender.name);
  for (const std::string& name : names) {
    if (std::count(known.begin(), known.end(), name) == 0) return no_such("method", name, known);
  }
  for (Contender& contender : all) {
    const bool asked = std::count(names.begin(), names.end(), contender.name) > 0;
    if (asked || contender.is_yardstick) chosen.push_back(std::move(contender));
  }
  return chosen;
}

Result<void> solve_images(const solver::Method& method, const std::vector<View<const float>>& readings,
                          const LightField& field, const CfaPattern& cfa,
                          const std::optional<NoiseModel>& noise, int threads, SolvedMaps& maps,
                          const std::array<double, 3>& plane_weights) {
  TileOptions tiles = pipeline::kSolveTile;
  tiles.threads = threads;
  const Size size = maps.status.size();
  return for_each_tile({0, 0, size.width, size.height}, tiles, {}, [&](Rect tile, int) {
    std::vector<View<const float>> cropped;
    for (const View<const float>& view : readings) cropped.push_back(view.crop(tile));
    method.solve({tile, maps.planes, cfa, cropped, &field, noise, plane_weights}, maps.output(tile));
  });
}

std::vector<View<const float>> planes_of(const Image<float>& readings) {
  std::vector<View<const float>> views;
  for (int k = 0; k < readings.planes(); ++k) views.emplace_back(readings.plane(k));
  return views;
}

Error no_such(const char* what, const std::string& name, const std::vector<std::string>& names) {
  return {ErrorKind::kUsage, fmt::format("no such {}", what), name,
          fmt::format("there are {}", fmt::join(names, ", ")), "choose one of these names"};
}

}  // namespace weft::bench
