// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/attended_devices.h"

#include <utility>

namespace weft::app {
namespace {

bool may_pass(const Error& error) {
  return error.kind == ErrorKind::kTryAgain || error.kind == ErrorKind::kProtocol;
}

}  // namespace

Result<double> AttendedDevices::light(const std::vector<int>& leds, double most_s) {
  Result<double> rest = devices_.lamps->light(leds, most_s);
  if (!rest && may_pass(rest.error())) {
    const Result<void> back = devices_.lamps->recover();
    rest = back ? devices_.lamps->light(leds, most_s) : Result<double>(back.error());
  }
  if (!rest && rest.error().kind != ErrorKind::kUsage) broken_ = rest.error();
  return rest;
}

Result<void> AttendedDevices::go_dark() {
  const Result<double> off = devices_.lamps->light({}, 1);
  return off ? Result<void>() : off.error();
}

Result<void> AttendedDevices::set(const capture::ExposureSettings& exposure) {
  if (set_ == exposure) return {};
  set_.reset();
  if (const Result<capture::CameraFacts> set = devices_.camera->set(exposure); !set) {
    if (set.error().kind == ErrorKind::kNoDevice) broken_ = set.error();
    return set.error();
  }
  set_ = exposure;
  return {};
}

Result<capture::Photograph> AttendedDevices::take(const std::filesystem::path& file) {
  Result<capture::Photograph> photograph = devices_.camera->take(file, [&] { static_cast<void>(go_dark()); });
  if (photograph) return photograph;
  static_cast<void>(go_dark());
  set_.reset();
  recover_camera();
  return photograph;
}

Result<std::string> AttendedDevices::look() {
  Result<std::string> jpeg = devices_.camera->look();
  if (!jpeg) recover_camera();
  return jpeg;
}

void AttendedDevices::recover_camera() {
  if (const Result<capture::CameraFacts> back = devices_.camera->recover(); !back) broken_ = back.error();
}

}  // namespace weft::app
