// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/table/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/spectra/spectrum.h"
#include "virtual_rig/table/said.h"

namespace weft::virtual_rig {
namespace {

using simulator::BareRig;
using simulator::Scene;
using simulator::TargetSettings;

constexpr double kRulerSquare_mm = 5;
constexpr int kRulerSquares = 20;
constexpr double kFoldShare = 0.4, kFold_mm = 8;  // of the sheet's width; how broad it is

constexpr Sayable kTilt = {"tilt", 0, 80, 0}, kAzimuth = {"azimuth", -360, 360, 0},
                  kTurn = {"turn", -360, 360, 0}, kX = {"x", -10000, 10000, 0}, kY = {"y", -10000, 10000, 0},
                  kHeight = {"height", 0, 1000, 0}, kColumns = {"columns", 3, 100, 0},
                  kRows = {"rows", 3, 100, 0}, kMirrored = {"mirrored", 0, 1, 0},
                  kReflectance = {"reflectance", 0, 1, 0}, kFold = {"fold", 0, 45, 0},
                  kOther = {"other", 0, 1, 0}, kAbove = {"height", 0.1, 200, 8};

simulator::CapturePose pose_of(const SaidValues& said, double above_mm) {
  return {.tilt_deg = said(kTilt),
          .azimuth_deg = said(kAzimuth),
          .rotation_deg = said(kTurn),
          .above_mm = above_mm + said(kHeight)};
}

/// A thing that is tilted, turned and shifted as was said, its lowest corner `above_mm` over the table.
TargetSettings placed(TargetSettings thing, const SaidValues& said, double above_mm) {
  thing.centre_mm = {said(kX), said(kY), 0};
  return simulator::resting(std::move(thing), pose_of(said, above_mm));
}

std::vector<TargetSettings> board(const BareRig& rig, const SaidValues& said) {
  TargetSettings board = rig.flat_board();
  auto& pattern = std::get<simulator::CharucoSettings>(board.pattern);
  pattern.squares_x = static_cast<int>(said.value(kColumns).value_or(pattern.squares_x));
  pattern.squares_y = static_cast<int>(said.value(kRows).value_or(pattern.squares_y));
  pattern.mirrored = said(kMirrored) != 0;
  return {placed(board, said, board.centre_mm.z)};
}

std::vector<TargetSettings> sheet(const BareRig& rig, const SaidValues& said) {
  TargetSettings paper = rig.paper();
  paper.white = said.value(kReflectance).value_or(paper.white);
  simulator::SheetLayout layout = rig.sheet();
  layout.x_mm += said(kX), layout.y_mm += said(kY);
  std::vector<TargetSettings> things =
      simulator::laid(layout, pose_of(said, simulator::CapturePose().above_mm), paper, said(kOther) == 0);
  if (said(kFold) > 0) {
    paper.pattern = simulator::PaperSettings{.width_mm = kFoldShare * layout.width_mm, .height_mm = kFold_mm};
    paper.centre_mm = {layout.x_mm, layout.y_mm, 0};
    const simulator::CapturePose on_sheet = {
        .tilt_deg = said(kFold), .azimuth_deg = 90, .above_mm = simulator::CapturePose().above_mm + 0.01};
    things.insert(things.begin(), simulator::resting(paper, on_sheet));
  }
  return things;
}

std::vector<TargetSettings> chart(const BareRig& rig, const SaidValues& said) {
  return {placed(rig.chart(), said, rig.chart().centre_mm.z)};
}

std::vector<TargetSettings> scale(const BareRig& rig, const SaidValues& said) {
  return {placed(rig.grey_scale(), said, rig.grey_scale().centre_mm.z)};
}

std::vector<TargetSettings> trap(const BareRig& rig, const SaidValues&) {
  return rig.trap();
}

std::vector<TargetSettings> ruler(const BareRig&, const SaidValues& said) {
  TargetSettings ruler;
  ruler.pattern = simulator::CheckerboardSettings{
      .squares_x = kRulerSquares, .squares_y = 2, .square_mm = kRulerSquare_mm, .margin_mm = 1};
  return {placed(ruler, said, 1)};
}

std::vector<TargetSettings> nothing(const BareRig&, const SaidValues&) {
  return {};
}

struct Thing {
  const char* name;
  std::vector<Sayable> settings;
  std::vector<TargetSettings> (*laid)(const BareRig& rig, const SaidValues& said);
  std::string does;
};

const std::vector<Thing>& things() {
  const std::vector<Sayable> anyhow = {kTilt, kAzimuth, kTurn, kX, kY, kHeight};
  const auto and_more = [&](const std::vector<Sayable>& more) {
    std::vector<Sayable> all = anyhow;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  static const std::vector<Thing> kThings = {
      {"board", and_more({kColumns, kRows, kMirrored}), board,
       "the ChArUco board of targets/board.toml, or one of so many columns= and rows=, mirrored=1: from "
       "behind"},
      {"sheet", and_more({kReflectance, kOther, kFold}), sheet,
       "the white sheet of targets/sheet.toml, other=1: another one alike, or of another reflectance=; "
       "fold=: a crease of so many degrees in its middle, where it lies flat"},
      {"scale", anyhow, scale, "the grey scale of targets/scale.toml"},
      {"chart", anyhow, chart, "the colour chart of targets/chart.toml, where the scene has spectra"},
      {"trap", {}, trap, "a sheet with a black trap in its middle"},
      {"ruler", anyhow, ruler,
       fmt::format("{} squares of {:g} mm in two rows", kRulerSquares, kRulerSquare_mm)},
      {"empty", {}, nothing, "nothing but the table's own tags and patches"},
  };
  return kThings;
}

const std::vector<Sayable>& of_blade() {
  static const std::vector<Sayable> kOfBlade = {kX, kY, kTurn, kAbove};
  return kOfBlade;
}

/// The same cloth under a blade.
Scene with_blade(Scene scene, const SaidValues& said) {
  scene.blade = {.lies = true,
                 .x_mm = said(kX),
                 .y_mm = said(kY),
                 .turn_deg = said.value(kTurn).value_or(simulator::BladeSettings().turn_deg),
                 .height_mm = said.value(kAbove).value_or(simulator::BladeSettings().height_mm)};
  return scene;
}

/// Dyes for a cloth that has none, as grey as it is green.
void dye(simulator::MaterialSettings& material) {
  if (material.dye || material.warp_dye || material.weft_dye) return;
  const auto dyed = [](const Rgb& albedo) { return simulator::flat_spectrum(albedo[1]); };
  material.dye = dyed(material.albedo);
  if (material.warp_albedo) material.warp_dye = dyed(*material.warp_albedo);
  if (material.weft_albedo) material.weft_dye = dyed(*material.weft_albedo);
  if (material.warp_dye || material.weft_dye) {
    material.warp_dye = material.warp_dye.value_or(*material.dye);
    material.weft_dye = material.weft_dye.value_or(*material.dye);
    material.dye.reset();
  }
  material.warp_albedo.reset();
  material.weft_albedo.reset();
}

/// The rig of one scene under the cloth of another.
Scene with_cloth_of(const Scene& other, Scene scene) {
  scene.fabric = other.fabric;
  scene.geometry = other.geometry;
  scene.material = other.material;
  if (scene.effects.spectral) dye(scene.material);
  simulator::EffectSettings& on = scene.effects;
  on.relief = other.effects.relief;
  on.cast_shadows = other.effects.cast_shadows;
  on.interreflection = other.effects.interreflection;
  on.translucency = other.effects.translucency;
  on.reflectance = other.effects.reflectance;
  return scene;
}

Error no_such_thing(const std::string& word) {
  std::vector<std::string> names = {"cloth [SCENE]", "blade"};
  for (const Thing& each : things()) names.emplace_back(each.name);
  return {ErrorKind::kUsage, "no such thing", word,
          fmt::format("on the table can lie {}", fmt::join(names, ", ")), "choose one of these"};
}

}  // namespace

Result<RigTable> RigTable::of(const Scene& scene) {
  Result<BareRig> bare = BareRig::of(scene);
  if (!bare) return std::move(bare).error();
  return RigTable(scene, std::move(*bare));
}

Result<Scene> RigTable::with(const std::vector<std::string>& words) const {
  if (words.empty()) return no_such_thing("table");
  const std::vector<std::string> of_it(words.begin() + 1, words.end());
  if (words[0] == "cloth" && of_it.size() <= 1) {
    if (of_it.empty()) return scene_;
    const Result<Scene> other = simulator::read_scene(of_it[0]);
    if (!other) return other.error();
    return with_cloth_of(*other, scene_);
  }
  if (words[0] == "blade") {
    const Result<SaidValues> said = SaidValues::of(of_it, of_blade());
    if (!said) return said.error();
    return with_blade(scene_, *said);
  }
  const auto thing = std::find_if(things().begin(), things().end(),
                                  [&](const Thing& each) { return words[0] == each.name; });
  if (thing == things().end()) return no_such_thing(words[0]);
  if (words[0] == "chart" && !bare_.has_chart()) {
    return Error{ErrorKind::kUsage, "this rig has no colour chart", "table chart",
                 "its scene names no spectra.chart, or not the effect spectral",
                 "start a rig of testdata/scenes/rig.toml"};
  }
  const Result<SaidValues> said = SaidValues::of(of_it, thing->settings);
  if (!said) return said.error();
  return bare_.with(thing->laid(bare_, *said));
}

std::vector<CommandWords> table_words() {
  std::vector<CommandWords> all = {
      {"table cloth [SCENE]", "the cloth of the rig's scene, or of another scene file, lies on the table",
       "table cloth"},
      {"table blade ...",
       "a blade lies level over the cloth of the rig's scene: one edge through x= and y=, turn= degrees from "
       "x "
       "towards y, the blade to its left, height= mm above the cloth",
       "table blade x=3 turn=240"}};
  for (const Thing& each : things()) {
    const std::string line = fmt::format("table {}", each.name);
    all.push_back({line, "on it lies " + each.does, line});
  }
  all.push_back(
      {"table THING ...",
       "board, sheet, scale, chart and ruler lie as tilt=, azimuth= (of the tilt), turn= (degrees), "
       "x=, y= (of the centre) and height= (above the table, mm) say",
       "table board tilt=30 azimuth=90"});
  return all;
}

}  // namespace weft::virtual_rig
