// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/session.h"

// Which solve of a session others are made from, and what speaks against one.

namespace weft::solve {

/// The levels of a solve, the least first. A method of comparison stands between the first two.
inline constexpr std::array<std::string_view, 5> kLevels = {"preview", "fast", "standard", "robust",
                                                            "reference"};

/// A complete solve, as one looks at it to choose.
struct ChoosableSolve {
  std::string id;
  std::filesystem::path folder;
  std::string level;          ///< or the method of comparison
  std::string written;        ///< ISO 8601
  std::string outdated = {};  ///< why its photographs are not those of today; empty: they are
  bool is_waiting = false;    ///< a batch made it, and nobody accepted it or asked for it since
  bool is_whole = true;       ///< all its maps were kept

  bool is_preview() const { return level == kLevels.front(); }
};
/// "the standard solve 0123456789abcdef of 2026-11-27T21:10:05Z"
std::string words_of(const ChoosableSolve& solve);

/// The solves of a session.
struct SessionSolves {
  std::filesystem::path session;
  bool is_lone = false;             ///< of photographs: there is one, and its folder is `session`
  std::vector<ChoosableSolve> all;  ///< the oldest first
  /// Indices of `all`; empty where there is no solve. `best`: of those of today's photographs the highest
  /// level, of two alike the newest; one that waits stands above previews alone. `current`: what a person
  /// chose, for as long as the photographs stay those that it was chosen for; else the best.
  std::optional<std::size_t> best = {}, current = {};
  bool is_chosen = false;  ///< the current one, by a person

  const ChoosableSolve* find(const std::string& id) const;  ///< null: there is none
  const ChoosableSolve* current_one() const;                ///< null: there is none
};
SessionSolves solves_of(const Session& session);
/// How a person makes one at this level: "weft solve SESSION --quality standard".
std::string command_to_solve(const SessionSolves& solves, const std::string& level);

/// The id of the current one; empty where there is none.
std::string current_solve(const Session& session);

/// Today's photographs, that nothing supersedes and nobody left out: what a choice is made for.
std::string digest_of_photographs(const Session& session);

/// Why what was made of the solve of this id is not what would be made today, a sentence each: photographs
/// that are others now, another current solve, a better one.
std::vector<std::string> why_stale(const SessionSolves& solves, const std::string& id);

/// Where maps come from: the solve of this id, without one the current. kNoInput where there is none, or none
/// of today's photographs; a preview is refused unless `draft` asks for it (kNoInput, kUsage of a named one).
Result<ChoosableSolve> solve_for_maps(const SessionSolves& solves, const std::string& id, bool draft);

/// What a product says of the solve that it was made of.
struct SourceFacts {
  std::string solve = {};               ///< its id
  std::string level = {};               ///< or the method of comparison; empty: nobody knows
  bool is_draft = false;                ///< it is a preview
  std::vector<std::string> stale = {};  ///< why another would have been made then, a sentence each
  /// Side of a pixel of photographs that was taken, mm. None: a calibrated camera took them.
  std::optional<double> pixel_mm = {};
  bool is_size_known = true;  ///< else `pixel_mm` is assumed, and with it all millimetres
};
SourceFacts source_of(const ChoosableSolve& solve, std::vector<std::string> stale);

}  // namespace weft::solve
