// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

#include "core/base/result.h"

namespace weft::simulator {

/// What a setting may be, both ends included.
struct Range {
  double least;
  double most;
};

/// A setting by its name.
struct NamedSetting {
  const char* name;
  double value;
  Range range;
};

/// kBadData for the first value that is not a number in its range.
Result<void> check(std::initializer_list<NamedSetting> settings);

}  // namespace weft::simulator
