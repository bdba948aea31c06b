// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "core/describe/fields.h"

// Fields that steps of a calibration share.

namespace weft::calibration {

/// What a step measures its part from: `says` is what lies there.
inline void describe_input(Fields& fields, std::filesystem::path& input, const char* says) {
  fields.value({.name = "input", .says = says, .need = kMustSay, .path = PathTo::kFolder, .option = ""},
               input);
}

inline void describe_kept(Fields& fields, std::filesystem::path& from) {
  fields.value({.name = "from",
                .says = "Calibration whose other parts are kept; it is never changed",
                .path = PathTo::kFolder},
               from);
}

inline void describe_new_calibration(Fields& fields, std::filesystem::path& output) {
  fields.value({.name = "output",
                .says = "Folder of the new calibration, which must not exist",
                .need = kMustSay,
                .path = PathTo::kNewFolder,
                .option = "-o,--output"},
               output);
}

/// The same where a step can do without.
inline void describe_wanted_calibration(Fields& fields, std::filesystem::path& output) {
  fields.value(
      {.name = "output",
       .says = "Folder of the new calibration, which must not exist; default none: only says what comes out",
       .path = PathTo::kNewFolder,
       .option = "-o,--output"},
      output);
}

/// The server names its own rig.
inline void describe_rig(Fields& fields, std::string& rig) {
  fields.value(
      {.name = "rig", .says = "Name of the rig, where there is no --from", .said = Said::kAtThisMachine},
      rig);
}

inline void describe_paper_delta(Fields& fields, std::optional<double>& paper_delta) {
  fields.value(
      {"paper_delta",
       "The paper reflects 1 - delta (1 - cosine) of Lambert's law; default as the lights' report has it",
       {-0.5, 1}},
      paper_delta);
}

}  // namespace weft::calibration
