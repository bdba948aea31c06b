// SPDX-License-Identifier: Apache-2.0
#include "core/image/image.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <new>
#include <string>

namespace weft::detail {
namespace {
constexpr std::size_t kHugePage = std::size_t{2} << 20;
}

// Anonymous maps arrive zeroed and untouched, so a large image costs memory only where it is written, and
// goes back to the system the moment it is released.
void* allocate_pixels(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  void* data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED) throw std::bad_alloc();
  if (bytes >= 4 * kHugePage) madvise(data, bytes, MADV_HUGEPAGE);
  return data;
}

void* allocate_pixels_on_disk(std::size_t bytes, const char* folder) {
  std::string name = std::string(folder) + "/weft-pixels-XXXXXX";
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) return nullptr;
  unlink(name.c_str());
  // Room is taken now: a page without room ends the program later.
  const bool has_room = posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0;
  void* data = has_room ? mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
  close(file);
  return data == MAP_FAILED ? nullptr : data;
}

void release_pixels(void* data, std::size_t bytes) {
  if (data != nullptr) munmap(data, bytes);
}

std::ptrdiff_t padded_stride(int width) {
  return (std::ptrdiff_t{width} + kRowGroup - 1) / kRowGroup * kRowGroup + kRowGroup;
}

std::ptrdiff_t padded_plane(std::ptrdiff_t stride, int height, std::size_t sample_bytes) {
  constexpr std::ptrdiff_t kPage = 4096;
  const std::ptrdiff_t bytes = stride * height * static_cast<std::ptrdiff_t>(sample_bytes);
  // An odd number of 64-byte lines past a page boundary: neighbouring planes start in different cache sets.
  const std::ptrdiff_t padded = (bytes + kPage - 1) / kPage * kPage + std::ptrdiff_t{17} * 64;
  return padded / static_cast<std::ptrdiff_t>(sample_bytes);
}

}  // namespace weft::detail
