// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/verb.h"
#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// Prints what a benchmark measured, as a table or with --json as a document.
Result<int> print_rows(const Result<Rows>& rows, const app::CommonArguments& common);

}  // namespace weft::bench
