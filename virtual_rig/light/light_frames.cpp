// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/light_frames.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <numeric>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>

#include "core/base/descriptor.h"
#include "core/base/files.h"
#include "core/base/sha256.h"
#include "core/image/raw_frame.h"
#include "simulator/build_passes.h"
#include "simulator/camera/defects.h"
#include "simulator/effects/random_key.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using simulator::EffectSettings;
using simulator::Scene;
using simulator::SimulationPlan;

// Part of a cache folder's name: raised whenever the same scene gives other planes.
constexpr int kVersion = 1;
constexpr int kBandRows = 256;
constexpr std::chrono::milliseconds kLockPoll(20);
constexpr const char* kPlanes = "light.f32";

Error for_the_cache(Error error) {
  error.remedy = "free disk space, or name another folder in XDG_CACHE_HOME";
  return error;
}

Error interrupted() {
  return {ErrorKind::kInterrupted, "interrupted", "", "stopped on request", ""};
}

/// Holds a lock of the system's until it goes; the end of a program, however it ends, frees it too.
Result<void> lock(const Descriptor& file, const fs::path& path, const std::stop_token& stop) {
  if (!file) return for_the_cache(cannot_write(path, errno));
  while (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) return for_the_cache(cannot_write(path, errno));
    if (stop.stop_requested()) return interrupted();
    std::this_thread::sleep_for(kLockPoll);
  }
  return {};
}

std::string digest_of(const Image<float>& picture) {
  std::string bytes;
  for (int p = 0; p < picture.planes(); ++p) {
    for (int y = 0; y < picture.height(); ++y) {
      bytes.append(reinterpret_cast<const char*>(picture.plane(p).row(y)),
                   sizeof(float) * static_cast<std::size_t>(picture.width()));
    }
  }
  return sha256_of(bytes);
}

/// Everything that the planes depend on.
std::string name_of(const Scene& scene) {
  std::string text = fmt::format("{}\n{}", kVersion, to_toml(scene));
  if (scene.geometry.heights_mm) text += digest_of(*scene.geometry.heights_mm);
  if (scene.material.print.albedo) text += digest_of(*scene.material.print.albedo);
  return sha256_of(text).substr(0, 32);
}

/// The scene up to its photosites, with nothing that changes from shot to shot.
Scene only_light(Scene scene) {
  for (bool EffectSettings::*sensor_or_shot :
       {&EffectSettings::noise, &EffectSettings::bloom, &EffectSettings::nonlinearity,
        &EffectSettings::dark_current, &EffectSettings::uneven_response, &EffectSettings::led_drift,
        &EffectSettings::movement, &EffectSettings::ambient}) {
    scene.effects.*sensor_or_shot = false;
  }
  scene.damage.clear();
  return scene;
}

/// The planes of a file under construction.
class Planes {
 public:
  Planes(const SimulationPlan& plan, float* data) : plan_(plan), data_(data), size_(plan.rig.camera.size) {}

