// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/rig/calibration.h"
#include "simulator/captures_layout.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"

namespace weft::simulator {

/// The rig of a scene whose cloth is taken away, and what it is calibrated with: boards, sheets and charts to
/// lay on its table. The paper is that of the scene's first target of kind paper (a white patch). The scene's
/// tags and patches stay; where it has no tag there is one in each corner of the frame.
class BareRig {
 public:
  /// Errors: as plan_of().
  static Result<BareRig> of(const Scene& scene);

  const Scene& table() const { return scene_; }  ///< nothing on it but what stays
  const SceneRig& rig() const { return rig_; }
  const TargetSettings& paper() const { return paper_; }
  int leds() const { return static_cast<int>(rig_.leds.leds.size()); }

  /// The table with these things on it. What was there keeps its number behind them.
  Scene with(const std::vector<TargetSettings>& things) const;

  CharucoSettings board() const { return board_pattern(scene_); }
  TargetSettings flat_board() const;
  /// Large enough for the five poses and plane_pose().
  SheetLayout sheet() const;
  TargetSettings grey_scale() const;
  bool has_chart() const;  ///< the scene names spectra of its patches
  TargetSettings chart() const;
  /// A hole in the middle of a flat sheet that sends nothing back, and that sheet.
  std::vector<TargetSettings> trap() const;

  /// What people write about these things: board.toml, sheet.toml, scale.toml, chart.toml.
  std::string board_toml() const;
  std::string sheet_toml() const;
  std::string scale_toml() const;
  std::string chart_toml() const;

  /// The tags that stay on the table, exactly.
  std::vector<Fiducial> fiducials() const;
  /// The white patches that stay on the table and lie in the frame, exactly.
  std::vector<WhitePatch> patches() const;

  /// LED positions as a tape measure gives them: each off by `error_mm` in a random direction.
  std::vector<Vec3> taped(double error_mm, std::int64_t seed) const;
  /// What a calibration begins with: the camera as its data sheet has it, LEDs at these places, aimed at the
  /// table's centre.
  Calibration start(const std::vector<Vec3>& taped_mm) const;

 private:
  BareRig(Scene scene, SceneRig rig, TargetSettings paper)
      : scene_(std::move(scene)), rig_(std::move(rig)), paper_(std::move(paper)) {}

  Scene scene_;
  SceneRig rig_;
  TargetSettings paper_;
};

/// The sheet by which a calibration is checked: tilted.
CapturePose plane_pose();

}  // namespace weft::simulator
