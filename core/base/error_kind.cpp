// SPDX-License-Identifier: Apache-2.0
#include "core/base/error_kind.h"

#include <algorithm>
#include <array>
#include <utility>

namespace weft {
namespace {

using Row = std::pair<ErrorKind, const char*>;

constexpr std::array<Row, 10> kNames = {{{ErrorKind::kUsage, "usage"},
                                         {ErrorKind::kBadData, "bad_data"},
                                         {ErrorKind::kNoInput, "no_input"},
                                         {ErrorKind::kNoDevice, "no_device"},
                                         {ErrorKind::kInternal, "internal"},
                                         {ErrorKind::kCannotCreate, "cannot_create"},
                                         {ErrorKind::kInputOutput, "input_output"},
                                         {ErrorKind::kTryAgain, "try_again"},
                                         {ErrorKind::kProtocol, "protocol"},
                                         {ErrorKind::kInterrupted, "interrupted"}}};

}  // namespace

const char* name_of(ErrorKind kind) {
  return std::ranges::find(kNames, kind, &Row::first)->second;
}

std::vector<const char*> error_kind_names() {
  std::vector<const char*> names;
  for (const auto& [kind, name] : kNames) names.push_back(name);
  return names;
}

std::optional<ErrorKind> error_kind_of(std::string_view name) {
  const auto* const row = std::ranges::find(kNames, name, &Row::second);
  return row == kNames.end() ? std::nullopt : std::optional(row->first);
}

}  // namespace weft
