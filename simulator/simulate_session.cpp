// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "simulator/build_passes.h"
#include "simulator/camera/dng_writer.h"
#include "simulator/frame_parts.h"
#include "simulator/reflectance/lobe_parameters.h"
#include "simulator/simulation_plan.h"
#include "simulator/truth_files.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

/// Adds the time it lives to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(&seconds), start_(steady_clock::now()) {}
  ~Stopwatch() { *seconds_ += std::chrono::duration<double>(steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* seconds_;
  steady_clock::time_point start_;
};

Error interrupted() {
  return {ErrorKind::kInterrupted, "interrupted", "", "stopped on request", ""};
}

constexpr int kLobePlanes = 7;  ///< of truth: roughness and specular

/// The yarn's, 0 to 180: it has no head.
double azimuth_deg(const SurfacePoint& point) {
  const double turned = degrees(std::atan2(point.along_y, point.along_x));
  return turned - 180 * std::floor(turned / 180);
}

/// The lists of passes that the shots of a session need.
enum PassKind : std::size_t { kOfShots, kOfBrackets, kOfParallel, kOfBlade, kPassKinds };
using ShotPasses = std::array<PassList, kPassKinds>;

/// One shot of a session.
struct Exposure {
  int shot = 0;  ///< its number for PassRunner::run
  int led = 0;
  ShotRole role = ShotRole::kLit;
  double exposure_us = 0;
  Polariser polariser = Polariser::kNone;
  PassKind passes = kOfShots;
};

/// The films' state in the shots that are taken first.
Polariser first_state(const FilmSettings& films) {
  switch (films.states) {
    case FilmStates::kNone:
      return Polariser::kNone;
    case FilmStates::kParallel:
      return Polariser::kParallel;
    case FilmStates::kCrossed:
    case FilmStates::kBoth:
      break;
  }
  return Polariser::kCrossed;
}

/// In the order of capture: the LEDs, the repeat, brackets, the LEDs through parallel films where they were
/// crossed before, the dark shot, that with the blade.
std::vector<Exposure> exposures_of(const SimulationPlan& plan) {
  const RetakeSettings& retakes = plan.scene.camera.retakes;
  const int leds = static_cast<int>(plan.rig.leds.leds.size());
  const double exposure_us = plan.rig.exposure_us;
  const Polariser state = first_state(plan.scene.films);
  std::vector<Exposure> all;
  for (int led = 1; led <= leds; ++led) all.push_back({led, led, ShotRole::kLit, exposure_us, state});
  if (retakes.repeat) all.push_back({leds + 1, 1, ShotRole::kRepeat, exposure_us, state});
  for (int led = 1; retakes.bracket && led <= leds; ++led) {
    all.push_back({2 * leds + led, led, ShotRole::kBracket, bracket_exposure_us(retakes, plan.rig, false),
                   state, kOfBrackets});
  }
  for (int led = 1; plan.scene.films.states == FilmStates::kBoth && led <= leds; ++led)
    all.push_back({3 * leds + led, led, ShotRole::kLit, exposure_us, Polariser::kParallel, kOfParallel});
  // Developed frames have no black level.
  if (plan.scene.frames == FrameFormat::kDng) all.push_back({0, 0, ShotRole::kDark, exposure_us, state});
  if (const int led = plan.scene.blade.led; led > 0)
    all.push_back({4 * leds + led, led, ShotRole::kBlade, exposure_us, state, kOfBlade});
  return all;
}

class SessionWriter {
 public:
  SessionWriter(const Scene& scene, const SimulationPlan& plan, PassList surface, ShotPasses of_shots,
                const SimulateOptions& options)
      : given_(scene),
        plan_(plan),
        scene_(plan.scene),
        options_(options),
        exposures_(exposures_of(plan)),
        band_rows_(of_shots.front().halo > 0 ? kTallBandRows : kBandRows),
        lobe_(plan.scene.effects.reflectance ? lobe_parameters_of(plan.scene.material.reflectance)
                                             : std::nullopt),
        surface_runner_(std::move(surface), options.tiles) {
    for (PassList& list : of_shots) shot_runners_.emplace_back(std::move(list), options.tiles);
  }

  Result<SimulationReport> write(const fs::path& target) {
    if (Result<void> ok = check_room(target); !ok) return ok.error();
    PartialFolder aside(target);
    folder_ = aside.path();
    for (const char* part : {"raw", "truth"}) {
      if (part == std::string_view("truth") && !options_.truth) continue;
      if (Result<void> ok = make_writable_folder(folder_ / part); !ok) return ok.error();
    }
    using Step = Result<void> (SessionWriter::*)();
    for (const Step step : {&SessionWriter::write_calibration_folder, &SessionWriter::write_truth,
                            &SessionWriter::write_frames, &SessionWriter::write_session_file}) {
      if (Result<void> ok = (this->*step)(); !ok) return ok.error();
    }
    if (Result<void> ok = publish(aside); !ok) return ok.error();
    report_.frames = frames();
    report_.exposure_us = plan_.rig.exposure_us;
    report_.passes = shot_runners_.front().costs();
    for (std::size_t kind = 1; kind < shot_runners_.size(); ++kind) {
      for (const PassCost& cost : shot_runners_[kind].costs()) add_cost(cost);
    }
    report_.left_out = plan_.left_out;
    return std::move(report_);
  }

  Result<void> write_truth_of(const fs::path& session) {
    folder_ = session;
    if (Result<void> ok = make_writable_folder(folder_ / "truth"); !ok) return ok;
    return write_truth();
  }

 private:
  /// To that of the pass of the same name.
  void add_cost(const PassCost& cost) {
    const auto same = std::ranges::find(report_.passes, cost.name, &PassCost::name);
    if (same == report_.passes.end()) return report_.passes.push_back(cost);
    same->seconds += cost.seconds;
    same->pixels += cost.pixels;
  }
  int width() const { return scene_.camera.width; }
  int height() const { return scene_.camera.height; }
  int leds() const { return static_cast<int>(plan_.rig.leds.leds.size()); }
  int frames() const { return static_cast<int>(exposures_.size()); }
  /// Planes of truth that each LED has of its own: what it is seen of and what reaches a point by the cloth.
  int planes_of_led() const {
    if (!options_.truth) return 0;
    return (scene_.effects.cast_shadows ? 1 : 0) + (scene_.effects.interreflection ? 3 : 0);
  }
  bool has_openness() const { return options_.truth && scene_.effects.interreflection; }
  std::uint64_t truth_planes() const {
    return kTruthPlanes + static_cast<std::uint64_t>(lobe_ ? kLobePlanes : 0) + (has_openness() ? 1U : 0U);
  }
  std::string shot_name(int index, const char* ending) const {
    const Exposure& e = exposure(index);
    const std::string state = e.polariser == Polariser::kNone ? "" : fmt::format("_{}", name_of(e.polariser));
    const char* blade = e.role == ShotRole::kBlade ? "_blade" : "";
    return fmt::format("{:02}_led{:02}{}{}{}", index, e.led, state, blade, ending);
  }
  const Exposure& exposure(int index) const { return exposures_[static_cast<std::size_t>(index)]; }

  /// Better now than after an hour of rendering.
  Result<void> check_room(const fs::path& target) const {
    std::error_code ignored;
    if (fs::exists(target, ignored)) {
      return Error{ErrorKind::kCannotCreate, "session exists", target.string(),
                   "sessions are never overwritten", "choose another name with -o or remove it"};
    }
    const auto pixels = static_cast<std::uint64_t>(Size{width(), height()}.pixels());
    const auto count = static_cast<std::uint64_t>(frames());
    const auto of_leds = static_cast<std::uint64_t>(planes_of_led()) * static_cast<std::uint64_t>(leds());
    const std::uint64_t sample =
        scene_.frames == FrameFormat::kExr ? 3 * sizeof(float) : sizeof(std::uint16_t);
    const std::uint64_t disk =
        pixels * (truth_planes() * sizeof(float) + count * sample + of_leds * sizeof(std::uint16_t));
    if (const std::uint64_t free = free_disk_bytes(target); free < disk) {
      return Error{ErrorKind::kInputOutput, "no room for the session", target.string(),
                   fmt::format("{} MB are needed, {} MB are free", disk / kMegabyte, free / kMegabyte),
                   "free disk space or choose another disk with -o"};
    }
    const std::uint64_t band_pixels =
        static_cast<std::uint64_t>(std::min(band_rows_, height())) * static_cast<std::uint64_t>(width());
    return check_memory(band_pixels *
                        (truth_planes() * sizeof(float) + count * sample + of_leds * sizeof(float)));
  }

  Result<void> write_calibration_folder() {
    Result<Calibration> written = write_calibration(
        folder_ / "calibration", options_.calibration.value_or(exact_calibration(scene_, plan_.rig)));
    if (!written) return written.error();
    session_.calibration_id = written->id;
    return {};
  }

  /// body(y0, y1) for each band of rows, in order.
  template <typename Body>
  Result<void> for_each_band(const Body& body) {
    for (int y0 = 0; y0 < height(); y0 += band_rows_) {
      const int y1 = std::min(y0 + band_rows_, height());
      if (Result<void> ok = body(y0, y1); !ok) return ok;
      rows_done_ += y1 - y0;
      if (options_.progress) options_.progress(rows_done_, (options_.truth ? 2 : 1) * height());
    }
    return {};
  }

  Result<void> write_truth() {
    if (!options_.truth) return {};
    if (Result<void> ok = write_file(folder_ / "truth" / "scene.toml", to_toml(given_)); !ok) return ok;
    std::vector<TruthFiles::Map> files = {
        {"normal.exr", {"X", "Y", "Z"}}, {"albedo.exr", {"R", "G", "B"}}, {"height.exr", {"Y"}}};
    if (lobe_) {
      files.push_back(
          {"roughness.exr", {"roughness", "alpha", "alpha_along", "yarn_deg"}, SampleType::kHalf});
      files.push_back({"specular.exr", {"R", "G", "B"}, SampleType::kHalf});
    }
    Result<TruthFiles> maps = TruthFiles::open(folder_ / "truth", {width(), height()}, band_rows_, files);
    if (!maps) return maps.error();
    Result<void> written = for_each_band([&](int y0, int y1) {
      maps->begin_band(y0);
      if (Result<void> ok = render_surface(*maps, y0, y1); !ok) return ok;
      const Stopwatch timing(report_.write_seconds);
      return maps->write_band(y1 - y0);
    });
    return written ? maps->finish() : written;
  }

  Result<void> render_surface(TruthFiles& maps, int y0, int y1) {
    const Stopwatch timing(report_.render_seconds);
    return surface_runner_.run({0, y0, width(), y1}, {}, options_.stop,
                               [&](const PassTile& tile) {
                                 maps.put(tile, 0, [&](std::size_t i) { return tile.surface[i].normal.x; });
                                 maps.put(tile, 1, [&](std::size_t i) { return tile.surface[i].normal.y; });
                                 maps.put(tile, 2, [&](std::size_t i) { return tile.surface[i].normal.z; });
                                 for (std::size_t c = 0; c < 3; ++c) {
                                   maps.put(tile, 3 + static_cast<int>(c),
                                            [&](std::size_t i) { return tile.albedo[i][c]; });
                                 }
                                 maps.put(tile, 6, [&](std::size_t i) { return tile.surface[i].height_mm; });
                                 if (lobe_) put_lobe(maps, tile);
                               },
                               {});
  }

  /// Targets on the cloth are matt.
  void put_lobe(TruthFiles& maps, const PassTile& tile) const {
    const auto put = [&](int plane, double of_cloth, double of_target) {
      maps.put(tile, kTruthPlanes + plane, [&](std::size_t i) {
        return tile.target.empty() || tile.target[i] == kCloth ? of_cloth : of_target;
      });
    };
    put(0, std::sqrt(std::sqrt(lobe_->alpha_across * lobe_->alpha_along)), 1);
    put(1, lobe_->alpha_across, 1);
    put(2, lobe_->alpha_along, 1);
    maps.put(tile, kTruthPlanes + 3, [&](std::size_t i) {
      return lobe_->has_direction && (tile.target.empty() || tile.target[i] == kCloth)
                 ? azimuth_deg(tile.surface[i])
                 : 0;
    });
    for (std::size_t c = 0; c < 3; ++c) put(4 + static_cast<int>(c), lobe_->f0[c], 0);
  }

  Result<void> write_frames() {
    return scene_.frames == FrameFormat::kExr ? write_developed_frames() : write_raw_frames();
  }

  Result<void> write_developed_frames() {
    std::vector<TruthFiles::Map> maps;
    for (int index = 0; index < frames(); ++index)
      maps.push_back({shot_name(index, ".exr"), {"R", "G", "B"}});
    Result<TruthFiles> files = TruthFiles::open(folder_ / "raw", {width(), height()}, band_rows_, maps);
    if (!files) return files.error();
    Result<TruthFiles> light = open_light_maps();
    if (!light) return light.error();
    Result<void> written = for_each_band([&](int y0, int y1) {
      files->begin_band(y0);
      const auto put = [&](const PassTile& tile, int index) { files->put_samples(tile, 3 * index); };
      if (Result<void> ok = render_frames(put, *light, y0, y1); !ok) return ok;
      const Stopwatch timing(report_.write_seconds);
      if (Result<void> ok = files->write_band(y1 - y0); !ok) return ok;
      return light->write_band(y1 - y0);
    });
    if (!written) return written;
    for (TruthFiles* each : {&*light, &*files}) {
      if (Result<void> ok = each->finish(); !ok) return ok;
    }
    for (int index = 0; index < frames(); ++index) {
      if (options_.stop.stop_requested()) return interrupted();
      if (Result<void> ok = record_shot(index, ".exr"); !ok) return ok;
    }
    return {};
  }

  Result<void> write_raw_frames() {
    std::vector<DngWriter> files;
    for (int index = 0; index < frames(); ++index) {
      Result<DngWriter> file = DngWriter::open(folder_ / "raw" / shot_name(index, ".dng"),
                                               frame_head(plan_, exposure(index).exposure_us),
                                               {width(), height()}, tags_of(scene_));
      if (!file) return file.error();
      files.push_back(std::move(*file));
    }
    Result<TruthFiles> light = open_light_maps();
    if (!light) return light.error();
    Image<std::uint16_t> counts({width(), std::min(band_rows_, height())}, frames());
    Result<void> written = for_each_band([&](int y0, int y1) {
      const auto put = [&](const PassTile& tile, int index) { copy_counts(tile, y0, counts.plane(index)); };
      if (Result<void> ok = render_frames(put, *light, y0, y1); !ok) return ok;
      const Stopwatch timing(report_.write_seconds);
      for (int index = 0; index < frames(); ++index) {
        const View<const std::uint16_t> rows = counts.plane(index);
        Result<void> ok =
            files[static_cast<std::size_t>(index)].write_rows(rows.crop({0, 0, width(), y1 - y0}));
        if (!ok) return ok;
      }
      return light->write_band(y1 - y0);
    });
    if (!written) return written;
    if (Result<void> ok = light->finish(); !ok) return ok;
    for (int index = 0; index < frames(); ++index) {
      if (options_.stop.stop_requested()) return interrupted();
      if (Result<void> ok = finish_frame(index, files[static_cast<std::size_t>(index)]); !ok) return ok;
    }
    return {};
  }

  Result<TruthFiles> open_light_maps() const {
    std::vector<TruthFiles::Map> maps;
    for (int led = 1; options_.truth && led <= leds(); ++led) {
      if (scene_.effects.cast_shadows)
        maps.push_back({fmt::format("visibility_led{:02}.exr", led), {"Y"}, SampleType::kHalf});
      if (scene_.effects.interreflection)
        maps.push_back({fmt::format("indirect_led{:02}.exr", led), {"R", "G", "B"}, SampleType::kHalf});
    }
    if (has_openness()) maps.push_back({"openness.exr", {"Y"}, SampleType::kHalf});
    return TruthFiles::open(folder_ / "truth", {width(), height()}, band_rows_, maps);
  }

  /// put(tile, index of the frame) for each tile of each frame.
  template <typename Put>
  Result<void> render_frames(const Put& put, TruthFiles& light, int y0, int y1) {
    const Stopwatch timing(report_.render_seconds);
    light.begin_band(y0);
    for (std::size_t kind = 0; kind < kPassKinds; ++kind) {
      std::vector<int> shots;
      for (const Exposure& e : exposures_) {
        if (e.passes == kind) shots.push_back(e.shot);
      }
      if (shots.empty()) continue;
      const Result<void> ok = shot_runners_[kind].run(
          {0, y0, width(), y1}, shots, options_.stop, [](const PassTile&) {},
          [&](const PassTile& tile) {
            const auto taken = std::find_if(exposures_.begin(), exposures_.end(),
                                            [&](const Exposure& e) { return e.shot == tile.shot; });
            put(tile, static_cast<int>(taken - exposures_.begin()));
            if (kind == kOfShots && taken->role == ShotRole::kLit && !light.empty()) put_light(light, tile);
          });
      if (!ok) return ok;
    }
    return {};
  }

  void put_light(TruthFiles& light, const PassTile& tile) const {
    int plane = (tile.led - 1) * planes_of_led();
    if (scene_.effects.cast_shadows) {
      light.put(tile, plane++, [&](std::size_t i) { return tile.visibility[i]; });
    }
    if (!scene_.effects.interreflection) return;
    if (tile.led == 1)  // of a cloth that moves, as it lay then
      light.put(tile, leds() * planes_of_led(), [&](std::size_t i) { return tile.openness[i]; });
    const Rgb flux = plan_.rig.leds.leds[static_cast<std::size_t>(tile.led - 1)].flux_rgb;
    for (std::size_t c = 0; c < 3; ++c) {
      light.put(tile, plane++, [&](std::size_t i) { return tile.indirect[i][c] * flux[c]; });
    }
  }

  Result<void> finish_frame(int index, DngWriter& file) {
    const Stopwatch timing(report_.write_seconds);
    if (Result<void> ok = file.finish(); !ok) return ok;
    return record_shot(index, ".dng");
  }

  Result<void> record_shot(int index, const char* ending) {
    Shot shot;
    shot.index = index;
    shot.led = exposure(index).led;
    shot.role = exposure(index).role;
    shot.file = "raw/" + shot_name(index, ending);
    shot.exposure_us = exposure(index).exposure_us;
    shot.iso = scene_.camera.iso;
    shot.f_number = scene_.camera.f_number;
    shot.polariser = exposure(index).polariser;
    Result<std::string> digest = sha256_of_file(folder_ / shot.file);
    if (!digest) return digest.error();
    shot.sha256 = *digest;
    session_.shots.push_back(std::move(shot));
    return {};
  }

  Result<void> write_session_file() {
    session_.folder = folder_;
    session_.fabric = scene_.fabric;
    session_.cloth_height_mm = scene_.geometry.cloth_height_mm;
    session_.pose = scene_.pose;
    session_.rig = "virtual rig";
    session_.films.leak = scene_.films.leak;
    return write_session(session_);
  }

  Result<void> publish(PartialFolder& aside) {
    const Stopwatch timing(report_.write_seconds);
    return aside.publish();
  }

  const Scene& given_;  ///< as it was asked for
  const SimulationPlan& plan_;
  const Scene& scene_;  ///< as it is simulated
  const SimulateOptions& options_;
  std::vector<Exposure> exposures_;
  int band_rows_;
  std::optional<LobeParameters> lobe_;  ///< of the cloth
  PassRunner surface_runner_;
  std::vector<PassRunner> shot_runners_;  ///< by PassKind
  fs::path folder_;
  Session session_;
  SimulationReport report_;
  int rows_done_ = 0;
};

}  // namespace

