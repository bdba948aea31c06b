// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "report/downsampler.h"
#include "report/drawing.h"
#include "report/preview.h"
#include "solve/bands/bands.h"
#include "solve/files/normal_comparison.h"

namespace weft::solve {

/// How a solve differs from its truth, as numbers and as a picture.
struct TruthError {
  NormalComparison normal;
  report::Downsampler reduced_deg;  ///< the error at preview size
};

/// Compares two normal maps on disk.
Result<TruthError> error_against(const std::filesystem::path& truth, const std::filesystem::path& normal,
                                 int threads);

/// A picture as PNG with 8 bits a channel.
Result<void> write_png(const std::filesystem::path& file, const report::Picture& picture);

/// The pictures a person opens first, reduced from the maps while they are solved.
class Pictures {
 public:
  explicit Pictures(Size size);
  void add(const MapBand& band);

  /// Writes albedo.png (sRGB; a relative albedo is scaled, and the sheet says by how much), normal.png,
  /// relit.png, error.png where there is a truth, else status_preview.png, and sheet.png with all of them
  /// under `title`. Returns their names. The files do not depend on the threads.
  Result<std::vector<std::string>> write(const std::filesystem::path& folder, const std::string& title,
                                         bool absolute_albedo, const TruthError* error, int threads) const;

 private:
  report::Downsampler normal_, albedo_;
  report::StatusPreview status_;
};

}  // namespace weft::solve
