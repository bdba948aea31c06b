// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"

namespace weft::library {

struct AcceptBatchOptions {
  std::filesystem::path plan;
  std::vector<std::string> sessions = {};  ///< names; none: all
  bool with_worse = false;                 ///< also what became worse
  bool dry_run = false;
};

/// What became of one session.
struct Accepted {
  std::string session, solve, before;
  bool is_moved = false;  ///< its current solve is another now
  std::string why;        ///< it was left as it is
};

/// Chooses the new solve of each session, as a person does (solve/session/current.h). Until then it stands
/// above previews alone. Sessions that became worse are left as they are, and so are those whose current
/// solve is another than when it was planned. Nothing is removed. Errors of read_batch(); kUsage where solves
/// lie beside the archive, or a name is none of the plan's.
Result<std::vector<Accepted>> accept_batch(const AcceptBatchOptions& options);

/// A solve that is not needed any more.
struct Freed {
  std::string session, solve;
  std::uint64_t bytes = 0;
};

/// Prunes sessions whose current solve is the one that the plan made: solves go that are neither that nor
/// among the `keep` newest (library/catalogue/prune.h). Removed only where `yes`.
Result<std::vector<Freed>> prune_batch(const std::filesystem::path& plan, int keep, bool yes);

}  // namespace weft::library
