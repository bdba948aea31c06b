// SPDX-License-Identifier: Apache-2.0
#include "capture/doctor/doctor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>

#include "capture/scan/second_copy.h"
#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "core/rig/same_camera.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using SetupVerdict = SetupFinding::Verdict;

constexpr double kLowBattery = 0.2;
constexpr double kMegabyte = 1e6;
constexpr std::string_view kVirtualRig = "weft-virtual-ri";  // as /proc/PID/comm has it

/// Programs that take devices of a rig away, and what keeps them off.
struct Thief {
  std::string_view name;  ///< as /proc/PID/comm has it: at most 15 letters
  std::string_view takes;
  std::string_view does;
  std::string_view remedy;
};
constexpr std::array kThieves = {
    Thief{"ModemManager", "board", "sends modem commands to every new serial port",
          "sudo systemctl disable --now ModemManager"},
    Thief{"brltty", "board", "takes boards with a CH340 for a braille display", "sudo apt-get remove brltty"},
    Thief{"gvfs-gphoto2-vo", "camera", "claims every camera that is plugged in",
          "systemctl --user mask --now gvfs-gphoto2-volume-monitor"},
    Thief{"gvfsd-gphoto2", "camera", "has the camera mounted as a disk", "gio mount -s gphoto2"},
};

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::optional<int> number_of(const std::string& text) {
  int value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

/// visit(pid, folder) for each process that can be seen.
template <typename Visit>
void for_each_process(const SystemPlaces& places, const Visit& visit) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(places.proc, ignored)) {
    if (const std::optional<int> pid = number_of(entry.path().filename().string())) visit(*pid, entry.path());
  }
}

SetupFinding fault(std::string part, std::string says, std::string remedy,
                   ErrorKind kind = ErrorKind::kNoDevice) {
  return {SetupVerdict::kFault, std::move(part), std::move(says), std::move(remedy), kind};
}

/// A known thief keeps the device from us; another program may only be looking. A virtual rig is the other
/// end of its board's terminal.
void report_holders(const std::vector<Holder>& holders, const std::string& part, const fs::path& file,
                    std::vector<SetupFinding>& found) {
  for (const Holder& holder : holders) {
    if (holder.name == kVirtualRig) continue;
    const auto* const thief =
        std::find_if(kThieves.begin(), kThieves.end(), [&](const Thief& t) { return t.name == holder.name; });
    const bool known = thief != kThieves.end();
    found.push_back({known ? SetupVerdict::kFault : SetupVerdict::kWarning, part,
                     fmt::format("{} (process {}) holds {}", holder.name, holder.pid, file.string()),
                     known ? std::string(thief->remedy) : fmt::format("kill {}", holder.pid)});
  }
}

/// Programs that take such devices and run. A device that `seems_taken` is theirs, though the system does not
/// show it; any other they take at its next replug, unless our rules keep them off.
void report_thieves(std::string_view part, bool seems_taken, const SystemPlaces& places,
                    std::vector<SetupFinding>& found) {
  const auto has_rules = [](const fs::path& folder) { return is_there(folder / "70-weft.rules"); };
  if (!seems_taken && std::any_of(places.udev.begin(), places.udev.end(), has_rules)) return;
  for_each_process(places, [&](int pid, const fs::path& folder) {
    const std::string name = first_line(folder / "comm");
    for (const Thief& thief : kThieves) {
      if (thief.takes != part || thief.name != name) continue;
      found.push_back({seems_taken ? SetupVerdict::kFault : SetupVerdict::kWarning, std::string(part),
                       fmt::format("{} (process {}) runs and {}", name, pid, thief.does),
                       std::string(thief.remedy)});
    }
  });
}

bool has_fault(const std::vector<SetupFinding>& found, std::size_t from) {
  return std::any_of(found.begin() + static_cast<std::ptrdiff_t>(from), found.end(),
                     [](const SetupFinding& f) { return f.verdict == SetupVerdict::kFault; });
}

void examine_board_port(const Rig& rig, const SystemPlaces& places, std::vector<SetupFinding>& found) {
  std::error_code failed;
  const fs::path port = fs::weakly_canonical(rig.board.port, failed);
  if (failed || !is_there(port)) {
    found.push_back(fault("board", fmt::format("there is no port {}", rig.board.port),
                          "plug the board in; ls -l /dev/serial/by-id names what is there"));
    return;
  }
  if (::faccessat(AT_FDCWD, port.c_str(), R_OK | W_OK, AT_EACCESS) != 0) {
    found.push_back(
        fault("board", fmt::format("this user may not use {}", port.string()), remedy_of_access(port)));
  }
  report_holders(holders_of(port, places), "board", port, found);
}

