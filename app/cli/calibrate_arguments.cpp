// SPDX-License-Identifier: Apache-2.0
#include "app/cli/calibrate_arguments.h"

#include <CLI/CLI.hpp>
#include <map>

namespace weft::app {
namespace {

// What every step that measures a part has.
template <typename Options>
CLI::App* add_step(CLI::App& calibrate, const char* name, const char* about, const char* input, Options& a) {
  CLI::App* verb = calibrate.add_subcommand(name, about);
  verb->add_option("input", a.input, input)->required();
  verb->add_option("--from", a.from, "Calibration whose other parts are kept; it is never changed");
  verb->add_option("-o,--output", a.output, "Folder of the new calibration, which must not exist")
      ->required();
  return verb;
}

void add_rig(CLI::App& verb, std::string& rig) {
  verb.add_option("--rig", rig, "Name of the rig, where there is no --from");
}

CLI::App* add_camera(CLI::App& calibrate, CalibrateCameraOptions& a) {
  CLI::App* verb = add_step(
      calibrate, "camera", "Lens and pose from photographs of a checkerboard or ChArUco board",
      "Folder of photographs of one board in many poses; those named table... show it flat on the table", a);
  add_rig(*verb, a.rig);
  BoardSettings& board = a.board;
  verb->add_option("--board", board.kind, "What is printed; default that of board.toml")
      ->check(CLI::IsMember({"charuco", "checkerboard"}));
  verb->add_option("--squares-x", board.squares_x, "Squares a row")->check(CLI::Range(2, 100));
  verb->add_option("--squares-y", board.squares_y, "Squares a column")->check(CLI::Range(2, 100));
  verb->add_option("--square-mm", board.square_mm, "Side of a square, mm")->check(CLI::PositiveNumber);
  verb->add_option("--marker-share", board.marker_share, "ChArUco: side of a marker over that of a square")
      ->check(CLI::Range(0.1, 0.95));
  verb->add_option("--dictionary", board.dictionary, "ChArUco: as OpenCV names it, DICT_5X5_100");
  verb->add_option("--thickness-mm", board.thickness_mm, "Of the board: the table is so far below its print")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--tags", a.tag_dictionary, "Dictionary of the tags on the table")->capture_default_str();
  verb->add_option("--most-blur", a.most_blur_px, "Photographs with wider edges are left out, pixels")
      ->check(CLI::Range(1.0, 100.0))
      ->capture_default_str();
  verb->add_option("--least-boards", a.least_boards, "Fewer usable photographs are refused")
      ->check(CLI::Range(3, 1000))
      ->capture_default_str();
  verb->add_option("--most-focal-percent", a.most_focal_percent,
                   "Boards too alike are refused: predicted sigma of the focal length, percent")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  return verb;
}

CLI::App* add_response(CLI::App& calibrate, CalibrateResponseOptions& a) {
  CLI::App* verb = add_step(
      calibrate, "response", "What counts say of light: noise, black level, linearity, bad photosites",
      "Folder with dark/, led01/, led02/, led01+led02/, scale/ of raw frames of a still scene", a);
  add_rig(*verb, a.rig);
  return verb;
}

CLI::App* add_color(CLI::App& calibrate, CalibrateColorOptions& a, std::vector<double>& corners) {
  CLI::App* verb =
      add_step(calibrate, "color", "From the camera's channels to linear Rec.709, by a 24-patch chart",
               "Photograph or session of the chart, or a folder of them", a);
  add_rig(*verb, a.rig);
  verb->add_option(
          "--corners", corners,
          "Outer corners of patches 1, 6, 24, 19 in pixels: x,y,x,y,x,y,x,y; default: found by itself")
      ->delimiter(',')
      ->expected(8);
  verb->add_flag("--curve", a.curve, "Affine, cubic, affine in xyY in place of a 3 x 3 matrix");
  return verb;
}

CLI::App* add_lights(CLI::App& calibrate, CalibrateLightsOptions& a, std::string& method) {
  CLI::App* verb = add_step(
      calibrate, "lights", "Where the LEDs are and how they shine, from white paper in five or more poses",
      "Folder of sessions (*.weft) of a sheet with tags, sheet.toml and, where measured anew, rig.toml", a);
  verb->add_option(
          "--method", method,
          "physical (a model of each LED), per-pixel (directions cell by cell), seed (the iteration of "
          "the paper that this scanner follows, on one flat sheet)")
      ->check(CLI::IsMember({"physical", "per-pixel", "seed"}))
      ->capture_default_str();
  verb->add_option("--tape-sigma", a.tape_sigma_mm, "How well positions were measured, mm an axis")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  verb->add_option("--flatness", a.flatness_deg, "Rms waviness of the sheet, degrees")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
  verb->add_flag("--lambertian", a.lambertian, "Take the paper to follow Lambert's law");
  verb->add_flag("--accept-misfit", a.accept_misfit,
                 "Write the calibration although readings and model contradict each other");
  return verb;
}

// What a scan is looked at for: both kinds of check, and update.
void add_evidence(CLI::App& verb, std::filesystem::path& from, std::filesystem::path& sheet,
                  const char* about_sheet, std::optional<double>& paper_delta) {
  verb.add_option("--from", from, "The calibration in question; default each session's own");
  verb.add_option("--sheet", sheet, about_sheet);
  verb.add_option(
          "--paper-delta", paper_delta,
          "The paper reflects 1 - delta (1 - cosine) of Lambert's law; default as the lights' report has it")
      ->check(CLI::Range(-0.5, 1.0));
}

CLI::App* add_check(CLI::App& calibrate, CalibrateCheckOptions& a, CheckRigOptions& rig) {
  CLI::App* verb = calibrate.add_subcommand(
      "check",
      "Accept or refuse a calibration on sheets it was not fitted to; with --session, see what moved. Exit "
      "code 65 where it does not hold");
  CLI::Option* input = verb->add_option("input", a.input, "Session of a sheet, or a folder of sessions");
  verb->add_option("--session", rig.session, "Any scan that shows tags, white patches or the sheet")
      ->excludes(input);
  add_evidence(*verb, a.from, a.sheet,
               "sheet.toml of the sheet in the pictures; default that beside them, with --session no sheet",
               a.paper_delta);
  verb->add_option("-o,--output", a.output, "Folder for result and report; default nothing is written");
  verb->add_option("--square-px", a.square_px, "Side of the squares that are compared, pixels")
      ->check(CLI::Range(8, 512))
      ->capture_default_str();
  verb->add_option("--flat-limit", a.limits.flat_rms_deg, "Of flat sheets, rms degrees")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--tilted-limit", a.limits.tilted_rms_deg, "Of tilted sheets, rms degrees")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--gain-limit", a.limits.slope_gain, "Of the slope gain, off 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--drift-limit", a.limits.drift, "Of a LED that is lit once more, relative")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  return verb;
}

CLI::App* add_grey(CLI::App& calibrate, CalibrateGreyOptions& a) {
  CLI::App* verb = calibrate.add_subcommand(
      "grey",
      "How bright each LED is by channel, and its white balance, from a grey scale of known reflectances");
  verb->add_option("session", a.session, "A scan of the scale, flat on the table")->required();
  verb->add_option("--scale", a.scale, "scale.toml: where it lies; default beside the session");
  verb->add_option("--from", a.from, "The calibration to change; default the session's own");
  verb->add_option("-o,--output", a.output, "Folder of the new calibration, which must not exist")
      ->required();
  return verb;
}

CLI::App* add_patches(CLI::App& calibrate, CalibratePatchesOptions& a) {
  CLI::App* verb = calibrate.add_subcommand(
      "patches", "White patches beside the cloth, by which later scans tell drift and moves");
  verb->add_option("session", a.session, "A scan of the table while the calibration is fresh")->required();
  verb->add_option("--patches", a.patches, "patches.toml: where they lie; default beside the session");
  verb->add_option("--from", a.from, "The calibration to add them to; default the session's own");
  verb->add_option(
          "--paper-delta", a.paper_delta,
          "The paper reflects 1 - delta (1 - cosine) of Lambert's law; default as the lights' report has it")
      ->check(CLI::Range(-0.5, 1.0));
  verb->add_option("-o,--output", a.output, "Folder of the new calibration, which must not exist")
      ->required();
  return verb;
}

CLI::App* add_update(CLI::App& calibrate, CalibrateUpdateOptions& a) {
  CLI::App* verb = calibrate.add_subcommand("update", "Fit again what moved, the rest held by its prior");
  verb->add_option("session", a.session, "A scan after the move that shows tags, white patches or the sheet")
      ->required();
  add_evidence(*verb, a.from, a.sheet, "sheet.toml of the sheet in the pictures; default no sheet",
               a.paper_delta);
  verb->add_option("-o,--output", a.output, "Folder of the new calibration, which must not exist")
      ->required();
  return verb;
}

CLI::App* add_history(CLI::App& calibrate, CalibrateHistoryOptions& a) {
  CLI::App* verb = calibrate.add_subcommand("history", "What was measured of a rig over time");
  verb->add_option("rig", a.rig, "Folder that holds calibrations and results of checks")->required();
  verb->add_option("--affected", a.sessions,
                   "Folder of sessions: lists those shot between the last check that passed and a move");
  verb->add_option("-o,--output", a.output, "Folder to make for the page; default none");
  return verb;
}

}  // namespace

