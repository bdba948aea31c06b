// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace weft::report {

/// A picture inside a page, which needs no other file.
struct PagePicture {
  std::string label;  ///< written under it
  std::string png;    ///< the bytes of the file
};

/// Pictures side by side, as a section of a page; empty where there are none.
std::string picture_row(const std::vector<PagePicture>& pictures);

}  // namespace weft::report
