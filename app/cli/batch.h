// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/verb.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "library/batch/farm.h"

namespace weft::app {

// The verbs of `weft batch`.
Verb batch_plan_verb();
Verb batch_run_verb();
Verb batch_merge_verb();
Verb batch_status_verb();
Verb batch_commands_verb();
Verb batch_accept_verb();
Verb batch_prune_verb();
Verb batch_submit_verb();
Verb batch_cancel_verb();

/// A command a line for each task, or for those with a session without result.
Result<int> print_batch_commands(const std::filesystem::path& plan, bool only_missing,
                                 const CommonArguments& common);

/// What Slurm has of a batch, for `weft batch status`.
Json json_of_queue(const library::FarmQueue& queue);
void print_queue(const library::FarmQueue& queue, const std::vector<int>& missing_tasks);

/// Has Slurm queue a task again that ended with 75; the exit code is that of the task.
int after_own_task(int code);

}  // namespace weft::app
