// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/tiles.h"
#include "core/rig/calibration.h"
#include "simulator/effects/passes.h"
#include "simulator/scene/scene.h"

namespace weft::simulator {

/// How a simulation is run, beside what the scene says.
struct SimulateOptions {
  TileOptions tiles;  ///< tile size and threads: they change no byte
  std::stop_token stop;
  /// Called after each band of rows: of the truth, then of all frames together.
  std::function<void(int rows_done, int rows)> progress;
  std::optional<Calibration> calibration = {};  ///< what a session holds in the place of the exact one
  bool truth = true;                            ///< write truth/
  int takes_before = 0;  ///< photographs that the sensor took before: others draw other noise
};

/// What a simulation did.
struct SimulationReport {
  int frames = 0;
  double exposure_us = 0;
  std::vector<PassCost> passes;  ///< in the order they run
  std::vector<LeftOutEffect> left_out;
  double render_seconds = 0;  ///< wall time of the passes
  double write_seconds = 0;   ///< wall time of files: frames, truth, syncing
};

/// Renders a scene into a session folder: a lit frame for each LED, the retakes it asks for and a dark one as
/// DNG, session.json and the exact calibration. Under truth/ there are scene.toml, normal.exr (X, Y, Z),
/// albedo.exr (R, G, B) and height.exr (mm, above the plane cloth_height_mm). With cast shadows there is a
/// visibility_ledKK.exr for each LED, the share of the LED that each point sees. With interreflection there
/// is an indirect_ledKK.exr (R, G, B), the reading of a white surface by light from the cloth alone, and
/// openness.exr, the share of an even sky that each point sees by its transport.bounce_rays. Of a material
/// that has lobe_parameters_of() there are roughness.exr (roughness, the root of alpha, of two of their
/// geometric mean; alpha across the yarn; alpha_along; yarn_deg, its azimuth from x, 0 to 180, 0 where the
/// lobe has no direction) and specular.exr (R, G, B: f0). The same scene gives the same bytes. Memory holds a
/// band of rows of everything.
///
/// The folder is made aside, with its parents, and renamed when complete: after an error or an interrupt
/// there is nothing. Errors: kBadData (the scene), kCannotCreate (`session_folder` exists or may not be
/// made), kInputOutput (no room on the disk), kTryAgain (not enough memory free), kInterrupted.
Result<SimulationReport> simulate_session(const Scene& scene, const std::filesystem::path& session_folder,
                                          const SimulateOptions& options);

/// Adds to a session that was photographed of this scene the folder truth/ that simulate_session() writes,
/// but for what each LED has of its own. Errors as above.
Result<void> simulate_truth(const Scene& scene, const std::filesystem::path& session,
                            const SimulateOptions& options);

/// One frame alone, the same bytes as in the session: of a LED from 1, or with 0 the dark shot. Errors as
/// above; kUsage where the scene has no such LED.
Result<void> simulate_frame(const Scene& scene, int led, const std::filesystem::path& file,
                            const SimulateOptions& options);

/// A photograph that is no shot of a session.
struct PhotographSettings {
  std::vector<int> leds;              ///< lit at once, from 1; none: dark
  std::optional<double> exposure_us;  ///< whole; else the scene's. Another one than that gathers what
                                      ///< [camera.retakes] shutter_error says
};

/// Writes it as DNG. Errors as simulate_frame(); kUsage for a LED that is named twice.
Result<void> simulate_photograph(const Scene& scene, const PhotographSettings& photograph,
                                 const std::filesystem::path& file, const SimulateOptions& options);

/// Part of a simulated picture as numbers, without mosaic, converter or files.
struct Rendering {
  Image<double> readings;   ///< plane 3 k + c: light k, channel c; 1 is full scale per second at ISO 100
  Image<double> normal;     ///< planes X, Y, Z
  Image<double> albedo;     ///< planes R, G, B
  Image<double> height_mm;  ///< above the plane cloth_height_mm
};

/// Renders the pixels of `area`, which may reach beyond the scene's frame, for all LEDs. The scene's effects
/// apply.
Result<Rendering> render_readings(const Scene& scene, Rect area, const TileOptions& tiles = {});

}  // namespace weft::simulator
