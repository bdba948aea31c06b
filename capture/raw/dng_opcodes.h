// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "capture/raw/tiff_tags.h"

namespace weft::capture {

/// What OpcodeList1, 2 and 3 of a DNG's directory ask a developer to do, each once: "GainMap",
/// "WarpRectilinear (optional)" where the file lets it be left out, "opcode 99" where its name is not known.
/// A gain map whose gains are all 1 asks nothing. (Digital Negative Specification 1.4 and later, chapter 7.)
std::vector<std::string> opcodes_of(const Tiff& tiff, const TiffDirectory& directory);

}  // namespace weft::capture