void examine_board(const Rig& rig, const Opened& open, const SystemPlaces& places,
                   std::vector<SetupFinding>& found) {
  const std::size_t before = found.size();
  examine_board_port(rig, places, found);
  if (has_fault(found, before) || !open.board) return report_thieves("board", false, places, found);
  const Result<std::string> greeting = open.board();
  const bool seems_taken = !greeting && (greeting.error().kind == ErrorKind::kTryAgain ||  // silent
                                         greeting.error().kind == ErrorKind::kNoDevice);   // busy
  report_thieves("board", seems_taken, places, found);
  found.push_back(greeting ? SetupFinding{SetupVerdict::kFine, "board", *greeting, ""}
                           : fault_of("board", greeting.error()));
}

struct UsbCamera {
  std::string name;
  fs::path node;  ///< /dev/bus/usb/BBB/DDD
  int megabits = 0;
};

/// Still-image devices (USB class 6) that are plugged in.
std::vector<UsbCamera> usb_cameras(const SystemPlaces& places) {
  std::vector<UsbCamera> cameras;
  std::error_code ignored;
  const fs::path devices = places.sys / "bus/usb/devices";
  for (const fs::directory_entry& entry : fs::directory_iterator(devices, ignored)) {
    const fs::path& device = entry.path();
    const fs::path interface = device / (device.filename().string() + ":1.0");
    const std::optional<int> bus = number_of(first_line(device / "busnum"));
    const std::optional<int> number = number_of(first_line(device / "devnum"));
    if (first_line(interface / "bInterfaceClass") != "06" || !bus || !number) continue;
    cameras.push_back({first_line(device / "product"),
                       places.dev / "bus/usb" / fmt::format("{:03}", *bus) / fmt::format("{:03}", *number),
                       number_of(first_line(device / "speed")).value_or(0)});
  }
  return cameras;
}

/// Cameras that the kernel shows. None is no fault: what drives the camera knows better what is there.
void examine_usb(const SystemPlaces& places, std::vector<SetupFinding>& found) {
  for (const UsbCamera& camera : usb_cameras(places)) {
    if (::faccessat(AT_FDCWD, camera.node.c_str(), R_OK | W_OK, AT_EACCESS) != 0) {
      found.push_back(fault("camera", fmt::format("this user may not use {}", camera.node.string()),
                            remedy_of_access(camera.node)));
    }
    report_holders(holders_of(camera.node, places), "camera", camera.node, found);
    if (camera.megabits > 0 && camera.megabits < 480) {
      found.push_back({SetupVerdict::kWarning, "camera",
                       fmt::format("{} runs at {} Mbit/s", camera.name, camera.megabits),
                       "use a port and cable of USB 2 or better"});
    }
  }
  report_thieves("camera", false, places, found);
}

void examine_camera(const Rig& rig, const Opened& open, const SystemPlaces& places,
                    std::vector<SetupFinding>& found) {
  const std::size_t before = found.size();
  if (!rig.camera.port.starts_with("ptpip:")) examine_usb(places, found);
  if (has_fault(found, before) || !open.camera) return;
  const Result<CameraFacts> facts = open.camera();
  if (!facts) {
    found.push_back(fault_of("camera", facts.error()));
    return;
  }
  found.push_back({SetupVerdict::kFine, "camera",
                   fmt::format("{} {} at {}, battery {:.0f} %", facts->model, facts->serial, facts->port,
                               100 * facts->battery),
                   ""});
  if (facts->battery < kLowBattery)
    found.push_back(
        {SetupVerdict::kWarning, "camera", "its battery will not last", "charge it, or use mains power"});
  if (camera_serial(rig).empty())
    found.push_back({SetupVerdict::kWarning, "camera", "the rig file takes any camera",
                     fmt::format("write serial = \"{}\" under [camera]", facts->serial)});
  if (std::abs(facts->clock_offset_s) > 60 + facts->clock_uncertainty_s)
    found.push_back({SetupVerdict::kWarning, "camera",
                     fmt::format("its clock is off by {:.0f} s", facts->clock_offset_s),
                     "set date and time in the camera's menu"});
}

void examine_room(const std::string& part, const fs::path& folder, std::uint64_t frame_bytes,
                  std::vector<SetupFinding>& found) {
  if (Result<void> ok = make_writable_folder(folder); !ok) {
    found.push_back(fault_of(part, ok.error()));
    return;
  }
  const double free = static_cast<double>(free_disk_bytes(folder));
  const double session = static_cast<double>(frame_bytes * kSessionFrames);
  const std::string room = fmt::format("{} has {:.0f} MB free, room for {:.0f} sessions", folder.string(),
                                       free / kMegabyte, session > 0 ? std::floor(free / session) : 0);
  if (free < session) {
    found.push_back(
        fault(part, room, "free some, or name another disk in the rig file", ErrorKind::kInputOutput));
  } else if (free < 20 * session) {
    found.push_back({SetupVerdict::kWarning, part, room, "free some before the night"});
  } else {
    found.push_back({SetupVerdict::kFine, part, room, ""});
  }
}

