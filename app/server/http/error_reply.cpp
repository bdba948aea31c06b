// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/error_reply.h"

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "core/describe/error_json.h"

namespace weft::app {
namespace {

/// What is said, and the word for it. Clients rely on the words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 53> kCodes = {{
    {"the token is missing or wrong", "not_logged_in"},
    {"the token is wrong", "wrong_token"},
    {"this token may only look", "may_only_look"},
    {"a change by a cookie needs an Origin", "no_origin"},
    {"pages from elsewhere may not use this daemon", "foreign_page"},
    {"the Host header is not this daemon's", "foreign_host"},
    {"the method is not taken", "wrong_method"},
    {"this call has no such method", "wrong_method"},
    {"there is no such call", "no_such_call"},
    {"the body is not said to be JSON", "not_json"},
    {"the request is refused", "unreadable"},
    {"the range is beyond the file", "beyond_file"},
    {"too many requests wait already", "too_busy"},
    {"too many clients follow this rig", "too_many_streams"},
    {"too many pictures are being made", "too_busy"},
    {"the rig is busy", "rig_busy"},
    {"this server has no rig", "no_rig"},
    {"this rig is real", "rig_is_real"},
    {"somebody else holds the controls", "controls_held"},
    {"the devices are closed", "devices_closed"},
    {"a scan has the devices", "rig_busy"},
    {"a test shot is being taken", "shot_on_its_way"},
    {"no such test shot", "no_such_shot"},
    {"the test shot has no picture", "no_such_shot"},
    {"no scan is running", "no_scan"},
    {"the scan is about to end", "scan_ending"},
    {"the scan has no fabric", "no_fabric"},
    {"the rig has moved since it was calibrated", "rig_moved"},
    {"there is a session of this name", "session_exists"},
    {"there is no such session", "no_such_session"},
    {"this is no name of a session", "no_such_session"},
    {"there is no such frame", "no_such_frame"},
    {"there is no such solve", "no_such_solve"},
    {"there is no such set of maps", "no_such_maps"},
    {"there is no such tile", "no_such_tile"},
    {"the readings of this solve are no longer there", "readings_gone"},
    {"nothing is known of millimetres", "no_millimetres"},
    {"session is being written", "session_busy"},
    {"session was changed meanwhile", "changed_meanwhile"},
    {"there is nothing to take back", "nothing_to_undo"},
    {"this is no name of a set", "no_such_set"},
    {"no set is worked on", "no_set"},
    {"the set is being photographed", "rig_busy"},
    {"the set has all that is needed", "set_complete"},
    {"there is no such batch", "no_such_batch"},
    {"there is a batch of this name", "batch_exists"},
    {"there is no such job", "no_such_job"},
    {"job cannot be cancelled", "job_ended"},
    {"job cannot be retried", "job_not_ended"},
    {"job cannot be forgotten", "job_not_ended"},
    {"job does not wait", "job_not_waiting"},
    {"the disk does not answer", "disk_silent"},
    {"a bug in weft", "bug"},
}};

}  // namespace

int http_status_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return 400;
    case ErrorKind::kNoInput:
      return 404;
    case ErrorKind::kCannotCreate:
    case ErrorKind::kTryAgain:
      return 409;
    case ErrorKind::kBadData:
      return 422;
    case ErrorKind::kInternal:
    case ErrorKind::kInputOutput:
      return 500;
    case ErrorKind::kProtocol:
      return 502;
    case ErrorKind::kNoDevice:
    case ErrorKind::kInterrupted:
      return 503;
  }
  return 500;
}

Json error_document(const Error& error) {
  Json document = json_of(error);
  if (const std::string_view code = code_of(error); !code.empty()) document["code"] = code;
  return {{"error", std::move(document)}};
}

std::string_view code_of(const Error& error) {
  const auto known = std::ranges::find(kCodes, std::string_view(error.what),
                                       &std::pair<std::string_view, std::string_view>::first);
  return known == kCodes.end() ? std::string_view() : known->second;
}

std::vector<std::string_view> error_codes() {
  std::vector<std::string_view> codes;
  for (const auto& [what, code] : kCodes) codes.push_back(code);
  return codes;
}

Error error_of_exception(const std::exception& thrown, const std::string& where) {
  if (dynamic_cast<const std::bad_alloc*>(&thrown) != nullptr) {
    return {ErrorKind::kTryAgain, "not enough memory", where, "the system refused some",
            "close other programs and run the same command again"};
  }
  return {ErrorKind::kInternal, "a bug in weft", where, thrown.what(),
          "run the same command again, and report it with what you did"};
}

Error error_of_document(const std::string& text, const std::string& where) {
  const Json document = Json::parse(text, nullptr, false);
  if (document.is_object() && document.contains("error")) return error_of_json(document["error"], where);
  return {ErrorKind::kProtocol, "the answer is not a daemon's", where, text.substr(0, 200),
          "check that the address is that of weft serve"};
}

std::string line_of(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace weft::app
