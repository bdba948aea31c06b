// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/product.h"
#include "core/base/result.h"
#include "core/rig/session.h"
#include "material/run/map_set_facts.h"
#include "solve/session/current.h"

// The sets of maps of a session, and which of them others are made from.

namespace weft::material {

/// A text or a truth of a document; empty or false where it has none of that kind.
std::string text_at(const Json& document, const char* key);
bool flag_at(const Json& document, const char* key);

/// Which of kClothKinds people said that the cloth is; empty where they did not.
std::string cloth_kind_of(const Session& session);

/// A set of maps with what is known of its solve.
struct SessionSet {
  Product product;
  MapSetFacts facts;
  std::string level;               ///< of its solve; empty: nobody knows
  bool is_draft = false;           ///< of a preview
  std::vector<std::string> stale;  ///< why it is not what would be made today, a sentence each
};

/// The complete sets of a session but its previews, the oldest first. `of_previews`: those too.
std::vector<SessionSet> sets_of(const solve::SessionSolves& solves, bool of_previews = false);

/// Which of these maps a set has not.
std::vector<std::string> lacking(const MapSetFacts& facts, const std::vector<std::string>& wanted);

/// Which of them exports and materials are made from: of those of the current solve, else of all, the newest
/// that has the maps `wanted`, else the newest. Maps of a preview come last. Null where there is none.
const SessionSet* set_to_use(const solve::SessionSolves& solves, const std::vector<SessionSet>& sets,
                             const std::vector<std::string>& wanted);

/// What to do where there are maps of a preview alone: "make better ones with weft maps SESSION".
std::string how_to_make_better(const solve::SessionSolves& solves);

/// "from the standard solve 0123456789abcdef", then why that is stale, and that its size is not known.
std::vector<std::string> source_lines(const solve::SourceFacts& source);
/// What a list of scans says of one; empty where it does not.
solve::SourceFacts source_in(const Json& scan);

}  // namespace weft::material
