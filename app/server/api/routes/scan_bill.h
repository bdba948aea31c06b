// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/scan/scan.h"
#include "core/base/json_document.h"

namespace weft::app {

/// What one kind of shot costs, and what it is for.
struct BillLine {
  std::string what;  ///< lit, dark, repeat, bracket, polariser, below
  int shots = 0;
  std::optional<double> seconds;  ///< by the pace of the last scan; none: not known yet
  std::string purpose;            ///< one sentence
  /// Error of normals without and with it, degrees, where docs/conditions.md measured that.
  std::optional<double> without_deg, with_deg;
};

/// A new scan's, before it begins. `pace_s`: seconds a shot.
std::vector<BillLine> bill_of(const capture::ScanRequest& request, std::optional<double> pace_s);

/// {"what", "shots", "seconds", "for", "without_deg", "with_deg"}.
Json json_of(const BillLine& line);

}  // namespace weft::app
