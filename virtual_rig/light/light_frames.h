// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/tiles.h"
#include "simulator/simulation_plan.h"

namespace weft::virtual_rig {

/// A file that is read in place; programs that map the same file share its memory.
class MappedFloats {
 public:
  MappedFloats() = default;
  MappedFloats(MappedFloats&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  MappedFloats& operator=(MappedFloats&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MappedFloats();

  /// A file of exactly `count` floats; kBadData where it has another size.
  static Result<MappedFloats> read(const std::filesystem::path& file, std::size_t count);
  /// A new file with room for `count` floats, to be filled in place. kInputOutput where the disk has no room.
  static Result<MappedFloats> make(const std::filesystem::path& file, std::size_t count);
  float* data() const { return data_; }

 private:
  float* data_ = nullptr;
  std::size_t bytes_ = 0;
};

/// How light is rendered where the cache has none.
struct RenderLightOptions {
  TileOptions tiles = {};
  std::stop_token stop = {};
  /// Only called where something is rendered; by any thread, one at a time.
  std::function<void(double share)> progress = {};
};

/// What arrives at each photosite of a scene's camera, rendered once and without noise: a plane for each LED
/// at full light and one for the light of the room, in the unit of a reading (1 is full scale in a second at
/// ISO 100), after lens and filters; and what makes photosites differ. An exposure is a weighted sum of
/// planes, and the rest of the sensor (exposure.h).
///
/// The planes live in a cache of files that all programs of this user share: rendered by whoever comes first,
/// aside and renamed, while others wait. A folder of the cache may be removed at any time.
class LightFrames {
 public:
  /// `cache` is a folder; nothing of it need be there. Errors: those of plan_of() and render passes;
  /// kCannotCreate, kInputOutput of the cache; kInterrupted.
  static Result<LightFrames> open(const simulator::Scene& scene, const std::filesystem::path& cache,
                                  const RenderLightOptions& options = {});

  const simulator::Scene& scene() const { return plan_.scene; }
  const simulator::SceneRig& rig() const { return plan_.rig; }
  Size size() const { return plan_.rig.camera.size; }
  int leds() const { return static_cast<int>(plan_.rig.leds.leds.size()); }
  /// Its folder of the cache.
  const std::filesystem::path& folder() const { return folder_; }

  View<const float> led(int number) const { return plane(number - 1); }  ///< from 1
  /// The room lit as brightly as a scene's lights.ambient = 1 has it, whether the scene names ambient or not.
  View<const float> ambient() const { return plane(leds()); }
  bool has_photosites() const;
  View<const float> response() const { return plane(leds() + 1); }    ///< of has_photosites(), as Photosite
  View<const float> dark_per_s() const { return plane(leds() + 2); }  ///< electrons per second
  View<const float> offset_counts() const { return plane(leds() + 3); }

  /// What the scene asks for and a rig that takes single photographs leaves out, in words.
  std::vector<std::string> left_out() const;

 private:
  LightFrames(simulator::SimulationPlan plan, std::filesystem::path folder)
      : plan_(std::move(plan)), folder_(std::move(folder)) {}
  int planes() const { return leds() + 1 + (has_photosites() ? 3 : 0); }
  View<const float> plane(int number) const;
  std::size_t floats() const;
  Result<void> map();
  Result<void> render(const RenderLightOptions& options) const;

  simulator::SimulationPlan plan_;
  std::filesystem::path folder_;
  MappedFloats file_;
};

/// XDG_CACHE_HOME/weft/virtual-rig, else ~/.cache/weft/virtual-rig, else a folder of the system's for
/// temporary files.
std::filesystem::path default_light_cache();

}  // namespace weft::virtual_rig