std::vector<CLI::App*> add_calibrate(CLI::App& app, CalibrateForms& forms) {
  CLI::App* calibrate = app.add_subcommand("calibrate", "Measure a rig; each step writes a new calibration");
  calibrate->require_subcommand(1);
  return {add_camera(*calibrate, forms.camera),
          add_response(*calibrate, forms.response),
          add_color(*calibrate, forms.color, forms.chart_corners),
          add_lights(*calibrate, forms.lights, forms.lights_method),
          add_check(*calibrate, forms.check, forms.check_rig),
          add_grey(*calibrate, forms.grey),
          add_patches(*calibrate, forms.patches),
          add_update(*calibrate, forms.update),
          add_history(*calibrate, forms.history)};
}

CalibrateArguments chosen_step(const CLI::App& calibrate, const CalibrateForms& forms) {
  const std::string step = calibrate.get_subcommands().front()->get_name();
  if (step == "camera") return forms.camera;
  if (step == "response") return forms.response;
  if (step == "lights") {
    static const std::map<std::string, LightsMethod> methods = {{"physical", LightsMethod::kPhysical},
                                                                {"per-pixel", LightsMethod::kPerPixel},
                                                                {"seed", LightsMethod::kSeed}};
    CalibrateLightsOptions lights = forms.lights;
    lights.method = methods.at(forms.lights_method);
    return lights;
  }
  if (step == "grey") return forms.grey;
  if (step == "patches") return forms.patches;
  if (step == "update") return forms.update;
  if (step == "history") return forms.history;
  if (step == "check") {
    if (forms.check_rig.session.empty()) return forms.check;
    CheckRigOptions rig = forms.check_rig;
    rig.from = forms.check.from;
    rig.sheet = forms.check.sheet;
    rig.output = forms.check.output;
    rig.paper_delta = forms.check.paper_delta;
    return rig;
  }
  CalibrateColorOptions color = forms.color;
  if (const std::vector<double>& c = forms.chart_corners; !c.empty()) {
    color.corners_px = {{{c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}}};
  }
  return color;
}

}  // namespace weft::app
