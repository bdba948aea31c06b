// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/request_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <sstream>

#include "core/base/files.h"
#include "core/rig/same_camera.h"

namespace weft::capture {
namespace {

constexpr std::uint64_t kSpareBytes = 16u << 20;  // of journal, calibration, file system

Error unsuited(std::string why) {
  return {ErrorKind::kBadData, "calibration is not of this rig as it stands", "scan", std::move(why),
          "name the rig's own calibration, or calibrate the rig as it is now"};
}

/// Whether two names of one camera have its number in common: "NIKON D5100", "Nikon DSC D5100 (PTP mode)".
bool are_one_model(const std::string& a, const std::string& b) {
  std::istringstream words(a);
  for (std::string word; words >> word;) {
    const bool has_digit =
        std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c); });
    if (has_digit && b.find(word) != std::string::npos) return true;
  }
  return a == b;
}

Result<void> check_disk(const std::filesystem::path& folder, std::uint64_t needed, const char* what) {
  const std::uint64_t free = free_disk_bytes(folder);
  if (free >= needed + kSpareBytes) return {};
  return Error{ErrorKind::kInputOutput, fmt::format("no room for {}", what), folder.string(),
               fmt::format("{} MB are needed, {} MB are free", (needed + kSpareBytes) >> 20, free >> 20),
               "free disk space or choose another disk, then run the same command again"};
}

}  // namespace

Result<ShotList> checked_shots(const ScanRequest& request, int leds_of_board, bool has_more_outputs,
                               const std::optional<Calibration>& calibration) {
  const auto refuse = [](std::string what, std::string why, std::string remedy) {
    return Error{ErrorKind::kUsage, std::move(what), "scan", std::move(why), std::move(remedy)};
  };
  ShotList list = asked_shots(request);
  if (!has_more_outputs && (request.below || request.polariser.is_turned)) {
    return Error{ErrorKind::kBadData,
                 request.below ? "the LED board has no output for a light below"
                               : "the LED board cannot turn the polariser",
                 "scan", "its firmware is older than that", "flash its firmware: weft rig flash PORT"};
  }
  if (list.leds.empty()) {
    list.leds.resize(static_cast<std::size_t>(leds_of_board));
    std::iota(list.leds.begin(), list.leds.end(), 1);
  }
  for (const int led : list.leds) {
    if (led < 1 || led > leds_of_board) {
      return refuse(fmt::format("there is no LED {}", led), fmt::format("the board has {}", leds_of_board),
                    "name LEDs of the board");
    }
    if (std::count(list.leds.begin(), list.leds.end(), led) > 1) {
      return refuse("a LED is named twice", fmt::format("LED {}", led), "name every LED once");
    }
    if (calibration && calibration->lights && led > static_cast<int>(light_count(*calibration->lights))) {
      return unsuited(fmt::format("it measures {} LEDs, and LED {} is asked for",
                                  light_count(*calibration->lights), led));
    }
  }
  if (list.leds.empty()) return refuse("no LED is asked for", "the board has none", "name LEDs of the board");
  if (list.blade && std::ranges::find(list.leds, *list.blade) == list.leds.end()) {
    return refuse(fmt::format("LED {} cannot throw the blade's shadow", *list.blade),
                  "it is not photographed without the blade", "name a LED that is");
  }
  if (list.bracket && !(*list.bracket >= 0.001 && *list.bracket <= 100)) {
    return refuse("bracket is out of range", fmt::format("it is {:g}", *list.bracket), "choose 0.001 to 100");
  }
  return list;
}

Result<void> check_calibration(const ScanRequest& request, const CameraFacts& camera,
                               const Calibration& calibration) {
  const CalibrationSubject& subject = calibration.subject;
  if (subject.rig != request.rig) {
    return unsuited(fmt::format("it is of rig \"{}\", this is \"{}\"", subject.rig, request.rig));
  }
  if (!same_setting(subject.f_number, request.exposure.f_number)) {
    return unsuited(
        fmt::format("it holds at f/{:g}, f/{:g} is asked for", subject.f_number, request.exposure.f_number));
  }
  const double iso = calibration.response ? calibration.response->iso.value_or(0) : 0;
  if (iso > 0 && !same_setting(iso, request.exposure.iso)) {
    return unsuited(fmt::format("its response was measured at ISO {:g}, ISO {:g} is asked for", iso,
                                request.exposure.iso));
  }
  if (!camera.model.empty() && !subject.camera_model.empty() &&
      !are_one_model(camera.model, subject.camera_model)) {
    return unsuited(fmt::format("it is of a {}, the camera is a {}", subject.camera_model, camera.model));
  }
  if (!same_serial(camera.serial, subject.camera_serial)) {
    return unsuited(fmt::format("it is of the body with serial number {}, this one has {}",
                                subject.camera_serial, camera.serial));
  }
  return {};
}

Result<void> check_room(const ScanRequest& request, int frames, int all, std::uint64_t bytes) {
  const auto times = [&](int count) { return static_cast<std::uint64_t>(count) * bytes; };
  if (Result<void> room = check_disk(request.session, times(frames), "the scan"); !room) return room;
  return request.copy.empty() ? Result<void>() : check_disk(request.copy, times(all), "the second copy");
}

}  // namespace weft::capture