void examine_calibration(const Rig& rig, std::vector<SetupFinding>& found) {
  if (rig.scan.calibration.empty()) {
    found.push_back({SetupVerdict::kWarning, "calibration",
                     "the rig file names none: frames are not compared with it",
                     "calibrate the rig (docs/calibration.md) and name the folder under [scan]"});
    return;
  }
  const Result<Calibration> calibration = read_calibration(rig.scan.calibration);
  if (!calibration) {
    found.push_back(fault_of("calibration", calibration.error()));
    return;
  }
  const std::size_t before = found.size();
  const CalibrationSubject& subject = calibration->subject;
  const auto wrong = [&](const std::string& says) {
    found.push_back(fault("calibration", says,
                          "name the calibration of this rig under [scan], or calibrate again",
                          ErrorKind::kBadData));
  };
  if (subject.rig != rig.name)
    wrong(fmt::format("it is of the rig {}, this one is {}", subject.rig, rig.name));
  if (subject.f_number > 0 && std::abs(subject.f_number / rig.scan.f_number - 1) > 0.01)
    wrong(fmt::format("it was measured at f/{:g}, scans are at f/{:g}", subject.f_number, rig.scan.f_number));
  if (!same_serial(rig.camera.serial, subject.camera_serial))
    wrong(fmt::format("it is of camera {}, this one is {}", subject.camera_serial, rig.camera.serial));
  if (!calibration->lights) wrong("it has no lights");
  if (!has_fault(found, before)) {
    found.push_back({SetupVerdict::kFine, "calibration",
                     fmt::format("{}{}", calibration->id.substr(0, 12),
                                 subject.measured.empty() ? "" : ", measured " + subject.measured),
                     ""});
  }
}

void examine_clock(std::vector<SetupFinding>& found) {
  struct timex clock = {};
  const bool synchronised = ::adjtimex(&clock) != TIME_ERROR && (clock.status & STA_UNSYNC) == 0;
  found.push_back(synchronised ? SetupFinding{SetupVerdict::kFine, "clock", "it is set by the network", ""}
                               : SetupFinding{SetupVerdict::kWarning, "clock", "nothing sets it",
                                              "sudo timedatectl set-ntp true"});
}

}  // namespace

const char* name_of(SetupFinding::Verdict verdict) {
  switch (verdict) {
    case SetupFinding::Verdict::kFine:
      return "fine";
    case SetupFinding::Verdict::kWarning:
      return "warning";
    case SetupFinding::Verdict::kFault:
      return "fault";
  }
  return "";
}

Json json_of(const SetupFinding& finding) {
  return {{"part", finding.part},
          {"verdict", name_of(finding.verdict)},
          {"says", finding.says},
          {"remedy", finding.remedy}};
}

SetupFinding fault_of(std::string part, const Error& error) {
  return fault(std::move(part), error.message(), error.remedy, error.kind);
}

std::vector<Holder> holders_of(const fs::path& file, const SystemPlaces& places) {
  std::vector<Holder> holders;
  for_each_process(places, [&](int pid, const fs::path& folder) {
    if (pid == ::getpid()) return;
    std::error_code ignored;
    for (const fs::directory_entry& fd : fs::directory_iterator(folder / "fd", ignored)) {
      std::error_code unreadable;
      if (fs::read_symlink(fd.path(), unreadable) != file || unreadable) continue;
      holders.push_back({pid, first_line(folder / "comm")});
      return;
    }
  });
  std::sort(holders.begin(), holders.end(), [](const Holder& a, const Holder& b) { return a.pid < b.pid; });
  return holders;
}

std::vector<SetupFinding> examine_rig(const Rig& rig, const Opened& open, const SystemPlaces& places) {
  std::vector<SetupFinding> found;
  examine_board(rig, open, places, found);
  examine_camera(rig, open, places, found);
  return found;
}

std::vector<SetupFinding> examine_folders(const Rig& rig, std::uint64_t frame_bytes) {
  std::vector<SetupFinding> found;
  examine_calibration(rig, found);
  examine_room("disk", rig.scan.sessions, frame_bytes, found);
  if (!rig.scan.copy.empty()) {
    examine_room("second disk", rig.scan.copy, frame_bytes, found);
    if (const auto one_disk = warning_of_one_disk(rig.scan.sessions, rig.scan.copy)) {
      found.push_back(
          {SetupVerdict::kWarning, "second disk", *one_disk, "mount it, or name a folder on another disk"});
    }
  }
  examine_clock(found);
  return found;
}

}  // namespace weft::capture
