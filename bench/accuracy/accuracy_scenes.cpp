// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy_scenes.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "simulator/build_passes.h"
#include "simulator/reflectance/presets.h"
#include "simulator/sampling/random.h"
#include "simulator/simulation_plan.h"
#include "solve/photographs/tile_reader.h"

namespace weft::bench {
namespace {

using namespace simulator;

constexpr int kPatchSide = 192;
constexpr int kQuickSide = 96;

struct FamilyName {
  const char* name;
  Family family;
};
constexpr FamilyName kFamilies[] = {
    {"smooth", Family::kSmooth}, {"plain", Family::kPlain}, {"deep", Family::kDeep}};

struct Material {
  const char* name;
  const char* preset;  ///< whose reflectance it has; none: Lambert
  double albedo;       ///< grey; 0: the preset's own
};
constexpr Material kMaterials[] = {{"lambert", nullptr, 0.5},  {"white", nullptr, 0.9},
                                   {"cotton", "wool", 0.5},    {"satin", "satin", 0},
                                   {"velvet", "velvet", 0.04}, {"dark-satin", "dark-satin", 0}};

MaterialSettings settings_of(const Material& material) {
  MaterialSettings settings;
  if (material.preset != nullptr) {
    const ClothPreset preset = *simulator::preset(material.preset);
    settings.reflectance = preset.reflectance;
    settings.albedo = preset.albedo;
  }
  if (material.albedo > 0) settings.albedo.fill(material.albedo);
  return settings;
}

// A weave of the family as no other seed draws it.
GeometrySettings weave_of(Family family, SceneSet set, std::uint32_t seed) {
  const auto of_family = static_cast<std::uint32_t>(family), of_set = static_cast<std::uint32_t>(set);
  std::uint32_t draws = 0;
  const auto draw = [&](double from, double to) {
    const auto bits = philox({draws++, of_family, 0, 0}, {seed, of_set});
    return from + (to - from) * uniform(bits[0], bits[1]);
  };
  const auto pitch_mm = [&] { return set == SceneSet::kTuning ? draw(0.70, 0.78) : draw(0.82, 0.90); };
  GeometrySettings weave = family_settings(family);
  weave.warp_pitch_mm = pitch_mm();
  weave.weft_pitch_mm = pitch_mm();
  weave.crimp *= draw(0.9, 1.1);
  weave.flank_deg *= draw(0.97, 1.03);
  weave.twist_relief *= draw(0.9, 1.1);
  weave.fibre_seed = seed;
  return weave;
}

EffectSettings accuracy_effects(bool has_sheen) {
  EffectSettings effects;
  effects.near_light = effects.relief = effects.cast_shadows = effects.interreflection = effects.noise = true;
  effects.reflectance = has_sheen;
  return effects;
}

std::vector<Rect> patches_of(const CameraSettings& camera, bool quick) {
  const int side = quick ? kQuickSide : kPatchSide;
  const auto at = [&](int x, int y) { return Rect{x, y, x + side, y + side}; };
  const Rect centre = at((camera.width - side) / 2 & ~1, (camera.height - side) / 2 & ~1);
  if (quick) return {centre};
  return {centre, at(camera.width - side - 64, 64)};
}

RawFrame frame_of(const SimulationPlan& plan, Size size) {
  const Sensor& sensor = plan.rig.sensor;
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(size);
  for (auto& row : frame.black) row.fill(static_cast<float>(sensor.black));
  frame.white = static_cast<float>(sensor.white);
  frame.shot = {sensor.make,          sensor.model,          "virtual",
                plan.rig.exposure_us, plan.scene.camera.iso, plan.scene.camera.f_number};
  return frame;
}

// The camera that sees the patch alone: its principal point moves with the corner.
CameraModel cropped(CameraModel camera, Rect area) {
  camera.size = {area.width(), area.height()};
  camera.cx -= area.x0;
  camera.cy -= area.y0;
  return camera;
}

template <typename T>
void copy_plane(View<const T> from, View<T> to) {
  for (int y = 0; y < from.height(); ++y) std::copy_n(from.row(y), from.width(), to.row(y));
}

template <typename T>
Image<T> copy_of(const Image<T>& image) {
  Image<T> copy(image.size(), image.planes());
  for (int p = 0; p < image.planes(); ++p) copy_plane<T>(image.plane(p), copy.plane(p));
  return copy;
}

// Counts of all LEDs through parallel films.
Result<void> run_parallel(const SimulationPlan& plan, Rect area, int threads, solve::Mosaics& mosaics) {
  SceneRig rig = plan.rig;
  rig.lobe_share = lobe_share_of(plan.scene.films, FilmStates::kParallel);
  Result<PassList> passes = build_passes(plan.scene, rig, Output::kCounts);
  if (!passes) return passes.error();
  std::vector<int> shots(plan.rig.leds.leds.size());
  // As a session numbers them: other shots than the crossed ones, with other noise.
  std::iota(shots.begin(), shots.end(), 3 * static_cast<int>(shots.size()) + 1);
  const auto nothing = [](const PassTile&) {};
  return PassRunner(std::move(*passes), {.threads = threads})
      .run(area, shots, {}, nothing, [&](const PassTile& tile) {
        RawFrame& frame = mosaics.frames[static_cast<std::size_t>(tile.led - 1)];
        for_each_pixel(tile.rect, [&](std::size_t i, int x, int y) {
          frame.counts(x - area.x0, y - area.y0) = tile.counts[i];
        });
      });
}

// Counts and truth, as the passes of the scene leave them.
Result<void> run_passes(const SimulationPlan& plan, Rect area, int threads, ClothPatch& patch) {
  Result<PassList> passes = build_passes(plan.scene, plan.rig, Output::kCounts);
  if (!passes) return passes.error();
  const auto put = [&](const PassTile& tile, auto view, const auto& value_of) {
    for_each_pixel(tile.rect, [&](std::size_t, int x, int y) {
      view(x - area.x0, y - area.y0) = static_cast<float>(value_of(index_in(tile.area, x, y)));
    });
  };
  const auto put_surface = [&](const PassTile& tile) {
    put(tile, patch.normal.plane(0), [&](std::size_t i) { return tile.surface[i].normal.x; });
    put(tile, patch.normal.plane(1), [&](std::size_t i) { return tile.surface[i].normal.y; });
    put(tile, patch.normal.plane(2), [&](std::size_t i) { return tile.surface[i].normal.z; });
    for (std::size_t c = 0; c < 3; ++c) {
      put(tile, patch.albedo.plane(static_cast<int>(c)), [&](std::size_t i) { return tile.albedo[i][c]; });
    }
    put(tile, patch.openness.plane(),
        [&](std::size_t i) { return tile.openness.empty() ? 1 : tile.openness[i]; });
  };
  const auto put_shot = [&](const PassTile& tile) {
    const bool dark = tile.led == 0;
    const int k = tile.led - 1;
    solve::Mosaics& mosaics = *patch.photographs.mosaics();
    RawFrame& frame = dark ? *mosaics.dark : mosaics.frames[static_cast<std::size_t>(k)];
    for_each_pixel(tile.rect, [&](std::size_t i, int x, int y) {
      frame.counts(x - area.x0, y - area.y0) = tile.counts[i];
    });
    if (!dark) put(tile, patch.visible.plane(k), [&](std::size_t i) { return tile.irradiance[i] > 0; });
  };
  std::vector<int> shots(plan.rig.leds.leds.size() + 1);
  std::iota(shots.begin(), shots.end(), 0);
  return PassRunner(std::move(*passes), {.threads = threads}).run(area, shots, {}, put_surface, put_shot);
}

}  // namespace

const char* name_of(SceneSet set) {
  return set == SceneSet::kTuning ? "tuning" : "held-out";
}

std::vector<AccuracyScene> accuracy_scenes(SceneSet set, std::uint32_t seed, bool quick) {
  std::vector<AccuracyScene> scenes;
  for (const auto& [family_name, family] : kFamilies) {
    for (const Material& material : kMaterials) {
      Scene scene;
      scene.seed = 2 * static_cast<std::int64_t>(seed) + (set == SceneSet::kHeldOut ? 1 : 0);
      scene.geometry = weave_of(family, set, seed);
      scene.material = settings_of(material);
      scene.effects = accuracy_effects(material.preset != nullptr);
      scenes.push_back({std::string(family_name) + " " + material.name, family_name, material.name, scene,
                        patches_of(scene.camera, quick)});
    }
  }
  return scenes;
}

Result<ClothPatch> render_patch(const Scene& scene, Rect area, int threads) {
  const Result<SimulationPlan> plan = plan_of(scene);
  if (!plan) return plan.error();
  const Calibration exact = exact_calibration(plan->scene, plan->rig);
  const double height_mm = scene.geometry.cloth_height_mm;
  const CameraModel camera = seen_from(scene.pose, height_mm, cropped(*exact.camera, area));
  Result<LightField> field =
      LightField::make(seen_from(scene.pose, height_mm, *exact.lights), camera, camera.size, height_mm);
  if (!field) return std::move(field).error();
  const Size size = {area.width(), area.height()};
  const auto lights = static_cast<int>(field->count());
  ClothPatch patch;
  patch.photographs.camera = camera;
  patch.readings = Image<float>(size, lights);
  patch.visible = Image<float>(size, lights);
  patch.normal = Image<float>(size, 3);
  patch.albedo = Image<float>(size, 3);
  patch.openness = Image<float>(size);
  solve::Photographs& photographs = patch.photographs;
  photographs.size = size;
  photographs.field = std::move(*field);
  photographs.albedo_scale = AlbedoScale::kAbsolute;
  std::vector<RawFrame> frames;
  for (int k = 0; k < lights; ++k) frames.push_back(frame_of(*plan, size));
  photographs.frames = solve::Mosaics(std::move(frames), frame_of(*plan, size), response_of(plan->rig.sensor),
                                      {plan->rig.exposure_us, scene.camera.iso});
  photographs.lobe_share = plan->rig.lobe_share;
  if (Result<void> ran = run_passes(*plan, area, threads, patch); !ran) return std::move(ran).error();
  if (scene.films.states == FilmStates::kBoth) {
    std::vector<RawFrame> more;
    for (int k = 0; k < lights; ++k) more.push_back(frame_of(*plan, size));
    solve::Mosaics parallel = photographs.mosaics()->alike(std::move(more));
    if (Result<void> ran = run_parallel(*plan, area, threads, parallel); !ran) return std::move(ran).error();
    photographs.parallel = std::move(parallel);
  }
  for (int k = 0; k < lights; ++k) {
    readings_of(photographs.frames, static_cast<std::size_t>(k), patch.area(), patch.readings.plane(k));
  }
  return patch;
}

Result<ClothPatch> with_lights(const ClothPatch& patch, const std::vector<int>& numbers) {
  Result<Lights> lights = select_lights(patch.field().lights(), numbers);
  if (!lights) return std::move(lights).error();
  Result<LightField> field = LightField::make(std::move(*lights), patch.photographs.camera, patch.size(),
                                              patch.field().cloth_height_mm());
  if (!field) return std::move(field).error();
  ClothPatch fewer;
  fewer.normal = copy_of(patch.normal);
  fewer.albedo = copy_of(patch.albedo);
  fewer.openness = copy_of(patch.openness);
  fewer.readings = Image<float>(patch.size(), static_cast<int>(numbers.size()));
  fewer.visible = Image<float>(patch.size(), static_cast<int>(numbers.size()));
  fewer.photographs.size = patch.size();
  fewer.photographs.camera = patch.photographs.camera;
  fewer.photographs.field = std::move(*field);
  fewer.photographs.albedo_scale = patch.photographs.albedo_scale;
  const solve::Mosaics& all = *patch.photographs.mosaics();
  std::vector<RawFrame> frames;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const int k = numbers[i] - 1, to = static_cast<int>(i);
    frames.push_back(copy_of(all.frames[static_cast<std::size_t>(k)]));
    copy_plane<float>(patch.readings.plane(k), fewer.readings.plane(to));
    copy_plane<float>(patch.visible.plane(k), fewer.visible.plane(to));
  }
  fewer.photographs.frames = all.alike(std::move(frames));
  return fewer;
}

Result<std::vector<ClothPatch>> render_patches(const AccuracyScene& scene, int threads) {
  std::vector<std::optional<Result<ClothPatch>>> rendered(scene.patches.size());
  parallel_for(rendered.size(), threads,
               [&](std::size_t i, int) { rendered[i] = render_patch(scene.scene, scene.patches[i], 1); });
  std::vector<ClothPatch> patches;
  for (auto& patch : rendered) {
    if (!patch->has_value()) return std::move(*patch).error();
    patches.push_back(std::move(*patch).value());
  }
  return patches;
}

}  // namespace weft::bench
