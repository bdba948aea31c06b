// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "library/import/import_plan.h"

namespace weft::library {

/// Makes what the plan calls new, one folder after the other, each aside and published whole: frames linked
/// or copied under the names of a session, the calibration, session.json with the digest of each frame. Files
/// of the source are opened for reading alone. Refused and present ones are passed over. After an error,
/// those before it are there, and the same import goes on. Reports the phase "import". Errors: kTryAgain (a
/// photograph changed while it was copied), kCannotCreate, kInputOutput, kInterrupted.
Result<void> run_import(const ImportProposal& plan, const JobContext& context);

}  // namespace weft::library
