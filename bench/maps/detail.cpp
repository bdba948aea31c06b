// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "bench/maps/facets.h"
#include "core/parallel.h"
#include "material/filtering/detail.h"
#include "material/filtering/gloss.h"

namespace weft::bench {
namespace {

using material::GlossJoin;
using material::NormalBlend;

// The detail as it lies on a base: turned by what turns z to the base normal the shortest way.
Vec3 turned_onto(Vec3 base, Vec3 detail) {
  const Vec3 axis = cross({0, 0, 1}, base);
  const Vec3 once = cross(axis, detail);
  return detail + once + (1 / (1 + base.z)) * cross(axis, once);
}

Json blend_row(double tilt_deg, const NormalSquare& detail, NormalBlend blend) {
  double to_heights = 0, to_turned = 0, count = 0;
  for (const double azimuth_deg : {0.0, 45.0, 90.0}) {
    const double tilt = radians(tilt_deg), azimuth = radians(azimuth_deg);
    const Vec3 base = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                       std::cos(tilt)};
    for (const Vec3 n : detail.normals) {
      const Vec3 joined = material::blended(base, n, blend);
      to_heights += angle_deg(joined, material::blended(base, n, NormalBlend::kAddSlopes));
      to_turned += angle_deg(joined, turned_onto(base, n));
      count += 1;
    }
  }
  return {{"base_tilt_deg", tilt_deg},
          {"detail", detail.name},
          {"detail_slope_deg", detail.slope_deg},
          {"blend", material::name_of(blend)},
          {"to_summed_heights_deg", to_heights / count},
          {"to_turned_detail_deg", to_turned / count}};
}

/// Light that facets reflect, and what single lobes would.
class FacetsOnFacets {
 public:
  FacetsOnFacets(double base, double detail) {
    std::mt19937 random(5);
    const std::vector<Vec3> facets = ggx_facets(base, 3000, random);
    lights_ = cosine_lights(200, random);
    // As many where they are brightest.
    for (const Vec3 n : ggx_facets(std::max(base, detail), 200, random)) {
      const Vec3 l = (2 * dot(n, view_)) * n - view_;
      if (l.z > 0.05) lights_.push_back(l);
    }
    for (const Vec3 l : lights_) {
      double sum = 0;
      for (const Vec3 n : facets) sum += reflected(n, {detail, detail, 0}, l, view_);
      truth_.push_back(sum / static_cast<double>(facets.size()));
    }
  }

  double relative_rms(double alpha) const {
    double off = 0, all = 0;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      off += std::pow(reflected({0, 0, 1}, {alpha, alpha, 0}, lights_[i], view_) - truth_[i], 2);
      all += truth_[i] * truth_[i];
    }
    return std::sqrt(off / all);
  }

  double best_alpha() const {
    double best = 0.03;
    for (double alpha = 0.03; alpha <= 1; alpha *= 1.02) {
      if (relative_rms(alpha) < relative_rms(best)) best = alpha;
    }
    return best;
  }

 private:
  Vec3 view_ = {std::sin(0.3), 0, std::cos(0.3)};
  std::vector<Vec3> lights_;
  std::vector<double> truth_;
};

Json join_row(double base, double detail) {
  const FacetsOnFacets truth(base, detail);
  const double best = truth.best_alpha();
  Json row = {{"base", base}, {"detail", detail}, {"best", best}, {"best_rms", truth.relative_rms(best)}};
  const auto add = [&](const std::string& name, GlossJoin join) {
    const double alpha = material::joined_alpha(base, detail, join);
    row[name] = alpha;
    row[name + "_rms"] = truth.relative_rms(alpha);
  };
  add("measured", GlossJoin::kMeasured);
  add("lengths", GlossJoin::kLengths);
  add("variances", GlossJoin::kVariances);
  add("printed", GlossJoin::kPrintedGlosses);
  return row;
}

}  // namespace

/// Normals of a detail layer joined with those of a tilted base: mean degrees to the normals of summed
/// heights, and to the detail turned onto the base normal. A row each tilt, weave and blend.
Result<Rows> maps_detail(const StudyOptions& options) {
  Rows rows;
  for (const NormalSquare& cloth : page_weaves(options.threads)) {
    if (cloth.name == "satin") continue;
    for (const double tilt_deg : {5.0, 15.0, 30.0, 45.0}) {
      for (const NormalBlend blend :
           {NormalBlend::kAddSlopes, NormalBlend::kWhiteout, NormalBlend::kRnm, NormalBlend::kBlendXy}) {
        rows.push_back(blend_row(tilt_deg, cloth, blend));
      }
    }
  }
  return rows;
}

/// Facets of one alpha on facets of another: the single alpha that reflects most like it, and what each rule
/// of joining says, with its relative rms.
Result<Rows> maps_gloss(const StudyOptions& options) {
  struct AlphaPair {
    double base, detail;
  };
  std::vector<AlphaPair> pairs;
  constexpr std::array kJoinedAlphas = {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7};
  for (const double base : kJoinedAlphas) {
    for (const double detail : kJoinedAlphas) {
      if (detail >= base) pairs.push_back({base, detail});
    }
  }
  Rows rows(pairs.size());
  parallel_for(pairs.size(), options.threads,
               [&](std::size_t i, int) { rows[i] = join_row(pairs[i].base, pairs[i].detail); });
  return rows;
}

}  // namespace weft::bench
