// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/worker_lines.h"

namespace weft::capture {

Json line_of(const ExposureSettings& exposure) {
  return {{"exposure_us", exposure.exposure_us}, {"iso", exposure.iso}, {"f_number", exposure.f_number}};
}

Result<ExposureSettings> exposure_of_line(const Json& line) {
  JsonFields fields(line, "exposure");
  const ExposureSettings exposure{fields.number("exposure_us"), fields.number("iso"),
                                  fields.number("f_number")};
  if (Result<void> ok = fields.status(); !ok)
    return Error{ErrorKind::kProtocol, "a line of weft-camera is wrong", "exposure", ok.error().message(),
                 ""};
  return exposure;
}

}  // namespace weft::capture
