// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bench/oracles/simulated_cloth.h"
#include "capture/devices.h"
#include "simulator/scene/scene.h"

namespace weft::test {

/// A plain weave of 96 x 64 photosites, 200 mm wide, under ten LEDs.
simulator::Scene small_scene();

/// Both devices of a rig over a SimulatedCloth, in one process and without waiting: what links, wires and
/// worker processes do is tested with the real ones, while here a scan meets each error that devices.h
/// allows, at each shot, a thousand times a minute.
class SimulatedRig {
 public:
  explicit SimulatedRig(const SimulatedCloth& cloth);

  enum class Fault {
    kNone,
    kNoAnswer,       ///< kTryAgain, and nothing was taken
    kLost,           ///< kTryAgain after the shutter: the photograph counts and is never seen
    kLate,           ///< the same, and the next shot delivers that photograph instead of its own
    kTwice,          ///< the file of the shot before in place of its own, though the camera counted on
    kNonsense,       ///< kProtocol
    kUnplugged,      ///< kNoDevice, until recover() was asked for `absent` times
    kBattery,        ///< kBadData
    kFullDisk,       ///< kInputOutput, half a file written
    kTruncated,      ///< half a file, with a digest to match
    kDamaged,        ///< a byte of it changes after its digest was made
    kLedWentOut,     ///< the exposure sees no LED
    kSecondShutter,  ///< somebody takes a photograph in between
  };
  std::map<int, Fault> camera_faults;    ///< by take, from 1
  std::map<int, ErrorKind> lamp_faults;  ///< by call of light(), from 1
  std::map<int, double> rests_s;         ///< by call of light(), from 1: so long its LED must cool first
  int absent = 2;                        ///< calls of recover() until an unplugged device is back

  std::map<int, int> wires;                            ///< LED that lights in the place of the one asked for
  std::map<int, double> gain;                          ///< of a LED; 0: dead
  int stays_lit = 0;                                   ///< LED that is always lit
  int stays_lit_from = 0;                              ///< from this take on
  double room = 0;                                     ///< light of the room
  int room_from = 0;                                   ///< from this take on
  std::function<void(int take)> on_take = [](int) {};  ///< called before each exposure

  capture::Lamps& lamps() { return lamps_; }
  capture::Camera& camera() { return camera_; }
  int takes() const { return takes_; }
  bool is_lit() const { return !lit_.empty(); }
  capture::CameraFacts facts;

 private:
  class Lamps : public capture::Lamps {
   public:
    explicit Lamps(SimulatedRig& rig) : rig_(rig) {}
    int leds() const override { return rig_.cloth_.leds(); }
    Result<double> light(std::span<const int> leds, double most_s) override;
    Result<void> recover() override;
    bool has_more_outputs() const override { return false; }
    Result<void> polarise(Polariser) override { return {}; }
    Result<std::vector<double>> can_light_s() override { return std::vector<double>{40, 12.5}; }

   private:
    SimulatedRig& rig_;
  };
  class Camera : public capture::Camera {
   public:
    explicit Camera(SimulatedRig& rig) : rig_(rig) {}
    Result<capture::CameraFacts> connect() override;
    Result<capture::CameraFacts> set(const capture::ExposureSettings& exposure) override;
    Result<std::vector<double>> shutter_times_us() override;
    Result<capture::Photograph> take(const std::filesystem::path& file,
                                     const std::function<void()>& exposed) override;
    Result<std::string> look() override { return std::string("\xff\xd8\xff\xd9"); }
    Result<void> stop_looking() override { return {}; }
    Result<capture::CameraFacts> recover() override;

   private:
    Result<capture::Photograph> written(const std::filesystem::path& file, SimulatedRig::Fault fault);
    SimulatedRig& rig_;
    std::optional<capture::Photograph> late_;
    std::string late_bytes_, last_bytes_;
  };
  Lighting lighting() const;

  const SimulatedCloth& cloth_;
  Lamps lamps_{*this};
  Camera camera_{*this};
  std::vector<int> lit_;
  std::chrono::steady_clock::time_point cool_at_;
  int takes_ = 0, lamp_calls_ = 0, camera_absent_ = 0, lamps_absent_ = 0;
  std::uint32_t image_number_ = 4711;
};

}  // namespace weft::test
