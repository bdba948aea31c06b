// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/exr_window.h"

#include <Imath/half.h>
#include <OpenEXR/openexr.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include "core/base/files.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

Error bad_exr(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "cannot read the map", file.string(), std::move(why), "make the map again"};
}

/// The headers of a file while they are looked at. The library says what is wrong by its codes alone.
class Headers {
 public:
  explicit Headers(const fs::path& file) {
    exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
    options.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
    code_ = exr_start_read(&context_, file.c_str(), &options);
  }
  ~Headers() { exr_finish(&context_); }
  Headers(const Headers&) = delete;
  Headers& operator=(const Headers&) = delete;

  exr_const_context_t get() const { return context_; }
  exr_result_t code() const { return code_; }

 private:
  exr_context_t context_ = nullptr;
  exr_result_t code_ = EXR_ERR_SUCCESS;
};

Result<void> read_fully(int file, std::byte* to, std::size_t bytes, std::int64_t from, const fs::path& name) {
  while (bytes > 0) {
    const ssize_t got = ::pread(file, to, bytes, from);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return cannot_read(name, errno);
    if (got == 0) return bad_exr(name, "its end is missing");
    to += got;
    from += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return {};
}

}  // namespace

Result<ExrWindow> ExrWindow::open(const fs::path& file) {
  ExrWindow window;
  window.file_ = file;
  window.descriptor_ = std::make_shared<Descriptor>(file, O_RDONLY);
  if (!*window.descriptor_) return cannot_read(file, errno);
  const Headers headers(file);
  if (headers.code() != EXR_ERR_SUCCESS) {
    return bad_exr(file, exr_get_default_error_message(headers.code()));
  }
  exr_storage_t storage = EXR_STORAGE_DEEP_TILED;
  exr_compression_t compression = EXR_COMPRESSION_NONE;
  exr_attr_box2i_t box = {};
  const exr_attr_chlist_t* channels = nullptr;
  if (exr_get_storage(headers.get(), 0, &storage) != EXR_ERR_SUCCESS ||
      exr_get_compression(headers.get(), 0, &compression) != EXR_ERR_SUCCESS ||
      exr_get_data_window(headers.get(), 0, &box) != EXR_ERR_SUCCESS ||
      exr_get_channels(headers.get(), 0, &channels) != EXR_ERR_SUCCESS)
    return bad_exr(file, "its header is not whole");
  if (storage != EXR_STORAGE_SCANLINE || compression != EXR_COMPRESSION_NONE) {
    return Error{ErrorKind::kUsage, "the map cannot be cut", file.string(), "it is compressed or tiled",
                 "read it whole"};
  }
  window.size_ = {box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
  std::int64_t offset = 0;
  for (int c = 0; c < channels->num_channels; ++c) {
    const exr_attr_chlist_entry_t& entry = channels->entries[c];
    if (entry.pixel_type == EXR_PIXEL_UINT || entry.x_sampling != 1 || entry.y_sampling != 1)
      return bad_exr(file, "a channel is neither half nor float at every pixel");
    const bool is_half = entry.pixel_type == EXR_PIXEL_HALF;
    window.channels_.push_back({entry.name.str, is_half ? SampleType::kHalf : SampleType::kFloat, offset});
    offset += std::int64_t{is_half ? 2 : 4} * window.size_.width;
  }
  for (int y = box.min.y; y <= box.max.y; ++y) {
    exr_chunk_info_t chunk = {};
    const exr_result_t code = exr_read_scanline_chunk_info(headers.get(), 0, y, &chunk);
    if (code != EXR_ERR_SUCCESS) return bad_exr(file, exr_get_default_error_message(code));
    if (chunk.packed_size != static_cast<std::uint64_t>(offset))
      return bad_exr(file, fmt::format("row {} does not hold its channels", y));
    window.rows_.push_back(static_cast<std::int64_t>(chunk.data_offset));
  }
  return window;
}

const ExrWindow::Channel* ExrWindow::find(const std::string& name) const {
  const auto found = std::ranges::find(channels_, name, &Channel::name);
  return found == channels_.end() ? nullptr : &*found;
}

bool ExrWindow::has(const std::string& channel) const {
  return find(channel) != nullptr;
}

Result<Image<float>> ExrWindow::read(Rect part, std::span<const std::string> channels) const {
  Image<float> image({part.width(), part.height()}, static_cast<int>(channels.size()));
  const auto width = static_cast<std::size_t>(part.width());
  std::vector<std::uint16_t> halves(width);
  for (int y = 0; y < part.height(); ++y) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const Channel& channel = *find(channels[c]);
      const bool is_half = channel.type == SampleType::kHalf;
      float* row = image.plane(static_cast<int>(c)).row(y);
      auto* to = is_half ? reinterpret_cast<std::byte*>(halves.data()) : reinterpret_cast<std::byte*>(row);
      const std::int64_t sample = is_half ? 2 : 4;
      const std::int64_t from =
          rows_[static_cast<std::size_t>(part.y0 + y)] + channel.offset + sample * part.x0;
      if (Result<void> ok =
              read_fully(descriptor_->get(), to, width * static_cast<std::size_t>(sample), from, file_);
          !ok)
        return std::move(ok).error();
      if (!is_half) continue;
      for (std::size_t x = 0; x < width; ++x) row[x] = imath_half_to_float(halves[x]);
    }
  }
  return image;
}

}  // namespace weft
