// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"

// The frames of a session as every job reads them, with one set of refusals.

namespace weft::capture {

/// A session whose scan came to its end; kBadData for another. Errors as read_session().
Result<Session> read_complete_session(const std::filesystem::path& folder);

/// Whether frames belong to their session, to each other and to a calibration, as far as headers say.
class FrameHeaders {
 public:
  /// `remedy` is for a calibration that does not suit. All but the text is borrowed.
  FrameHeaders(const Session& session, const Calibration& calibration, std::string remedy);

  /// Looks at one frame without decoding it. kBadData, naming the file, for one that is raw where the first
  /// was developed or the other way round; of another size or layout of filters than the first; of another
  /// exposure or ISO than session.json says; and for a calibration that does not suit it (core/rig/suits.h)
  /// or is of another size. Errors of reading a header.
  Result<void> look_at(const Shot& shot);

  /// What the frames have in common; of no meaning before one was looked at.
  bool is_raw() const { return is_raw_; }
  Size size() const { return size_; }
  /// What some of them ask a developer to do, as of DngLayout::opcodes, each once.
  const std::vector<std::string>& opcodes() const { return opcodes_; }

 private:
  Result<void> check_alike(const Shot& shot, Size size, const CfaPattern& cfa,
                           const ShotMetadata& says) const;
  Result<void> check_calibration(const std::filesystem::path& file, Size size,
                                 const ShotMetadata& says) const;

  const Session& session_;
  const Calibration& calibration_;
  std::string remedy_;
  std::string first_file_;
  bool is_raw_ = true;
  Size size_;
  CfaPattern cfa_;
  std::vector<std::string> opcodes_;
};

/// The frame of a shot, decoded after a look at its digest; `size` is that of its header. kBadData for bytes
/// that are not those that were captured.
Result<RawFrame> read_raw_shot(const Session& session, const Shot& shot, Size size);
/// The same of a developed frame, linear, with full and meaningless values marked.
Result<Image<float>> read_developed_shot(const Session& session, const Shot& shot);

}  // namespace weft::capture
