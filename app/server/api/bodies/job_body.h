// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/server/api/bodies/job_places.h"
#include "app/server/jobs/job.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// The body of POST /api/v1/jobs: {"kind", "request_id"} with the fields of its kind (job_kinds.h). All that
/// can be told before the verb runs is: kUsage with the field and its rule; kNoInput where what it works on
/// is not there; kCannotCreate where its output is.
Result<JobSpec> read_job_body(const Json& body, const JobPlaces& places);

}  // namespace weft::app
