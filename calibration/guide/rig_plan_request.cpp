// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/rig_plan_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/rig/cloth_kinds.h"
namespace weft::calibration {
namespace {

constexpr double kUsualF0 = 0.04;

Result<NamedCloth> cloth_of(const RigPlanRequest& r) {
  if (!r.reflectance.empty()) return cloth_of_reflectance(r.reflectance, r.albedo);
  if (!r.roughness) return *std::ranges::find(planned_cloths(), r.cloth, &NamedCloth::name);
  NamedCloth typed;
  typed.name = fmt::format("ggx {:g}", *r.roughness);
  typed.cloth.lobe = {
      .family = solver::LobeFamily::kGgx, .alpha = *r.roughness, .f0 = r.f0.value_or(kUsualF0)};
  return typed;
}

}  // namespace

Result<NamedCloth> RigPlanRequest::asked_cloth() const {
  Result<NamedCloth> asked = cloth_of(*this);
  if (asked && albedo) asked->cloth.albedo = *albedo;
  if (asked && relief_deg) asked->cloth.relief_deg = *relief_deg;
  return asked;
}

void describe(Fields& fields, RigPlanRequest& r) {
  fields.value(
      {.name = "rig",
       .says = "Rig file or calibration folder; default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml",
       .option = "",
       .said = Said::kAtThisMachine},
      r.plan.rig);
  fields.value(
      {.name = "cloth", .says = "What is to be scanned", .words = {kClothKinds.begin(), kClothKinds.end()}},
      r.cloth);
  fields.value(
      {.name = "reflectance", .says = "reflectance.json of a solve: its first lobe", .path = PathTo::kFile},
      r.reflectance);
  fields.value({"roughness", "Alpha of a GGX lobe", {0.02, 1}}, r.roughness);
  fields.value({"f0", "Strength of that lobe; default 0.04", {0, 0.6}}, r.f0);
  fields.need("f0", "roughness");
  fields.exclude("reflectance", "cloth");
  fields.exclude("reflectance", "roughness");
  fields.exclude("roughness", "cloth");
  fields.value({"albedo", "Of the cloth; default its own, else 0.3", {0.001, 1}}, r.albedo);
  fields.value({"relief_deg", "Mean slope of the cloth, degrees; default 20", {0, 60}}, r.relief_deg);
  fields.choice({"aim", "What the best place is best for: all, normal, alpha, f0"}, r.plan.aim,
                solver::kPlanAimNames);
  fields.value({"pace", "Of a scan, seconds a shot", {0.1, 600}}, r.plan.seconds_a_shot);
  fields.value({.name = "picture",
                .says = "Drawing of the places for one more LED (SVG)",
                .said = Said::kAtThisMachine},
               r.picture);
}

}  // namespace weft::calibration
