// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/session.h"
#include "exchange/presets/channels.h"
#include "material/run/map_facts.h"

namespace weft::exchange {

/// A folder of maps of one cloth: a set of maps (maps.json), a built material (material.json), or a solve
/// (solve.json) as it was photographed.
struct MapFolder {
  std::filesystem::path folder;
  std::string kind;  ///< "maps", "material" or "solve"
  std::string id;
  std::string title;  ///< of the cloth, as people call it
  std::string name;   ///< of the cloth in names of files
  Size size;
  std::optional<double> mm_per_pixel;  ///< none: photographs do not tell
  bool is_size_known = true;           ///< else it is assumed
  bool is_tile = false;
  std::string albedo_scale;  ///< "absolute", "relative" or, where nobody says, "unknown"
  std::vector<material::MapFacts>
      maps;                   ///< `document`: its entry; a parameter of several numbers has them there
  std::string document_file;  ///< "maps.json"
  Json document;
  std::optional<Session> session;  ///< that it lies in, or the photographs that it was solved from
  /// The solve's level, whether it is a preview, and why it is stale today, a sentence each.
  std::string level = {};
  bool is_draft = false;
  std::vector<std::string> stale = {};

  const material::MapFacts* map(const std::string& name) const;
};

/// What is opened, and what it is for.
struct MapFolderWish {
  std::filesystem::path input;           ///< a session, a solve of photographs, or a folder as above
  std::string maps_id = {};              ///< of a session's sets; empty: set_to_use() says it
  std::vector<std::string> wanted = {};  ///< maps, of which a session's set should be
  bool is_draft = false;                 ///< maps of a preview will do
};

/// kNoInput where there is no such thing; kUsage for maps of a preview that nobody asked for; kBadData with
/// file and key for a document that cannot be used, a map's file that leaves the folder, sizes and pitches
/// that are none.
Result<MapFolder> open_map_folder(const MapFolderWish& wish);

/// For people: which solves it is of, and what is stale of them.
std::vector<std::string> source_of(const MapFolder& folder);

/// What leads back to the photographs: ids, and the SHA-256 of documents, maps and raw files.
Result<Json> provenance_of(const MapFolder& folder);

/// The numbers of maps that are none but numbers, and for the planes of `wanted` which file and channel they
/// are read from.
struct PlaneOrigin {
  std::string file = {};                   ///< empty: a number or nothing
  std::vector<std::string> channels = {};  ///< the first of these that the file has
  std::optional<double> constant = {};
};
PlaneOrigin origin_of(const MapFolder& folder, MapPlane plane);

}  // namespace weft::exchange
