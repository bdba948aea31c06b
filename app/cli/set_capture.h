// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>

#include "app/cli/verb.h"
#include "app/server/http/client.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// What a set is begun with, or taken up.
struct SetArguments {
  std::string part, name;
  std::filesystem::path description, from;  ///< board.toml, sheet.toml ...; a calibration
};

/// A set of photographs for a calibration, as the interface of its rig has it (calibrations/work), and a
/// person before it.
class SetCapture {
 public:
  /// `after_each` is done after each photograph that is of use, while others are wanted.
  SetCapture(
      const RigClient& client, const CommonArguments& common, std::function<void()> after_each = [] {})
      : client_(client), common_(common), after_each_(std::move(after_each)) {}

  Result<void> begin(const SetArguments& a);
  Result<void> leave_out(const std::string& name, bool out);
  /// What comes next; false where the photograph is of no use. kInterrupted.
  Result<bool> photograph(const std::stop_token& stop);
  /// Photographs at the Enter key until all is there, or enough for the person; false where that one stops
  /// before.
  Result<bool> converse(const std::stop_token& stop);

  void print_progress() const;  ///< figures and what comes next
  void print_next() const;      ///< there must be something
  void print_standing() const;  ///< every photograph, and figures

  const Json& set() const { return set_; }
  bool is_complete() const { return set_["next"].is_null(); }

 private:
  Result<void> took(Result<Json> document);
  Result<void> wait(const std::stop_token& stop);
  Result<void> obey(const std::string& line, const std::stop_token& stop);

  const RigClient& client_;
  const CommonArguments& common_;
  const std::function<void()> after_each_;
  Json set_;
  std::string last_;
};

}  // namespace weft::app
