// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/describe/described_fields.h"

namespace weft::simulator {

/// What `weft sample` and its job are told.
struct SampleRequest {
  std::filesystem::path session = "sample.weft";
};

inline void describe(Fields& fields, SampleRequest& request) {
  describe_output(fields, request.session, "Session folder, NAME.weft, which may be there already");
}

}  // namespace weft::simulator
