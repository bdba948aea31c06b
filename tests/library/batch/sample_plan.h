// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "library/batch/plan.h"

namespace weft::batch {

/// A session of a plan, told from others by its number.
inline Job sample_job(int number, double seconds = 100) {
  Job job;
  job.session = fmt::format("/archive/2025/cloth-{}.weft", number);
  job.digest = fmt::format("{:064}", number);
  job.quality = "standard";
  job.calibration = "c0ffee";
  job.solve = fmt::format("{:016}", number);
  job.rig = "rig a";
  job.fabric = "twill";
  job.megapixels = 16.2;
  job.forecast = {seconds, 0.1 * seconds, 0.62, 0.05, number % 2 == 0, {}};
  job.memory_bytes = 700'000'000 + static_cast<std::uint64_t>(number);
  job.read_bytes = 354'000'000;
  job.write_bytes = 452'000'000;
  return job;
}

/// A plan of so many sessions, of tasks of 250 seconds.
inline Plan sample_plan(int sessions) {
  Plan plan;
  plan.header.archive = "/archive";
  plan.header.solver_version = 9;
  plan.header.threads = 2;
  plan.header.levels = {{"standard", 1.25, 0.62, 0.1, sessions}};
  for (int i = 0; i < sessions; ++i) plan.jobs.push_back(sample_job(i));
  share_out(plan.jobs, 250);
  return plan;
}

}  // namespace weft::batch
