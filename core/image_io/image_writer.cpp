// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/files.h"
#include "core/image_io/file_sink.h"
#include "core/image_io/image_io.h"
#include "core/image_io/oiio.h"
#include "core/image_io/pack_row.h"
#include "core/image_io/spec_words.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

struct Format {
  std::string name;
  std::vector<std::string> extensions;
  std::vector<SampleType> types;
  std::vector<Compression> compressions;
  std::size_t most_channels;
};

const std::vector<Format>& formats() {
  using enum SampleType;
  using enum Compression;
  static const std::vector<Format> all = {
      {"openexr", {".exr"}, {kHalf, kFloat}, {kNone, kZip, kPiz}, 1024},
      {"tiff", {".tif", ".tiff"}, {kUint8, kUint16, kHalf, kFloat}, {kNone, kZip}, 1024},
      {"png", {".png"}, {kUint8, kUint16}, {kNone, kZip}, 4}};
  return all;
}

OIIO::TypeDesc oiio_type(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return OIIO::TypeUInt8;
    case SampleType::kUint16:
      return OIIO::TypeUInt16;
    case SampleType::kHalf:
      return OIIO::TypeHalf;
    case SampleType::kFloat:
      return OIIO::TypeFloat;
  }
  return OIIO::TypeFloat;
}

bool names_are_distinct(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) == names.end() && !names.front().empty();
}

/// The format of `file`, if it can hold such an image.
Result<const Format*> format_for(const fs::path& file, Size size, const std::vector<std::string>& channels,
                                 const WriteOptions& options) {
  const auto refuse = [&](std::string why, std::string remedy) {
    return Error{ErrorKind::kUsage, "cannot write such an image", file.string(), std::move(why),
                 std::move(remedy)};
  };
  const auto has = [](const auto& list, const auto& value) {
    return std::find(list.begin(), list.end(), value) != list.end();
  };
  const std::string extension = OIIO::Strutil::lower(file.extension().string());
  const auto format = std::find_if(formats().begin(), formats().end(),
                                   [&](const Format& f) { return has(f.extensions, extension); });
  if (format == formats().end()) {
    return refuse("its name ends in none of .exr, .tif, .tiff and .png", "choose one of these endings");
  }
  if (size.width < 1 || size.height < 1) {
    return refuse(fmt::format("{} x {} pixels", size.width, size.height), "write at least one pixel");
  }
  if (channels.empty() || channels.size() > format->most_channels || !names_are_distinct(channels)) {
    return refuse(fmt::format("channels \"{}\"", fmt::join(channels, "\", \"")),
                  fmt::format("name 1 to {} different channels", format->most_channels));
  }
  if (!has(format->types, options.type) || !has(format->compressions, options.compression)) {
    return refuse(fmt::format("{} cannot hold {} samples with compression {}", format->name,
                              oiio_type(options.type).c_str(), name_of(options.compression)),
                  "choose another type, compression or ending");
  }
  return &*format;
}

OIIO::ImageSpec spec_of(const std::string& format, Size size, const std::vector<std::string>& channels,
                        const WriteOptions& options) {
  OIIO::ImageSpec spec(size.width, size.height, static_cast<int>(channels.size()), oiio_type(options.type));
  spec.channelnames = channels;
  const auto alpha = std::find(channels.begin(), channels.end(), "A");
  spec.alpha_channel = alpha == channels.end() ? -1 : static_cast<int>(alpha - channels.begin());
  if (format == "openexr") {
    for (const auto& [key, text] : options.attributes) spec.attribute(key, text);
  } else if (!options.attributes.empty()) {
    constexpr auto kReplaceBadUtf8 = nlohmann::json::error_handler_t::replace;
    spec.attribute("ImageDescription",
                   nlohmann::json(options.attributes).dump(-1, ' ', /*ensure_ascii=*/true, kReplaceBadUtf8));
  }
  spec.attribute("compression", name_of(options.compression));
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("png:compressionLevel", 2);  // three times as fast as the default, for a file a third larger
  spec.attribute("tiff:half", 1);
  spec.attribute("tiff:write_exif", 0);
  // A date of another type than text is dropped; without one, OpenImageIO would write the present.
  spec.attribute("DateTime", 0);
  add_density(spec, format, options.pitch_mm);
  add_color(spec, format, options.color);
  return spec;
}

