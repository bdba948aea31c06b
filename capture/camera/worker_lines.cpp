// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/worker_lines.h"

#include <string>

#include "core/error_kind.h"

namespace weft::capture {

Json line_of(const Error& error) {
  return {{"kind", name_of(error.kind)},
          {"what", error.what},
          {"where", error.where},
          {"why", error.why},
          {"remedy", error.remedy}};
}

Error error_of_line(const Json& line) {
  JsonFields fields(line, "weft-camera");
  Error error{error_kind_of(fields.text("kind")).value_or(ErrorKind::kProtocol), fields.text("what"),
              fields.text("where"), fields.text("why"), fields.text("remedy")};
  if (Result<void> ok = fields.status(); !ok) error.why = ok.error().message();
  return error;
}

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
