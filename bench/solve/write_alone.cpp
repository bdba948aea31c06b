// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/write_alone.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "bench/base/report.h"
#include "core/image_io/png_library.h"
#include "core/parallel.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

Result<double> exr_seconds(const fs::path& file, const fs::path& copy) try {
  Imf::setGlobalThreadCount(hardware_threads());
  Imf::InputFile in(file.c_str());
  const Imath::Box2i window = in.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x) + 1,
             height = static_cast<std::size_t>(window.max.y) + 1;
  std::vector<std::vector<char>> planes;
  Imf::FrameBuffer frame;
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c) {
    const std::size_t sample = c.channel().type == Imf::HALF ? 2 : 4;
    planes.emplace_back(sample * width * height);
    frame.insert(c.name(), Imf::Slice(c.channel().type, planes.back().data(), sample, sample * width));
  }
  in.setFrameBuffer(frame);
  in.readPixels(window.min.y, window.max.y);
  return least_seconds(3, [&] {
    Imf::OutputFile out(copy.c_str(), in.header(), hardware_threads());
    out.setFrameBuffer(frame);
    out.writePixels(static_cast<int>(height));
  });
} catch (const std::exception& failure) {
  return Error{ErrorKind::kInputOutput, "cannot write again", file.string(), failure.what(), ""};
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

bool read_png(png_structp png, png_infop header, std::FILE* file) {
  return png_does(png, [&] {
    png_init_io(png, file);
    png_read_png(png, header, PNG_TRANSFORM_IDENTITY, nullptr);
  });
}

bool write_png(png_structp from, png_infop header, std::FILE* file) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, png_fails, png_warns);
  png_infop copied = png_create_info_struct(png);
  const bool done = png_does(png, [&] {
    png_init_io(png, file);
    png_set_IHDR(png, copied, png_get_image_width(from, header), png_get_image_height(from, header),
                 png_get_bit_depth(from, header), png_get_color_type(from, header), PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_compression_level(png, kPngEffort);
    png_set_rows(png, copied, png_get_rows(from, header));
    png_write_png(png, copied, PNG_TRANSFORM_IDENTITY, nullptr);
  });
  png_destroy_write_struct(&png, &copied);
  return done;
}

Result<double> png_seconds(const fs::path& file, const fs::path& copy) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, png_fails, png_warns);
  png_infop header = png_create_info_struct(png);
  const File in(std::fopen(file.c_str(), "rb"), std::fclose);
  bool done = in != nullptr && read_png(png, header, in.get());
  const double seconds = !done ? 0 : least_seconds(3, [&] {
    const File out(std::fopen(copy.c_str(), "wb"), std::fclose);
    done &= out != nullptr && write_png(png, header, out.get());
  });
  png_destroy_read_struct(&png, &header, nullptr);
  if (!done) return Error{ErrorKind::kInputOutput, "cannot write again", file.string(), "", ""};
  return seconds;
}

}  // namespace

Result<double> write_alone_seconds(const fs::path& file, const fs::path& copy) {
  return file.extension() == ".png" ? png_seconds(file, copy) : exr_seconds(file, copy);
}

}  // namespace weft::bench
