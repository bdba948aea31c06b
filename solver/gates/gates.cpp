// SPDX-License-Identifier: Apache-2.0
#include "solver/gates/gates.h"

#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"
#include "solver/height/height.h"
#include "solver/transport/horizon.h"

namespace weft::solver {
namespace {

// What the pixels of all samples add up to.
struct Totals {
  std::vector<float> slopes_deg;
  std::int64_t readings = 0, shadowed = 0, pixels = 0, specular = 0;
  double albedo = 0, openness = 0;
};

bool is_solved(const SolvedSample& sample, int x, int y) {
  return (sample.status(x, y) & kNoSolution) == 0;
}

void add_pixels(const SolvedSample& sample, Totals& totals) {
  totals.readings += sample.readings;
  totals.shadowed += sample.shadowed;
  for (int y = 0; y < sample.albedo.height(); ++y) {
    for (int x = 0; x < sample.albedo.width(); ++x) {
      if (!is_solved(sample, x, y)) continue;
      ++totals.pixels;
      totals.specular += (sample.status(x, y) & kSpecular) != 0;
      totals.albedo += static_cast<double>(sample.albedo(x, y));
      const double across = std::hypot(sample.normal[0](x, y), sample.normal[1](x, y));
      totals.slopes_deg.push_back(
          static_cast<float>(degrees(std::atan2(across, static_cast<double>(sample.normal[2](x, y))))));
    }
  }
}

// Adds the openness of the sample's own relief, in pixels.
Result<void> add_openness(const SolvedSample& sample, Totals& totals) {
  HeightOptions options;
  options.threads = 1;
  Result<Height> height = height_from_normals(sample.normal, {}, options);
  if (!height) return std::move(height).error();
  const Result<Relief> relief = Relief::of(height->height_mm.plane(), 1);
  if (!relief) return relief.error();
  const Size size = height->height_mm.size();
  Image<float> openness(size);
  const Result<void> scanned =
      scan_openness(*relief, {0, 0, size.width, size.height},
                    {sample.normal[0], sample.normal[1], sample.normal[2]}, {}, openness.plane());
  if (!scanned) return scanned.error();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (is_solved(sample, x, y)) totals.openness += static_cast<double>(openness(x, y));
    }
  }
  return {};
}

Gate gate(const char* name, double value, double limit, const char* unit) {
  return {name, value, limit, unit, value > limit};
}

}  // namespace

Result<Gates> measure_gates(std::span<const SolvedSample> samples, const GateLimits& limits,
                            AlbedoScale scale) {
  Totals totals;
  for (const SolvedSample& sample : samples) {
    add_pixels(sample, totals);
    if (Result<void> ok = add_openness(sample, totals); !ok) return std::move(ok).error();
  }
  if (totals.pixels == 0) {
    return Error{ErrorKind::kBadData, "cloth cannot be judged", "sample tiles", "no pixel has a solution",
                 "look at status.png of a solve with --quality standard"};
  }
  const auto share = [](std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  const auto pixels = static_cast<double>(totals.pixels);
  const auto slope_deg = static_cast<double>(lower_quantile(std::move(totals.slopes_deg), 0.95));
  const double albedo = scale == AlbedoScale::kAbsolute ? totals.albedo / pixels : 1;
  const double indirect = albedo * (1 - totals.openness / pixels);
  return Gates{
      gate("slope", slope_deg, limits.slope_deg, "degrees"),
      gate("shadowed", share(totals.shadowed, totals.readings), limits.shadowed_share, "of readings"),
      gate("indirect", indirect, limits.indirect_share, "of direct light"),
      gate("specular", share(totals.specular, totals.pixels), limits.specular_share, "of pixels")};
}

}  // namespace weft::solver
