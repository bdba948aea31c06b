// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/describe/fields.h"

namespace weft::torture {

/// What a formula as textbooks have it gets wrong, what weft's own function makes of the same, and what that
/// says of itself. Truths are closed forms, or computed with 64 bits of mantissa and more.
struct HardCase {
  std::string stage;            ///< "capture", "calibration", "solver", "gloss", "height", "maps", "export"
  std::string what;             ///< what is hard
  std::string unit;             ///< of both errors
  std::optional<double> plain;  ///< error of the plain formula; none: it gives no number
  std::optional<double> ours;   ///< error of weft; none: it refuses to answer
  std::string flag = {};        ///< what weft says of it: status bits, a refusal, a count; empty: nothing
  double within = 0;            ///< the most that `ours` may be
  std::string must_say = {};    ///< part of `flag`

  /// An answer within its bound, or none and a flag that says so.
  bool holds() const {
    const bool is_right = ours ? *ours <= within : !flag.empty();
    return is_right && flag.find(must_say) != std::string::npos;
  }
};

inline void describe(Fields& fields, HardCase& hard) {
  fields.value({.name = "stage", .says = "capture, calibration, solver, gloss, height, maps or export"},
               hard.stage);
  fields.value({.name = "what", .says = "What is hard"}, hard.what);
  fields.value({.name = "unit", .says = "Of the errors"}, hard.unit);
  fields.value({.name = "plain", .says = "Error of the plain formula; missing: it gives no number"},
               hard.plain);
  fields.value({.name = "ours", .says = "Error of weft; missing: it refuses to answer"}, hard.ours);
  fields.value({.name = "flag", .says = "What weft says of it"}, hard.flag);
  fields.value({.name = "within", .says = "The most that ours may be"}, hard.within);
}

/// All of them in the order of the stages, computed anew. Takes about a second.
std::vector<HardCase> hard_cases();

// Those of a stage.
std::vector<HardCase> hard_captures();
std::vector<HardCase> hard_calibrations();
std::vector<HardCase> hard_lobes();
std::vector<HardCase> hard_heights();
std::vector<HardCase> hard_maps();
std::vector<HardCase> hard_exports();

}  // namespace weft::torture
