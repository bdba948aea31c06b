// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/describe/described_fields.h"

namespace weft::capture {

/// What `weft copy` and a job that copies are told.
struct CopyRequest {
  std::filesystem::path session;
  std::filesystem::path to;  ///< folder; empty: where the session says that its copy belongs
};

inline void describe(Fields& fields, CopyRequest& request) {
  describe_session(fields, request.session);
  fields.value({.name = "to",
                .says = "Folder on another disk; default the one it was scanned with",
                .said = Said::kAtThisMachine},
               request.to);
}

}  // namespace weft::capture
