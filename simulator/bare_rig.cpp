// SPDX-License-Identifier: Apache-2.0
#include "simulator/bare_rig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/rig/camera.h"
#include "simulator/sampling/random.h"
#include "simulator/simulation_plan.h"
#include "simulator/spectra/observer.h"
#include "simulator/targets/target.h"

namespace weft::simulator {
namespace {

constexpr double kTableAlbedo = 0.08;
constexpr double kThickness_mm = 3;  // of the board
constexpr double kWhite = 0.88;      // of paper, where the scene has none
constexpr double kTrapShare = 0.15;  // of the frame's height
constexpr double kLifted_mm = 1;     // of charts over the table

TargetSettings paper_in(const Scene& scene) {
  const auto paper = std::find_if(scene.targets.begin(), scene.targets.end(), [](const TargetSettings& t) {
    return kind_of(t.pattern) == TargetKind::kPaper;
  });
  TargetSettings plain;
  plain.white = kWhite;
  return paper == scene.targets.end() ? plain : *paper;
}

/// The corners of a row of patches, clockwise from the upper left of the first.
std::string corners_px(const CameraModel& camera, const TargetSettings& scale,
                       const GreyScaleSettings& pattern) {
  const auto patches = static_cast<double>(pattern.reflectances.size());
  const double u = (patches * pattern.patch_mm + (patches - 1) * pattern.gap_mm) / 2,
               v = pattern.patch_mm / 2;
  std::string text;
  for (const auto& [x, y] : {std::pair{-u, v}, {u, v}, {u, -v}, {-u, -v}}) {
    const Vec3 p = project(camera, scale.centre_mm + Vec3{x, y, 0});
    text += fmt::format("{}[{:.2f}, {:.2f}]", text.empty() ? "" : ", ", p.x, p.y);
  }
  return text;
}

}  // namespace

CapturePose plane_pose() {
  return {.tilt_deg = 15, .azimuth_deg = 210};
}

Result<BareRig> BareRig::of(const Scene& given) {
  const Result<SimulationPlan> plan = plan_of(given);
  if (!plan) return plan.error();
  Scene scene = plan->scene;
  scene.fabric = "calibration";
  scene.geometry = {};
  scene.material = {};
  scene.targets = furniture(plan->scene, plan->rig.camera);
  scene.damage.clear();
  // Through the same films, but in one state: what is calibrated is matt.
  if (scene.films.states == FilmStates::kBoth) scene.films.states = FilmStates::kCrossed;
  scene.frames = FrameFormat::kDng;
  scene.camera.retakes.repeat = false;
  scene.camera.retakes.bracket.reset();
  EffectSettings& on = scene.effects;
  on.relief = on.cast_shadows = on.interreflection = on.translucency = on.reflectance = on.movement = false;
  if (on.spectral) {
    scene.material.dye = flat_spectrum(kTableAlbedo);
  } else {
    scene.material.albedo.fill(kTableAlbedo);
  }
  Result<SceneRig> rig = rig_of(scene);
  if (!rig) return std::move(rig).error();
  return BareRig(std::move(scene), std::move(*rig), paper_in(given));
}

Scene BareRig::with(const std::vector<TargetSettings>& things) const {
  Scene scene = scene_;
  scene.targets.insert(scene.targets.begin(), things.begin(), things.end());
  return scene;
}

TargetSettings BareRig::flat_board() const {
  TargetSettings flat;
  flat.pattern = board();
  flat.centre_mm.z = kThickness_mm;
  return flat;
}

SheetLayout BareRig::sheet() const {
  std::vector<CapturePose> poses = five_poses();
  poses.push_back(plane_pose());
  return sheet_layout(scene_, rig_.camera, poses);
}

TargetSettings BareRig::grey_scale() const {
  TargetSettings scale;
  GreyScaleSettings pattern;
  const double width_mm = 0.8 * scene_.camera.width * scene_.camera.mm_per_pixel;
  pattern.patch_mm = std::floor(width_mm / static_cast<double>(pattern.reflectances.size()) / 1.1);
  pattern.gap_mm = 0.1 * pattern.patch_mm;
  scale.pattern = pattern;
  scale.centre_mm.z = kLifted_mm;
  return scale;
}

bool BareRig::has_chart() const {
  return !scene_.spectra.chart.empty() && scene_.effects.spectral;
}

TargetSettings BareRig::chart() const {
  TargetSettings chart;
  ChartSettings pattern;
  pattern.patch_mm = std::floor(0.6 * scene_.camera.width * scene_.camera.mm_per_pixel / 6 / 1.1);
  pattern.gap_mm = 0.1 * pattern.patch_mm;
  pattern.frame_mm = 0.2 * pattern.patch_mm;
  chart.pattern = pattern;
  chart.centre_mm.z = kLifted_mm;
  return chart;
}

std::vector<TargetSettings> BareRig::trap() const {
  TargetSettings trap;
  const double height_mm = scene_.camera.height * scene_.camera.mm_per_pixel;
  trap.pattern =
      GreyScaleSettings{.reflectances = {0}, .patch_mm = kTrapShare * height_mm, .gap_mm = 0, .margin_mm = 0};
  trap.white = 0;
  trap.centre_mm.z = kLifted_mm;
  std::vector<TargetSettings> things = laid(sheet(), {}, paper_);
  things.insert(things.begin(), std::move(trap));
  return things;
}

std::string BareRig::board_toml() const {
  const CharucoSettings board = this->board();
  return fmt::format(
      "kind = \"charuco\"\nsquares_x = {}\nsquares_y = {}\nsquare_mm = {}\nmarker_share = {}\ndictionary = "
      "\"{}\"\nthickness_mm = {}\n",
      board.squares_x, board.squares_y, board.square_mm, board.marker_share, board.dictionary, kThickness_mm);
}

std::string BareRig::sheet_toml() const {
  const SheetLayout sheet = this->sheet();
  std::string text = fmt::format("width_mm = {}\nheight_mm = {}\nreflectance = {}\nmargin_mm = {}\n",
                                 sheet.width_mm, sheet.height_mm, paper_.white, sheet.margin_mm);
  for (const CaptureTag& tag : sheet.tags) {
    text +=
        fmt::format("\n[[tag]]\ndictionary = \"{}\"\nid = {}\nside_mm = {}\ncentre_mm = [{:.4f}, {:.4f}]\n",
                    TagSettings().dictionary, tag.id, sheet.tag_mm, tag.centre_mm[0], tag.centre_mm[1]);
  }
  return text;
}

std::string BareRig::scale_toml() const {
  const TargetSettings scale = grey_scale();
  const auto& pattern = std::get<GreyScaleSettings>(scale.pattern);
  return fmt::format("reflectances = [{}]\ncorners_px = [{}]\n", fmt::join(pattern.reflectances, ", "),
                     corners_px(rig_.camera, scale, pattern));
}

// The patches as the observer sees them.
std::string BareRig::chart_toml() const {
  std::string text = "rec709 = [\n";
  for (const Spectrum& patch : scene_.spectra.chart) {
    const auto [r, g, b] = rec709_albedo(patch);
    text += fmt::format("  [{:.6f}, {:.6f}, {:.6f}],\n", r, g, b);
  }
  return text + "]\n";
}

std::vector<Fiducial> BareRig::fiducials() const {
  std::vector<Fiducial> fiducials;
  for (const TargetSettings& target : scene_.targets) {
    const auto* tag = std::get_if<TagSettings>(&target.pattern);
    const Result<Target> placed = Target::make(target, scene_.seed, 0);
    if (tag == nullptr || !placed) continue;
    const double half_mm = tag->side_mm / 2;
    fiducials.push_back({tag->dictionary,
                         tag->id,
                         {placed->place_mm(-half_mm, half_mm), placed->place_mm(half_mm, half_mm),
                          placed->place_mm(half_mm, -half_mm), placed->place_mm(-half_mm, -half_mm)}});
  }
  return fiducials;
}

std::vector<WhitePatch> BareRig::patches() const {
  std::vector<WhitePatch> patches;
  const Size frame = rig_.camera.size;
  for (const TargetSettings& target : scene_.targets) {
    const auto* paper = std::get_if<PaperSettings>(&target.pattern);
    const Result<Target> placed = Target::make(target, scene_.seed, 0);
    if (paper == nullptr || !placed) continue;
    const double x_mm = paper->width_mm / 2, y_mm = paper->height_mm / 2;
    WhitePatch patch;
    for (const Vec3 corner : {placed->place_mm(-x_mm, y_mm), placed->place_mm(x_mm, y_mm),
                              placed->place_mm(x_mm, -y_mm), placed->place_mm(-x_mm, -y_mm)}) {
      const Vec3 p = project(rig_.camera, corner);
      if (p.x >= 0 && p.y >= 0 && p.x <= frame.width - 1 && p.y <= frame.height - 1)
        patch.polygon_px.push_back({p.x, p.y});
    }
    if (patch.polygon_px.size() < 4) continue;
    patch.reflectance_rgb.fill(target.white);
    patch.delta = target.sheet.non_lambertian;
    patch.height_mm = target.centre_mm.z;
    patches.push_back(std::move(patch));
  }
  return patches;
}

std::vector<Vec3> BareRig::taped(double error_mm, std::int64_t seed) const {
  constexpr std::uint32_t kTapeStream = 1;
  std::vector<Vec3> positions_mm;
  for (std::size_t k = 0; k < rig_.leds.leds.size(); ++k) {
    const auto n = static_cast<std::uint32_t>(k);
    const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(seed), kTapeStream};
    const NormalPair xy = normal_pair(philox({n, 0, 0, 0}, key));
    const NormalPair z = normal_pair(philox({n, 1, 0, 0}, key));
    const Vec3 off = error_mm * normalized({xy.first, xy.second, z.first});
    positions_mm.push_back(rig_.leds.leds[k].position_mm + off);
  }
  return positions_mm;
}

Calibration BareRig::start(const std::vector<Vec3>& taped_mm) const {
  Calibration start;
  start.subject = exact_calibration(scene_, rig_).subject;
  start.subject.albedo_scale = AlbedoScale::kRelative;
  start.camera = overhead_camera(rig_.camera.size, scene_.camera.distance_mm, scene_.camera.mm_per_pixel);
  start.response = response_of(rig_.sensor);
  NearLights lights;
  for (const Vec3 position : taped_mm) {
    NearLight& led = lights.leds.emplace_back();
    led.position_mm = position;
    led.aim = normalized(-1.0 * position);
    led.flux_rgb.fill(scene_.lights.flux);
  }
  start.lights = std::move(lights);
  return start;
}

}  // namespace weft::simulator
