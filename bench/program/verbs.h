// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/cli/verb.h"

namespace weft::bench {

/// The verbs of `weft bench`, in the order of its help.
std::vector<app::Verb> verbs();

// Those with a file each.
app::Verb accuracy_verb();
app::Verb explain_verb();
app::Verb photos_verb();
app::Verb capture_verb();
app::Verb page_verb();

}  // namespace weft::bench
