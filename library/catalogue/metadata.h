// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/session.h"

// What people say of a cloth, kept in its session.json. No solve depends on it; maps do on its kind.

namespace weft::library {

/// `metadata` of session.json (docs/formats.md). Empty or 0: nobody said.
struct Metadata {
  int revision = 0;                    ///< counts the changes
  std::string id = {};                 ///< article number or barcode
  std::vector<std::string> tags = {};  ///< sorted, each once
  std::string composition = {};        ///< "80 % wool, 20 % polyamide"
  std::string construction = {};       ///< "twill 2/1"
  std::string side = {};               ///< "front" or "back"
  std::string kind = {};               ///< of kClothKinds
  std::string notes = {};              ///< may have several lines
  double weight_g_m2 = 0;
  double thickness_mm = 0;

  friend bool operator==(const Metadata&, const Metadata&) = default;
};

/// Texts are valid UTF-8 without control characters, of at most this many bytes; notes may have line feeds.
inline constexpr std::size_t kLongestText = 200;
inline constexpr std::size_t kLongestNotes = 10'000;
inline constexpr std::size_t kMostTags = 64;

/// kBadData, `where` being its name for messages.
Result<Metadata> metadata_from_json(const Json& document, const std::string& where);
/// Whether a scan may begin with this as the metadata of its session: the rules of the fields above; further
/// ones of plain names are texts of one line, numbers or truths. kUsage with the field and its rule.
Result<void> check_new_metadata(const Json& metadata);
/// What a session says; empty where it says nothing. kBadData.
Result<Metadata> metadata_of(const Session& session);
/// {"id", "tags", "composition", "construction", "side", "kind", "notes", "weight_g_m2", "thickness_mm",
/// "revision"}; amounts that nobody said are null.
Json json_of(const Metadata& metadata);

/// A change that was made, and what undoes it: `before` and `after` hold the fields that differ, null where
/// there was none.
struct MetadataChange {
  std::filesystem::path folder;  ///< of the session
  Json before, after;
  int revision = 0;  ///< after it
};

/// What must hold of the session for a change to be made: somebody else may have changed it.
struct Provided {
  std::optional<int> revision = {};  ///< that of its metadata
  Json values = {};                  ///< of fields, as Change has them; null: any
};

/// Sets fields of a session's metadata, or `fabric`, `current_solve` (solve/session/current.h) or `left_out`
/// (solve/session/left_out_shots.h, a whole list); a field that is null is removed. Others stay, unknown ones
/// of newer versions too. `tags` is a whole list. Takes the lock that a scan holds. Errors: kUsage (a field
/// that is none, or breaks a rule), kNoInput (also: no such solve or shot), kBadData, kTryAgain (a scan
/// writes the session, or it is not as provided), kCannotCreate.
Result<MetadataChange> change_metadata(const std::filesystem::path& session, const Json& fields,
                                       const Provided& provided = {});

/// What a change did, in words: "tags of twill: red, wool".
std::string words_of(const MetadataChange& change);

}  // namespace weft::library
