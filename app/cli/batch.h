// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/verb.h"

namespace weft::app {

// The verbs of `weft batch`.
Verb batch_plan_verb();
Verb batch_run_verb();
Verb batch_merge_verb();
Verb batch_status_verb();
Verb batch_commands_verb();
Verb batch_accept_verb();
Verb batch_prune_verb();

}  // namespace weft::app
