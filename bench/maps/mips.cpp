// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/studies.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/maps/processor_time.h"
#include "bench/maps/rules.h"
#include "core/parallel.h"

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
/// set of cloths: `page` has the slopes of docs/filtering.md, `other` other kinds. Columns are view and
/// pixels a side of the footprint; then all of them, by base alpha, the satin alone, and processor time.
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

}  // namespace weft::bench
