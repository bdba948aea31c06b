// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>

#include <bit>

#include "core/image_io/exr_channels.h"
#include "core/image_io/image_sink.h"
#include "core/image_io/image_source.h"
#include "core/image_io/pack_row.h"

namespace weft {
namespace {

class ExrSink : public ImageSink {
 public:
  ExrSink(const ImageToWrite& image, FileSink& file)
      : channels_(image.channels),
        type_(image.options.type),
        width_(static_cast<std::size_t>(image.size.width)),
        stream_(file),
        output_(std::make_unique<Imf::OutputFile>(stream_, exr_header(image), exr_threads())) {}

  std::string write(const std::byte* samples, int rows) override try {
    const std::size_t pixel = sample_bytes(type_) * channels_.size(), row = pixel * width_;
    const Imf::PixelType type = type_ == SampleType::kHalf ? Imf::HALF : Imf::FLOAT;
    // The library adds the offset of a row; `samples` begins at the one that comes next.
    const std::int64_t origin =
        std::bit_cast<std::int64_t>(samples) - static_cast<std::int64_t>(row) * output_->currentScanLine();
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const std::int64_t first = origin + static_cast<std::int64_t>(c * sample_bytes(type_));
      frame.insert(channels_[c], Imf::Slice(type, std::bit_cast<char*>(first), pixel, row));
    }
    output_->setFrameBuffer(frame);
    output_->writePixels(rows);
    return "";
  } catch (const std::exception& refusal) {
    return library_reason(refusal.what());
  }

  std::string finish() override {
    output_.reset();  // writes where rows begin
    return "";
  }

 private:
  std::vector<std::string> channels_;
  SampleType type_;
  std::size_t width_;
  ExrStream stream_;
  std::unique_ptr<Imf::OutputFile> output_;
};

}  // namespace

std::unique_ptr<ImageSink> exr_sink(const ImageToWrite& image, FileSink& file, std::string& why) try {
  return std::make_unique<ExrSink>(image, file);
} catch (const std::exception& refusal) {
  why = library_reason(refusal.what());
  return nullptr;
}

}  // namespace weft
