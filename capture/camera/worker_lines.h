// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "capture/devices.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::capture {

// What the lines between weft-camera and its parent are made of (worker.h describes them).

Json line_of(const ExposureSettings& exposure);
/// kProtocol where a field is missing.
Result<ExposureSettings> exposure_of_line(const Json& line);

}  // namespace weft::capture
