// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/file_sink.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace weft {
namespace {
constexpr std::size_t kMostHeld = std::size_t{1} << 14;
}

FileSink::FileSink(const std::filesystem::path& file)
    : file_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {
  if (file_ < 0) error_number_ = errno;
  held_.reserve(kMostHeld);
}

FileSink::~FileSink() {
  if (file_ >= 0) ::close(file_);
}

void FileSink::abandon() {
  held_.clear();
  if (error_number_ == 0) error_number_ = ECANCELED;
}

bool FileSink::finish() {
  drain();
  if (file_ >= 0 && ::close(file_) != 0 && error_number_ == 0) error_number_ = errno;
  file_ = -1;
  return error_number_ == 0;
}

void FileSink::write(const void* data, std::size_t bytes) {
  const std::int64_t offset = at_;
  at_ += static_cast<std::int64_t>(bytes);
  end_ = std::max(end_, at_);
  if (error_number_ != 0) return;
  const bool follows = offset == held_offset_ + static_cast<std::int64_t>(held_.size());
  if (!follows || held_.size() + bytes > kMostHeld) {
    drain();
    held_offset_ = offset;
  }
  if (bytes > kMostHeld) {
    put(data, bytes, offset);
    held_offset_ = at_;
  } else {
    const char* first = static_cast<const char*>(data);
    held_.insert(held_.end(), first, first + bytes);
  }
}

void FileSink::drain() {
  put(held_.data(), held_.size(), held_offset_);
  held_.clear();
}

void FileSink::put(const void* data, std::size_t bytes, std::int64_t offset) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0 && error_number_ == 0) {
    const ssize_t n = ::pwrite(file_, next, bytes, offset);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      error_number_ = errno;
      return;
    }
    next += n;
    offset += n;
    bytes -= static_cast<std::size_t>(n);
  }
}

}  // namespace weft
