// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/scan/simulated_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "core/base/files.h"
#include "simulator/camera/dng_writer.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using capture::CameraFacts;
using capture::ExposureSettings;
using capture::Photograph;

double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

template <typename T>
T unwrapped(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

Error device_error(ErrorKind kind, const char* what) {
  return {kind, what, "simulated device", "as injected", "none"};
}

}  // namespace

simulator::Scene small_scene() {
  simulator::Scene scene;
  scene.fabric = "plain weave";
  scene.camera.width = 96;
  scene.camera.height = 64;
  scene.camera.mm_per_pixel = 200.0 / 96;
  scene.material.albedo = {0.5, 0.4, 0.3};
  scene.effects.near_light = true;
  scene.effects.noise = true;
  return scene;
}

SimulatedRig::SimulatedRig(const SimulatedCloth& cloth) : cloth_(cloth) {
  facts.model = cloth.calibration().subject.camera_model;
  facts.serial = cloth.calibration().subject.camera_serial;
  facts.port = "simulated";
  facts.clock_uncertainty_s = 0.01;
}

Lighting SimulatedRig::lighting() const {
  Lighting lighting;
  for (const int led : lit_) {
    const auto other = wires.find(led);
    const int lights = other == wires.end() ? led : other->second;
    lighting.leds[lights] = gain.contains(lights) ? gain.at(lights) : 1;
  }
  if (stays_lit != 0 && takes_ >= stays_lit_from) lighting.leds[stays_lit] = 1;
  if (takes_ >= room_from) lighting.room = room;
  return lighting;
}

Result<double> SimulatedRig::Lamps::light(std::span<const int> leds, double) {
  if (rig_.lamps_absent_ > 0) return device_error(ErrorKind::kNoDevice, "board is gone");
  const auto fault = rig_.lamp_faults.find(++rig_.lamp_calls_);
  if (fault != rig_.lamp_faults.end()) {
    rig_.lit_.clear();
    if (fault->second == ErrorKind::kNoDevice) rig_.lamps_absent_ = rig_.absent;
    return device_error(fault->second, "board fails");
  }
  rig_.lit_.clear();
  const auto now = std::chrono::steady_clock::now();
  if (const auto rest = rig_.rests_s.find(rig_.lamp_calls_); rest != rig_.rests_s.end()) {
    rig_.cool_at_ = now + std::chrono::duration_cast<std::chrono::nanoseconds>(
                              std::chrono::duration<double>(rest->second));
  }
  if (!leds.empty() && now < rig_.cool_at_) return std::chrono::duration<double>(rig_.cool_at_ - now).count();
  rig_.lit_.assign(leds.begin(), leds.end());
  return 0.0;
}

Result<void> SimulatedRig::Lamps::recover() {
  rig_.lit_.clear();
  if (rig_.lamps_absent_ > 0 && --rig_.lamps_absent_ > 0)
    return device_error(ErrorKind::kNoDevice, "board is gone");
  return {};
}

Result<CameraFacts> SimulatedRig::Camera::connect() {
  return recover();
}

Result<CameraFacts> SimulatedRig::Camera::recover() {
  if (rig_.camera_absent_ > 0 && --rig_.camera_absent_ > 0) {
    return device_error(ErrorKind::kNoDevice, "camera is gone");
  }
  return rig_.facts;
}

Result<CameraFacts> SimulatedRig::Camera::set(const ExposureSettings& exposure) {
  if (rig_.camera_absent_ > 0) return device_error(ErrorKind::kNoDevice, "camera is gone");
  rig_.facts.exposure = exposure;
  return rig_.facts;
}

/// Thirds of a stop from 1/4000 s to 30 s.
Result<std::vector<double>> SimulatedRig::Camera::shutter_times_us() {
  std::vector<double> times;
  for (int i = -36; i <= 15; ++i) times.push_back(std::round(1e6 * std::exp2(i / 3.0)));
  return times;
}

Result<Photograph> SimulatedRig::Camera::written(const fs::path& file, Fault fault) {
  Photograph photograph;
  photograph.file = file;
  photograph.file += ".dng";
  photograph.ending = "dng";
  photograph.image_number = ++rig_.image_number_;
  photograph.triggered_s = now_s();
  photograph.taken_s = photograph.triggered_s;
  photograph.exposure = rig_.facts.exposure;
  const Lighting lighting = fault == Fault::kLedWentOut ? Lighting() : rig_.lighting();
  const RawFrame frame = rig_.cloth_.photograph(lighting, rig_.facts.exposure.exposure_us,
                                                static_cast<std::uint32_t>(rig_.takes_));
  simulator::DngTags tags;
  tags.image_number = photograph.image_number;
  if (Result<void> done = simulator::write_dng(photograph.file, frame, tags); !done) return done.error();
  photograph.bytes = fs::file_size(photograph.file);
  if (fault == Fault::kTruncated || fault == Fault::kFullDisk) {
    fs::resize_file(photograph.file, photograph.bytes / 2);
    photograph.bytes /= 2;
  }
  photograph.sha256 = unwrapped(sha256_of_file(photograph.file));
  if (fault == Fault::kDamaged) {
    std::string bytes = unwrapped(read_text(photograph.file));
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    if (Result<void> done = write_file(photograph.file, bytes); !done) return done.error();
  }
  return photograph;
}

Result<Photograph> SimulatedRig::Camera::take(const fs::path& file, const std::function<void()>& exposed) {
  ++rig_.takes_;
  rig_.on_take(rig_.takes_);
  if (rig_.camera_absent_ > 0) return device_error(ErrorKind::kNoDevice, "camera is gone");
  const auto found = rig_.camera_faults.find(rig_.takes_);
  const Fault fault = found == rig_.camera_faults.end() ? Fault::kNone : found->second;
  switch (fault) {
    case Fault::kNoAnswer:
      return device_error(ErrorKind::kTryAgain, "camera does not answer");
    case Fault::kNonsense:
      return device_error(ErrorKind::kProtocol, "camera talks nonsense");
    case Fault::kUnplugged:
      rig_.camera_absent_ = rig_.absent;
      return device_error(ErrorKind::kNoDevice, "camera is gone");
    case Fault::kBattery:
      return device_error(ErrorKind::kBadData, "battery is empty");
    default:
      break;
  }
  if (fault == Fault::kSecondShutter) ++rig_.image_number_;
  Result<Photograph> photograph = written(file, fault);
  exposed();
  if (!photograph) return photograph;
  if (fault == Fault::kFullDisk) return device_error(ErrorKind::kInputOutput, "disk is full");
  if (fault == Fault::kLost || fault == Fault::kLate) {
    if (fault == Fault::kLate) {
      late_ = *photograph;
      late_bytes_ = unwrapped(read_text(photograph->file));
    }
    fs::remove(photograph->file);
    return device_error(ErrorKind::kTryAgain, "no photograph came");
  }
  if (fault == Fault::kTwice) {
    if (Result<void> done = write_file(photograph->file, last_bytes_); !done) return done.error();
    photograph->sha256 = unwrapped(sha256_of_file(photograph->file));
  }
  last_bytes_ = unwrapped(read_text(photograph->file));
  if (late_) {  // the file of the shot before, under this one's name
    if (Result<void> done = write_file(photograph->file, late_bytes_); !done) return done.error();
    late_->file = photograph->file;
    late_->triggered_s = photograph->triggered_s;
    photograph = *std::exchange(late_, std::nullopt);
  }
  return photograph;
}

}  // namespace weft::test
