// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/control_socket.h"

#include <algorithm>
#include <string>

#include "app/server/api/api.h"

namespace weft::app {
namespace {

// What was not on the table before is rendered first.
constexpr double kLongest_s = 120;
constexpr std::size_t kLongestLine = 500;

Error refused_line(std::string rule) {
  return {ErrorKind::kUsage, "the virtual rig cannot be told this", "line", std::move(rule),
          "see lines of GET rig/virtual"};
}

Result<std::string> tell_virtual(const capture::Rig& rig, const std::string& line) {
  if (!rig.daemon.virtual_control.empty())
    return virtual_rig::tell_rig(rig.daemon.virtual_control, line, kLongest_s);
  return Error{ErrorKind::kNoInput, "this rig is real", rig.file.string(),
               "its file names no daemon.virtual_control",
               "start weft-virtual-rig, and weft serve with the rig file that it writes"};
}

Result<Json> told_json(const capture::Rig& rig, const std::string& line) {
  const Result<std::string> said = tell_virtual(rig, line);
  if (!said) return said.error();
  Json document = Json::parse(*said, nullptr, /*allow_exceptions=*/false);
  if (!document.is_discarded()) return document;
  return Error{ErrorKind::kProtocol, "the virtual rig answers no JSON", line, *said,
               "use one of the same version"};
}

Result<Reply> how_it_is(const RigParts& parts, const Call&) {
  Result<Json> status = told_json(parts.rig, "status"), lines = told_json(parts.rig, "commands");
  if (!status) return std::move(status).error();
  if (!lines) return std::move(lines).error();
  return json_reply({{"status", std::move(*status)}, {"lines", std::move(*lines)}});
}

/// One line, which names no path: no call does.
Result<std::string> line_in(const Json& body) {
  const Json line = body.value("line", Json());
  if (!line.is_string() || line.empty()) return refused_line("must be a text");
  std::string text = line.get<std::string>();
  const auto is_forbidden = [](char c) { return c == '/' || static_cast<unsigned char>(c) < ' '; };
  if (text.size() > kLongestLine || std::ranges::any_of(text, is_forbidden))
    return refused_line("must be one line of at most 500 bytes that names no path");
  return text;
}

Result<Reply> obey(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Result<std::string> line = line_in(*body);
  if (!line) return line.error();
  const Result<std::string> said = tell_virtual(parts.rig, *line);
  if (!said) return said.error();
  return json_reply({{"said", *said}});
}

}  // namespace

Resource virtual_rig_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/rig/virtual", [&parts](const Call& call) { return how_it_is(parts, call); },
            false, Pool::kDevices},
           {"POST", "/api/v1/rig/virtual", [&parts](const Call& call) { return obey(parts, call); }, false,
            Pool::kDevices}}};
}

}  // namespace weft::app
