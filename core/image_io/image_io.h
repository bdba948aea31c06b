// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/image/compression.h"
#include "core/image/image.h"

// Image files: EXR, TIFF, PNG, and JPEG for reading. Their libraries stay behind this header. Values are what
// the file holds, without transfer function or premultiplication by alpha; full scale of integers is 1.
// Pixels are not converted by what a file says of its colours.

namespace weft {

enum class SampleType { kUint8, kUint16, kHalf, kFloat };

/// Text attributes. EXR keeps each under its name, TIFF and PNG all of them as JSON in ImageDescription. Use
/// names of your own ("weft.units"): EXR keeps neither empty texts nor names that have a meaning of their own
/// ("compression", "DateTime").
using ImageAttributes = std::map<std::string, std::string>;

/// Width and height of a pixel on the cloth, mm. 0: not known, and the file says nothing. PNG holds whole
/// pixels a metre (pHYs), TIFF and EXR pixels an inch to seven digits; TIFF none of less than one an inch.
using PixelPitch = std::array<double, 2>;

/// What a file says of its colours. Their transfer function is told by the chunks cICP, iCCP, sRGB and gAMA
/// of a PNG, the ICC profile of a TIFF or JPEG, the chromaticities of an EXR. A JPEG without a profile is
/// sRGB.
enum class ColorSpace {
  kData,         ///< they are none, or nothing is said
  kSrgb,         ///< that of IEC 61966-2-1, which PNG and TIFF are written with
  kLinearColor,  ///< none: linear Rec.709, written as chromaticities of an EXR, not in PNG and TIFF
  kOther         ///< another one; not written
};

/// What an image file holds, without its pixels.
struct ImageFileInfo {
  Size size;
  std::vector<std::string> channels;     ///< R, G, B, A or X, Y, Z first; only EXR keeps other names
  SampleType type = SampleType::kFloat;  ///< the widest of the channels; kFloat for anything else
  std::string format;                    ///< "openexr", "tiff", "png", "jpeg"
  ImageAttributes attributes;
  PixelPitch pitch_mm = {};
  ColorSpace color = ColorSpace::kData;
  std::string color_by = {};       ///< what says so, as "its chunk sRGB"; empty: nothing does
  std::array<int, 2> origin = {};  ///< where an EXR's pixels begin in the picture that they are a part of
  bool is_mosaic = false;          ///< grey behind colour filters, as a raw file's
  /// Other EXR parts or TIFF pages that may be meant as well as the one that is read, in words.
  std::vector<std::string> alike = {};
  std::vector<std::string> remarks = {};  ///< what was passed over, as "2 bytes behind its end"
};

/// An image in memory: one float plane a channel. lround(65535 * v) is the count of a 16-bit file, exactly.
struct LoadedImage {
  ImageFileInfo info;
  Image<float> planes;

  /// The plane of this name; an empty view where there is none.
  View<const float> channel(std::string_view name) const;
};

/// What a file says of itself; its content tells the format, not its name. Errors: kNoInput, kBadData.
Result<ImageFileInfo> read_image_info(const std::filesystem::path& file);
/// Reads every channel of an image, whatever its tiling and data window; NaN and infinities pass. Of EXR
/// parts and TIFF pages it is the largest, thumbnails and parts without a colour or grey being passed over.
/// Errors: kNoInput; kBadData if truncated, damaged, deep or a raw file's thumbnail; kTryAgain if it is
/// larger than the memory that is free.
Result<LoadedImage> read_image(const std::filesystem::path& file);

struct WriteOptions {
  SampleType type = SampleType::kFloat;
  Compression compression = Compression::kNone;
  ImageAttributes attributes = {};
  PixelPitch pitch_mm = {};
  ColorSpace color = ColorSpace::kData;
};

/// Writes an image row band by row band, aside (`FILE.partial`) until `finish` renames it: no date, no host
/// name, the same bytes for the same pixels whatever the bands and the time they take. Dropped unfinished, it
/// removes what it wrote. Errors: kUsage if the format cannot hold such an image, kCannotCreate, kInputOutput
/// with the system's reason.
class ImageWriter {
 public:
  /// The format follows the ending of `file`: .exr (half, float), .tif (all types), .png (uint8, uint16).
  static Result<ImageWriter> open(const std::filesystem::path& file, Size size,
                                  const std::vector<std::string>& channels, const WriteOptions& options);
  ImageWriter(ImageWriter&&) noexcept;
  ImageWriter& operator=(ImageWriter&&) noexcept;
  ~ImageWriter();

  /// The next rows: one view a channel, all of one height. Values are rounded to nearest, ties to even, and
  /// clamped to what the type can hold; NaN is 0 in integers, NaN and infinities stay in half and float.
  Result<void> write_rows(std::span<const View<const float>> planes);
  /// The next rows of a one-channel 16-bit image, bit for bit.
  Result<void> write_rows(View<const std::uint16_t> plane);
  /// Closes and renames into place. Syncing is the caller's, who may have many files to sync at once.
  Result<void> finish();

 private:
  struct State;
  explicit ImageWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a whole image at once.
Result<void> write_image(const std::filesystem::path& file, std::span<const View<const float>> planes,
                         const std::vector<std::string>& channels, const WriteOptions& options);

}  // namespace weft
