// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/rig/calibration.h"

// The cards that lie in the corners of a table: a tag, and white beside it (weft target tags).

namespace weft::calibration {

/// Targets that were printed for a rig, beside its rig file, and what is written of its cards there.
inline constexpr const char* kTargetsFolder = "targets";
inline constexpr const char* kCardsFile = "tags.toml";

/// A card, in sides of its tag: the tag's quiet zone, and the width of the white that begins behind it, as
/// high as both; on the right of even tags and on the left of odd ones, so that it lies towards the middle.
inline constexpr double kCardQuiet = 0.25, kCardWhite = 1.2;

/// Where the white of each card lies in the pictures, by the tags that a calibration knows; of cards that are
/// whole in the frame. `common` has what a patch is beside that.
std::vector<WhitePatch> patches_of_cards(const Calibration& calibration, const WhitePatch& common);

/// Whether the rig of a session has such cards: tags.toml in the targets/ of a folder above it.
bool has_cards(const std::filesystem::path& session);

}  // namespace weft::calibration
