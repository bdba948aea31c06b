// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "library/chain/chain.h"
#include "solve/run/explain.h"

// Makes what is missing, a draft or stale of a session's chain, and nothing twice.

namespace weft::library {

/// What `weft make` and its job are told.
struct MakeOptions {
  std::filesystem::path session;
  solve::LevelWish wish = {};  ///< what the solve shall reach; none: the level that its price recommends
  /// What it is exported for, by name; none: what it was exported for before.
  std::vector<std::string> presets = {};
  bool only_explains = false;  ///< says what would be made
};
void describe(Fields& fields, MakeOptions& options);

struct MadeLink {
  std::string name;  ///< "solve", "maps" or "export"
  std::string id;    ///< ChainLink::id
  std::filesystem::path folder;
  double seconds = 0;
};

struct MakeReport {
  std::vector<std::string> steps;  ///< what was made, or would be, a sentence each
  std::vector<MadeLink> made;
  Chain chain;  ///< afterwards
};

/// Is told of each step before it begins: "solve it at robust: 0.28 degrees on 99 % of the cloth in 3.4 s
/// foretold".
using TellStep = std::function<void(const std::string& step)>;

/// Solves the session where it has no fresh solve, or none as good as is wished for; makes the maps of that
/// solve, finished as the newest set was; exports them. A stale solve is made again at its level. Else the
/// level is chosen on a cut (explain_session()); a preview never is, nor one that is no better than what is
/// there. The solve becomes the session's current one. Errors of these, of choose_level(), of
/// make_maps() and of export_maps(); what was made before an error stays.
Result<MakeReport> make_session(const MakeOptions& options, const JobContext& context, const TellStep& tell);

/// What `weft maps` would be refused for is made first: a solve of today's photographs that is no preview.
/// Returns its id; empty where there was one.
Result<std::string> make_solve_first(const std::filesystem::path& session, const JobContext& context,
                                     const TellStep& tell);
/// The same for `weft export`: maps that are no draft and that these presets can be packed of, finished as
/// the newest are. Returns their folder.
Result<std::filesystem::path> make_maps_first(const std::filesystem::path& session,
                                              const std::vector<std::string>& presets,
                                              const JobContext& context, const TellStep& tell);

}  // namespace weft::library
