// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/cli/command_tree.h"

namespace weft::app {

/// A page of the manual in the macros of mdoc(7).
struct ManualPage {
  std::string file;  ///< "weft-solve.1"
  std::string text;
};

/// A page of the program and one of each verb that it runs itself; `version` and `date` ("November 26, 2026")
/// stand at their feet and heads.
std::vector<ManualPage> manual_pages(const CommandWord& program, std::string_view version,
                                     std::string_view date);

}  // namespace weft::app