fs::path aside(fs::path file) {
  file += ".partial";
  return file;
}

/// Rows handed to the encoder at once: always the same, since some encoders make blocks of what they get.
int rows_a_chunk(std::size_t row_bytes) {
  constexpr std::size_t kChunkBytes = std::size_t{4} << 20;
  constexpr std::size_t kStep = 32;  // lines of a TIFF strip and of an EXR piz block
  return static_cast<int>(std::clamp(kChunkBytes / row_bytes / kStep * kStep, kStep, std::size_t{4096}));
}

}  // namespace

struct ImageWriter::State {
  State(fs::path target, Size image_size, std::size_t image_channels, SampleType sample_type)
      : file(std::move(target)),
        size(image_size),
        channels(image_channels),
        type(sample_type),
        row_bytes(static_cast<std::size_t>(size.width) * channels * sample_bytes(type)),
        sink(aside(file)) {}
  ~State() {
    if (finished) return;
    sink.abandon();
    if (begun) complete_into_nothing();
    output.reset();
    ::unlink(aside(file).c_str());
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::byte* next_row() { return chunk.data() + static_cast<std::size_t>(rows_held) * row_bytes; }
  void complete_into_nothing();
  Result<void> row_added();
  Result<void> encode_chunk();
  Result<void> check(bool encoder_is_content);
  Result<void> check_rows(Size rows, std::size_t planes, bool type_fits);

  fs::path file;
  Size size;
  std::size_t channels;
  SampleType type;
  std::size_t row_bytes;
  FileSink sink;
  std::unique_ptr<OIIO::ImageOutput> output;
  std::vector<std::byte> chunk;
  int rows_held = 0;
  int rows_encoded = 0;
  std::optional<Error> failure;
  bool begun = false;
  bool finished = false;
};

// libpng prints a complaint about an image that ends without pixels.
void ImageWriter::State::complete_into_nothing() {
  if (output->format_name() != std::string("png")) return;
  while (rows_encoded < size.height) {
    rows_held = std::min(rows_a_chunk(row_bytes), size.height - rows_encoded);
    static_cast<void>(encode_chunk());
  }
}

Result<void> ImageWriter::State::check(bool encoder_is_content) {
  if (sink.error_number() != 0) {
    failure = cannot_write(file, sink.error_number());
  } else if (!encoder_is_content) {
    failure = Error{ErrorKind::kInputOutput, "cannot encode", file.string(), oiio_reason(output->geterror()),
                    "choose another format or compression"};
  }
  if (failure) return *failure;
  return {};
}

Result<void> ImageWriter::State::check_rows(Size rows, std::size_t planes, bool type_fits) {
  if (failure) return *failure;
  const int left = size.height - rows_encoded - rows_held;
  if (planes == channels && type_fits && rows.width == size.width && rows.height <= left) return {};
  return Error{ErrorKind::kInternal, "rows do not fit their image", file.string(),
               fmt::format("{} planes of {} x {}, wanted {} planes, {} wide, of at most {} rows", planes,
                           rows.width, rows.height, channels, size.width, left),
               ""};
}

Result<void> ImageWriter::State::row_added() {
  ++rows_held;
  if (static_cast<std::size_t>(rows_held) * row_bytes < chunk.size()) return {};
  return encode_chunk();
}

Result<void> ImageWriter::State::encode_chunk() {
  if (rows_held == 0) return {};
  const int y = rows_encoded;
  rows_encoded += rows_held;
  rows_held = 0;
  return check(output->write_scanlines(y, rows_encoded, 0, oiio_type(type), chunk.data()));
}

ImageWriter::ImageWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ImageWriter::ImageWriter(ImageWriter&&) noexcept = default;
ImageWriter& ImageWriter::operator=(ImageWriter&&) noexcept = default;
ImageWriter::~ImageWriter() = default;

Result<ImageWriter> ImageWriter::open(const fs::path& file, Size size,
                                      const std::vector<std::string>& channels, const WriteOptions& options) {
  prepare_oiio();
  const Result<const Format*> format = format_for(file, size, channels, options);
  if (!format) return format.error();

  auto state = std::make_unique<State>(file, size, channels.size(), options.type);
  if (state->sink.error_number() != 0) return cannot_write(file, state->sink.error_number());
  state->chunk.resize(state->row_bytes *
                      static_cast<std::size_t>(std::min(rows_a_chunk(state->row_bytes), size.height)));
  state->output = OIIO::ImageOutput::create((*format)->name, &state->sink);
  const bool opened = state->output->open(file.string(), spec_of((*format)->name, size, channels, options));
  if (Result<void> checked = state->check(opened); !checked) return checked.error();
  // Until the end each format only appends. What would not is the directory that OpenImageIO's TIFF rewrites
  // every five seconds, which makes bytes depend on time; the one that counts is written by `close`.
  state->sink.only_append(true);
  state->begun = true;
  return ImageWriter(std::move(state));
}

Result<void> ImageWriter::write_rows(std::span<const View<const float>> planes) {
  if (planes.empty()) return state_->check_rows({}, 0, false);
  for (const View<const float>& plane : planes) {
    const Size rows = plane.size() == planes.front().size() ? plane.size() : Size{};
    if (Result<void> fits = state_->check_rows(rows, planes.size(), true); !fits) return fits;
  }
  std::vector<const float*> row(planes.size());
  for (int y = 0; y < planes.front().height(); ++y) {
    for (std::size_t c = 0; c < planes.size(); ++c) row[c] = planes[c].row(y);
    pack_row(row, static_cast<std::size_t>(state_->size.width), state_->type, state_->next_row());
    if (Result<void> added = state_->row_added(); !added) return added;
  }
  return {};
}

Result<void> ImageWriter::write_rows(View<const std::uint16_t> plane) {
  if (Result<void> fits = state_->check_rows(plane.size(), 1, state_->type == SampleType::kUint16); !fits) {
    return fits;
  }
  for (int y = 0; y < plane.height(); ++y) {
    std::memcpy(state_->next_row(), plane.row(y), state_->row_bytes);
    if (Result<void> added = state_->row_added(); !added) return added;
  }
  return {};
}

Result<void> ImageWriter::finish() {
  State& state = *state_;
  if (state.failure) return *state.failure;
  if (state.rows_encoded + state.rows_held != state.size.height) {
    return Error{ErrorKind::kInternal, "image is not complete", state.file.string(),
                 fmt::format("{} of {} rows", state.rows_encoded + state.rows_held, state.size.height), ""};
  }
  if (Result<void> encoded = state.encode_chunk(); !encoded) return encoded;
  state.sink.only_append(false);
  const bool closed = state.output->close();
  state.sink.finish();
  if (Result<void> checked = state.check(closed); !checked) return checked;
  if (::rename(aside(state.file).c_str(), state.file.c_str()) != 0) return cannot_write(state.file, errno);
  state.finished = true;
  return {};
}

Result<void> write_image(const fs::path& file, std::span<const View<const float>> planes,
                         const std::vector<std::string>& channels, const WriteOptions& options) {
  const Size size = planes.empty() ? Size{} : planes.front().size();
  Result<ImageWriter> writer = ImageWriter::open(file, size, channels, options);
  if (!writer) return writer.error();
  if (Result<void> written = writer->write_rows(planes); !written) return written;
  return writer->finish();
}

}  // namespace weft
