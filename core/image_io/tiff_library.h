// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiffio.h>

#include <memory>
#include <string>

namespace weft {

struct TiffCloser {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffFile = std::unique_ptr<TIFF, TiffCloser>;

/// What libtiff says of one file: never on standard error, and of failures only the first.
class TiffWords {
 public:
  TiffWords();
  TiffWords(const TiffWords&) = delete;
  TiffWords& operator=(const TiffWords&) = delete;
  ~TiffWords() { TIFFOpenOptionsFree(options_); }

  TIFFOpenOptions* options() { return options_; }
  const std::string& complaint() const { return complaint_; }
  /// The complaint of a step that has failed.
  std::string reason() const;

 private:
  static int keep(TIFF* tiff, void* words, const char* module, const char* format, va_list values);

  TIFFOpenOptions* options_;
  std::string complaint_;
};

}  // namespace weft
