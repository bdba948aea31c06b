// SPDX-License-Identifier: Apache-2.0
#include "app/cli/print_rig_plan.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "calibration/guide/rig_plan_request.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

std::string cell_of(double value, const char* pattern) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(pattern), value) : "-";
}

void print_rig_plan(const calibration::RigPlan& plan) {
  const solver::ForeseenCloth& cloth = plan.cloth.cloth;
  const bool is_pile = cloth.lobe.family == solver::LobeFamily::kCloth;
  print(fmt::format("{} under the {} LEDs of {}; albedo {:g}, mean slope {:g} degrees; standard deviations:",
                    plan.cloth.name, plan.planned.leds.size(), plan.rig, cloth.albedo, cloth.relief_deg));
  print(fmt::format("{:>7}  {:>7}  {:>7}  {:10}  {:>5}  {:>7}  {:>7}", "normal", "alpha",
                    is_pile ? "sheen" : "f0", "observable", "shots", "seconds", "won"));
  for (const calibration::RigPlanRow& row : plan.rows) {
    print(fmt::format("{:>6}°  {:>7}  {:>7}  {:10}  {:>+5}  {:>+7.3g}  {:>6}°  {}",
                      cell_of(row.sigma.normal_deg, "{:.3f}"), cell_of(row.sigma.alpha, "{:.4f}"),
                      cell_of(row.sigma.f0, "{:.4f}"), row.sigma.is_observable ? "yes" : "no",
                      row.extra_shots, row.extra_seconds, cell_of(row.degrees_won, "{:+.3f}"), row.what));
  }
  print(plan.verdict);
  for (const std::string& each : plan.notes) print("  " + each);
}

Result<int> run_rig_plan(const calibration::RigPlanRequest& arguments, const CommonArguments& common) {
  if (!arguments.picture.empty() && arguments.picture.extension() != ".svg") {
    return Error{ErrorKind::kUsage, "a plan is drawn as SVG", arguments.picture.string(),
                 "its name does not end in .svg", "name it plan.svg"};
  }
  const Result<calibration::NamedCloth> cloth = arguments.asked_cloth();
  if (!cloth) return cloth.error();
  calibration::RigPlanOptions options = arguments.plan;
  options.rig = find_rig(options.rig);
  options.cloth = *cloth;
  const Result<calibration::RigPlan> plan = [&] {
    ProgressLine line(common.quiet);
    return calibration::plan_rig(options, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!plan) return plan.error();
  if (!arguments.picture.empty()) {
    if (Result<void> drawn = write_file(arguments.picture, calibration::picture_of(*plan)); !drawn)
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
  const auto a = std::make_shared<calibration::RigPlanRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return run_rig_plan(*a, common); };
}

}  // namespace weft::app
