// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace weft::app {

/// A file of the page, which is part of this program.
struct PageFile {
  std::string_view path;  ///< "/index.html", "/assets/NAME-HASH.js"
  std::string_view bytes, gzipped;
};

/// Those of app/web/dist.
std::vector<PageFile> page_files();

}  // namespace weft::app
