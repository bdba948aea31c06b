// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/camera/camera_profile.h"
#include "capture/camera/photograph_evidence.h"
#include "capture/camera/worker_process.h"
#include "capture/devices.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::capture {

/// A clock and the serial number of the camera it is of.
struct RememberedClock {
  std::string serial;
  CameraClock clock;
};

/// A camera's clock as it was watched within the last hour, kept in a file between connections, for watching
/// takes up to a second.
class ClockMemory {
 public:
  explicit ClockMemory(std::filesystem::path file) : file_(std::move(file)) {}

  /// Its uncertainty has grown by what two quartzes drift apart. Nothing where it is older than an hour, or
  /// this machine's clock was set back since.
  std::optional<RememberedClock> recall(double now_s) const;
  /// What cannot be kept is watched again.
  void keep(const RememberedClock& watched, double now_s) const;
  void forget() const;

 private:
  std::filesystem::path file_;
};

struct CameraLinkOptions {
  std::string profile = "nikon-d5100";  ///< built in, or the path of a TOML file
  std::string port;              ///< "ptpip:ADDRESS:PORT:PORT"; "usb:BUS,DEVICE" or empty: found on USB
  std::string serial;            ///< empty: the only camera there is, and from then on that one
  std::filesystem::path worker;  ///< weft-camera; empty: beside the running program
  std::filesystem::path state;   ///< folder for what libgphoto2 remembers and says; empty: one that goes
  Environment environment;       ///< for the worker, on top of this process's
};

/// The camera through weft-camera, a process that is killed when it hangs, and started again when it has
/// crashed. For one thread at a time.
///
/// A photograph lands as `FILE.arrived` and gets its name only after its own header has proved it to be the
/// one that was asked for: raw, its count after the last one's, its time between trigger and now by the
/// camera's clock, its exposure as set. Else it is removed: kProtocol ("an older photograph arrived") or
/// kBadData. After kTryAgain, kProtocol and kNoDevice the camera takes nothing until recover().
///
/// connect() watches the camera's clock turn, or glances at it where it was watched within the last hour and
/// has not been set since.
class CameraLink : public Camera {
 public:
  static Result<std::unique_ptr<CameraLink>> make(CameraLinkOptions options);
  /// Ends the camera's session, within a second.
  ~CameraLink() override;
  CameraLink(const CameraLink&) = delete;
  CameraLink& operator=(const CameraLink&) = delete;

  Result<CameraFacts> connect() override;
  Result<CameraFacts> set(const ExposureSettings& exposure) override;
  Result<std::vector<double>> shutter_times_us() override;
  Result<Photograph> take(const std::filesystem::path& file, const std::function<void()>& exposed) override;
  Result<std::string> look() override;
  Result<void> stop_looking() override;
  Result<CameraFacts> recover() override;

  /// 0 where no worker runs.
  pid_t worker_pid() const { return worker_ ? worker_->pid() : 0; }

 private:
  CameraLink(CameraLinkOptions options, CameraProfile profile, bool own_state);

  Result<CameraFacts> open(const std::string& serial, bool watch_clock);
  Result<CameraFacts> note_opened(const Json& opened);
  void note_clock(const Json& clock);
  void forget_clock();
  Result<void> start_worker();
  void end_worker();
  /// What the worker says before it answers may move the deadline.
  using OnEvent = std::function<void(WorkerProcess::Deadline&)>;
  Result<Json> request(
      Json asked, double most_s, const OnEvent& on_event = [](auto&) {});
  Result<Json> answer_of(WorkerProcess::Deadline& deadline, const OnEvent& on_event);
  Result<Photograph> examined(const std::filesystem::path& aside, const Json& landed) const;

  CameraLinkOptions options_;
  CameraProfile profile_;
  bool own_state_;
  std::unique_ptr<WorkerProcess> worker_;
  int id_ = 0;
  bool ready_ = false;
  CameraFacts facts_;
  ClockMemory clock_memory_;
  std::optional<CameraClock> clock_;
  bool is_clock_remembered_ = false;
  std::optional<std::uint32_t> last_image_number_;
  std::optional<ExposureSettings> wanted_;  // set again after a reconnect
};

}  // namespace weft::capture