Result<SimulationReport> simulate_session(const Scene& scene, const fs::path& session_folder,
                                          const SimulateOptions& options) try {
  const Result<SimulationPlan> plan = plan_of(scene);
  if (!plan) return plan.error();
  if (session_folder.empty()) {
    return Error{ErrorKind::kUsage, "no session folder", "simulation", "its name is empty",
                 "name one with -o"};
  }
  Result<PassList> surface = build_passes(plan->scene, plan->rig, Output::kSurface);
  const Output output = plan->scene.frames == FrameFormat::kExr ? Output::kRgb : Output::kCounts;
  SceneRig bracket_rig = plan->rig, parallel_rig = plan->rig, blade_rig = plan->rig;
  bracket_rig.exposure_us = bracket_exposure_us(plan->scene.camera.retakes, plan->rig, true);
  parallel_rig.lobe_share = lobe_share_of(plan->scene.films, FilmStates::kParallel);
  blade_rig.blade_lies = plan->scene.blade.led > 0 || plan->scene.blade.lies;
  const std::array<const SceneRig*, kPassKinds> rigs = {&plan->rig, &bracket_rig, &parallel_rig, &blade_rig};
  ShotPasses of_shots;
  for (std::size_t kind = 0; kind < kPassKinds; ++kind) {
    Result<PassList> passes = build_passes(plan->scene, *rigs[kind], output);
    if (!passes) return passes.error();
    passes->takes_before = options.takes_before;
    of_shots[kind] = std::move(*passes);
  }
  if (!surface) return surface.error();
  return SessionWriter(scene, *plan, std::move(*surface), std::move(of_shots), options).write(session_folder);
} catch (const std::bad_alloc&) {
  return no_memory("the system refused some");
}

Result<void> simulate_truth(const Scene& scene, const fs::path& session, const SimulateOptions& options) try {
  const Result<SimulationPlan> plan = plan_of(scene);
  if (!plan) return plan.error();
  Result<PassList> surface = build_passes(plan->scene, plan->rig, Output::kSurface);
  if (!surface) return surface.error();
  return SessionWriter(scene, *plan, std::move(*surface), {}, options).write_truth_of(session);
} catch (const std::bad_alloc&) {
  return no_memory("the system refused some");
}

}  // namespace weft::simulator
