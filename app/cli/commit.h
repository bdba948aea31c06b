// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace weft::app {

/// The commit that the program was built from, "-dirty" behind it where files had changed; "" where it was
/// not built in a clone. The build writes it (cmake/commit.cmake).
const char* commit();

}  // namespace weft::app
