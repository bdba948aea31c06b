// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/maps_studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bench/maps/cloths.h"
#include "bench/maps/rules.h"
#include "core/base/parallel.h"
#include "material/filtering/detail.h"
#include "material/filtering/joined_gloss.h"

namespace weft::bench {
namespace {

using material::MipRule;
using material::NormalWeight;

constexpr std::array kFootprints_px = {4, 16, 64};
constexpr std::array kViews_deg = {0.0, 75.0};
constexpr std::array kBaseAlphas = {0.1, 0.3, 0.5};

std::vector<MipContender> all_rules() {
  std::vector<MipContender> contenders;
  for (const material::MipRuleName& rule : material::kMipRules) contenders.push_back({rule.name, rule.rule});
  contenders.push_back({"vmf, facet area", MipRule::kVmf, NormalWeight::kFacet});
  contenders.push_back({"vmf-yarns, facet area", MipRule::kVmfYarns, NormalWeight::kFacet});
  return contenders;
}

/// One cloth, alpha, view and footprint.
struct MipCase {
  std::size_t cloth = 0;
  double alpha = 0, view_deg = 0;
  int side_px = 0;
  MipErrors errors;

  double error(std::size_t contender) const {
    return contender < errors.by_contender.size() ? errors.by_contender[contender] : errors.best;
  }
};

std::vector<MipCase> measured_cases(const std::vector<NormalSquare>& cloths,
                                    const std::vector<MipContender>& contenders, int threads) {
  std::vector<MipCase> cases;
  for (std::size_t cloth = 0; cloth < cloths.size(); ++cloth) {
    for (const double alpha : kBaseAlphas) {
      for (const double view_deg : kViews_deg) {
        for (const int side_px : kFootprints_px) cases.push_back({cloth, alpha, view_deg, side_px, {}});
      }
    }
  }
  parallel_for(cases.size(), threads, [&](std::size_t i, int) {
    MipCase& one = cases[i];
    const MipTrial trial = {
        .alpha = one.alpha, .across_px = one.side_px, .down_px = one.side_px, .view_deg = one.view_deg};
    one.errors = mip_errors(cloths[one.cloth], trial, contenders, static_cast<std::uint32_t>(i + 1));
  });
  return cases;
}

material::Surface surface_of(const NormalSquare& cloth) {
  const Size size = {cloth.side, cloth.side};
  material::Surface surface;
  surface.slope = Image<float>(size, 2);
  surface.status = Image<std::uint16_t>(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Vec3 n = cloth.at(x, y);
      surface.slope(x, y, 0) = static_cast<float>(-n.x / n.z);
      surface.slope(x, y, 1) = static_cast<float>(-n.y / n.z);
    }
  }
  return surface;
}

// Processor time of all levels, a pixel of the finest.
Json us_per_pixel(const material::Surface& surface, const MipContender& contender, int threads) {
  const double seconds = processor_seconds([&] {
    (void)material::roughness_mips(
        surface, {.rule = contender.rule, .weight = contender.weight, .alpha = 0.2, .threads = threads});
  });
  return seconds * 1e6 / static_cast<double>(surface.size().pixels());
}

template <typename Is>
double mean_error(const std::vector<MipCase>& cases, std::size_t contender, const Is& is) {
  double sum = 0, count = 0;
  for (const MipCase& one : cases) {
    if (!is(one)) continue;
    sum += one.error(contender);
    count += 1;
  }
  return sum / count;
}

Json row_of(const std::string& set, const std::string& rule, const std::vector<MipCase>& cases,
            std::size_t contender, std::size_t satin) {
  Json row = {{"set", set}, {"rule", rule}};
  for (const double view_deg : kViews_deg) {
    for (const int side_px : kFootprints_px) {
      row[std::to_string(static_cast<int>(view_deg)) + "_deg_" + std::to_string(side_px) + "_px"] =
          mean_error(cases, contender,
                     [&](const MipCase& c) { return c.view_deg == view_deg && c.side_px == side_px; });
    }
  }
  row["all"] = mean_error(cases, contender, [](const MipCase&) { return true; });
  for (const double alpha : kBaseAlphas) {
    row["alpha_0." + std::to_string(static_cast<int>(std::lround(10 * alpha)))] =
        mean_error(cases, contender, [&](const MipCase& c) { return c.alpha == alpha; });
  }
  for (const int side_px : {16, 64}) {
    row["satin_" + std::to_string(side_px) + "_px"] = mean_error(cases, contender, [&](const MipCase& c) {
      return c.cloth == satin && c.view_deg == 0 && c.side_px == side_px;
    });
  }
  return row;
}

}  // namespace

