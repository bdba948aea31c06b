// SPDX-License-Identifier: Apache-2.0
#include "app/daemon/error_json.h"

#include <algorithm>
#include <array>

namespace weft::app {
namespace {

struct KindRow {
  ErrorKind kind;
  const char* name;
  int status;
};

constexpr std::array<KindRow, 10> kKinds = {{{ErrorKind::kUsage, "usage", 400},
                                             {ErrorKind::kBadData, "bad_data", 422},
                                             {ErrorKind::kNoInput, "no_input", 404},
                                             {ErrorKind::kNoDevice, "no_device", 503},
                                             {ErrorKind::kInternal, "internal", 500},
                                             {ErrorKind::kCannotCreate, "cannot_create", 409},
                                             {ErrorKind::kInputOutput, "input_output", 500},
                                             {ErrorKind::kTryAgain, "try_again", 409},
                                             {ErrorKind::kProtocol, "protocol", 502},
                                             {ErrorKind::kInterrupted, "interrupted", 503}}};

const KindRow& row_of(ErrorKind kind) {
  return *std::ranges::find(kKinds, kind, &KindRow::kind);
}

}  // namespace

const char* kind_name(ErrorKind kind) {
  return row_of(kind).name;
}

int http_status_of(ErrorKind kind) {
  return row_of(kind).status;
}

Json error_document(const Error& error) {
  return {{"error",
           {{"kind", kind_name(error.kind)},
            {"what", error.what},
            {"where", error.where},
            {"why", error.why},
            {"remedy", error.remedy}}}};
}

Error error_of_document(const std::string& text, const std::string& where) {
  const Json document = Json::parse(text, nullptr, false);
  const Error unknown = {ErrorKind::kProtocol, "the answer is not a daemon's", where, text.substr(0, 200),
                         "check that the address is that of weft serve"};
  if (!document.is_object() || !document.contains("error") || !document["error"].is_object()) return unknown;
  JsonFields fields(document["error"], where);
  const std::string kind = fields.text("kind");
  const auto row = std::ranges::find_if(kKinds, [&](const KindRow& each) { return kind == each.name; });
  if (row == kKinds.end()) return unknown;
  return {row->kind, fields.text_or("what", ""), fields.text_or("where", ""), fields.text_or("why", ""),
          fields.text_or("remedy", "")};
}

std::string line_of(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace weft::app
