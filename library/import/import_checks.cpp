// SPDX-License-Identifier: Apache-2.0
#include "library/import/import_checks.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/text.h"
#include "core/rig/same_camera.h"
#include "core/rig/suits.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

/// How a frame differs from another: by what, and a sentence; empty where it does not.
struct Difference {
  std::string by, words;
};

Difference difference(const SourceFrame& frame, const SourceFrame& first) {
  const ShotMetadata &is = frame.shot, &was = first.shot;
  if (frame.source.is_developed != first.source.is_developed)
    return {"their kind", "one is raw and the other developed"};
  if (!is.model.empty() && !was.model.empty() && is.model != was.model)
    return {"their camera", fmt::format("they are of a {} and a {}", was.model, is.model)};
  if (!same_serial(is.serial, was.serial)) {
    return {"their body",
            fmt::format("they are of the bodies with serial numbers {} and {}", was.serial, is.serial)};
  }
  if (frame.size != first.size) {
    return {"their size", fmt::format("they have {} x {} and {} x {} pixels", first.size.width,
                                      first.size.height, frame.size.width, frame.size.height)};
  }
  if (frame.cfa != first.cfa)
    return {"their colour filters", "their colour filters are laid out differently"};
  const std::array<std::tuple<const char*, const char*, double, double>, 4> settings = {
      {{"their exposure", "exposure us", was.exposure_us, is.exposure_us},
       {"their ISO value", "ISO", was.iso, is.iso},
       {"their aperture", "f/", was.f_number, is.f_number},
       {"their focal length", "focal length mm", was.focal_mm, is.focal_mm}}};
  for (const auto& [by, name, a, b] : settings)
    if (a > 0 && b > 0 && !same_setting(a, b))
      return {by, fmt::format("they were taken at {} {:.6g} and {:.6g}", name, a, b)};
  return {};
}

/// Those that differ from one.
std::vector<const SourceFrame*> unlike(const std::vector<SourceFrame>& frames, const SourceFrame& one) {
  std::vector<const SourceFrame*> others;
  for (const SourceFrame& frame : frames)
    if (!difference(frame, one).by.empty()) others.push_back(&frame);
  return others;
}

Error unsaid(const SourceFrame& frame, const std::string& what, const std::string& key) {
  return {ErrorKind::kBadData, "nothing says the " + what + " of the frames", frame.source.file.string(),
          "the file does not", fmt::format("write {} = ... to import.toml beside the frames", key)};
}

/// Whether two files are one, or have the same bytes.
Result<bool> is_same_file(const fs::path& stored, const std::string& sha256, const fs::path& source) {
  std::error_code failed;
  if (fs::equivalent(stored, source, failed) && !failed) return true;
  const Result<std::string> digest = sha256_of_file(source);
  if (!digest) return digest.error();
  return *digest == sha256;
}

}  // namespace

Result<void> check_alike(const std::vector<SourceFrame>& frames) {
  const SourceFrame* usual = &frames.front();
  std::vector<const SourceFrame*> others = unlike(frames, *usual);
  if (others.empty()) return {};
  if (2 * others.size() > frames.size()) {
    usual = others.front();
    others = unlike(frames, *usual);
  }
  const Difference first = difference(*others.front(), *usual);
  std::vector<std::string> names;
  for (const SourceFrame* frame : others) names.push_back(frame->label);
  return Error{ErrorKind::kBadData, "photographs are not of one session, by " + first.by,
               fmt::format("{} and {}", usual->source.file.string(), first_few(names)), first.words,
               "put those of the other setting into a folder of their own, or aside"};
}

Result<void> check_readable(const std::vector<Error>& unreadable) {
  if (unreadable.empty()) return {};
  Error error = unreadable.front();
  std::vector<std::string> more;
  for (std::size_t i = 1; i < unreadable.size(); ++i) more.push_back(unreadable[i].where);
  if (!more.empty()) error.why += fmt::format("; nor can {} be used", first_few(more));
  return error;
}

bool hold_same_bytes(const fs::path& a, const fs::path& b) {
  const Result<std::string> digest = sha256_of_file(a);
  const Result<bool> same = digest ? is_same_file(b, *digest, a) : Result<bool>(digest.error());
  return same && *same;
}

Result<CommonSetting> setting_of(const std::vector<SourceFrame>& frames, const ImportDescription& said,
                                 const Calibration& calibration) {
  const SourceFrame& first = frames.front();
  const auto known = [](double by_file, std::optional<double> told) {
    return by_file > 0 ? by_file : told.value_or(0);
  };
  CommonSetting setting = {known(first.shot.exposure_us, said.exposure_us), known(first.shot.iso, said.iso),
                           known(first.shot.f_number, said.f_number)};
  if (setting.exposure_us <= 0) return unsaid(first, "exposure", "exposure_us");
  if (setting.iso <= 0) return unsaid(first, "ISO value", "iso");
  if (setting.f_number <= 0) setting.f_number = calibration.subject.f_number;
  return setting;
}

Result<void> check_calibration(const Calibration& calibration, const Session& session,
                               const SourceFrame& frame) {
  constexpr const char* kRemedy = "name the calibration of the rig that took them with --calibration";
  if (Result<void> ok = suits(calibration, session, frame.shot); !ok) {
    Error error = std::move(ok).error();
    error.where = frame.source.file.string();
    error.remedy = kRemedy;
    return error;
  }
  const Size calibrated = calibration.camera->size;
  if (calibrated == frame.size) return {};
  return Error{ErrorKind::kBadData, "calibration does not suit the session", frame.source.file.string(),
               fmt::format("its camera has {} x {} pixels, the frame {} x {}", calibrated.width,
                           calibrated.height, frame.size.width, frame.size.height),
               kRemedy};
}

Result<bool> is_same_session(const Session& there, const Session& wanted,
                             const std::vector<SourceFrame>& frames) {
  if (there.state != "complete" || there.shots.size() != wanted.shots.size()) return false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Shot &is = there.shots[i], &shall = wanted.shots[i];
    if (is.led != shall.led || is.role != shall.role) return false;
    const Result<bool> same = is_same_file(there.path_of(is), is.sha256, frames[i].source.file);
    if (!same || !*same) return same;
  }
  return true;
}

}  // namespace weft::library
