// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/jobs/rig_plan.h"
#include "core/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct RigPlanArguments {
  RigPlanOptions plan;
  std::string cloth = "satin";
  fs::path reflectance, picture;
  std::optional<double> roughness, f0, albedo, relief_deg;
};

std::vector<std::string> planned_cloth_names() {
  std::vector<std::string> names;
  for (const NamedCloth& each : planned_cloths()) names.push_back(each.name);
  return names;
}

Result<NamedCloth> asked_cloth(const RigPlanArguments& a) {
  if (!a.reflectance.empty()) return cloth_of_reflectance(a.reflectance, a.albedo);
  if (a.roughness) {
    NamedCloth typed;
    typed.name = fmt::format("ggx {:g}", *a.roughness);
    typed.cloth.lobe = {.family = solver::LobeFamily::kGgx, .alpha = *a.roughness, .f0 = a.f0.value_or(0.04)};
    return typed;
  }
  return *std::ranges::find(planned_cloths(), a.cloth, &NamedCloth::name);
}

std::string cell_of(double value, const char* pattern) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(pattern), value) : "-";
}

void print_rig_plan(const RigPlan& plan) {
  const solver::PlannedCloth& cloth = plan.cloth.cloth;
  const bool is_pile = cloth.lobe.family == solver::LobeFamily::kCloth;
  print(fmt::format("{} under the {} LEDs of {}; albedo {:g}, mean slope {:g} degrees; standard deviations:",
                    plan.cloth.name, plan.planned.leds.size(), plan.rig, cloth.albedo, cloth.relief_deg));
  print(fmt::format("{:>7}  {:>7}  {:>7}  {:10}  {:>5}  {:>7}  {:>7}", "normal", "alpha",
                    is_pile ? "sheen" : "f0", "observable", "shots", "seconds", "won"));
  for (const RigPlanRow& row : plan.rows) {
    print(fmt::format("{:>6}°  {:>7}  {:>7}  {:10}  {:>+5}  {:>+7.3g}  {:>6}°  {}",
                      cell_of(row.sigma.normal_deg, "{:.3f}"), cell_of(row.sigma.alpha, "{:.4f}"),
                      cell_of(row.sigma.f0, "{:.4f}"), row.sigma.is_observable ? "yes" : "no",
                      row.extra_shots, row.extra_seconds, cell_of(row.degrees_won, "{:+.3f}"), row.what));
  }
  print(plan.verdict);
  for (const std::string& each : plan.notes) print("  " + each);
}

Result<int> run_rig_plan(const RigPlanArguments& arguments, const CommonArguments& common) {
  if (!arguments.picture.empty() && arguments.picture.extension() != ".svg") {
    return Error{ErrorKind::kUsage, "a plan is drawn as SVG", arguments.picture.string(),
                 "its name does not end in .svg", "name it plan.svg"};
  }
  Result<NamedCloth> cloth = asked_cloth(arguments);
  if (!cloth) return std::move(cloth).error();
  if (arguments.albedo) cloth->cloth.albedo = *arguments.albedo;
  if (arguments.relief_deg) cloth->cloth.relief_deg = *arguments.relief_deg;
  RigPlanOptions options = arguments.plan;
  options.rig = find_rig(options.rig);
  options.cloth = *cloth;
  const Result<RigPlan> plan = [&] {
    ProgressLine line(common.quiet);
    return plan_rig(options, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!plan) return plan.error();
  if (!arguments.picture.empty()) {
    if (Result<void> drawn = write_file(arguments.picture, picture_of(*plan)); !drawn)
      return std::move(drawn).error();
  }
  if (common.json) {
    print_json(json_of(*plan));
  } else {
    print_rig_plan(*plan);
  }
  return kDone;
}

}  // namespace

Run add_rig_plan(Options& options) {
  const auto a = std::make_shared<RigPlanArguments>();
  options.add("rig", &a->plan.rig,
              "Rig file or calibration folder; default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
  const Option cloth = options.add("--cloth", &a->cloth, "What is to be scanned")
                           .one_of(planned_cloth_names())
                           .shows_default();
  const Option file =
      options.add("--reflectance", &a->reflectance, "reflectance.json of a solve: its first lobe");
  const Option roughness =
      options.add("--roughness", &a->roughness, "Alpha of a GGX lobe").in_range(0.02, 1.0);
  options.add("--f0", &a->f0, "Strength of that lobe; default 0.04").in_range(0.0, 0.6).needs(roughness);
  file.excludes(cloth).excludes(roughness);
  roughness.excludes(cloth);
  options.add("--albedo", &a->albedo, "Of the cloth; default its own, else 0.3").in_range(0.001, 1.0);
  options.add("--relief", &a->relief_deg, "Mean slope of the cloth, degrees; default 20").in_range(0.0, 60.0);
  options.add_choice("--aim", &a->plan.aim, solver::kPlanAimNames,
                     "What the best place is best for: all, normal, alpha, f0");
  options.add("--pace", &a->plan.seconds_a_shot, "Of a scan, seconds a shot")
      .in_range(0.1, 600.0)
      .shows_default();
  options.add("--picture", &a->picture, "Drawing of the places for one more LED (SVG)");
  return [a](const CommonArguments& common) { return run_rig_plan(*a, common); };
}

}  // namespace weft::app
