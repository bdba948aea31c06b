// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/server/api/bodies/job_places.h"
#include "app/server/jobs/job.h"
#include "core/base/result.h"

// Jobs that plan and run batches of solves, as their kinds add it (job_kinds.h).

namespace weft::app {

/// Adds to a batch_plan what its `wants` say: `sessions` (names) or `find` (words of a search), and `name`.
/// The folders are written down and the batch is begun (batch_place.h), which `of` names; `wants` then has
/// their number in place of their names. A session that cannot be read is no error: the plan says why it is
/// left out. kUsage, kNoInput where a name or all that was searched for is not there.
Result<void> add_batch_plan(JobSpec& spec, const JobPlaces& places);

/// Adds to a batch_run the plan of `batch` and the seconds that it is planned to take. kNoInput, kBadData.
Result<void> add_batch_run(JobSpec& spec, const JobPlaces& places);

}  // namespace weft::app
