// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

namespace weft {

/// Before the first use in a process: OpenImageIO prints nothing by itself.
void prepare_oiio();

/// What OpenImageIO says of a failure, as one line without a full stop.
std::string oiio_reason(const std::string& message);

}  // namespace weft
