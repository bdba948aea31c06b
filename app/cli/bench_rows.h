// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/arguments.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "bench/base/report.h"

namespace weft::app {

/// Prints what a benchmark measured, as a table or with --json as a document.
inline Result<int> print_rows(const Result<bench::Rows>& rows, const CommonArguments& common) {
  if (!rows) return rows.error();
  if (common.json) {
    print_json(bench::document_of(*rows));
  } else {
    print(bench::table_of(*rows));
  }
  return kDone;
}

}  // namespace weft::app
