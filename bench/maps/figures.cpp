// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include "bench/maps/rules.h"
#include "bench/maps/studies.h"

namespace weft::bench {
namespace {

using material::MipRule;

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

}  // namespace weft::bench
