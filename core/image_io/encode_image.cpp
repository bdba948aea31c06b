// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/encode_image.h"

#include <cstdlib>

#include "core/image_io/image_source.h"
#include "core/image_io/jpeg_library.h"
#include "core/image_io/png_writer.h"

namespace weft {
namespace {

Error refused(const std::string& why) {
  return {ErrorKind::kInternal, "the picture cannot be encoded", "", library_reason(why), ""};
}

struct Picture {
  std::span<const std::uint8_t> samples;
  Size size;
  int channels;
};

// In a frame out of which libjpeg may jump.
void encode(jpeg_compress_struct& jpeg, const Picture& picture, PictureFormat format) {
  jpeg.image_width = static_cast<JDIMENSION>(picture.size.width);
  jpeg.image_height = static_cast<JDIMENSION>(picture.size.height);
  jpeg.input_components = picture.channels;
  jpeg.in_color_space = picture.channels == 3 ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, format == PictureFormat::kJpeg ? 92 : 85, TRUE);
  const int luma = format == PictureFormat::kJpeg || picture.channels == 1 ? 1 : 2;
  jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = luma;
  jpeg_start_compress(&jpeg, TRUE);
  const std::size_t row_bytes =
      static_cast<std::size_t>(picture.size.width) * static_cast<std::size_t>(picture.channels);
  while (jpeg.next_scanline < jpeg.image_height) {
    auto* row = const_cast<JSAMPROW>(picture.samples.data() + row_bytes * jpeg.next_scanline);  // NOLINT
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
}

Result<std::string> encode_jpeg(const Picture& picture, PictureFormat format) {
  JpegWords words;
  jpeg_compress_struct jpeg = {};
  jpeg.err = &words.manager;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT: libjpeg's type
  const bool done = jpeg_does(words, [&] {
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    encode(jpeg, picture, format);
  });
  jpeg_destroy_compress(&jpeg);
  std::string file;
  if (done) file.assign(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);  // NOLINT: libjpeg takes it from malloc
  if (!done) return refused(words.complaint.data());
  return file;
}

Result<std::string> encode_png(const Picture& picture) {
  std::string file;
  PngEncoder encoder(
      {.size = picture.size, .channels = picture.channels, .color = ColorSpace::kSrgb},
      [&file](const void* data, std::size_t bytes) { file.append(static_cast<const char*>(data), bytes); });
  const auto* samples = reinterpret_cast<const std::byte*>(picture.samples.data());
  std::string why = encoder.begin();
  if (why.empty()) why = encoder.write(samples, picture.size.height);
  if (why.empty()) why = encoder.finish();
  if (!why.empty()) return refused(why);
  return file;
}

}  // namespace

Result<std::string> encode_image(std::span<const std::uint8_t> samples, Size size, int channels,
                                 PictureFormat format) {
  const auto wanted = static_cast<std::size_t>(size.pixels()) * static_cast<std::size_t>(channels);
  if (size.width < 1 || size.height < 1 || (channels != 1 && channels != 3) || samples.size() < wanted)
    return refused("it has neither one channel nor three, or no pixels");
  const Picture picture = {samples, size, channels};
  return format == PictureFormat::kPng ? encode_png(picture) : encode_jpeg(picture, format);
}

}  // namespace weft
