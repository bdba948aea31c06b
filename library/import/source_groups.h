// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "library/import/led_decision.h"
#include "library/import/name_pattern.h"
#include "library/import/source_folders.h"
#include "library/import/source_frame.h"

// Which photographs are of one session.

namespace weft::library {

/// Photographs of one session, to all that names, folders and times tell.
struct SourceGroup {
  std::string name;              ///< a name that a session may have; no other group has it
  std::string fabric;            ///< by the pattern; empty: it says nothing
  std::filesystem::path root;    ///< the folder that was named
  std::filesystem::path folder;  ///< that its frames lie in
  std::vector<SourceFrame> frames;
  std::vector<Error> unreadable;  ///< of files that belong to it and cannot be opened
  std::vector<ImportDoubt> doubts;
};

struct GroupingOptions {
  std::optional<NamePattern> pattern;
  double gap_s = 60;     ///< between two sessions in one folder
  std::size_t leds = 0;  ///< of the rig: a folder of so many frames, or one more, is one session
};

/// Opens the files and groups them: by {session} of the pattern, else by folder (and {fabric}), and a folder
/// of more frames than a session has at gaps of time: in the order of names that count on, where a gap in
/// the midst of a session is the clock's, else in that of times, where all files have some. Files that do
/// not follow the pattern go to `left_over`. Reports the phase "look". Errors: the caller's stop token.
Result<std::vector<SourceGroup>> group_frames(const std::vector<SourceFile>& files,
                                              const GroupingOptions& options, const JobContext& context,
                                              std::vector<LeftOver>& left_over);

}  // namespace weft::library
