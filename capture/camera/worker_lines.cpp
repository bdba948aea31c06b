// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/worker_lines.h"

#include <array>
#include <string>
#include <utility>

namespace weft::capture {
namespace {

constexpr std::array<std::pair<ErrorKind, const char*>, 10> kKinds = {{
    {ErrorKind::kUsage, "usage"},
    {ErrorKind::kBadData, "bad_data"},
    {ErrorKind::kNoInput, "no_input"},
    {ErrorKind::kNoDevice, "no_device"},
    {ErrorKind::kInternal, "internal"},
    {ErrorKind::kCannotCreate, "cannot_create"},
    {ErrorKind::kInputOutput, "input_output"},
    {ErrorKind::kTryAgain, "try_again"},
    {ErrorKind::kProtocol, "protocol"},
    {ErrorKind::kInterrupted, "interrupted"},
}};

}  // namespace

Json line_of(const Error& error) {
  Json line;
  for (const auto& [kind, name] : kKinds) {
    if (kind == error.kind) line["kind"] = name;
  }
  line["what"] = error.what;
  line["where"] = error.where;
  line["why"] = error.why;
  line["remedy"] = error.remedy;
  return line;
}

Error error_of_line(const Json& line) {
  JsonFields fields(line, "weft-camera");
  Error error{ErrorKind::kProtocol, fields.text("what"), fields.text("where"), fields.text("why"),
              fields.text("remedy")};
  const std::string name = fields.text("kind");
  for (const auto& [kind, known] : kKinds) {
    if (name == known) error.kind = kind;
  }
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