  Result<void> render(const RenderLightOptions& options) const {
    const Scene light = only_light(plan_.scene);
    Scene room = light;
    room.effects.ambient = true;
    room.lights.ambient = 1;
    Result<simulator::PassList> of_leds = build_passes(light, plan_.rig, simulator::Output::kRgb);
    Result<simulator::PassList> of_room = build_passes(room, plan_.rig, simulator::Output::kRgb);
    if (!of_leds) return of_leds.error();
    if (!of_room) return of_room.error();
    simulator::PassRunner lit(std::move(*of_leds), options.tiles), dark(std::move(*of_room), options.tiles);
    std::vector<int> shots(plan_.rig.leds.leds.size());
    std::iota(shots.begin(), shots.end(), 1);
    const std::vector<int> none = {0};
    std::mutex counting;
    std::int64_t done = 0;
    const std::int64_t all = size_.pixels() * static_cast<std::int64_t>(shots.size() + 1);
    const auto count = [&](std::int64_t pixels) {
      const std::lock_guard lock(counting);
      done += pixels;
      if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(all));
    };
    for (int y0 = 0; y0 < size_.height; y0 += kBandRows) {
      const Rect band = {0, y0, size_.width, std::min(y0 + kBandRows, size_.height)};
      const auto run = [&](simulator::PassRunner& runner, const std::vector<int>& which) {
        return runner.run(
            band, which, options.stop, [](const simulator::PassTile&) {},
            [&](const simulator::PassTile& t) {
              put(t);
              count(t.rect.pixels());
            });
      };
      if (Result<void> ok = run(lit, shots); !ok) return ok;
      if (Result<void> ok = run(dark, none); !ok) return ok;
    }
    return {};
  }

  void draw_photosites() const {
    const simulator::SensorPattern pattern(defects_of(plan_.scene), random_key(plan_.scene));
    std::vector<simulator::PhotositeDefect> row(static_cast<std::size_t>(size_.width));
    const int first = static_cast<int>(plan_.rig.leds.leds.size()) + 1;
    for (int y = 0; y < size_.height; ++y) {
      pattern.fill({0, y, size_.width, y + 1}, row);
      for (int x = 0; x < size_.width; ++x) {
        const simulator::PhotositeDefect& site = row[static_cast<std::size_t>(x)];
        *at(first, x, y) = static_cast<float>(site.response);
        *at(first + 1, x, y) = static_cast<float>(site.dark_electrons_per_s);
        *at(first + 2, x, y) = static_cast<float>(site.offset_counts);
      }
    }
  }

 private:
  float* at(int plane, int x, int y) const {
    return data_ + plane * size_.pixels() + static_cast<std::int64_t>(y) * size_.width + x;
  }

  /// What the filter of each photosite passes, per second at ISO 100.
  void put(const simulator::PassTile& tile) const {
    constexpr CfaPattern kCfa;
    const double exposure = plan_.rig.exposure(plan_.scene.camera.iso);
    const int plane = tile.shot == 0 ? static_cast<int>(plan_.rig.leds.leds.size()) : tile.shot - 1;
    simulator::for_each_pixel(tile.rect, [&](std::size_t i, int x, int y) {
      const auto channel = static_cast<std::size_t>(kCfa.channel_at(x, y));
      *at(plane, x, y) = static_cast<float>(tile.samples[3 * i + channel] / exposure);
    });
  }

  const SimulationPlan& plan_;
  float* data_;
  Size size_;
};

}  // namespace

MappedFloats::~MappedFloats() {
  if (data_ != nullptr) ::munmap(data_, bytes_);
}

Result<MappedFloats> MappedFloats::read(const fs::path& file, std::size_t count) {
  const Descriptor in(file, O_RDONLY);
  if (!in) return cannot_read(file, errno);
  MappedFloats mapped;
  mapped.bytes_ = count * sizeof(float);
  struct stat status = {};
  if (::fstat(in.get(), &status) != 0) return cannot_read(file, errno);
  if (static_cast<std::uint64_t>(status.st_size) != mapped.bytes_) {
    return Error{ErrorKind::kBadData, "file of another size", file.string(),
                 fmt::format("it has {} bytes in the place of {}", status.st_size, mapped.bytes_),
                 "remove it"};
  }
  void* data = ::mmap(nullptr, mapped.bytes_, PROT_READ, MAP_SHARED, in.get(), 0);
  if (data == MAP_FAILED) return cannot_read(file, errno);
  mapped.data_ = static_cast<float*>(data);
  return mapped;
}

Result<MappedFloats> MappedFloats::make(const fs::path& file, std::size_t count) {
  const Descriptor out(file, O_RDWR | O_CREAT | O_EXCL);
  if (!out) return cannot_write(file, errno);
  MappedFloats mapped;
  mapped.bytes_ = count * sizeof(float);
  // Without its blocks a full disk would be a SIGBUS half-way.
  const int full = ::posix_fallocate(out.get(), 0, static_cast<off_t>(mapped.bytes_));
  if (full != 0) return cannot_write(file, full);
  void* data = ::mmap(nullptr, mapped.bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, out.get(), 0);
  if (data == MAP_FAILED) return cannot_write(file, errno);
  mapped.data_ = static_cast<float*>(data);
  return mapped;
}

