// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/image.h"
#include "core/image_io/linear_image.h"

namespace weft::capture {

/// What a picture says of itself, by its header alone: what its samples mean, and how it was taken.
struct PictureMeaning {
  std::filesystem::path file;
  std::string format;                   ///< "tiff", "jpeg", of a raw "dng"
  bool is_raw = false;                  ///< a mosaic that LibRaw reads
  Size size;                            ///< as stored
  std::string samples;                  ///< "16 bits", "floats", "counts"
  std::vector<std::string> channels;    ///< as the file names them
  Transfer transfer = Transfer::kAuto;  ///< kAuto: through a curve that is neither
  std::string transfer_by;              ///< what says so; empty: nothing does, it is told by the samples
  int orientation = 1;                  ///< as of capture::PhotographFacts
  std::array<int, 2> origin = {};       ///< as of ImageFileInfo
  std::string model, lens;              ///< empty where nothing is said
  double exposure_us = 0, iso = 0, f_number = 0;  ///< 0 where nothing is said
  std::vector<std::string> passed_over;           ///< as of ImageFileInfo::remarks
  /// Why it cannot be solved from; none for a photograph.
  std::optional<Error> unfit = {};
};
void describe(Fields& fields, PictureMeaning& picture);

/// Errors of opening the file as a raw or an image.
Result<PictureMeaning> meaning_of_picture(const std::filesystem::path& file);

/// "linear: its chunk gAMA says so", "sRGB, as 8 bits are where nothing says otherwise".
std::string transfer_words(const PictureMeaning& picture);

}  // namespace weft::capture
