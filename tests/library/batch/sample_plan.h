// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "library/batch/plan.h"

namespace weft::library {

/// A session of a plan, told from others by its number.
inline PlannedSolve sample_solve(int number, double seconds = 100) {
  PlannedSolve planned;
  planned.session = fmt::format("/archive/2025/cloth-{}.weft", number);
  planned.digest = fmt::format("{:064}", number);
  planned.quality = "standard";
  planned.calibration = "c0ffee";
  planned.solve = fmt::format("{:016}", number);
  planned.rig = "rig a";
  planned.fabric = "twill";
  planned.megapixels = 16.2;
  planned.forecast = {seconds, 0.1 * seconds, 0.62, 0.05, number % 2 == 0, {}};
  planned.memory_bytes = 700'000'000 + static_cast<std::uint64_t>(number);
  planned.read_bytes = 354'000'000;
  planned.write_bytes = 452'000'000;
  return planned;
}

/// A plan of so many sessions, of tasks of 250 seconds.
inline BatchPlan sample_plan(int sessions) {
  BatchPlan plan;
  plan.header.archive = "/archive";
  plan.header.solver_version = 9;
  plan.header.threads = 2;
  plan.header.levels = {{"standard", 1.25, 0.62, 0.1, sessions}};
  for (int i = 0; i < sessions; ++i) plan.solves.push_back(sample_solve(i));
  share_out(plan.solves, 250);
  return plan;
}

}  // namespace weft::library