Result<LightFrames> LightFrames::open(const Scene& scene, const fs::path& cache,
                                      const RenderLightOptions& options) {
  Result<SimulationPlan> plan = plan_of(scene);
  if (!plan) return plan.error();
  const std::string name = name_of(plan->scene);
  LightFrames frames(std::move(*plan), cache / name);
  if (frames.map()) return frames;

  if (Result<void> ok = make_writable_folder(cache); !ok) return for_the_cache(ok.error());
  const fs::path lock_path = cache / (name + ".lock");
  const Descriptor lock_file(lock_path, O_RDWR | O_CREAT);
  if (Result<void> ok = lock(lock_file, lock_path, options.stop); !ok) return ok.error();
  if (frames.map()) return frames;
  if (Result<void> ok = frames.render(options); !ok) return ok.error();
  if (Result<void> ok = frames.map(); !ok) return ok.error();
  return frames;
}

bool LightFrames::has_photosites() const {
  return plan_.scene.effects.dark_current || plan_.scene.effects.uneven_response;
}

std::size_t LightFrames::floats() const {
  return static_cast<std::size_t>(size().pixels()) * static_cast<std::size_t>(planes());
}

View<const float> LightFrames::plane(int number) const {
  return {file_.data() + number * size().pixels(), size(), size().width};
}

Result<void> LightFrames::map() {
  Result<MappedFloats> file = MappedFloats::read(folder_ / kPlanes, floats());
  if (!file) return file.error();
  file_ = std::move(*file);
  return {};
}

/// Under the lock: what lies aside or is damaged is nobody's.
Result<void> LightFrames::render(const RenderLightOptions& options) const {
  fs::path aside = folder_;
  aside += ".partial";
  std::error_code failed;
  for (const fs::path& left : {aside, folder_}) {
    fs::remove_all(left, failed);
    if (failed) return for_the_cache(cannot_write(left, failed.value()));
  }
  if (Result<void> ok = make_writable_folder(aside); !ok) return for_the_cache(ok.error());
  const auto rendered = [&]() -> Result<void> {
    const Result<MappedFloats> file = MappedFloats::make(aside / kPlanes, floats());
    if (!file) return for_the_cache(file.error());
    const Planes planes(plan_, file->data());
    if (Result<void> ok = planes.render(options); !ok) return ok;
    if (has_photosites()) planes.draw_photosites();
    return write_file(aside / "scene.toml", to_toml(plan_.scene));
  }();
  Result<void> published = rendered ? publish_folder(aside, folder_) : rendered;
  if (!published) fs::remove_all(aside, failed);
  return published;
}

std::vector<std::string> LightFrames::left_out() const {
  std::vector<std::string> left_out;
  const Scene& s = plan_.scene;
  if (s.effects.movement) left_out.emplace_back("movement: the cloth lies still between exposures");
  if (s.effects.led_drift) left_out.emplace_back("led_drift: LEDs flicker and do not fade");
  if (!s.damage.empty()) left_out.emplace_back("damage: frames are whole");
  if (s.frames == simulator::FrameFormat::kExr)
    left_out.emplace_back("frames = \"exr\": a camera delivers raw files");
  return left_out;
}

fs::path default_light_cache() {
  const auto folder = [](const char* variable) -> fs::path {
    const char* value = std::getenv(variable);
    return value != nullptr ? value : "";
  };
  if (const fs::path xdg = folder("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "weft/virtual-rig";
  if (const fs::path home = folder("HOME"); home.is_absolute()) return home / ".cache/weft/virtual-rig";
  std::error_code ignored;
  return fs::temp_directory_path(ignored) / "weft-virtual-rig";
}

}  // namespace weft::virtual_rig
