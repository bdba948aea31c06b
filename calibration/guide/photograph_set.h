// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/run/board_photographs.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

// The photographs that one step of a calibration needs, in a folder that `weft calibrate` reads as it is.

namespace weft::calibration {

/// What a set is of: the folders of docs/calibration.md.
enum class SetPart { kBoard, kResponse, kTrap, kSheet, kChart, kCheck, kMoved };
inline constexpr std::array<const char*, 7> kSetPartNames = {"board", "response", "trap", "sheet",
                                                             "chart", "check",    "moved"};
const char* name_of(SetPart part);  ///< "board"
std::optional<SetPart> set_part_of(const std::string& name);

/// A set as set.json in its folder has it (weft.set/1). The folder is what counts: a photograph that lies
/// there is of the set, whether set.json came to know of it or not.
struct PhotographSet {
  std::filesystem::path folder;
  SetPart part = SetPart::kBoard;
  std::string rig;
  std::string created;          ///< ISO 8601
  std::filesystem::path from;   ///< the calibration that was known before
  double exposure_us = 0;       ///< of its photographs; 0: not metered yet
  Json asked = Json::object();  ///< by photograph: the pose that a person was asked for
  Json why = Json::object();    ///< by session that weft left out: why
  Json document;                ///< set.json as it was read, so that fields of newer versions survive

  /// What people write about the board or the sheet, beside the photographs.
  std::filesystem::path board_file() const { return folder / "board.toml"; }
  std::filesystem::path sheet_file() const { return folder / "sheet.toml"; }
  std::filesystem::path left_out() const { return folder / "left_out"; }
  /// Its photographs are sessions of a white sheet.
  bool is_of_sheets() const {
    return part == SetPart::kSheet || part == SetPart::kCheck || part == SetPart::kMoved;
  }
};

void describe(Fields& fields, PhotographSet& set);

/// What a set is begun with.
struct SetRequest {
  std::filesystem::path folder;
  SetPart part = SetPart::kBoard;
  std::string rig;
  std::filesystem::path from;
  /// Text of board.toml, sheet.toml or chart.toml; empty: newest_description(). Not of a set that is there.
  std::string description;
};

/// What the newest of the sets in a folder, and of the rig's own targets beside it (printed_target.h), says
/// of such a thing; empty: none does.
std::string newest_description(const std::filesystem::path& sets, SetPart part);

/// Begins a set, or takes up the one that is in the folder. kCannotCreate where the folder holds another part
/// or another rig's, or something that is no set; kNoInput, kBadData for what is written about the board or
/// the sheet.
Result<PhotographSet> begin_set(const SetRequest& request);
Result<PhotographSet> read_set(const std::filesystem::path& folder);
Result<void> write_set(const PhotographSet& set);

/// Moves a photograph or session of the set to left_out/, or from there back. kNoInput where it is not there,
/// kCannotCreate where one of its name lies there.
Result<void> leave_out(const PhotographSet& set, const std::string& name, bool out);

}  // namespace weft::calibration
