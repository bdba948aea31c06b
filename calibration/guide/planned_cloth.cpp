// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/planned_cloth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/json_document.h"
#include "core/base/vec.h"
#include "core/describe/field_json.h"
#include "core/rig/cloth_kinds.h"
#include "solve/report/reflectance_facts.h"

namespace weft::calibration {
namespace {

using solver::Lobe;
using solver::LobeFamily;

constexpr double kPlanRelief_deg = 20;
// Every fifth float of a satin of five harnesses is weft.
constexpr double kSatinWeft = 0.2;
constexpr double kUnknownAlbedo = 0.3;

Lobe satin_lobe(double alpha, double along) {
  return {.family = LobeFamily::kAnisotropicGgx, .alpha = alpha, .f0 = 0.05, .along = along};
}

Lobe pile_lobe(double alpha, double f0) {
  return {.family = LobeFamily::kCloth, .alpha = alpha, .f0 = f0};
}

solver::ForeseenCloth cloth_of(const Lobe& lobe, double albedo, double weft_share = 0) {
  return {.lobe = lobe, .albedo = albedo, .relief_deg = kPlanRelief_deg, .weft_share = weft_share};
}

Error not_a_lobe(const std::filesystem::path& file, std::string why) {
  return {ErrorKind::kBadData, "no lobe to plan for", file.string(), std::move(why),
          "name a cloth with --cloth, or its roughness with --roughness and --f0"};
}

std::optional<LobeFamily> family_called(const std::string& name) {
  for (const LobeFamily family : {LobeFamily::kGgx, LobeFamily::kAnisotropicGgx, LobeFamily::kBeckmann,
                                  LobeFamily::kCloth, LobeFamily::kTwoGgx}) {
    if (name == name_of(family)) return family;
  }
  return {};
}

Result<Lobe> lobe_of(const solve::LobeCluster& cluster, const std::filesystem::path& file, double albedo) {
  const solve::FittedLobe& said = cluster.lobe;
  const std::optional<LobeFamily> family = family_called(said.family);
  const bool is_of_two = family == LobeFamily::kTwoGgx;
  const char* missing = !said.alpha                           ? "alpha"
                        : !said.f0 && !cluster.f0_over_albedo ? "f0"
                        : is_of_two && !said.alpha_broad      ? "alpha_broad"
                        : is_of_two && !said.broad_share      ? "broad_share"
                                                              : nullptr;
  if (missing != nullptr) return not_a_lobe(file, fmt::format("\"{}\" is missing", missing));
  Lobe lobe;
  lobe.alpha = *said.alpha;
  lobe.f0 = said.f0 ? *said.f0 : albedo * *cluster.f0_over_albedo;
  const double along = said.alpha_along.value_or(lobe.alpha);
  lobe.axis = radians(said.axis_deg.value_or(0));
  lobe.bend = said.bend.value_or(0);
  if (is_of_two) {
    lobe.broad = *said.alpha_broad;
    lobe.broad_share = *said.broad_share;
  }
  if (!family) return not_a_lobe(file, "a lobe of the family \"" + said.family + "\" is not planned for");
  if (!(lobe.alpha >= 0.02 && lobe.alpha <= 1 && along >= 0.001 && along <= 20 && lobe.f0 >= 0 &&
        lobe.f0 <= 0.6 && lobe.broad >= 0.02 && lobe.broad <= 1 && lobe.broad_share >= 0 &&
        lobe.broad_share <= 1))
    return not_a_lobe(file, "its roughness or f0 is none that a cloth has");
  lobe.family = *family;
  lobe.along = along / lobe.alpha;
  return lobe;
}

}  // namespace

const std::vector<NamedCloth>& planned_cloths() {
  static const std::vector<NamedCloth> cloths = [] {
    const std::array assumed = {
        cloth_of({}, 0.57), cloth_of(pile_lobe(0.7, 0.046), 0.24), cloth_of(pile_lobe(0.3, 0.05), 0.012),
        cloth_of(satin_lobe(0.45, 0.35), 0.4, kSatinWeft), cloth_of(satin_lobe(0.35, 0.4), 0.06, kSatinWeft)};
    static_assert(assumed.size() == kClothKinds.size());
    std::vector<NamedCloth> all;
    for (std::size_t i = 0; i < kClothKinds.size(); ++i)
      all.push_back({std::string(kClothKinds[i]), assumed[i]});
    return all;
  }();
  return cloths;
}

Result<NamedCloth> cloth_of_reflectance(const std::filesystem::path& file, std::optional<double> albedo) {
  Result<Json> document = read_json(file, "weft.reflectance", 1);
  if (!document) return std::move(document).error();
  const Result<solve::ReflectanceFacts> facts =
      read_fields<solve::ReflectanceFacts>(*document, file.string());
  if (!facts) return facts.error();
  const auto cluster = std::ranges::find(facts->clusters, true, &solve::LobeCluster::is_observable);
  if (cluster == facts->clusters.end()) return not_a_lobe(file, "the solve called nothing observable");
  const double of_pixels = albedo.value_or(kUnknownAlbedo);
  const Result<Lobe> lobe = lobe_of(*cluster, file, of_pixels);
  if (!lobe) return lobe.error();
  return NamedCloth{name_of(lobe->family), cloth_of(*lobe, of_pixels, cluster->weft_share.value_or(0))};
}

}  // namespace weft::calibration
