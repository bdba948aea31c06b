// SPDX-License-Identifier: Apache-2.0
// The steps that measure a part of a rig.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/calibrate.h"
#include "app/jobs/calibrate/camera.h"
#include "app/jobs/calibrate/color.h"
#include "app/jobs/calibrate/grey.h"
#include "app/jobs/calibrate/lights.h"
#include "app/jobs/calibrate/response.h"

namespace weft::app {
namespace {

template <typename PartOptions>
void add_input(Options& options, PartOptions& a, const std::string& input) {
  options.add("input", &a.input, input).required();
  options.add("--from", &a.from, "Calibration whose other parts are kept; it is never changed");
}

template <typename PartOptions>
void add_folders(Options& options, PartOptions& a, const std::string& input) {
  add_input(options, a, input);
  options.add("-o,--output", &a.output, "Folder of the new calibration, which must not exist").required();
}

void add_rig_name(Options& options, std::string& rig) {
  options.add("--rig", &rig, "Name of the rig, where there is no --from");
}

void add_board(Options& options, BoardSettings& board) {
  options.add("--board", &board.kind, "What is printed; default that of board.toml")
      .one_of({"charuco", "checkerboard"});
  options.add("--squares-x", &board.squares_x, "Squares a row").in_range(calibration::kBoardSquares);
  options.add("--squares-y", &board.squares_y, "Squares a column").in_range(calibration::kBoardSquares);
  options.add("--square-mm", &board.square_mm, "Side of a square, mm").in_range(calibration::kBoardSquare_mm);
  options.add("--marker-share", &board.marker_share, "ChArUco: side of a marker over that of a square")
      .in_range(calibration::kMarkerShare);
  options.add("--dictionary", &board.dictionary, "ChArUco: as OpenCV names it, DICT_5X5_100");
  options.add("--thickness-mm", &board.thickness_mm, "Of the board: the table is so far below its print")
      .in_range(kBoardThickness_mm);
}

Run add_camera(Options& options) {
  const auto a = std::make_shared<CalibrateCameraOptions>();
  add_folders(
      options, *a,
      "Folder of photographs of one board in many poses; those named table... show it flat on the table");
  add_rig_name(options, a->rig);
  add_board(options, a->board);
  options.add("--tags", &a->tag_dictionary, "Dictionary of the tags on the table").shows_default();
  options.add("--most-blur", &a->most_blur_px, "Photographs with wider edges are left out, pixels")
      .in_range(1.0, 100.0)
      .shows_default();
  options.add("--least-boards", &a->least_boards, "Fewer usable photographs are refused")
      .in_range(3, 1000)
      .shows_default();
  options
      .add("--most-focal-percent", &a->most_focal_percent,
           "Boards too alike are refused: predicted sigma of the focal length, percent")
      .in_range(0.001, 10.0)
      .shows_default();
  return run_step(options, [a](const JobContext& context) { return calibrate_camera(*a, context); });
}

Run add_response(Options& options) {
  const auto a = std::make_shared<CalibrateResponseOptions>();
  add_folders(options, *a,
              "Folder with dark/, led01/, led02/, led01+led02/, scale/ of raw frames of a still scene");
  add_rig_name(options, a->rig);
  options.add("--trap", &a->trap,
              "Set of a black trap (weft capture trap): the lens's veil; default trap/ of input");
  return run_step(options, [a](const JobContext& context) { return calibrate_response(*a, context); });
}

Run add_color(Options& options) {
  const auto a = std::make_shared<CalibrateColorOptions>();
  const auto corners = std::make_shared<std::vector<double>>();
  add_folders(options, *a, "Photograph or session of the chart, or a folder of them");
  add_rig_name(options, a->rig);
  options
      .add("--corners", corners.get(),
           "Outer corners of patches 1, 6, 24, 19 in pixels: x,y,x,y,x,y,x,y; default: found by itself")
      .by_commas()
      .takes(8, 8);
  options.add_flag("--curve", &a->curve, "Affine, cubic, affine in xyY in place of a 3 x 3 matrix");
  return run_step(options, [a, corners](const JobContext& context) {
    if (const std::vector<double>& c = *corners; !c.empty())
      a->corners_px = {{{c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}}};
    return calibrate_color(*a, context);
  });
}

Run add_lights(Options& options) {
  const auto a = std::make_shared<CalibrateLightsOptions>();
  const auto method = std::make_shared<std::string>("physical");
  add_input(
      options, *a,
      "Folder of sessions (*.weft) of a sheet with tags, sheet.toml and, where measured anew, rig.toml");
  options.add("-o,--output", &a->output,
              "Folder of the new calibration, which must not exist; default none: only says what comes out");
  options
      .add("--method", method.get(),
           "physical (a model of each LED), per-pixel (directions cell by cell), seed (the iteration of "
           "the paper that this scanner follows, on one flat sheet)")
      .one_of({"physical", "per-pixel", "seed"})
      .shows_default();
  options.add("--tape-sigma", &a->tape_sigma_mm, "How well positions were measured, mm an axis")
      .in_range(kTapeSigma_mm)
      .shows_default();
  options.add("--flatness", &a->flatness_deg, "Rms waviness of the sheet, degrees")
      .in_range(kFlatness_deg)
      .shows_default();
  options
      .add("--flicker", &a->flicker_percent,
           "Flicker of LEDs from shot to shot, percent, where sheets do not tell")
      .in_range(kFlicker_percent)
      .shows_default();
  options.add_flag("--lambertian", &a->lambertian, "Take the paper to follow Lambert's law");
  options.add_flag("--accept-misfit", &a->accept_misfit,
                   "Write the calibration although readings and model contradict each other");
  return run_step(options, [a, method](const JobContext& context) {
    static const std::map<std::string, LightsMethod> methods = {{"physical", LightsMethod::kPhysical},
                                                                {"per-pixel", LightsMethod::kPerPixel},
                                                                {"seed", LightsMethod::kSeed}};
    a->method = methods.at(*method);
    return calibrate_lights(*a, context);
  });
}

Run add_grey(Options& options) {
  const auto a = std::make_shared<CalibrateGreyOptions>();
  options.add("session", &a->session, "A scan of the scale, flat on the table").required();
  options.add("--scale", &a->scale, "scale.toml: where it lies; default beside the session");
  options.add("--from", &a->from, "The calibration to change; default the session's own");
  options.add("-o,--output", &a->output, "Folder of the new calibration, which must not exist").required();
  return run_step(options, [a](const JobContext& context) { return calibrate_grey(*a, context); });
}

}  // namespace

Verb calibrate_camera_verb() {
  return {"camera", "Lens and pose from photographs of a checkerboard or ChArUco board", add_camera};
}

Verb calibrate_response_verb() {
  return {"response", "What counts say of light: noise, black level, linearity, bad photosites",
          add_response};
}

Verb calibrate_color_verb() {
  return {"color", "From the camera's channels to linear Rec.709, by a 24-patch chart", add_color};
}

Verb calibrate_lights_verb() {
  return {"lights", "Where the LEDs are and how they shine, from white paper in five or more poses",
          add_lights};
}

Verb calibrate_grey_verb() {
  return {"grey",
          "How bright each LED is by channel, and its white balance, from a grey scale of known reflectances",
          add_grey};
}

}  // namespace weft::app
