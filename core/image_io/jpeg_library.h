// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csetjmp>
#include <cstdio>
// It uses FILE without including what declares it.
#include <jpeglib.h>

namespace weft {

/// What libjpeg says goes here and never to standard error.
struct JpegWords {
  JpegWords();

  jpeg_error_mgr manager = {};  ///< first, since libjpeg hands back its address
  std::jmp_buf out = {};
  std::array<char, JMSG_LENGTH_MAX> complaint =
      {};  ///< of the first failure or damage; "" where there is none
};

/// Runs `steps`, out of which libjpeg jumps where it fails: nothing in them may have a destructor. Returns
/// whether they came to their end.
template <typename Steps>
bool jpeg_does(JpegWords& words, const Steps& steps) {
  if (setjmp(words.out) != 0) return false;  // NOLINT: libjpeg knows no other way
  steps();
  return true;
}

}  // namespace weft
