// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace weft::virtual_rig {

/// A number that may be said of a thing.
struct Sayable {
  const char* name;
  double least, most, usual;
};

/// What was said of a thing, as "tilt=30".
class SaidValues {
 public:
  /// kUsage for a word that names none of `settings`, or a number out of its range.
  static Result<SaidValues> of(const std::vector<std::string>& words, const std::vector<Sayable>& settings);

  double operator()(const Sayable& setting) const { return value(setting).value_or(setting.usual); }
  std::optional<double> value(const Sayable& setting) const;

 private:
  std::vector<std::pair<std::string, double>> values_;
};

}  // namespace weft::virtual_rig
