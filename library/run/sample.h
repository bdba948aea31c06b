// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "library/batch/forecast.h"
#include "library/batch/plan.h"
#include "library/run/survey.h"
#include "solve/run/explain.h"

namespace weft::library {

/// What is measured on a session.
struct SampleOptions {
  const BatchProduct& product;
  std::optional<solver::Level> only = {};       ///< this level alone; none: all
  std::optional<solve::SharedSeconds>& shared;  ///< of the sessions before
};

/// Prices levels of one session on its own photographs (solve/run/explain.h), as many as level_names() has,
/// or the one. Where it has a solve, the seconds hold comparing with that, as measured here, and each level
/// that it can be compared with says how far its middle turns. Errors of explain_session().
Result<std::vector<Forecast>> measure_session(const Candidate& candidate, const SampleOptions& options,
                                              const JobContext& context);

}  // namespace weft::library
