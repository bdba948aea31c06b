// SPDX-License-Identifier: Apache-2.0
#include "bench/program/rows.h"

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"

namespace weft::bench {

Result<int> print_rows(const Result<Rows>& rows, const app::CommonArguments& common) {
  if (!rows) return rows.error();
  if (common.json) {
    app::print_json(document_of(*rows));
  } else {
    app::print(table_of(*rows));
  }
  return app::kDone;
}

}  // namespace weft::bench
