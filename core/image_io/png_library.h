// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <png.h>

#include <string>

namespace weft {

/// What libpng says goes here and never to standard error. `complaint` is the first failure.
struct PngWords {
  std::string complaint;
};

/// Level of zlib that weft writes with: three times as fast as the default, for a file a third larger.
inline constexpr int kPngEffort = 2;

/// For png_create_*_struct, with a PngWords as its pointer, or none.
[[noreturn]] void png_fails(png_structp png, png_const_charp why);
void png_warns(png_structp png, png_const_charp);

/// Runs `steps`, out of which libpng jumps where it fails: nothing in them may have a destructor. Returns
/// whether they came to their end.
template <typename Steps>
bool png_does(png_structp png, const Steps& steps) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT: libpng knows no other way
  steps();
  return true;
}

}  // namespace weft
