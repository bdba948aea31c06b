// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/describe/fields.h"
#include "core/image/compression.h"

// Fields that requests share.

namespace weft {

/// The session that is worked on.
inline void describe_session(Fields& fields, std::filesystem::path& session) {
  fields.value({.name = "session",
                .says = "Session folder, NAME.weft",
                .need = kMustSay,
                .path = PathTo::kSession,
                .option = ""},
               session);
}

/// Which of its solves.
inline void describe_solve(Fields& fields, std::string& solve, bool& is_draft,
                           std::filesystem::path& calibration) {
  fields.value({"solve", "Id of the solve; default the session's current one"}, solve);
  fields.value({"draft", "A preview will do, of half the size and without masks"}, is_draft);
  fields.value({.name = "calibration",
                .says = "Calibration folder; default the session's own",
                .path = PathTo::kFolder},
               calibration);
}

/// Where files go; a server keeps them where they are found.
inline void describe_output(Fields& fields, std::filesystem::path& output, const char* says) {
  fields.value({.name = "output", .says = says, .option = "-o,--output", .said = Said::kAtThisMachine},
               output);
}

/// A shutter time, in microseconds. `otherwise`: what it is where nothing is said.
inline void describe_exposure(Fields& fields, std::optional<double>& exposure_us, const NumberRange& range_us,
                              const std::string& otherwise) {
  fields.value(
      {.name = "exposure_us",
       .says = "Shutter time: 20ms, 0.5s, 1/60 or, without a unit, us; the camera's nearest is taken; "
               "default " +
               otherwise,
       .range = range_us,
       .units = {{"us", 1}, {"ms", 1e3}, {"s", 1e6}, {"", 1}}},
      exposure_us);
}

inline void describe_grid(Fields& fields, std::optional<double>& mm_per_pixel) {
  fields.value({.name = "mm_per_pixel",
                .says = "Of the grid; default what the camera sees. Of solved photographs: of theirs, kept",
                .range = {1e-4, 100},
                .option = "--mm-per-pixel"},
               mm_per_pixel);
}

inline void describe_compression(Fields& fields, Compression& compression) {
  fields.choice({"compress", "Of EXR files: none, zip, piz"}, compression, kCompressionNames);
}

}  // namespace weft
