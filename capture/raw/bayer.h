// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/image/raw_frame.h"

namespace weft::capture {

/// The filter cell with these colours (0 red, 1 green, 2 blue; [y & 1][x & 1]), its greens told apart;
/// nothing unless it is one red, two green on a diagonal and one blue (Bayer, US patent 3 971 065, 1976).
std::optional<CfaPattern> bayer_cell(const std::array<std::array<int, 2>, 2>& colors);

/// The error of a raw file without such a cell.
Error not_bayer(const std::string& where);

}  // namespace weft::capture
