// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

namespace weft {

/// Width and height in pixels.
struct Size {
  int width = 0;
  int height = 0;
  std::int64_t pixels() const { return std::int64_t{width} * height; }
  friend bool operator==(const Size&, const Size&) = default;
};

/// Columns x0 <= x < x1 and rows y0 <= y < y1 of an image.
struct Rect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  std::int64_t pixels() const { return std::int64_t{width()} * height(); }
  friend bool operator==(const Rect&, const Rect&) = default;
};

/// Vector code may read and write whole groups of this many samples past the last column of a row.
inline constexpr int kRowGroup = 64;

/// A borrowed plane: `stride` samples from one row to the next. Copy it freely; it owns nothing.
template <typename T>
class View {
 public:
  View() = default;
  View(T* data, Size size, std::ptrdiff_t stride) : data_(data), size_(size), stride_(stride) {}
  operator View<const T>() const { return {data_, size_, stride_}; }  // NOLINT(google-explicit-constructor)

  T* row(int y) const { return data_ + y * stride_; }
  T& operator()(int x, int y) const { return row(y)[x]; }
  int width() const { return size_.width; }
  int height() const { return size_.height; }
  Size size() const { return size_; }
  std::ptrdiff_t stride() const { return stride_; }
  bool empty() const { return data_ == nullptr; }

  /// The part of this view inside `r`, whose (0, 0) is (r.x0, r.y0).
  View crop(Rect r) const { return {data_ + r.y0 * stride_ + r.x0, {r.width(), r.height()}, stride_}; }

 private:
  T* data_ = nullptr;
  Size size_;
  std::ptrdiff_t stride_ = 0;
};

namespace detail {
void* allocate_pixels(std::size_t bytes);
/// The same in a file of `folder` that has no name; null where the disk has no room for it.
void* allocate_pixels_on_disk(std::size_t bytes, const char* folder);
void release_pixels(void* data, std::size_t bytes);
/// Samples from one row to the next: `width` rounded up to a whole row group, plus one.
std::ptrdiff_t padded_stride(int width);
/// Samples from one plane to the next: never near a power of two in bytes, so that planes read side by side
/// do not compete for the same cache sets (measured: up to 5 times slower).
std::ptrdiff_t padded_plane(std::ptrdiff_t stride, int height, std::size_t sample_bytes);
}  // namespace detail

/// An owned image of one or more planes of equal size: planar, move-only, zeroed, rows aligned to 64 bytes
/// and padded so that a whole row group may be read or written at any column inside the row.
template <typename T>
class Image {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Image() = default;
  explicit Image(Size size, int planes = 1) {
    lay_out(size, planes);
    data_ = static_cast<T*>(detail::allocate_pixels(bytes_));
  }
  /// The same on the disk of `folder`, from where pages come and go as they are used; nothing where that has
  /// no room.
  static std::optional<Image> on_disk(Size size, int planes, const char* folder) {
    Image image;
    image.lay_out(size, planes);
    image.data_ = static_cast<T*>(detail::allocate_pixels_on_disk(image.bytes_, folder));
    if (image.data_ == nullptr) return std::nullopt;
    return image;
  }
  Image(Image&& other) noexcept { swap(other); }
  Image& operator=(Image&& other) noexcept {
    Image moved(std::move(other));
    swap(moved);
    return *this;
  }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;
  ~Image() { detail::release_pixels(data_, bytes_); }

  View<T> plane(int p = 0) { return {data_ + p * plane_, size_, stride_}; }
  View<const T> plane(int p = 0) const { return {data_ + p * plane_, size_, stride_}; }
  T& operator()(int x, int y, int p = 0) { return plane(p)(x, y); }
  const T& operator()(int x, int y, int p = 0) const { return plane(p)(x, y); }

  Size size() const { return size_; }
  int width() const { return size_.width; }
  int height() const { return size_.height; }
  int planes() const { return planes_; }
  bool empty() const { return data_ == nullptr; }

 private:
  void lay_out(Size size, int planes) {
    size_ = size;
    planes_ = planes;
    stride_ = detail::padded_stride(size.width);
    plane_ = detail::padded_plane(stride_, size.height, sizeof(T));
    bytes_ = static_cast<std::size_t>(plane_) * static_cast<std::size_t>(planes) * sizeof(T);
  }
  void swap(Image& other) noexcept {
    std::swap(size_, other.size_);
    std::swap(planes_, other.planes_);
    std::swap(stride_, other.stride_);
    std::swap(plane_, other.plane_);
    std::swap(bytes_, other.bytes_);
    std::swap(data_, other.data_);
  }

  Size size_;
  int planes_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::ptrdiff_t plane_ = 0;
  std::size_t bytes_ = 0;
  T* data_ = nullptr;
};

}  // namespace weft
