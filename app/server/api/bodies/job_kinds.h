// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/server/api/bodies/job_places.h"
#include "app/server/jobs/job.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::app {

/// A verb that can be asked for as a job.
struct JobKind {
  const char* name;
  const char* title;  ///< for people
  std::vector<std::string> verb;
  /// Each walks over some of what its body may say, in the struct that it gives.
  std::vector<std::shared_ptr<void> (*)(Fields&)> fields;
  /// Adds what the daemon knows and its client does not say; `wants` of the job is its body, which fits.
  Result<void> (*add)(JobSpec& spec, const JobPlaces& places) = nullptr;
};

const std::vector<JobKind>& job_kinds();

/// The kind that holds a scan against its calibration, as each is once it is finished.
inline constexpr const char* kRigCheck = "rig_check";

/// [{"kind", "title", "schema"}]: what a page draws a form of.
Json job_forms();

/// Components of OpenAPI: JobRequest, which is one of a body a kind, and those.
Json job_schemas();

}  // namespace weft::app
