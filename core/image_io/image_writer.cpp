// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/image_io/file_sink.h"
#include "core/image_io/image_io.h"
#include "core/image_io/image_sink.h"
#include "core/image_io/image_source.h"
#include "core/image_io/pack_row.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

struct Format {
  std::string name;
  std::unique_ptr<ImageSink> (*open)(const ImageToWrite& image, FileSink& file, std::string& why);
  std::vector<std::string> extensions;
  std::vector<SampleType> types;
  std::vector<Compression> compressions;
  std::size_t most_channels;
};

const std::vector<Format>& formats() {
  using enum SampleType;
  using enum Compression;
  static const std::vector<Format> all = {
      {"openexr", exr_sink, {".exr"}, {kHalf, kFloat}, {kNone, kZip, kPiz}, 1024},
      {"tiff", tiff_sink, {".tif", ".tiff"}, {kUint8, kUint16, kHalf, kFloat}, {kNone, kZip}, 1024},
      {"png", png_sink, {".png"}, {kUint8, kUint16}, {kNone, kZip}, 4}};
  return all;
}

const char* word_of(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return "uint8";
    case SampleType::kUint16:
      return "uint16";
    case SampleType::kHalf:
      return "half";
    case SampleType::kFloat:
      return "float";
  }
  return "float";
}

std::string lower(std::string word) {
  for (char& c : word) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return word;
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
  const std::string extension = lower(file.extension().string());
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
                              word_of(options.type), name_of(options.compression)),
                  "choose another type, compression or ending");
  }
  return &*format;
}

fs::path aside(fs::path file) {
  file += ".partial";
  return file;
}

/// Rows handed to the encoder at once: always the same, since encoders make blocks of what they get.
int rows_a_chunk(std::size_t row_bytes) {
  constexpr std::size_t kChunkBytes = std::size_t{4} << 20;
  constexpr std::size_t kStep = 32;  // lines of a TIFF strip and of an EXR piz block
  return static_cast<int>(std::clamp(kChunkBytes / row_bytes / kStep * kStep, kStep, std::size_t{4096}));
}

}  // namespace

std::string text_of_attributes(const ImageAttributes& attributes) {
  if (attributes.empty()) return "";
  constexpr auto kReplaceBadUtf8 = nlohmann::json::error_handler_t::replace;
  return nlohmann::json(attributes).dump(-1, ' ', /*ensure_ascii=*/true, kReplaceBadUtf8);
}

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
    output.reset();
    ::unlink(aside(file).c_str());
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::byte* next_row() { return chunk.data() + static_cast<std::size_t>(rows_held) * row_bytes; }
  Result<void> row_added();
  Result<void> encode_chunk();
  Result<void> check(const std::string& complaint);
  Result<void> check_rows(Size rows, std::size_t planes, bool type_fits);

  fs::path file;
  Size size;
  std::size_t channels;
  SampleType type;
  std::size_t row_bytes;
  FileSink sink;
  std::unique_ptr<ImageSink> output;
  std::vector<std::byte> chunk;
  int rows_held = 0;
  int rows_encoded = 0;
  std::optional<Error> failure;
  bool finished = false;
};

Result<void> ImageWriter::State::check(const std::string& complaint) {
  if (sink.error_number() != 0) {
    failure = cannot_write(file, sink.error_number());
  } else if (!complaint.empty()) {
    failure = Error{ErrorKind::kInputOutput, "cannot encode", file.string(), library_reason(complaint),
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
  const int rows = std::exchange(rows_held, 0);
  rows_encoded += rows;
  return check(output->write(chunk.data(), rows));
}

ImageWriter::ImageWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ImageWriter::ImageWriter(ImageWriter&&) noexcept = default;
ImageWriter& ImageWriter::operator=(ImageWriter&&) noexcept = default;
ImageWriter::~ImageWriter() = default;

Result<ImageWriter> ImageWriter::open(const fs::path& file, Size size,
                                      const std::vector<std::string>& channels, const WriteOptions& options) {
  const Result<const Format*> format = format_for(file, size, channels, options);
  if (!format) return format.error();

  auto state = std::make_unique<State>(file, size, channels.size(), options.type);
  if (state->sink.error_number() != 0) return cannot_write(file, state->sink.error_number());
  state->chunk.resize(state->row_bytes *
                      static_cast<std::size_t>(std::min(rows_a_chunk(state->row_bytes), size.height)));
  std::string why;
  state->output = (*format)->open({size, channels, options}, state->sink, why);
  if (Result<void> checked = state->check(why); !checked) return checked.error();
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
  const std::string complaint = state.output->finish();
  state.sink.finish();
  if (Result<void> checked = state.check(complaint); !checked) return checked;
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
