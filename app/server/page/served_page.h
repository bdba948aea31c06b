// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/server/http/routes.h"
#include "app/server/page/page_files.h"

namespace weft::app {

/// The page that a browser is led to, by a link that ends in #TOKEN. Its files hold no data and need no
/// token. `/index.html` is answered at `/` and at every address that begins with one of the screens, as in
/// /sessions/NAME. What lies below `/assets/` has its content in its name and may be kept for ever; the rest
/// is asked for again by its ETag. Who takes gzip gets it, where it is shorter.
std::vector<Route> page_routes(const std::vector<PageFile>& files = page_files());

}  // namespace weft::app
