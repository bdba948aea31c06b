// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/guide/photograph_set.h"
#include "calibration/run/board_photographs.h"
#include "calibration/run/sheet_files.h"
#include "core/image/image.h"

// The boards and sheets that a rig owns, told apart in a photograph by their markers.

namespace weft::calibration {

/// A board or a sheet: one of the two.
struct OwnedTarget {
  std::string says;  ///< "a white sheet of 168 x 111.5 mm"
  std::string text;  ///< of its file
  std::optional<PrintedBoard> board;
  std::optional<TaggedSheet> sheet;
};

/// What this file describes; nothing where it can not be read, or describes neither.
std::optional<OwnedTarget> read_target(const std::filesystem::path& file);

/// All that targets/ beside a rig file describes, also what was set aside there for a newer one.
std::vector<OwnedTarget> owned_targets(const std::filesystem::path& rig_folder);

/// The one most of whose markers are in the picture, four of a board and two of a sheet at least; the first
/// of several. Null: none.
const OwnedTarget* target_in(View<const std::uint8_t> grey, std::span<const OwnedTarget> targets);

/// Where what was photographed by a step shows another board or sheet of the rig than the set describes, the
/// set is of that one from then on. True: it was so. Not for a set of which something is used.
Result<bool> adopt_target(const PhotographSet& set, const std::string& step);

/// The picture in which tags of a session are looked for: its first lit photograph. Errors: those of
/// read_session() and decode_raw(); kBadData where the session is not complete.
Result<Image<std::uint8_t>> grey_of_session(const std::filesystem::path& session);

}  // namespace weft::calibration
