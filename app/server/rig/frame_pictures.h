// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "capture/scan/scan.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

using HistogramRgb = std::array<capture::RawHistogram, 3>;
/// {"red", "green", "blue": {"bins": [64 counts from black to white], "clipped": share}}.
Json to_json(const HistogramRgb& histogram);

/// A raw frame on disk and the digest that names it.
struct FrameFile {
  std::filesystem::path file;
  std::string sha256;
  std::optional<HistogramRgb> histogram = {};  ///< where it has been counted already
};

/// white_gains() of the lights of a calibration: that of the frame's session, else this folder's. None where
/// neither has lights.
std::optional<std::array<float, 3>> frame_gains(const std::filesystem::path& frame,
                                                const std::filesystem::path& calibration);

/// What of frames is shown to people: a thumbnail and the histogram, kept in a folder under the frame's
/// digest, so that each frame is decoded once however often its session is looked at, moved or renamed. The
/// folder may be emptied at any time. Safe from any thread; one frame is decoded at a time.
class FramePictures {
 public:
  using CalibrationFolder = std::function<std::filesystem::path()>;

  /// Keeps the newest `most` frames in the folder, and at times a tenth more. `calibration`: of frames that
  /// are no session's.
  explicit FramePictures(
      std::filesystem::path folder, std::size_t most = 2000,
      CalibrationFolder calibration = [] { return std::filesystem::path(); });
  ~FramePictures();

  /// Has it made soon, if it is not there.
  void prepare(FrameFile frame);
  /// The bytes of a PNG of 320 pixels at most: linear counts times frame_gains(), or grey on average,
  /// sRGB-encoded. Made now if it is not there. Errors: those of decode_raw(), kTryAgain where too many wait
  /// for theirs, kInterrupted.
  Result<std::string> thumbnail(const FrameFile& frame);
  /// As to_json() above. The same errors.
  Result<Json> histogram(const FrameFile& frame);
  /// The histogram, if it is there already.
  std::optional<Json> ready_histogram(const FrameFile& frame) const;
  /// Ends waiting and making.
  void stop();

 private:
  std::filesystem::path path_of(const FrameFile& frame, const char* ending) const;
  Result<void> make(const FrameFile& frame);
  Result<void> make_files(const FrameFile& frame);
  void run();

  std::filesystem::path folder_;
  std::size_t most_;
  CalibrationFolder calibration_;
  std::size_t made_ = 0;  ///< since the folder was pruned
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FrameFile> wanted_;
  std::size_t waiting_ = 0;  ///< in make()
  bool making_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace weft::app
