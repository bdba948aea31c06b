// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "virtual_rig/board/lit_log.h"
#include "virtual_rig/ptp/dataset.h"
#include "virtual_rig/ptp/faults.h"
#include "virtual_rig/ptp/link.h"
#include "virtual_rig/ptp/properties.h"
#include "virtual_rig/ptp/virtual_camera.h"

namespace weft::virtual_rig::ptp {

/// A thread that does things when their time has come, one after the other. What has not begun when it ends
/// is not done.
class Timeline {
 public:
  Timeline() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

  void at(RigClock::time_point when, std::function<void()> action);
  /// Waits for what it is doing.
  void stop();

 private:
  void run(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::multimap<RigClock::time_point, std::function<void()>> actions_;
  std::jthread thread_;  // last: ends before what it uses
};

/// Where the bodies differ.
struct BodyFacts {
  const char* model;  ///< as DeviceInfo has it
  std::uint16_t usb_product;
  std::chrono::milliseconds shutter_lag;  ///< from the command until the shutter opens
  std::span<const std::uint16_t> operations;
};

const BodyFacts& facts_of(CameraBody body);

/// A body behind its sockets: session, properties, pictures and exposures in real time. Links bring it
/// operations; it does not know which. Safe from any thread.
class PtpBody {
 public:
  PtpBody(const VirtualCameraOptions& options, DevelopExposure develop);

  /// The ways to it, from now on; either may be missing.
  void attach(Link* network, Link* usb);
  /// No exposure goes on from now on, and none of what is still to befall does.
  void stop() { timeline_.stop(); }

  Answer transact(const Request& request, BytesView data);

  /// A host has connected. False: it is turned away.
  bool admit_to_network();
  /// A host wants the interface. False: another program has it.
  bool admit_to_usb();
  /// The host went without closing its session, and the link tells so. (On USB a killed host's stays open.)
  void end_session();
  /// The host resets the body (USB's still image class): no session, and whatever kept it silent is over.
  void reset();
  /// The cable is out, and in again after a while.
  void pull_cable();

  void inject(const PtpFaultKind& kind, int shot);
  int shots() const;

 private:
  struct Picture {
    ObjectFacts facts;
    std::shared_ptr<const Bytes> bytes = {};
    std::optional<PtpFault> in_transfer = {};
  };
  struct Exposure {
    int shot = 0;  ///< by the count that faults go by
    bool to_memory = false;
    int power_cycle = 0;
    CameraExposure camera = {};
    RigClock::time_point done = {};  ///< with its dark picture, where it takes one
    std::string date = {};
  };
  struct Notice {
    Event event;
    std::uint32_t parameter;
  };

  Answer serve(const Request& request, BytesView data);
  Answer open_session();
  Answer object_handles(const Request& request) const;
  Answer object_info(std::uint32_t handle);
  Answer object(std::uint32_t handle, std::uint64_t offset, std::uint64_t most);
  Answer delete_object(std::uint32_t handle);
  Answer property(const Request& request, BytesView data);
  Answer events();
  Answer ready();
  Answer capture(bool to_memory);
  Answer start_live_view();
  Answer end_live_view();
  Answer live_picture();
  void tell_prohibitions();

  bool busy() const;
  Exposure expose(bool to_memory);
  void half_exposed(const Exposure& exposure);
  void finish(const Exposure& exposure);
  Result<Bytes> develop(const Exposure& exposure);
  void keep(const Exposure& exposure, Bytes file);
  std::uint32_t new_handle(bool to_memory) const;

  void befall_before_next();
  void befall(PtpFault fault);
  void tell_changes(std::initializer_list<PropertyCode> codes);
  void break_link();
  void unplug();
  void set_power(bool on);
  void update_presence();
  void after(double seconds, std::function<void()> action);

  const VirtualCameraOptions options_;
  const BodyFacts& facts_;
  const DevelopExposure develop_;

  mutable std::mutex mutex_;
  Link* network_ = nullptr;
  Link* usb_ = nullptr;
  PropertyTable properties_;
  FaultSchedule faults_;
  std::map<std::uint32_t, Picture> objects_;
  std::deque<Notice> notices_;
  std::shared_ptr<const Bytes> last_file_;  ///< kept only where it is to come again
  int captures_ = 0;
  int connections_ = 0;
  std::uint32_t image_number_;
  int power_cycles_ = 0;
  bool powered_ = true, cable_in_ = true, port_open_ = true;
  bool session_open_ = false, session_silent_ = false, card_full_ = false;
  bool exposing_ = false, stuck_ = false, undeveloped_ = false;
  bool live_ = false, never_live_ = false;
  int looks_ = 0;  ///< pictures of live view that were asked for
  RigClock::time_point busy_until_ = {}, claimed_until_ = {}, next_look_ = {}, live_until_ = {};
  Timeline timeline_;  // last: ends before what it uses
};

}  // namespace weft::virtual_rig::ptp
