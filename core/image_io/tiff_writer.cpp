// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/image_io/color_profile.h"
#include "core/image_io/image_sink.h"
#include "core/image_io/image_source.h"
#include "core/image_io/pack_row.h"
#include "core/image_io/tiff_library.h"

namespace weft {
namespace {

constexpr std::uint32_t kStripRows = 32;

FileSink& sink_of(thandle_t file) {
  return *static_cast<FileSink*>(file);
}

tmsize_t read_nothing(thandle_t, void*, tmsize_t) {
  return 0;
}

tmsize_t write_to(thandle_t file, void* data, tmsize_t bytes) {
  sink_of(file).write(data, static_cast<std::size_t>(bytes));
  return bytes;
}

toff_t seek_in(thandle_t file, toff_t offset, int whence) {
  FileSink& sink = sink_of(file);
  const std::int64_t from = whence == SEEK_END ? sink.size() : whence == SEEK_CUR ? sink.tell() : 0;
  sink.seek(from + static_cast<std::int64_t>(offset));
  return static_cast<toff_t>(sink.tell());
}

int leave_open(thandle_t) {
  return 0;
}

toff_t size_of(thandle_t file) {
  return static_cast<toff_t>(sink_of(file).size());
}

void describe_samples(TIFF* tiff, const ImageToWrite& image) {
  const SampleType type = image.options.type;
  const bool is_float = type == SampleType::kHalf || type == SampleType::kFloat;
  const int colors = image.channels.size() >= 3 ? 3 : 1;
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, static_cast<int>(image.channels.size()));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * sample_bytes(type)));
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, is_float ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, colors == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  std::vector<std::uint16_t> extra;
  for (std::size_t c = static_cast<std::size_t>(colors); c < image.channels.size(); ++c)
    extra.push_back(image.channels[c] == "A" ? EXTRASAMPLE_UNASSALPHA : EXTRASAMPLE_UNSPECIFIED);
  if (!extra.empty()) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<int>(extra.size()), extra.data());
  if (image.options.compression == Compression::kZip) {
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(tiff, TIFFTAG_PREDICTOR, is_float ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
  } else {
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  }
}

void describe_meaning(TIFF* tiff, const ImageToWrite& image) {
  const std::string text = text_of_attributes(image.options.attributes);
  if (!text.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, text.c_str());
  const auto [x_mm, y_mm] = image.options.pitch_mm;
  if (x_mm > 0 && y_mm > 0 && std::max(x_mm, y_mm) <= 25.4) {
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 25.4 / x_mm);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 25.4 / y_mm);
  }
  if (image.options.color == ColorSpace::kSrgb && image.channels.size() >= 3) {
    const std::vector<std::uint8_t> profile = srgb_profile();
    TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data());
  }
}

class TiffSink : public ImageSink {
 public:
  TiffSink(const ImageToWrite& image, FileSink& file)
      : row_bytes_(static_cast<std::size_t>(image.size.width) * image.channels.size() *
                   sample_bytes(image.options.type)) {
    // Offsets of 32 bits end at 4 GB, and compressed strips may be larger than their pixels.
    constexpr double kMost = 4.0e9;
    const bool is_big = static_cast<double>(row_bytes_) * image.size.height > kMost;
    tiff_.reset(TIFFClientOpenExt("image", is_big ? "w8" : "w", &file, read_nothing, write_to, seek_in,
                                  leave_open, size_of, nullptr, nullptr, words_.options()));
    if (!tiff_) return;
    TIFFSetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(image.size.width));
    TIFFSetField(tiff_.get(), TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(image.size.height));
    TIFFSetField(tiff_.get(), TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(tiff_.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff_.get(), TIFFTAG_ROWSPERSTRIP, kStripRows);
    describe_samples(tiff_.get(), image);
    describe_meaning(tiff_.get(), image);
  }

  std::string complaint() const { return tiff_ && words_.complaint().empty() ? "" : words_.reason(); }

  std::string write(const std::byte* samples, int rows) override {
    for (int y = 0; y < rows; y += static_cast<int>(kStripRows)) {
      const auto lines = static_cast<std::size_t>(std::min(rows - y, static_cast<int>(kStripRows)));
      auto* strip = const_cast<std::byte*>(samples + row_bytes_ * static_cast<std::size_t>(y));  // NOLINT
      if (TIFFWriteEncodedStrip(tiff_.get(), strips_++, strip, static_cast<tmsize_t>(lines * row_bytes_)) < 0)
        return words_.reason();
    }
    return "";
  }

  std::string finish() override {
    tiff_.reset();
    return words_.complaint().empty() ? "" : words_.reason();
  }

 private:
  std::size_t row_bytes_;
  std::uint32_t strips_ = 0;
  TiffWords words_;
  TiffFile tiff_;
};

}  // namespace

std::unique_ptr<ImageSink> tiff_sink(const ImageToWrite& image, FileSink& file, std::string& why) {
  auto sink = std::make_unique<TiffSink>(image, file);
  why = sink->complaint();
  return sink;
}

}  // namespace weft
