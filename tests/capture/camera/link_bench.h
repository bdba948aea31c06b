// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera/camera_link.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "simulator/camera/dng_writer.h"
#include "tests/capture/raw/dng_bytes.h"
#include "virtual_rig/ptp/virtual_camera.h"

namespace weft::capture {

/// The file of an exposure: small, and true in all that it says of itself.
inline Result<std::vector<std::uint8_t>> small_dng(const virtual_rig::CameraExposure& exposure) {
  RawFrame frame = sample_frame({64, 48});
  frame.shot.exposure_us = exposure.exposure_us;
  frame.shot.iso = exposure.iso;
  frame.shot.f_number = exposure.f_number;
  simulator::DngTags tags;
  tags.date_time_original = exposure.date_time;
  tags.milliseconds = exposure.milliseconds;
  tags.image_number = exposure.image_number;
  return simulator::dng_bytes(frame, tags);
}

inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// With a finder whose pictures are numbered in their third byte.
inline virtual_rig::VirtualCameraOptions with_finder(virtual_rig::VirtualCameraOptions options = {}) {
  options.finder = [number = std::uint8_t{0}]() mutable {
    std::vector<std::uint8_t> picture(40'000, '\n');
    picture[0] = picture[picture.size() - 2] = 0xff;
    picture[1] = 0xd8;
    picture[2] = ++number;
    picture.back() = 0xd9;
    return picture;
  };
  return options;
}

/// A virtual camera and a link to it through the real weft-camera, in a folder of their own.
class LinkBench {
 public:
  explicit LinkBench(virtual_rig::VirtualCameraOptions options = {}) {
    static int count = 0;
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("weft_link_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(folder_ / "raw");
    options.size = {64, 48};
    auto started = virtual_rig::VirtualCamera::start(options, &small_dng);
    if (!started) throw std::runtime_error(started.error().message());
    camera_ = std::move(*started);
    link_options_.port =
        "ptpip:127.0.0.1:" + std::to_string(camera_->port()) + ":" + std::to_string(camera_->port());
    link_options_.state = folder_ / "state";
  }
  ~LinkBench() {
    link_.reset();
    camera_.reset();
    std::filesystem::remove_all(folder_);
  }
  LinkBench(const LinkBench&) = delete;
  LinkBench& operator=(const LinkBench&) = delete;

  /// Through the stand-in for libusb, to the cameras behind these sockets.
  void use_usb(const std::string& sockets) {
    link_options_.port.clear();
    // The stand-in is loaded before a sanitizer's runtime, which is in order: it is built without.
    link_options_.environment = {{"LD_PRELOAD", WEFT_USB_STAND_IN},
                                 {"WEFT_USB_CAMERAS", sockets},
                                 {"ASAN_OPTIONS", "verify_asan_link_order=0:detect_leaks=0"}};
  }

  CameraLinkOptions& options() { return link_options_; }
  virtual_rig::VirtualCamera& camera() { return *camera_; }
  void switch_off() { camera_.reset(); }
  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path raw(int index) const {
    return folder_ / "raw" / (index < 10 ? "0" + std::to_string(index) : std::to_string(index));
  }

  /// A D5100 that is given up sooner.
  void hurry(double readout_s) {
    change_profile({{"readout_s = 5", "readout_s = " + std::to_string(readout_s)}});
  }
  /// The D5100's profile with some of its lines replaced.
  void change_profile(const std::vector<std::pair<std::string, std::string>>& changes) {
    std::string toml(nikon_d5100_toml());
    for (const auto& [line, instead] : changes) toml.replace(toml.find(line), line.size(), instead);
    link_options_.profile = folder_ / "changed.toml";
    if (const auto written = write_file(link_options_.profile, toml); !written)
      throw std::runtime_error(written.error().message());
  }

  CameraLink& link() {
    if (!link_) {
      auto made = CameraLink::make(link_options_);
      if (!made) throw std::runtime_error(made.error().message());
      link_ = std::move(*made);
    }
    return *link_;
  }
  void drop_link() { link_.reset(); }

  /// Connected and set to 1/60 s.
  CameraLink& ready() {
    const auto connected = link().connect();
    if (!connected) throw std::runtime_error(connected.error().message());
    if (const auto set = link().set({1e6 / 60, 100, 8}); !set)
      throw std::runtime_error(set.error().message());
    return *link_;
  }

  /// Takes a photograph as a scan does: recovers and takes again, at most `tries` times within 30 s.
  Result<Photograph> take_patiently(int index, int tries = 3) {
    for (int attempt = 1;; ++attempt) {
      Result<Photograph> taken = link().take(raw(index), [] {});
      if (taken || attempt == tries) return taken;
      last_error_ = taken.error();
      ++retakes_;
      const auto begin = std::chrono::steady_clock::now();
      Result<CameraFacts> back = link().recover();
      while (!back && back.error().kind != ErrorKind::kBadData && seconds_since(begin) < 30)
        back = link().recover();
      if (!back) return std::move(back).error();
    }
  }
  int retakes() const { return retakes_; }
  const Error& last_error() const { return last_error_; }

 private:
  std::filesystem::path folder_;
  std::unique_ptr<virtual_rig::VirtualCamera> camera_;
  CameraLinkOptions link_options_;
  std::unique_ptr<CameraLink> link_;
  int retakes_ = 0;
  Error last_error_;
};

/// What is wrong with a photograph that is said to be whole and the body's `image_number`th; empty if
/// nothing.
inline std::string wrong_with(const Photograph& photograph, std::uint32_t image_number) {
  if (photograph.image_number != image_number)
    return "image " + std::to_string(photograph.image_number.value_or(0)) + ", not " +
           std::to_string(image_number);
  const auto sha256 = sha256_of_file(photograph.file);
  if (!sha256) return sha256.error().message();
  if (*sha256 != photograph.sha256) return "its digest differs";
  if (std::filesystem::file_size(photograph.file) != photograph.bytes) return "its size differs";
  return "";
}

/// Files that belong to no photograph.
inline int left_over(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    count += entry.path().extension() != ".dng";
  return count;
}

}  // namespace weft::capture