/// Rules of mips against the mean of the shaded pixels beneath a texel, GGX of F0 0.04: relative rms of
/// f (n . l) over base alphas 0.1, 0.3 and 0.5, hundred footprints a side and 128 lights. A row each rule and
/// set of cloths: `page` has the slopes of docs/measured/filtering.md, `other` other kinds. Columns are view
/// and pixels a side of the footprint; then all of them, by base alpha, the satin alone, and processor time.
Result<Rows> maps_mips(const StudyOptions& options) {
  const std::vector<MipContender> contenders = all_rules();
  constexpr std::size_t kSatinOfEach = 1;
  Rows rows;
  for (const auto& [set, cloths] :
       {std::pair{"page", page_weaves(options.threads)}, std::pair{"other", other_weaves(options.threads)}}) {
    const std::vector<MipCase> cases = measured_cases(cloths, contenders, options.threads);
    const material::Surface surface = surface_of(cloths.front());
    for (std::size_t c = 0; c <= contenders.size(); ++c) {
      const std::string rule = c < contenders.size() ? contenders[c].name : "best single alpha";
      rows.push_back(row_of(set, rule, cases, c, kSatinOfEach));
      rows.back()["us_per_pixel"] =
          c < contenders.size() ? us_per_pixel(surface, contenders[c], options.threads) : Json();
    }
  }
  return rows;
}

namespace {

const std::vector<MipContender>& shown_rules() {
  static const std::vector<MipContender> kRules = {{"none", MipRule::kNone},
                                                   {"toksvig", MipRule::kToksvig},
                                                   {"seed-code", MipRule::kVmfSeedCode},
                                                   {"seed-eq37", MipRule::kVmfSeedEq37},
                                                   {"vmf", MipRule::kVmf},
                                                   {"lean", MipRule::kLean}};
  return kRules;
}

Json figure_row(int figure, const std::string& what, const NormalSquare& cloth, const MipTrial& trial) {
  const MipErrors errors = mip_errors(cloth, trial, shown_rules(), 17);
  Json row = {{"figure", figure}, {"what", what + ", " + cloth.name}};
  for (std::size_t c = 0; c < shown_rules().size(); ++c) row[shown_rules()[c].name] = errors.by_contender[c];
  row["best single alpha"] = errors.best;
  row["degrees"] = Json();
  return row;
}

// Degrees from the mirrored view to where a lobe is brightest.
double peak_off_mirror_deg(double alpha, double view_deg) {
  const double tilt = radians(view_deg);
  const Vec3 v = {std::sin(tilt), 0, std::cos(tilt)};
  double brightest = 0, at_deg = 0;
  for (double light_deg = 0; light_deg < 90; light_deg += 0.05) {
    const Vec3 l = {-std::sin(radians(light_deg)), 0, std::cos(radians(light_deg))};
    const double f = reflected({0, 0, 1}, {alpha, alpha, 0}, l, v) / l.z;
    if (f > brightest) at_deg = light_deg;
    brightest = std::max(brightest, f);
  }
  return at_deg - view_deg;
}

Json peak_row(double alpha, double view_deg) {
  Json row = {{"figure", 19},
              {"what", "peak beyond the mirrored view, alpha " + std::to_string(alpha).substr(0, 4) +
                           ", view " + std::to_string(static_cast<int>(view_deg))}};
  for (const MipContender& rule : shown_rules()) row[rule.name] = Json();
  row["best single alpha"] = Json();
  row["degrees"] = peak_off_mirror_deg(alpha, view_deg);
  return row;
}

}  // namespace

/// Figures 17 to 20 of seed 000 as numbers: the same error by rule, of a rougher normal map under a lobe of
/// 0.05 (17), of Beckmann's lobe under grazing light (18), and seen at 75 degrees through the footprint that
/// is seen and through the square of it that trilinear filtering takes (20). Of figure 19 the angle from
/// mirrored direction to the lobe's peak.
Result<Rows> maps_figures(const StudyOptions& options) {
  Rows rows;
  for (const NormalSquare& cloth : page_weaves(options.threads)) {
    rows.push_back(figure_row(17, "alpha 0.05, 16 px", cloth, {.alpha = 0.05}));
    rows.push_back(figure_row(18, "Beckmann, light at 75 to 85 degrees", cloth,
                              {.alpha = 0.1,
                               .view_deg = 60,
                               .law = FacetLaw::kBeckmann,
                               .lowest_light_deg = 85,
                               .highest_light_deg = 75}));
    const MipTrial seen = {.alpha = 0.1, .across_px = 4, .down_px = 16, .view_deg = 75};
    MipTrial trilinear = seen;
    trilinear.texel_across_px = 16;
    rows.push_back(figure_row(20, "seen 4 x 16 px, filtered alike", cloth, seen));
    rows.push_back(figure_row(20, "seen 4 x 16 px, filtered 16 x 16", cloth, trilinear));
  }
  for (const double alpha : {0.05, 0.1, 0.2}) {
    for (const double view_deg : {30.0, 60.0, 75.0}) rows.push_back(peak_row(alpha, view_deg));
  }
  return rows;
}

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
