// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/describe/described_fields.h"

namespace weft::torture {

/// What `weft torture` and its job are told.
struct TortureRequest {
  std::filesystem::path session = "torture.weft";
  bool is_strict = false;
};

inline void describe(Fields& fields, TortureRequest& request) {
  describe_output(fields, request.session, "Session folder, NAME.weft, which may be there already");
  fields.value(
      {.name = "strict", .says = "Exit code 2 where a case is off its bound", .said = Said::kAtThisMachine},
      request.is_strict);
}

}  // namespace weft::torture
