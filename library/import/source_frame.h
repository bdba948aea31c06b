// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/scan/glance.h"
#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "library/import/name_pattern.h"
#include "library/import/source_folders.h"

namespace weft::library {

/// A photograph that is to be of a session, and what it says of itself.
struct SourceFrame {
  SourceFile source;
  NameParts said;     ///< by its name
  std::string label;  ///< its path below its root, for tables and "source" of session.json
  Size size;
  CfaPattern cfa;
  ShotMetadata shot;
  /// EXIF DateTimeOriginal with sub-seconds: seconds since 1970 if the camera's clock showed UTC, and the
  /// true ones where the file names the zone.
  std::optional<double> taken_s;
  bool knows_zone = false;
  std::optional<std::uint32_t> image_number;  ///< the body's count of shots
};

/// Opens a file and reads its header. Errors of reading a raw's header or an image's; kBadData for an image
/// whose values are no linear light.
Result<SourceFrame> look_at_frame(const SourceFile& source, const NameParts& said);

/// "2026-01-31T23:59:58.25", with a Z where the zone is known; empty where no time is.
std::string time_words(const SourceFrame& frame);

/// The light on each patch: glance_at() of a raw, the same of a developed frame. Decodes it whole. Errors of
/// decoding.
Result<std::vector<double>> light_of(const SourceFrame& frame, const capture::PatchGrid& grid,
                                     const capture::GlanceScale& scale);

/// How bright a frame is where it is bright: what nine tenths of its patches stay below; 1 where they are
/// full.
double level_of(const std::vector<double>& light);

}  // namespace weft::library
