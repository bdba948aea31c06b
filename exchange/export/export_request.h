// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/describe/fields.h"
#include "exchange/export/export.h"

namespace weft::app {

/// What `weft export` and a job that exports are told.
struct ExportRequest {
  ExportOptions options;
  bool lists = false;
  std::string shown;  ///< a preset to print; empty: none
  bool only_explains = false;
};
void describe(Fields& fields, ExportRequest& request);

}  // namespace weft::app
