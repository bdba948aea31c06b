// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

namespace weft::bench {

/// Wall seconds of `weft batch run` over so many sessions, `jobs` at a time, against one process that
/// solves them in turn with all threads, and against what the plan said.
Result<Rows> batch_local(const StudyOptions& options, int jobs);
/// Seconds of `weft batch plan` over 10 000 sessions, those of the sample apart.
Result<Rows> batch_plan(const StudyOptions& options);
/// Seconds of `weft batch merge` over 10 000 results.
Result<Rows> batch_merge(const StudyOptions& options);
/// `weft batch run` killed so many times at random moments until all is done: what is published, half made
/// and done twice.
Result<Rows> batch_kills(const StudyOptions& options, int kills);
/// 40 sessions of 1 megapixel by three rigs of mixed bodies, one of whose calibrations has two LEDs in the
/// wrong place, by how far: what the report says of calibrations.
Result<Rows> batch_rigs(const StudyOptions& options);
/// 200 small tasks here against their simulation, and simulations of a million sessions on 100 nodes.
Result<Rows> batch_farm(const StudyOptions& options);

}  // namespace weft::bench
