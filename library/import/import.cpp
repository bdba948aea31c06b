// SPDX-License-Identifier: Apache-2.0
#include "library/import/import.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "capture/scan/journal.h"
#include "core/base/files.h"
#include "core/base/product.h"
#include "solve/input/session_photos.h"
#include "solve/run/look_at_lights.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

Error cannot_link(const fs::path& to, int error_number) {
  Error error = cannot_write(to, error_number);
  error.remedy = "take --link copy: " + error.remedy;
  return error;
}

/// A copy that nobody writes to, of the bytes that were read.
Result<void> copy_frame(const fs::path& from, const fs::path& to, const std::string& sha256) {
  std::error_code failed;
  fs::copy_file(from, to, failed);
  if (failed) return cannot_write(to, failed.value());
  fs::permissions(to, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read, failed);
  if (failed) return cannot_write(to, failed.value());
  const Result<std::string> digest = sha256_of_file(to);
  if (!digest) return digest.error();
  if (*digest == sha256) return {};
  return Error{ErrorKind::kTryAgain, "photograph changed while it was copied", from.string(),
               "its SHA-256 is not the one it was read with", "run the same import again"};
}

/// `to` becomes the file `from`, whose digest this is.
Result<void> bring(const fs::path& from, const fs::path& to, FrameLink link, const std::string& sha256) {
  switch (link) {
    case FrameLink::kHard: {
      // A link to a link is not what a session should hold.
      std::error_code failed;
      const fs::path file = fs::canonical(from, failed);
      if (failed) return cannot_read(from, failed.value());
      if (::link(file.c_str(), to.c_str()) != 0) return cannot_link(to, errno);
      return {};
    }
    case FrameLink::kSymbolic: {
      std::error_code failed;
      fs::create_symlink(fs::absolute(from), to, failed);
      return failed ? Result<void>(cannot_link(to, failed.value())) : Result<void>();
    }
    case FrameLink::kCopy:
      break;
  }
  return copy_frame(from, to, sha256);
}

std::uint64_t bytes_of(const fs::path& file) {
  std::error_code failed;
  const auto bytes = fs::file_size(file, failed);
  return failed ? 0 : bytes;
}

Result<void> make_session(const ProposedSession& planned, const ImportProposal& plan,
                          const JobContext& context, double from, double to) {
  capture::remove_abandoned(planned.session.folder);
  PartialFolder aside(planned.session.folder);
  std::uint64_t bytes = std::uint64_t{1} << 20;
  for (const SourceFrame& frame : planned.frames)
    bytes += plan.link == FrameLink::kCopy ? bytes_of(frame.source.file) : 0;
  if (Result<void> ok = begin(aside, bytes); !ok) return ok;
  if (Result<void> ok = make_writable_folder(aside.path() / "raw"); !ok) return ok;
  Session session = planned.session;
  session.folder = aside.path();
  for (std::size_t f = 0; f < planned.frames.size(); ++f) {
    if (context.stop.stop_requested()) return interrupted();
    const fs::path& file = planned.frames[f].source.file;
    Result<std::string> digest = sha256_of_file(file);
    if (!digest) return std::move(digest).error();
    Shot& shot = session.shots[f];
    if (Result<void> ok = bring(file, session.path_of(shot), plan.link, *digest); !ok) return ok;
    shot.sha256 = std::move(*digest);
    const double share = static_cast<double>(f + 1) / static_cast<double>(planned.frames.size());
    context.progress("import", from + share * (to - from));
  }
  std::error_code failed;
  fs::copy(plan.calibration, session.calibration_folder(), fs::copy_options::recursive, failed);
  if (failed) return cannot_write(session.calibration_folder(), failed.value());
  if (Result<void> ok = write_session(session); !ok) return ok;
  return aside.publish();
}

Result<void> make_photographs(const ProposedPhotographs& planned, const ImportProposal& plan) {
  capture::remove_abandoned(planned.session.folder);
  PartialFolder aside(planned.session.folder);
  std::uint64_t bytes = std::uint64_t{1} << 20;
  for (const fs::path& file : planned.files) bytes += plan.link == FrameLink::kCopy ? bytes_of(file) : 0;
  if (Result<void> ok = begin(aside, bytes); !ok) return ok;
  Session session = planned.session;
  session.folder = aside.path();
  const fs::path folder = session.folder / solve::kPhotographsFolder;
  if (Result<void> ok = make_writable_folder(folder); !ok) return ok;
  for (std::size_t i = 0; i < planned.files.size(); ++i) {
    const Shot& shot = session.shots[i];
    if (Result<void> ok = bring(planned.files[i], session.path_of(shot), plan.link, shot.sha256); !ok)
      return ok;
  }
  solve::LightList lights = planned.lights;
  for (solve::ListedLight& light : lights.lights) light.photograph = folder / light.photograph;
  if (Result<void> ok = write_light_file(lights, folder / solve::kLightsFile); !ok) return ok;
  std::error_code failed;
  if (!planned.mask.empty())
    fs::copy_file(planned.mask, folder / ("mask" + planned.mask.extension().string()), failed);
  if (!failed && !planned.picture.empty())
    fs::copy_file(planned.picture, session.folder / "balls.png", failed);
  if (failed) return cannot_write(folder, failed.value());
  if (Result<void> ok = write_session(session); !ok) return ok;
  return aside.publish();
}

}  // namespace

Result<void> run_import(const ImportProposal& plan, const JobContext& context) {
  if (plan.count(ImportState::kNew) == 0) return {};
  if (Result<void> ok = make_writable_folder(plan.archive); !ok) return ok;
  const double share = 1 / static_cast<double>(plan.sessions.size() + plan.photographs.size());
  for (std::size_t s = 0; s < plan.sessions.size(); ++s) {
    if (plan.sessions[s].state != ImportState::kNew) continue;
    const double from = static_cast<double>(s) * share;
    if (Result<void> ok = make_session(plan.sessions[s], plan, context, from, from + share); !ok) return ok;
  }
  for (const ProposedPhotographs& planned : plan.photographs) {
    if (planned.state != ImportState::kNew) continue;
    if (context.stop.stop_requested()) return interrupted();
    if (Result<void> ok = make_photographs(planned, plan); !ok) return ok;
  }
  context.progress("import", 1);
  return {};
}

}  // namespace weft::library
