// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/png_writer.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "core/image_io/image_sink.h"
#include "core/image_io/image_source.h"
#include "core/image_io/pack_row.h"

namespace weft {
namespace {

png_uint_32 pixels_a_metre(double mm) {
  return static_cast<png_uint_32>(std::clamp(std::round(1000 / mm), 1.0, 16777216.0));
}

/// Puts a file together from the encoder and its sink.
class PngSink : public ImageSink {
 public:
  PngSink(const ImageToWrite& image, FileSink& file)
      : encoder_({image.size, static_cast<int>(image.channels.size()), image.options.type,
                  image.options.attributes, image.options.pitch_mm, image.options.color},
                 [&file](const void* data, std::size_t bytes) { file.write(data, bytes); }) {}

  std::string begin() { return encoder_.begin(); }
  std::string write(const std::byte* samples, int rows) override { return encoder_.write(samples, rows); }
  std::string finish() override { return encoder_.finish(); }

 private:
  PngEncoder encoder_;
};

}  // namespace

PngEncoder::PngEncoder(const PngToWrite& image, Put put)
    : image_(image),
      put_(std::move(put)),
      png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &words_, png_fails, png_warns)),
      header_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {}

PngEncoder::~PngEncoder() {
  png_destroy_write_struct(&png_, &header_);
}

std::string PngEncoder::begin() {
  if (header_ == nullptr) return "the file format library gives no reason";
  const std::string description = text_of_attributes(image_.attributes);
  const bool done =
      png_does(png_, [this, text = description.c_str()] { put_header(text); });  // NOLINT: no destructor
  return done ? "" : library_reason(words_.complaint);
}

// In a frame out of which libpng may jump.
void PngEncoder::put_header(const char* description) {
  png_set_write_fn(
      png_, &put_,
      [](png_structp png, png_bytep data, png_size_t bytes) {
        bool is_put = true;
        try {
          (*static_cast<Put*>(png_get_io_ptr(png)))(data, bytes);
        } catch (const std::exception&) {
          is_put = false;
        }
        if (!is_put) png_error(png, "its bytes find no room");
      },
      nullptr);
  static constexpr int kColors[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                    PNG_COLOR_TYPE_RGB_ALPHA};
  const bool is_16 = image_.type == SampleType::kUint16;
  png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_IHDR(png_, header_, static_cast<png_uint_32>(image_.size.width),
               static_cast<png_uint_32>(image_.size.height), is_16 ? 16 : 8, kColors[image_.channels - 1],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  png_set_compression_level(png_, kPngEffort);
  if (image_.color == ColorSpace::kSrgb) png_set_sRGB_gAMA_and_cHRM(png_, header_, PNG_sRGB_INTENT_ABSOLUTE);
  const auto [x_mm, y_mm] = image_.pitch_mm;
  if (x_mm > 0 && y_mm > 0)
    png_set_pHYs(png_, header_, pixels_a_metre(x_mm), pixels_a_metre(y_mm), PNG_RESOLUTION_METER);
  char keyword[] = "Description";
  png_text text = {};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = keyword;
  text.text = const_cast<char*>(description);  // NOLINT: libpng only reads it
  if (*description != 0) png_set_text(png_, header_, &text, 1);
  png_write_info(png_, header_);
  png_set_swap(png_);
}

std::string PngEncoder::write(const std::byte* samples, int rows) {
  const std::size_t row_bytes = static_cast<std::size_t>(image_.size.width) *
                                static_cast<std::size_t>(image_.channels) * sample_bytes(image_.type);
  const bool done = png_does(png_, [this, samples, rows, row_bytes] {
    const auto* row = reinterpret_cast<const png_byte*>(samples);
    for (int y = 0; y < rows; ++y, row += row_bytes) png_write_row(png_, row);
  });
  return done ? "" : library_reason(words_.complaint);
}

std::string PngEncoder::finish() {
  const bool done = png_does(png_, [this] { png_write_end(png_, nullptr); });
  return done ? "" : library_reason(words_.complaint);
}

std::unique_ptr<ImageSink> png_sink(const ImageToWrite& image, FileSink& file, std::string& why) {
  auto sink = std::make_unique<PngSink>(image, file);
  why = sink->begin();
  return sink;
}

}  // namespace weft
