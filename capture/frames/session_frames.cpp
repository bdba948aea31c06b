// SPDX-License-Identifier: Apache-2.0
#include "capture/frames/session_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "capture/raw/decode_raw.h"
#include "capture/raw/raw_info.h"
#include "core/base/files.h"
#include "core/image_io/linear_image.h"
#include "core/rig/exposure_words.h"
#include "core/rig/same_camera.h"
#include "core/rig/suits.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

Result<RawInfo> header_of(const fs::path& file) {
  if (!is_linear_image(file)) return read_raw_info(file);
  Result<ImageFileInfo> info = read_linear_image_info(file);
  if (!info) return std::move(info).error();
  return RawInfo{.size = info->size, .cfa = {}, .shot = {}};
}

Result<void> check_digest(const fs::path& file, const Shot& shot) {
  if (shot.sha256.empty()) return {};
  const Result<std::string> digest = sha256_of_file(file);
  if (!digest) return digest.error();
  if (*digest == shot.sha256) return {};
  return Error{ErrorKind::kBadData, "frame is not the one that was captured", file.string(),
               "its SHA-256 differs from session.json: it was changed, truncated or swapped",
               "copy the session again from the rig's disk"};
}

}  // namespace

Result<Session> read_complete_session(const fs::path& folder) {
  Result<Session> session = read_session(folder);
  if (!session || session->state == "complete") return session;
  return Error{ErrorKind::kBadData, "session is not complete", folder.string(),
               fmt::format("its state is \"{}\"", session->state), "finish the scan with weft scan"};
}

FrameHeaders::FrameHeaders(const Session& session, const Calibration& calibration, std::string remedy)
    : session_(session), calibration_(calibration), remedy_(std::move(remedy)) {}

Result<void> FrameHeaders::look_at(const Shot& shot) {
  const fs::path file = session_.path_of(shot);
  const bool is_first = first_file_.empty();
  if (is_first) is_raw_ = !is_linear_image(file);
  if (is_linear_image(file) == is_raw_) {
    return Error{ErrorKind::kBadData, "session mixes raw and developed frames", file.string(),
                 "all frames must be of one kind", "export them all the same way"};
  }
  const Result<RawInfo> info = header_of(file);
  if (!info) return info.error();
  if (is_first) {
    first_file_ = shot.file;
    size_ = info->size;
    cfa_ = info->cfa;
  }
  for (const std::string& opcode : info->opcodes)
    if (std::ranges::find(opcodes_, opcode) == opcodes_.end()) opcodes_.push_back(opcode);
  if (Result<void> ok = check_alike(shot, info->size, info->cfa, info->shot); !ok) return ok;
  return check_calibration(file, info->size, info->shot);
}

Result<void> FrameHeaders::check_alike(const Shot& shot, Size size, const CfaPattern& cfa,
                                       const ShotMetadata& says) const {
  const auto refuse = [&](std::string why) {
    return Error{ErrorKind::kBadData, "frame does not belong to its session", session_.path_of(shot).string(),
                 std::move(why), "copy the session again from the rig, or scan the cloth again"};
  };
  if (size != size_) {
    return refuse(fmt::format("it has {} x {} pixels, {} has {} x {}", size.width, size.height, first_file_,
                              size_.width, size_.height));
  }
  if (cfa != cfa_) return refuse("its colour filters are laid out differently from the first frame's");
  // A file that records its exposure must agree with the journal: mixed-up frames are caught here.
  const auto differs = [](double recorded, double journal) {
    return recorded > 0 && !same_setting(recorded, journal);
  };
  if (differs(says.exposure_us, shot.exposure_us)) {
    return refuse(fmt::format("it was exposed for {}, session.json says {}", exposure_words(says.exposure_us),
                              exposure_words(shot.exposure_us)));
  }
  if (differs(says.iso, shot.iso)) {
    return refuse(fmt::format("it was taken at ISO {:.6g}, session.json says {:.6g}", says.iso, shot.iso));
  }
  return {};
}

Result<void> FrameHeaders::check_calibration(const fs::path& file, Size size,
                                             const ShotMetadata& says) const {
  if (Result<void> ok = suits(calibration_, session_, says); !ok) {
    Error error = std::move(ok).error();
    error.where = file.string();
    error.remedy = remedy_;
    return error;
  }
  const Size calibrated = calibration_.camera->size;
  if (calibrated == size) return {};
  return Error{ErrorKind::kBadData, "calibration does not suit the session", file.string(),
               fmt::format("its camera has {} x {} pixels, the frame {} x {}", calibrated.width,
                           calibrated.height, size.width, size.height),
               remedy_};
}

Result<RawFrame> read_raw_shot(const Session& session, const Shot& shot, Size size) {
  const fs::path file = session.path_of(shot);
  if (Result<void> same = check_digest(file, shot); !same) return std::move(same).error();
  return decode_raw(file, {.size = size});
}

Result<Image<float>> read_developed_shot(const Session& session, const Shot& shot) {
  const fs::path file = session.path_of(shot);
  if (Result<void> same = check_digest(file, shot); !same) return std::move(same).error();
  return read_linear_image(file, Transfer::kLinear, Clipped::kMark, NotNumbers::kMark);
}

}  // namespace weft::capture
