// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"

// What image_reader.cpp knows of the formats.

namespace weft {

/// An opened image file, whose header has been read.
class ImageSource {
 public:
  ImageSource() = default;
  ImageSource(const ImageSource&) = delete;
  ImageSource& operator=(const ImageSource&) = delete;
  virtual ~ImageSource() = default;

  const ImageFileInfo& info() const { return info_; }
  /// What reading takes beside the planes.
  virtual double scratch_bytes() const = 0;
  /// Fills a plane a channel, once. Returns why it failed, or nothing.
  virtual std::string read(Image<float>& planes) = 0;

  void remark(std::string words) { info_.remarks.push_back(std::move(words)); }

 protected:
  ImageFileInfo info_;
};

/// Errors: kNoInput, kBadData.
Result<std::unique_ptr<ImageSource>> open_exr(const std::filesystem::path& file);
Result<std::unique_ptr<ImageSource>> open_tiff(const std::filesystem::path& file);
Result<std::unique_ptr<ImageSource>> open_png(const std::filesystem::path& file);
Result<std::unique_ptr<ImageSource>> open_jpeg(const std::filesystem::path& file);

/// One of several pictures in a file, and where it stands there, from 0.
struct PicturePart {
  int number = 0;
  Size size;
  std::string words = {};  ///< "part 2 \"beauty\", 96 x 72: R, G, B"
};
/// The number of the largest, and what others are as large (ImageFileInfo::alike, remarks) go into `info`.
int choose_part(std::vector<PicturePart> parts, ImageFileInfo& info);

/// An image that is damaged.
Error bad_image(const std::filesystem::path& file, std::string why);

/// What a library says of a failure, as one line without a full stop.
std::string library_reason(const std::string& message);

/// The counts of `samples` that stand `step` apart, as values of full scale 1.
void unpack_counts(const std::uint8_t* samples, std::size_t step, View<float> row);
void unpack_counts(const std::uint16_t* samples, std::size_t step, View<float> row);

/// Whether the tiles of a damaged header would need more memory than its pixels.
bool tile_is_too_large(std::int64_t width, std::int64_t height, Size image);

/// The description that ImageWriter puts into a TIFF or PNG, or the text of another program.
ImageAttributes attributes_of_texts(ImageAttributes texts);

/// The pitch of pixels a unit of `unit_mm`; nothing where one of them is not known.
PixelPitch pitch_of_density(double x, double y, double unit_mm);

}  // namespace weft
