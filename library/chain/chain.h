// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/describe/fields.h"
#include "core/rig/scan_verdict.h"
#include "core/rig/session.h"
#include "solve/session/current.h"

// What a session has on the way from its photographs to the files of an engine, and how fresh that is.

namespace weft::library {

enum class Freshness {
  kMissing,
  kDraft,  ///< of a preview, which has half the size and no masks
  kStale,  ///< another would be made today
  kFresh
};
inline constexpr std::array kFreshnessNames = {"missing", "draft", "stale", "fresh"};

/// One thing on the way.
struct ChainLink {
  std::string name;  ///< "photographs", "solve", "maps" or "export"
  Freshness freshness = Freshness::kMissing;
  std::string id = {};                               ///< of a solve or a set of maps; of an export its preset
  std::string folder = {};                           ///< absolute; empty: there is none
  std::string written = {};                          ///< ISO 8601
  std::string level = {};                            ///< of the solve that it is, or that it is made of
  std::optional<double> mean_deg = {}, solved = {};  ///< the error to expect of that solve, and the share
  std::vector<std::string> why = {};                 ///< it is not fresh, a sentence each
  std::string says = {};  ///< what it is: "robust, 0.28 degrees on 99 % of the cloth"
};
void describe(Fields& fields, ChainLink& link);

struct Chain {
  std::string session, fabric;  ///< its folder; the cloth
  ScanVerdict verdict = {};
  /// Nothing is missing, a draft or stale; that nothing was exported is no lack.
  bool is_fresh = false;
  std::vector<ChainLink> links;  ///< photographs, solve, maps, and an export at least, in this order

  const ChainLink& link(const std::string& name) const;  ///< the first of this name
};
/// weft.chain/1.
void describe(Fields& fields, Chain& chain);
Json json_of(const Chain& chain);

/// The chain of a session as it lies on the disk. A solve is stale where its photographs, the session's
/// calibration or the solver are others than those that it was made with; maps where their solve is, or
/// another is taken now; an export, the newest of each preset, where its maps are, or others are. What a
/// person chose is not called stale. What cannot be read counts as not there.
Chain chain_of(const Session& session);

/// "robust, 0.28 degrees on 99 % of the cloth; stale: LED 3 was photographed again since".
std::string words_of(const ChainLink& link);

}  // namespace weft::library
