// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/raw_frame.h"

namespace weft::simulator {

/// What a DNG says about the camera and a RawFrame does not.
struct DngTags {
  std::string date_time_original;        ///< "2026:01:31 23:59:58" of EXIF; empty: the file names no time
  std::optional<int> milliseconds = {};  ///< of date_time_original, 0 to 999
  std::optional<std::uint32_t> image_number = {};  ///< the body's count of shots
  /// Camera RGB of a neutral patch under the scene's light, green = 1.
  std::array<double, 3> as_shot_neutral = {1, 1, 1};
  /// Camera RGB from XYZ under D65, by rows. By default the filters of the made-up body are those of linear
  /// Rec.709 (ITU-R BT.709-6, with IEC 61966-2-1's inverse matrix).
  std::array<double, 9> camera_from_xyz = {3.2406,  -1.5372, -0.4986,  //
                                           -0.9689, 1.8758,  0.0415,   //
                                           0.0557,  -0.2040, 1.0570};
};

/// Writes a frame as DNG 1.4 (Adobe, 2012): little-endian classic TIFF, directories first and the counts last
/// in one uncompressed 16-bit strip, so that a reader can tell a truncated file. The same input gives the
/// same bytes. Numbers that are no whole numbers are stored as the simplest ratio within 1e-9 of them.
///
/// The frame: sides of 1 to 65 535 pixels (LibRaw reads from 22), under 4 GiB in all, a Bayer cell, a whole
/// white level of 1 to 65 535 counts, 0 <= black < white, an exposure of 1 ns to 1000 s, a focal length up to
/// 10 m, make and model of together up to 63 ASCII characters, a serial number of as many. What is zero or
/// empty is left out.
///
/// The file is written aside and renamed (core/base/files.h). Errors: kUsage where the frame breaks a rule
/// above; kCannotCreate and kInputOutput with the system's reason.
Result<void> write_dng(const std::filesystem::path& file, const RawFrame& frame, const DngTags& tags = {});

/// The bytes of that file, in memory. kUsage as write_dng().
Result<std::vector<std::uint8_t>> dng_bytes(const RawFrame& frame, const DngTags& tags = {});

/// The same file row band by row band. It is not written aside: make it in a folder that is published when
/// it is complete (core/base/files.h). Errors as write_dng(); a file that is there is kCannotCreate.
class DngWriter {
 public:
  /// `frame` says everything but the counts, which are not looked at.
  static Result<DngWriter> open(const std::filesystem::path& file, const RawFrame& frame, Size size,
                                const DngTags& tags = {});
  /// The next rows, all of them `size.height` in the end.
  Result<void> write_rows(View<const std::uint16_t> rows);
  Result<void> finish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path file_;
  std::unique_ptr<std::FILE, Close> out_;
};

}  // namespace weft::simulator
