// SPDX-License-Identifier: Apache-2.0
#include "bench/program/studies.h"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "app/cli/exit_code.h"
#include "bench/batch/batch_studies.h"
#include "bench/calibration/calibration_studies.h"
#include "bench/effects/effects_studies.h"
#include "bench/export/export_studies.h"
#include "bench/maps/maps_studies.h"
#include "bench/numerics/numerics.h"
#include "bench/server/server_studies.h"
#include "bench/solve/solve_studies.h"

namespace weft::bench {
namespace {

app::Option add_size(app::Options& options, const Choice& choice, double megapixels, const char* help) {
  choice->options.megapixels = megapixels;
  return options.add("--megapixels", &choice->options.megapixels, help).in_range(0.01, 200.0).shows_default();
}

app::Run add_solve(app::Options& options) {
  std::vector<app::Option> instead;
  const Choice choice =
      by_flag(options,
              {{"speed", "", solve_speed},
               {"exact", "Noise-free errors against the truth instead of speed", solve_exactness},
               {"noise", "Errors under noise against the Cramer-Rao bound", solve_noise},
               {"order", "Demosaicing before solving against after it", solve_order},
               {"end-to-end", "From eleven DNG files to maps on disk, with peak memory", end_to_end}},
              &instead);
  add_size(options, choice, 4, "Size of the photographs, millions of pixels");
  exclude_each_other(instead);
  return run_of(choice);
}

app::Run add_effects(app::Options& options) {
  const auto gallery = std::make_shared<std::filesystem::path>();
  std::vector<app::Option> instead;
  const Choice choice = by_flag(
      options,
      {{"cost", "",
        [gallery](const StudyOptions& o) {
          return gallery->empty() ? effects_cost(o) : effects_gallery(*gallery, o.threads);
        }},
       {"rays", "Error and time of sampled effects at 1 to 4096 rays", effects_rays},
       {"embree", "Shadow and bounce rays against bare Embree", effects_embree},
       {"auto", "What effects = \"auto\" at 0.25 sigma changes and saves against all effects", effects_auto}},
      &instead);
  instead.push_back(add_size(options, choice, 1, "Size of a frame, millions of pixels"));
  instead.push_back(
      options.add("--gallery", gallery.get(), "Folder for a picture of each effect off and on"));
  exclude_each_other(instead);
  return run_of(choice);
}

app::Run add_numerics(app::Options& options) {
  std::vector<app::Option> instead;
  const Choice choice = by_flag(options,
                                {{"cases", "", [](const StudyOptions&) { return numerics_cases(); }},
                                 {"curve", "Error against condition number instead of the cases",
                                  [](const StudyOptions&) { return numerics_curve(); }}},
                                &instead);
  const auto docs = std::make_shared<std::filesystem::path>();
  instead.push_back(options.add("--docs", docs.get(),
                                "Folder with measured/numerics.md: its tables and pictures, made again"));
  options.add("--scenes", &choice->options.scenes, "Folder with torture.toml")
      .shows_default()
      .needs(instead.back());
  exclude_each_other(instead);
  return [=](const app::CommonArguments& common) -> Result<int> {
    if (docs->empty()) return run_of(choice)(common);
    if (Result<void> written = write_numerics_docs(*docs, choice->options.scenes); !written)
      return written.error();
    return app::kDone;
  };
}

app::Run add_height(app::Options& options) {
  const Choice choice = by_flag(options, {{"height", "", height_speed}});
  add_size(options, choice, 4, "Size of the normal map, millions of pixels");
  return run_of(choice);
}

app::Run add_registration(app::Options& options) {
  return run_of(by_flag(options, {{"registration", "", registration}}));
}

app::Run add_transport(app::Options& options) {
  const Choice choice = by_flag(options, {{"transport", "", transport}});
  add_size(options, choice, 1, "Size of the height map, millions of pixels");
  return run_of(choice);
}

app::Run add_maps(app::Options& options) {
  const Choice choice =
      by_part(options,
              {{"height", "normals to heights in tiles and as a whole", maps_height, {.megapixels = 4}},
               {"scans", "heights of solved normals, and of true ones", maps_scans, {.megapixels = 0.125}},
               {"flatten", "slow errors of slopes, removed in each way", maps_flatten},
               {"occlusion", "line sweeps and horizon steps against rays", maps_occlusion, {.megapixels = 1}},
               {"mips", "rules of roughness mips against shaded pixels", maps_mips},
               {"figures", "figures 17 to 20 of the scanner's paper as numbers", maps_figures},
               {"detail", "normals of a detail layer on a base", maps_detail},
               {"gloss", "roughness of a detail layer on a base", maps_gloss},
               {"opacity", "coverage from a light below", maps_opacity}});
  options
      .add("--megapixels", &choice->options.megapixels,
           "Size of the map that times are of; 0 is that of docs/maps.md")
      .in_range(0.0, 200.0)
      .shows_default();
  return run_of(choice);
}

app::Run add_export(app::Options& options) {
  const Choice choice = by_part(
      options,
      {{"blocks", "textures of blocks: what they lose of a solved cloth, and how fast", export_blocks},
       {"presets", "seconds and megabytes of each preset on a tile of 2048 x 2048", export_presets},
       {"losses", "what normals and albedo lose in every format", export_losses}});
  choice->options.scene = "testdata/scenes/export_satin.toml";
  options.add("--scene", &choice->options.scene, "Scene of the cloth").shows_default();
  return run_of(choice);
}

/// For the docs, photographs are not timed: the picture has none of it.
Result<Rows> lights_for_docs(StudyOptions options, const std::filesystem::path& docs) {
  options.megapixels = 0;
  Result<Rows> rows = calibration_lights_table(options);
  if (!rows) return rows;
  if (Result<void> written = write_calibration_docs(docs, *rows); !written) return std::move(written).error();
  return rows;
}

app::Run add_calibration(app::Options& options) {
  const auto docs = std::make_shared<std::filesystem::path>();
  const Choice choice = by_part(
      options,
      {{"camera", "lens and pose", calibration_camera_table, {.megapixels = 16, .runs = 50}},
       {"response", "noise and black level", calibration_response_table, {.runs = 3}},
       {"color", "a chart through filters", calibration_color_table},
       {"lights",
        "where LEDs are",
        [docs](const StudyOptions& o) {
          return docs->empty() ? calibration_lights_table(o) : lights_for_docs(o, *docs);
        },
        {.megapixels = 16, .runs = 5}},
       {"grey", "fluxes and white balances by a chart of greys", calibration_grey_table, {.runs = 200}},
       {"moved", "what moved since", calibration_moved_table, {.runs = 50}},
       {"watched", "which knocks the scan after them tells", calibration_watched_table, {.runs = 200}},
       {"degenerate", "captures that cannot say what is asked", calibration_degenerate_table, {.runs = 20}},
       {"end-to-end", "what all of it together leaves of errors", calibration_end_to_end_table}});
  options
      .add("--seeds", &choice->options.runs,
           "Rigs or noises to average over; 0 is as many as docs/measured/calibration.md")
      .in_range(0, 10000)
      .shows_default();
  options.add("--docs", docs.get(), "With --part lights: folder for pictures/calibration_poses.svg");
  return [=](const app::CommonArguments& common) -> Result<int> {
    if (docs->empty() || choice->part == "lights") return run_of(choice)(common);
    return Error{ErrorKind::kUsage, "part has no pictures", "--docs", "only the part lights makes one",
                 "give --part lights, or leave --docs out"};
  };
}

app::Run add_server(app::Options& options) {
  const Choice choice =
      by_part(options, {{"lease",
                         "how soon a LED is dark once its client or the daemon has died",
                         server_lease_table,
                         {.runs = 100}},
                        {"door",
                         "answers beside malformed requests, silent clients and slow readers",
                         door_table,
                         {.runs = 200}},
                        {"library",
                         "answers with tens of thousands of sessions, which it makes in a temporary folder",
                         server_library_table,
                         {.runs = 50}},
                        {"scan",
                         "a scan beside malformed requests, silent clients and slow readers, over one alone",
                         scan_beside_table,
                         {.megapixels = 1, .runs = 10}},
                        {"tiles",
                         "what a viewer waits for, of maps of 16 and 100 megapixels",
                         server_tiles_table,
                         {.runs = 400}},
                        {"viewers",
                         "a scan beside two who look at tiles, over one alone",
                         viewers_table,
                         {.megapixels = 1, .runs = 10}}});
  options
      .add("--runs", &choice->options.runs,
           "Trials of each death, requests or tiles of each row, or pairs of scans; 0 is as many as "
           "docs/measured/reliability.md")
      .in_range(0, 1000000);
  options.add("--seed", &choice->options.seed, "Of the moments, or of malformed requests").shows_default();
  return run_of(choice);
}

app::Run add_batch(app::Options& options) {
  struct Most {
    int jobs = 1, kills = 100;
  };
  const auto most = std::make_shared<Most>();
  const Choice choice = by_part(
      options, {{"local",
                 "sessions by a batch against one process that solves them in turn",
                 [most](const StudyOptions& o) { return batch_local(o, most->jobs); },
                 {.megapixels = 1, .runs = 200}},
                {"plan", "a plan of 10 000 sessions", batch_plan, {.megapixels = 0.05, .runs = 10'000}},
                {"merge", "a report of 10 000 results", batch_merge, {.runs = 10'000}},
                {"kills",
                 "a batch that is killed at random moments",
                 [most](const StudyOptions& o) { return batch_kills(o, most->kills); },
                 {.megapixels = 0.05, .runs = 400}},
                {"rigs",
                 "40 sessions by three rigs, one calibrated wrongly",
                 batch_rigs,
                 {.megapixels = 1, .runs = 40}},
                {"farm",
                 "a million sessions on 100 nodes, simulated, and the simulation against 200 tasks here",
                 batch_farm,
                 {.megapixels = 0.05, .runs = 200}}});
  choice->options.scene = "testdata/scenes/twill.toml";
  options.add("--scene", &choice->options.scene, "Scene of the sessions").shows_default();
  options.add("--sessions", &choice->options.runs, "How many; 0 is as the part has it").not_negative();
  options.add("--megapixels", &choice->options.megapixels, "Of a session; 0 is as the part has it")
      .not_negative();
  options.add("--jobs", &most->jobs, "Local: sessions at a time").in_range(1, 256).shows_default();
  options.add("--kills", &most->kills, "Kills: how many").not_negative().shows_default();
  return run_of(choice);
}

}  // namespace

std::vector<app::Verb> verbs() {
  return {{"solve", "Speed and exactness of the solver", add_solve},
          {"effects", "Cost, error and pictures of the simulator's effects", add_effects},
          {"numerics", "Pixels that are numerically hard: errors, flags and what solved them", add_numerics},
          accuracy_verb(),
          explain_verb(),
          photos_verb(),
          cloths_verb(),
          forecast_verb(),
          sanity_verb(),
          frames_verb(),
          {"height", "Error, time and memory from normals to heights", add_height},
          {"registration",
           "Shots registered to each other: what a moved one costs and gets back, and what gloss feigns",
           add_registration},
          {"transport", "Light between yarns by horizons and by rays: time and error", add_transport},
          {"maps", "Derived maps of a cloth: error and price of each way to make them", add_maps},
          {"export", "Exports of a cloth: what each encoding loses, and how fast it is written", add_export},
          {"calibration", "What calibrating a simulated rig recovers", add_calibration},
          capture_verb(),
          {"server", "The server: what it promises, measured", add_server},
          {"batch", "Batches: against one process, plans and reports of 10 000 sessions, kills, a farm",
           add_batch},
          page_verb()};
}

}  // namespace weft::bench
