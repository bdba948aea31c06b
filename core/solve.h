// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/json_document.h"
#include "core/product.h"
#include "core/result.h"
#include "core/solve_record.h"

// A solve: the maps that one run of the solver left in <session>/solve/<id>/ (docs/formats.md).

namespace weft {

inline constexpr ProductKind kSolveProduct = {"weft.solve", "solve.json", "solve",
                                              "solve the session first with weft solve"};

/// The complete solve of a session that has this id; without an id the newest. kNoInput where there is none.
Result<Product> find_solve(const std::filesystem::path& session, const std::string& id = "");

/// The complete solves of a session, the oldest first.
std::vector<Product> list_solves(const std::filesystem::path& session);

/// A sentence for the person at the rig, and what to do.
struct SolveWarning {
  std::string name;    ///< LEDS_EXCHANGED, CONDITIONS ...
  std::string text;    ///< one sentence without a full stop
  std::string remedy;  ///< an imperative phrase without a full stop; may be empty

  friend bool operator==(const SolveWarning&, const SolveWarning&) = default;
};

/// Angles between the normals and those of a truth.
struct SolveError {
  double mean_deg = 0, median_deg = 0, p95_deg = 0, max_deg = 0;

  friend bool operator==(const SolveError&, const SolveError&) = default;
};

/// What solve.json says of a solve.
struct SolveFacts {
  std::string id;
  int solver_version = 0;
  std::string method;
  std::string compression = "none";  ///< of EXR files: none, zip, piz
  Size size;                         ///< of the maps
  int lights = 0;
  std::string albedo_scale = "relative";  ///< or "absolute"
  std::string color = "camera";           ///< whose channels albedo is in; or "rec709"
  std::int64_t pixels = 0;                ///< with a solution
  std::array<std::int64_t, kStatusNames.size()> status =
      {};  ///< pixels with each bit, as kStatusNames has them
  std::vector<SolveWarning> warnings;
  std::vector<std::string> pictures;  ///< files in its folder
  std::optional<SolveError> error;    ///< where there is a truth
  Json document;                      ///< all of solve.json, which json_of() keeps but for what stands above

  /// Pixels whose status has `bit`.
  std::int64_t with(StatusBit bit) const;
};

/// Reads solve.json, `where` being its name for messages. Documents of early versions have no color, warnings
/// or pictures. kBadData.
Result<SolveFacts> solve_facts_of(const Json& document, const std::string& where = kSolveProduct.document);
Json json_of(const SolveFacts& facts);

}  // namespace weft
