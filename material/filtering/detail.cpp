// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/solve/solve_record.h"

namespace weft::material {
namespace {

struct BlendName {
  NormalBlend blend;
  const char* name;
};
constexpr std::array<BlendName, 4> kBlendNames = {{{NormalBlend::kAddSlopes, "add-slopes"},
                                                   {NormalBlend::kWhiteout, "whiteout"},
                                                   {NormalBlend::kRnm, "rnm"},
                                                   {NormalBlend::kBlendXy, "blend-xy"}}};

/// Weighted sums of what a layer has taken out, and how much there was.
struct DetailSums {
  double weight = 0;
  std::array<double, 6> sum = {};  // slopes x, y, albedo of three channels, height
};

/// Pixels of a side that whole repeats cover; the last by a share.
double covered(double repeat_px, int side, bool is_tile) {
  if (is_tile || repeat_px <= 0) return side;
  return std::floor(side / repeat_px + 1e-9) * repeat_px;
}

double share_of(int i, double covered_px) {
  return std::clamp(covered_px - i, 0.0, 1.0);
}

double weight_of(const Surface& surface, int x, int y) {
  if ((surface.status(x, y) & kNoSolution) != 0) return 0;
  return surface.opacity.empty() ? 1 : double{surface.opacity(x, y)};
}

DetailSums sums_over(const Surface& surface, View<const float> height_mm, double width, double height,
                     int threads) {
  std::vector<DetailSums> rows(static_cast<std::size_t>(surface.size().height));
  parallel_for(rows.size(), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < surface.size().width; ++x) {
      const double w = weight_of(surface, x, y) * share_of(x, width) * share_of(y, height);
      if (!(w > 0)) continue;
      const float z = height_mm.empty() ? 0.0F : height_mm(x, y);
      const std::array<float, 6> values = {surface.slope(x, y, 0),  surface.slope(x, y, 1),
                                           surface.albedo(x, y, 0), surface.albedo(x, y, 1),
                                           surface.albedo(x, y, 2), z};
      rows[row].weight += w;
      for (std::size_t i = 0; i < values.size(); ++i) rows[row].sum[i] += w * double{values[i]};
    }
  });
  DetailSums all;
  for (const DetailSums& row : rows) {
    all.weight += row.weight;
    for (std::size_t i = 0; i < all.sum.size(); ++i) all.sum[i] += row.sum[i];
  }
  return all;
}

Error no_layer(ErrorKind kind, std::string why, std::string remedy) {
  return {kind, "the cloth makes no detail layer", "detail layer", std::move(why), std::move(remedy)};
}

DetailLayer layer_of(const Surface& surface, View<const float> height_mm, const DetailFacts& facts,
                     int threads) {
  DetailLayer layer = {Image<float>(surface.size(), 2), Image<float>(surface.size(), 3), {}, facts};
  if (!height_mm.empty()) layer.height_mm = Image<float>(surface.size());
  parallel_for(static_cast<std::size_t>(surface.size().height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < surface.size().width; ++x) {
      const bool solved = (surface.status(x, y) & kNoSolution) == 0;
      const auto less = [&](float value, double mean) {
        return solved ? static_cast<float>(double{value} - mean) : 0.0F;
      };
      layer.slope(x, y, 0) = less(surface.slope(x, y, 0), facts.slope_x);
      layer.slope(x, y, 1) = less(surface.slope(x, y, 1), facts.slope_y);
      for (int c = 0; c < 3; ++c) {
        const double mean = facts.albedo[static_cast<std::size_t>(c)];
        layer.albedo(x, y, c) =
            solved && mean > 0 ? static_cast<float>(double{surface.albedo(x, y, c)} / mean) : 1.0F;
      }
      if (!height_mm.empty()) layer.height_mm(x, y) = less(height_mm(x, y), facts.height_mm);
    }
  });
  return layer;
}

}  // namespace

Result<DetailLayer> detail_layer(const Surface& surface, View<const float> height_mm,
                                 const DetailOptions& options) {
  const Size size = surface.size();
  if (!height_mm.empty() && height_mm.size() != size) {
    return no_layer(ErrorKind::kUsage,
                    fmt::format("the height has {} x {} pixels and the surface {} x {}", height_mm.width(),
                                height_mm.height(), size.width, size.height),
                    "give the height of this surface");
  }
  const double width = covered(options.repeat.x_px, size.width, surface.is_tile),
               height = covered(options.repeat.y_px, size.height, surface.is_tile);
  if (!(width > 0 && height > 0)) {
    return no_layer(ErrorKind::kUsage,
                    fmt::format("no whole repeat of {:g} x {:g} pixels lies in {} x {}", options.repeat.x_px,
                                options.repeat.y_px, size.width, size.height),
                    "scan more of the cloth, or name no repeat");
  }
  const DetailSums sums = sums_over(surface, height_mm, width, height, options.threads);
  if (!(sums.weight > 0)) {
    return no_layer(ErrorKind::kBadData, "no pixel has a solution", "look at the status map of the solve");
  }
  const auto mean = [&](std::size_t i) { return sums.sum[i] / sums.weight; };
  const DetailFacts facts = {mean(0),
                             mean(1),
                             {mean(2), mean(3), mean(4)},
                             mean(5),
                             width * height / static_cast<double>(size.pixels())};
  return layer_of(surface, height_mm, facts, options.threads);
}

const char* name_of(NormalBlend blend) {
  return std::ranges::find(kBlendNames, blend, &BlendName::blend)->name;
}

std::optional<NormalBlend> normal_blend_named(std::string_view name) {
  const auto* found = std::ranges::find(kBlendNames, name, &BlendName::name);
  return found == kBlendNames.end() ? std::nullopt : std::optional(found->blend);
}

Vec3 blended(Vec3 base, Vec3 detail, NormalBlend blend) {
  const double x = base.x + detail.x, y = base.y + detail.y;
  switch (blend) {
    case NormalBlend::kAddSlopes:
      return normalized({base.x / base.z + detail.x / detail.z, base.y / base.z + detail.y / detail.z, 1});
    case NormalBlend::kWhiteout:
      return normalized({x, y, base.z * detail.z});
    case NormalBlend::kRnm: {
      const Vec3 t = {base.x, base.y, base.z + 1}, u = {-detail.x, -detail.y, detail.z};
      return normalized((dot(t, u) / t.z) * t - u);
    }
    case NormalBlend::kBlendXy:
      break;
  }
  return normalized({x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))});
}

}  // namespace weft::material
