// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/describe/fields.h"
#include "material/assets/compose.h"

namespace weft::material {

/// What `weft material build` and a job that builds are told.
struct BuildRequest {
  std::vector<std::string> files;
  std::filesystem::path output = {};
  ComposeOptions compose = {};
};
void describe(Fields& fields, BuildRequest& request);

}  // namespace weft::material
