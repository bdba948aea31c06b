// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "library/batch/forecast.h"
#include "library/batch/plan.h"
#include "solve/input/session_input.h"

// What sessions are, seen without opening a photograph.

namespace weft::library {

/// One level that a session could be solved at.
struct LevelOfSession {
  std::string solve;        ///< id that the solve would have
  bool is_there = false;    ///< it is complete already
  double pixels_share = 1;  ///< pixels of its maps over those of the frame
  std::uint64_t memory_bytes = 0, write_bytes = 0;
};

struct Candidate {
  solve::SessionOptions input;
  std::optional<Error> error = {};  ///< why it cannot be solved; then nothing else is known
  std::string digest, rig, before;  ///< before: id of its current solve
  SessionTraits traits;
  Size size;
  std::vector<LevelOfSession> levels;  ///< in the order of level_names()
  std::uint64_t read_bytes = 0;
};

/// What a task asks a farm for: a quarter more than is counted, and the program itself.
std::uint64_t with_room(std::uint64_t bytes);

/// The levels, from the cheapest.
std::vector<std::string> level_names();

struct SurveyOptions {
  const BatchHeader& header;  ///< archive, output, product and calibrations
  int threads = 0;            ///< that solves will have
};

/// Folders of sessions at and below those named, absolute, in their order, each once. kNoInput for what is
/// not there or cannot be listed.
Result<std::vector<std::filesystem::path>> sessions_below(const std::vector<std::string>& folders);

/// Looks at sessions in parallel, and reports the phase "look". A calibration is read once, whichever
/// sessions hold a copy of it.
Result<std::vector<Candidate>> survey(const std::vector<std::filesystem::path>& sessions,
                                      const SurveyOptions& options, const JobContext& context);

/// Reads named calibrations. kUsage where two are of one rig; errors of read_calibration().
Result<std::vector<NamedCalibration>> read_named(const std::vector<std::filesystem::path>& folders);

}  // namespace weft::library
