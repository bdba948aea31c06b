// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/rig_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "simulator/scene/scene_rig.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = "lock";
// What a rig makes and takes away again.
constexpr const char* kProfile = "camera.toml";
constexpr std::array kMade = {"rig.toml", kProfile,      "calibration", "environment", "home",
                              "targets",  "board",       "modem",       kBeside,       kBesideModem,
                              "control",  "camera.sock", kFullDisk};

constexpr const char* kD80 = R"toml(# A Nikon D80 that takes its pictures to its card.
model = "D80"
usb = ["Nikon DSC D80 (PTP mode)"]
trigger = "returns_at_once"

[widgets]
shutter = "shutterspeed2"
iso = "iso"
f_number = "f-number"

[[by_hand]]
widget = "expprogram"
values = ["M"]
says = "the mode dial is not on M"
remedy = "turn the camera's mode dial to M"

[set]
imagequality = "NEF (Raw)"
capturetarget = "Memory card"
autofocus = "Off"
whitebalance = "Daylight"
)toml";

/// How well a tape measures, and in which directions it errs.
constexpr double kTapeError_mm = 10;
constexpr std::int64_t kTapeSeed = 1;

/// A basic string of TOML.
std::string quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

bool is_d80(const LightFrames& frames) {
  return frames.scene().camera.body == simulator::Body::kD80;
}

std::string leds_toml(const std::vector<Vec3>& taped_mm) {
  std::string text;
  for (const Vec3 p : taped_mm)
    text += fmt::format("\n[[led]]\nposition_mm = [{:.1f}, {:.1f}, {:.1f}]\n", p.x, p.y, p.z);
  return text;
}

std::string rig_toml(const LightFrames& frames, const std::string& leds, const RigFiles& files) {
  const simulator::Scene& scene = frames.scene();
  return fmt::format(
      R"(# A virtual rig: what a host is told of it. It ends with the program that made it.
name = "virtual rig"
leds = {}

[board]
port = {}

[camera]
profile = {}
port = {}
serial = {}
{}{}{}
[scan]
calibration = "calibration"
iso = {}
f_number = {}
cloth_height_mm = {}
sessions = "scans"

[daemon]
port = 0
virtual_control = "control"
)",
      frames.leds(), quoted(files.board_port), quoted(is_d80(frames) ? kProfile : "nikon-d5100"),
      quoted(files.camera_port), quoted(files.camera_serial), leds, files.below ? "\n[below]\n" : "",
      files.polariser ? "\n[polariser]\nstates = [\"crossed\", \"parallel\"]\nsettle_s = 0.1\n" : "",
      scene.camera.iso, scene.camera.f_number, scene.geometry.cloth_height_mm);
}

/// All that there is to know of the rig. Where it has films, its LEDs are what they are behind them: it was
/// calibrated so.
Result<Calibration> exactly_known(const LightFrames& frames, bool has_films) {
  if (!has_films) return exact_calibration(frames.scene(), frames.rig());
  simulator::Scene scene = frames.scene();
  scene.films.states = simulator::FilmStates::kCrossed;
  scene.camera.exposure_us = frames.rig().exposure_us;
  const Result<simulator::SceneRig> rig = rig_of(scene);
  if (!rig) return rig.error();
  return exact_calibration(scene, *rig);
}

}  // namespace

Result<RigFolder> RigFolder::take(const fs::path& folder, bool keep_log) {
  if (Result<void> ok = make_writable_folder(folder); !ok) return ok.error();
  std::error_code failed;
  const bool is_new = fs::is_empty(folder, failed);
  if (failed) return cannot_write(folder, failed.value());
  if (!is_new && !is_there(folder / kLock)) {
    return Error{ErrorKind::kCannotCreate, "folder is not a virtual rig's", folder.string(),
                 "there is something in it", "name another folder, or one that is not there yet"};
  }
  const int lock = ::open((folder / kLock).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock < 0) return cannot_write(folder / kLock, errno);
  if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock);
    return Error{ErrorKind::kTryAgain, "another virtual rig lives there", folder.string(),
                 "it holds the lock", "name another folder, or end that rig"};
  }
  RigFolder taken(fs::absolute(folder, failed).lexically_normal(), lock, keep_log);
  taken.remove_made();  // what a rig that was killed has left
  return taken;
}

RigFolder::RigFolder(RigFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)), keep_log_(other.keep_log_) {}

RigFolder::~RigFolder() {
  if (lock_ < 0) return;
  remove_made();
  if (!keep_log_) remove(kExposureLog);
  std::error_code ignored;
  const auto entries = std::distance(fs::directory_iterator(path_, ignored), fs::directory_iterator());
  if (entries == 1) {  // the lock: it marks a folder that holds sessions still as a rig's
    remove(kLock);
    fs::remove(path_, ignored);
  }
  ::close(lock_);
}

void RigFolder::remove(const char* name) const {
  std::error_code ignored;
  fs::remove_all(path_ / name, ignored);
}

void RigFolder::remove_made() const {
  for (const char* name : kMade) remove(name);
}

Result<void> RigFolder::write(const LightFrames& frames, const simulator::BareRig& rig,
                              const RigFiles& files) const {
  const std::vector<Vec3> taped_mm = rig.taped(kTapeError_mm, kTapeSeed);
  Result<Calibration> known = files.is_bare ? rig.start(taped_mm) : exactly_known(frames, files.polariser);
  if (!known) return std::move(known).error();
  known->subject.camera_serial = files.camera_serial;
  if (!files.is_bare) {
    known->fiducials = rig.fiducials();
    known->patches = rig.patches();
  }
  const Result<Calibration> written = write_calibration(path_ / "calibration", std::move(*known));
  if (!written) return written.error();
  if (Result<void> ok = write_things(rig, files.is_bare); !ok) return ok;
  if (Result<void> ok = make_writable_folder(path_ / "home"); !ok) return ok;
  if (is_d80(frames)) {
    if (Result<void> ok = write_file(path_ / kProfile, kD80); !ok) return ok;
  }
  std::string environment;
  for (const std::string& line : files.environment) environment += line + '\n';
  if (Result<void> ok = write_file(path_ / "environment", environment); !ok) return ok;
  return write_file(path_ / "rig.toml", rig_toml(frames, files.is_bare ? leds_toml(taped_mm) : "", files));
}

/// `is_bare`: nobody has measured by what law the paper reflects.
Result<void> RigFolder::write_things(const simulator::BareRig& rig, bool is_bare) const {
  const fs::path targets = path_ / "targets";
  if (Result<void> ok = make_writable_folder(targets); !ok) return ok;
  std::string sheet = rig.sheet_toml();
  if (!is_bare) sheet.insert(0, fmt::format("delta = {}\n", rig.paper().sheet.non_lambertian));
  std::vector<std::pair<const char*, std::string>> files = {
      {"board.toml", rig.board_toml()}, {"sheet.toml", sheet}, {"scale.toml", rig.scale_toml()}};
  if (rig.has_chart()) files.emplace_back("chart.toml", rig.chart_toml());
  for (const auto& [name, text] : files) {
    if (Result<void> ok = write_file(targets / name, text); !ok) return ok;
  }
  return {};
}

}  // namespace weft::virtual_rig
