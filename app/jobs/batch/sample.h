// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/jobs/batch/survey.h"
#include "batch/forecast.h"
#include "batch/plan.h"
#include "core/job.h"
#include "core/result.h"

namespace weft::app {

/// Prices every level of one session on its own photographs (app/jobs/explain.h). Where it has a solve, the
/// seconds hold comparing with that, as measured here, and each level that it can be compared with says how
/// far its middle turns. Errors of explain_session().
Result<std::vector<batch::Forecast>> measure_session(const Candidate& candidate,
                                                     const batch::Product& product,
                                                     const JobContext& context);

}  // namespace weft::app
