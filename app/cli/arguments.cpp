// SPDX-License-Identifier: Apache-2.0
#include "app/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <map>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"

namespace weft::app {
namespace {

void add_common(CLI::App& verb, CommonArguments& common) {
  verb.add_flag("--json", common.json, "Print one JSON document on standard output");
  verb.add_flag("-q,--quiet", common.quiet, "No progress on standard error");
  verb.add_option("--threads", common.threads, "Threads; 0 is all the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
}

CLI::App* add_simulate(CLI::App& app, SimulateArguments& a) {
  CLI::App* verb =
      app.add_subcommand("simulate", "Render a scene (TOML) into a session of raw DNG frames with its truth");
  verb->add_option("scene", a.scene, "Scene file; docs/scenes.md lists its keys and units")->required();
  verb->add_option("-o,--output", a.output,
                   "Session folder to make, NAME.weft, which must not exist; with --led the DNG file, with "
                   "--captures the folder of the parts")
      ->required();
  CLI::Option* led =
      verb->add_option("--led", a.led, "Render one frame alone: of this LED, 0 for the dark shot")
          ->check(CLI::NonNegativeNumber);
  verb->add_flag("--explain", a.explain,
                 "List the passes that run and why, the effects left out with what they would change and "
                 "cost, and after the run what each pass cost")
      ->excludes(led);
  verb->add_option("--captures", a.parts,
                   "Take what calibrating this scene's rig needs, a folder a part: all, or some of start, "
                   "camera, response, color, lights, check")
      ->delimiter(',')
      ->expected(0, 6)
      ->excludes(led);
  return verb;
}

// The levels, or the methods for comparison.
std::vector<std::string> names_of(bool quality) {
  std::vector<std::string> names;
  for (const solver::MethodName& name : solver::method_names()) {
    if (name.is_quality == quality) names.emplace_back(name.name);
  }
  return names;
}

CLI::App* add_solve(CLI::App& app, SolveArguments& a, CommonArguments& common, std::string& quality,
                    std::string& method, std::string& transfer, std::vector<int>& lights) {
  CLI::App* verb = app.add_subcommand(
      "solve", "Turn a session, or photographs under known lights, into albedo and normals");
  CLI::Option* session = verb->add_option("session", a.session.folder, "Session folder, NAME.weft");
  CLI::Option* photos = verb->add_option(
      "--photos", a.photos.folder,
      "Folder of photographs under distant lights: filenames.txt, light_directions.txt (unit x y z, "
      "x right, y up, z to the camera), light_intensities.txt (R G B), mask.png");
  CLI::Option* light_file = verb->add_option(
      "--lp", a.photos.light_file, "RTI light file: a count, then a line \"file x y z\" a photograph");
  session->excludes(photos)->excludes(light_file);
  photos->excludes(light_file);
  CLI::Option* level =
      verb->add_option(
              "--quality", quality,
              "Level: preview (half size, no masks), fast (least squares without shadows), standard "
              "(weighted, misfits rejected; default), robust (for highlights), reference (in double, "
              "shadows and light between yarns taken out where the cloth needs it)")
          ->check(CLI::IsMember(names_of(true)));
  CLI::Option* by_name =
      verb->add_option(
              "--method", method,
              "Method for comparison: seed (four systems a pixel by SVD, after demosaicing), "
              "least-squares (every valid reading), wls (weighted), l1 (least absolute residuals), sbl "
              "(sparse errors), lts (least trimmed squares)")
          ->check(CLI::IsMember(names_of(false)))
          ->excludes(level);
  CLI::Option* explain = verb->add_flag(
      "--explain", a.explain,
      "Solve nothing: predict, from sample tiles, each level's mean error in degrees and its seconds here");
  CLI::Option* within = verb->add_option("--within", a.wish.within_seconds,
                                         "Choose the best level that takes so many seconds, by --explain")
                            ->check(CLI::PositiveNumber);
  CLI::Option* to = verb->add_option("--to", a.wish.to_deg,
                                     "Choose the cheapest level expected to be so many degrees off at most")
                        ->check(CLI::PositiveNumber);
  CLI::Option* ladder =
      verb->add_option("--ladder", a.ladder,
                       "Solve by every level, and draw the same 128 x 128 normals of each into this PNG")
          ->needs(session);
  for (CLI::Option* priced : {explain, within, to, ladder}) priced->excludes(level)->excludes(by_name);
  ladder->excludes(explain)->excludes(within)->excludes(to);
  verb->add_option("--lights", lights,
                   "LEDs or photographs to solve from, numbered from 1: 1,4,7; default all")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  verb->add_option("--calibration", a.session.calibration, "Calibration folder; default the session's own")
      ->needs(session);
  verb->add_option(
          "--transfer", transfer,
          "How photographs follow light: auto (16-bit and float linear, 8-bit and JPEG sRGB), linear, srgb")
      ->check(CLI::IsMember({"auto", "linear", "srgb"}))
      ->capture_default_str();
  CLI::Option* output =
      verb->add_option("-o,--output", a.options.output,
                       "Folder for the maps; default SESSION/solve/ID, or ./NAME-solve/ID for photographs");
  for (CLI::Option* unsaved : {explain, ladder}) unsaved->excludes(output);
  verb->add_option("--compress", a.options.compression, "Of EXR files: none, zip, piz")
      ->check(CLI::IsMember({"none", "zip", "piz"}))
      ->capture_default_str();
  verb->add_option("--tile-width", a.options.tile.width, "Columns a tile (changes no byte of the result)")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  verb->add_option("--tile-height", a.options.tile.height, "Rows a tile (changes no byte of the result)")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  verb->add_flag("!--no-previews", a.options.previews, "Write no pictures");
  verb->add_flag("--strict", common.strict, "Exit with 2 where pixels have no solution");
  return verb;
}

CLI::App* add_compare(CLI::App& app, CompareArguments& a, std::string& kind) {
  CLI::App* verb = app.add_subcommand("compare", "Compare a map with the truth: degrees, or relative albedo");
  verb->add_option("tested", a.tested, "Map to test (EXR, TIFF, PNG)")->required();
  verb->add_option("truth", a.truth, "Map that is right")->required();
  verb->add_option("--mask", a.mask, "Image that is over one half where pixels count");
  verb->add_option("--kind", kind, "What the maps are: normal, albedo")
      ->check(CLI::IsMember({"normal", "albedo"}))
      ->capture_default_str();
  return verb;
}

CLI::App* add_bench_solve(CLI::App& bench, BenchSolveArguments& a) {
  CLI::App* verb = bench.add_subcommand("solve", "Speed and exactness of the solver");
  verb->add_option("--megapixels", a.megapixels, "Size of the photographs, millions of pixels")
      ->check(CLI::Range(0.01, 200.0))
      ->capture_default_str();
  CLI::Option* exact =
      verb->add_flag("--exact", a.exact, "Noise-free errors against the truth instead of speed");
  CLI::Option* noise = verb->add_flag("--noise", a.noise, "Errors under noise against the Cramer-Rao bound");
  CLI::Option* order = verb->add_flag("--order", a.order, "Demosaicing before solving against after it");
  CLI::Option* end_to_end =
      verb->add_flag("--end-to-end", a.end_to_end, "From eleven DNG files to maps on disk, with peak memory");
  exact->excludes(noise)->excludes(order)->excludes(end_to_end);
  noise->excludes(order)->excludes(end_to_end);
  order->excludes(end_to_end);
  return verb;
}

CLI::App* add_bench_effects(CLI::App& bench, BenchEffectsArguments& a) {
  CLI::App* verb = bench.add_subcommand("effects", "Cost, error and pictures of the simulator's effects");
  CLI::Option* size = verb->add_option("--megapixels", a.megapixels, "Size of a frame, millions of pixels")
                          ->check(CLI::Range(0.01, 200.0))
                          ->capture_default_str();
  CLI::Option* rays = verb->add_flag("--rays", a.rays, "Error and time of sampled effects at 1 to 4096 rays");
  CLI::Option* embree = verb->add_flag("--embree", a.embree, "Shadow and bounce rays against bare Embree");
  CLI::Option* choice = verb->add_flag(
      "--auto", a.choice, "What effects = \"auto\" at 0.25 sigma changes and saves against all effects");
  CLI::Option* gallery =
      verb->add_option("--gallery", a.gallery, "Folder for a picture of each effect off and on");
  rays->excludes(embree)->excludes(choice)->excludes(gallery)->excludes(size);
  embree->excludes(choice)->excludes(gallery)->excludes(size);
  choice->excludes(gallery)->excludes(size);
  gallery->excludes(size);
  return verb;
}

CLI::App* add_bench_numerics(CLI::App& bench, BenchNumericsArguments& a) {
  CLI::App* verb = bench.add_subcommand(
      "numerics", "Pixels that are numerically hard: errors, flags and what solved them");
  CLI::Option* curve =
      verb->add_flag("--curve", a.curve, "Error against condition number instead of the cases");
  CLI::Option* docs =
      verb->add_option("--docs", a.docs, "Folder with numerics.md, whose tables and pictures to make again");
  verb->add_option("--scenes", a.scenes, "Folder with torture.toml")->capture_default_str()->needs(docs);
  curve->excludes(docs);
  return verb;
}

CLI::App* add_bench_accuracy(CLI::App& bench, BenchAccuracyArguments& a, std::string& set) {
  CLI::App* verb = bench.add_subcommand("accuracy", "What each level and method gets right, and its price");
  verb->add_flag("--quick", a.quick, "One small patch a scene, no yardsticks");
  verb->add_option("--set", set, "Scenes: those that methods are tuned on, or those held out")
      ->check(CLI::IsMember({"tuning", "held-out"}))
      ->capture_default_str();
  verb->add_option("--scene", a.scene, "One scene alone, such as \"deep satin\"");
  verb->add_option("--method", a.methods, "These levels and methods alone: fast,least-squares")
      ->delimiter(',');
  CLI::Option* bound = verb->add_flag(
      "--bound", a.bound, "Instead: scatter against the Cramer-Rao bound, and whether sigma is honest");
  CLI::Option* leds = verb->add_flag("--leds", a.leds, "Instead: from three to ten LEDs");
  CLI::Option* specular = verb->add_flag("--specular", a.specular,
                                         "Instead: who says SPECULAR on 30 dark satins and 90 other cloths");
  CLI::Option* docs = verb->add_option(
      "--docs", a.docs,
      "All of it, into this folder: the figures of accuracy.md, pictures/accuracy.svg, .json");
  bound->excludes(leds)->excludes(specular)->excludes(docs);
  leds->excludes(specular)->excludes(docs);
  specular->excludes(docs);
  return verb;
}

CLI::App* add_bench_explain(CLI::App& bench, BenchExplainArguments& a, std::string& set) {
  CLI::App* verb = bench.add_subcommand("explain", "Errors that solve --explain predicts against true ones");
  verb->add_flag("--quick", a.quick, "One small patch a scene");
  verb->add_option("--set", set, "Scenes: those that the prediction is fitted to, or those held out")
      ->check(CLI::IsMember({"tuning", "held-out"}))
      ->capture_default_str();
  return verb;
}

CLI::App* add_bench_photos(CLI::App& bench, BenchPhotosArguments& a) {
  CLI::App* verb = bench.add_subcommand("photos", "Errors on real photographs under known distant lights");
  verb->add_option("folder", a.folder,
                   "Photographs in the layout of the DiLiGenT benchmark, with normal_gt.exr")
      ->required();
  verb->add_option("--pick", a.pick, "Well-spread lights a subset; 0 is all of them")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--subsets", a.subsets, "Subsets to average over")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb->add_option("--seed", a.seed, "Of the subsets")->capture_default_str();
  verb->add_option("--method", a.methods, "These levels and methods alone: fast,least-squares")
      ->delimiter(',');
  return verb;
}

CLI::App* add_bench_height(CLI::App& bench, BenchHeightArguments& a) {
  CLI::App* verb = bench.add_subcommand("height", "Error, time and memory from normals to heights");
  verb->add_option("--megapixels", a.megapixels, "Size of the normal map, millions of pixels")
      ->check(CLI::Range(0.01, 200.0))
      ->capture_default_str();
  return verb;
}

CLI::App* add_bench_transport(CLI::App& bench, BenchTransportArguments& a) {
  CLI::App* verb = bench.add_subcommand("transport", "Shadow and gather rays of the solver: time and error");
  verb->add_option("--megapixels", a.megapixels, "Size of the height map, millions of pixels")
      ->check(CLI::Range(0.01, 200.0))
      ->capture_default_str();
  return verb;
}

CLI::App* add_rectify(CLI::App& app, RectifyOptions& a) {
  CLI::App* verb =
      app.add_subcommand("rectify", "Put the maps of a solve on a square grid of the table, lens removed");
  verb->add_option("session", a.session, "Session folder, NAME.weft")->required();
  verb->add_option("--solve", a.solve, "Id of the solve; default the newest complete one");
  verb->add_option("--calibration", a.calibration, "Calibration folder; default the session's own");
  verb->add_option("-o,--output", a.output, "Folder for the maps; default SESSION/rectified/ID");
  verb->add_option("--mm-per-pixel", a.mm_per_pixel, "Of the grid; default what the camera sees")
      ->check(CLI::PositiveNumber);
  verb->add_option("--turn", a.turn_deg, "Degrees that the grid is turned, counterclockwise from above")
      ->check(CLI::Range(-360.0, 360.0))
      ->capture_default_str();
  verb->add_option("--compress", a.compression, "Of EXR files: none, zip, piz")
      ->check(CLI::IsMember({"none", "zip", "piz"}))
      ->capture_default_str();
  return verb;
}

CLI::App* add_bench_calibration(CLI::App& bench, BenchCalibrationArguments& a) {
  CLI::App* verb = bench.add_subcommand("calibration", "What calibrating a simulated rig recovers");
  verb->add_option("--part", a.part, "camera, response, color, lights, grey, degenerate, moved, end-to-end")
      ->check(CLI::IsMember(
          {"camera", "response", "color", "lights", "grey", "degenerate", "moved", "end-to-end"}))
      ->capture_default_str();
  verb->add_option("--seeds", a.seeds, "Rigs or noises to average over; 0 is as many as docs/calibration.md")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  verb->add_option("--docs", a.docs, "With --part lights: folder for pictures/calibration_poses.svg");
  return verb;
}

CLI::App* add_bench_capture(CLI::App& bench, BenchCaptureArguments& a) {
  CLI::App* verb = bench.add_subcommand("capture", "Scans: their speed, and what faults do to them");
  verb->add_option(
          "--part", a.part,
          "board, camera, scans: of the rig of --rig; faults: the fault matrix, on virtual rigs that "
          "it starts; http: a daemon among hostile clients")
      ->check(CLI::IsMember({"board", "camera", "scans", "faults", "http"}))
      ->capture_default_str();
  verb->add_option("--rig", a.rig, "Rig file; default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
  verb->add_option("--runs", a.runs,
                   "Commands, shots, scans, runs or requests; 0 is as many as docs/reliability.md")
      ->check(CLI::Range(0, 1000000));
  verb->add_option("--scene", a.scene, "Scene of the fault matrix")->capture_default_str();
  verb->add_option("--megapixels", a.megapixels, "Size of its frames, millions of pixels")
      ->check(CLI::Range(0.05, 200.0))
      ->capture_default_str();
  verb->add_option("--rigs", a.rigs, "Rigs side by side")->check(CLI::Range(1, 64))->capture_default_str();
  verb->add_option("--seed", a.seed, "Of shots and moments, or of malformed requests")->capture_default_str();
  verb->add_option("--fault", a.faults, "These faults alone, by their names in the table");
  verb->add_option("--keep", a.keep, "Folder for the sessions and logs of runs that went wrong");
  return verb;
}

CLI::App* add_demo(CLI::App& app, DemoArguments& a) {
  CLI::App* verb = app.add_subcommand("demo", "Scan a simulated cloth, solve it and show the result");
  verb->add_option("scene", a.scene, "Scene file (TOML)")->required();
  verb->add_option("-o,--output", a.output, "Folder for the session and its maps")->capture_default_str();
  verb->add_option("--megapixels", a.megapixels, "Size instead of the scene's, millions of pixels")
      ->check(CLI::Range(0.01, 200.0));
  return verb;
}

}  // namespace

std::optional<Arguments> parse_arguments(int argc, char** argv, int& exit_code) {
  CLI::App app("weft: photometric-stereo textile scanner");
  app.name("weft");
  app.set_version_flag("--version", WEFT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 2 done with warnings under --strict, 64 usage, 65 bad data, 66 no input, 69 "
      "device not there,\n"
      "70 our own bug, 73 cannot create, 74 input/output, 75 try again, 76 protocol, 130 interrupted.");

  CommonArguments common;
  SimulateArguments simulate;
  SolveArguments solve;
  CompareArguments compare;
  BenchSolveArguments bench_solve;
  BenchEffectsArguments bench_effects;
  BenchTransportArguments bench_transport;
  BenchHeightArguments bench_height;
  BenchNumericsArguments bench_numerics;
  BenchAccuracyArguments bench_accuracy;
  BenchExplainArguments bench_explain;
  BenchPhotosArguments bench_photos;
  BenchCalibrationArguments bench_calibration;
  BenchCaptureArguments bench_capture;
  DemoArguments demo;
  RigForms rig;
  CalibrateForms calibrate;
  RectifyOptions rectify;
  std::string quality, method, transfer = "auto", kind = "normal", set = "held-out";
  std::vector<int> lights;
  CLI::App* simulate_verb = add_simulate(app, simulate);
  CLI::App* solve_verb = add_solve(app, solve, common, quality, method, transfer, lights);
  CLI::App* compare_verb = add_compare(app, compare, kind);
  const std::vector<CLI::App*> calibrate_steps = add_calibrate(app, calibrate);
  CLI::App* calibrate_verb = calibrate_steps.front()->get_parent();
  CLI::App* rectify_verb = add_rectify(app, rectify);
  const RigVerbs rig_verbs = add_rig_verbs(app, rig);
  CLI::App* bench_verb = app.add_subcommand("bench", "Measure");
  bench_verb->require_subcommand(1);
  CLI::App* bench_solve_verb = add_bench_solve(*bench_verb, bench_solve);
  CLI::App* bench_effects_verb = add_bench_effects(*bench_verb, bench_effects);
  CLI::App* bench_numerics_verb = add_bench_numerics(*bench_verb, bench_numerics);
  CLI::App* bench_accuracy_verb = add_bench_accuracy(*bench_verb, bench_accuracy, set);
  CLI::App* bench_explain_verb = add_bench_explain(*bench_verb, bench_explain, set);
  CLI::App* bench_photos_verb = add_bench_photos(*bench_verb, bench_photos);
  CLI::App* bench_height_verb = add_bench_height(*bench_verb, bench_height);
  CLI::App* bench_registration_verb = bench_verb->add_subcommand(
      "registration", "Shots registered to each other: shift, error, cost and gain on three weaves");
  CLI::App* bench_transport_verb = add_bench_transport(*bench_verb, bench_transport);
  CLI::App* bench_calibration_verb = add_bench_calibration(*bench_verb, bench_calibration);
  CLI::App* bench_capture_verb = add_bench_capture(*bench_verb, bench_capture);
  CLI::App* demo_verb = add_demo(app, demo);
  for (CLI::App* verb : {simulate_verb,
                         solve_verb,
                         compare_verb,
                         rectify_verb,
                         bench_solve_verb,
                         bench_effects_verb,
                         bench_numerics_verb,
                         bench_accuracy_verb,
                         bench_explain_verb,
                         bench_photos_verb,
                         bench_height_verb,
                         bench_transport_verb,
                         bench_registration_verb,
                         bench_calibration_verb,
                         bench_capture_verb,
                         demo_verb,
                         rig_verbs.serve,
                         rig_verbs.scan,
                         rig_verbs.status,
                         rig_verbs.lights,
                         rig_verbs.test,
                         rig_verbs.doctor,
                         rig_verbs.copy}) {
    add_common(*verb, common);
  }
  for (CLI::App* step : calibrate_steps) {
    add_common(*step, common);
    step->add_flag("--strict", common.strict, "Exit with 2 where the report has something to say");
  }

  const auto usage = [&](const std::string& why) {
    note("weft: " + why + ". See weft --help.");
    exit_code = kUsageError;
    return std::nullopt;
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    const std::vector<std::string> unknown = app.remaining(/*recurse=*/true);
    // What is not known says more than what is then missing.
    if (!asked_for_help && !unknown.empty()) return usage(unknown.front() + " was not expected");
    exit_code = asked_for_help ? kDone : kUsageError;
    app.exit(error);
    return std::nullopt;
  }

  if (*simulate_verb) {
    simulate.captures = simulate_verb->count("--captures") > 0;
    std::erase_if(simulate.parts, [](const std::string& part) { return part.empty() || part == "all"; });
    return Arguments{common, simulate};
  }
  if (*compare_verb) {
    compare.albedo = kind == "albedo";
    return Arguments{common, compare};
  }
  if (*demo_verb) return Arguments{common, demo};
  if (*rectify_verb) return Arguments{common, rectify};
  if (*rig_verbs.serve) return Arguments{common, rig.serve};
  if (*rig_verbs.scan) return Arguments{common, rig.scan};
  if (*rig_verbs.doctor) return Arguments{common, rig.doctor};
  if (*rig_verbs.copy) return Arguments{common, rig.copy};
  if (*rig_verbs.rig) {
    rig.rig.task = *rig_verbs.lights ? RigTask::kLights : *rig_verbs.test ? RigTask::kTest : RigTask::kStatus;
    return Arguments{common, rig.rig};
  }
  if (*calibrate_verb) return Arguments{common, chosen_step(*calibrate_verb, calibrate)};
  if (*bench_numerics_verb) return Arguments{common, bench_numerics};
  if (*bench_accuracy_verb) {
    bench_accuracy.tuning = set == "tuning";
    return Arguments{common, bench_accuracy};
  }
  if (*bench_explain_verb) {
    bench_explain.tuning = set == "tuning";
    return Arguments{common, bench_explain};
  }
  if (*bench_photos_verb) return Arguments{common, bench_photos};
  if (*bench_height_verb) return Arguments{common, bench_height};
  if (*bench_registration_verb) return Arguments{common, BenchRegistrationArguments{}};
  if (*bench_calibration_verb) return Arguments{common, bench_calibration};
  if (*bench_capture_verb) return Arguments{common, bench_capture};
  if (*bench_transport_verb) return Arguments{common, bench_transport};
  if (*bench_effects_verb) return Arguments{common, bench_effects};
  if (*bench_verb) return Arguments{common, bench_solve};
  if (solve.session.folder.empty() && solve.photos.folder.empty() && solve.photos.light_file.empty()) {
    return usage("solve needs a session, --photos or --lp");
  }
  if (!method.empty()) solve.options.method = method;
  if (!quality.empty()) solve.options.method = quality;
  solve.session.leds = lights;
  solve.photos.lights = lights;
  static const std::map<std::string, Transfer> transfers = {
      {"auto", Transfer::kAuto}, {"linear", Transfer::kLinear}, {"srgb", Transfer::kSrgb}};
  solve.photos.transfer = transfers.at(transfer);
  return Arguments{common, solve};
}

}  // namespace weft::app
