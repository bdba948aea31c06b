// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/export_request.h"

#include "core/describe/described_fields.h"

namespace weft::exchange {

void describe(Fields& fields, ExportRequest& r) {
  ExportOptions& e = r.options;
  fields.value({.name = "input",
                .says = "Session folder; folder of a set of maps, a built material or a solve; material: "
                        "FILE.toml, library:NAME",
                .option = "",
                .said = Said::kAtThisMachine},
               e.input);
  fields.value(
      {.name = "presets",
       .says = "Which files: names of --list, or files that end in .toml (docs/exports.md), by commas",
       .option = "--preset"},
      e.presets);
  describe_output(fields, e.output,
                  "Folder; of several presets it gets one for each. Default SESSION/export/PRESET");
  fields.value({.name = "maps",
                .says = "Id of the set of maps; default the newest of the session's current solve",
                .said = Said::kAtThisMachine},
               e.maps);
  fields.value({"draft", "Maps of a preview will do, of half the size and without masks"}, e.is_draft);
  fields.value({"name", "Of the cloth, in file names; default as it is called"}, e.name);
  fields.value({.name = "size_px",
                .says = "Pixels of the longer side; default as many as there are",
                .range = {1, 1 << 20}},
               e.size_px);
  fields.value({.name = "mm_per_pixel",
                .says = "Of a solve of photographs: what a pixel of them is wide on the cloth, kept for all "
                        "that is made of it",
                .range = {1e-4, 100},
                .option = "--mm-per-pixel",
                .said = Said::kAtThisMachine},
               e.mm_per_pixel);
  fields.value({.name = "dx10", .says = "DDS files with headers of DX10 alone, which say sRGB"}, e.is_dx10);
  fields.value({.name = "list", .says = "Only list the presets", .said = Said::kAtThisMachine}, r.lists);
  fields.value({.name = "show",
                .says = "Only print a preset as TOML, to begin one of your own with",
                .said = Said::kAtThisMachine},
               r.shown);
  fields.value({.name = "explain",
                .says = "Only say what each file and each format costs and loses on this cloth",
                .said = Said::kAtThisMachine},
               r.only_explains);
  fields.value({.name = "to_deg",
                .says = "Degrees that normals may lose in the mean, as 0.1 or 0.1deg: chooses their bits",
                .range = {1e-9, 90},
                .units = {{"deg"}, {""}}},
               e.to_deg);
  fields.value({.name = "within_s",
                .says = "Seconds that writing the textures may take one thread: chooses the bits with which "
                        "normals lose least",
                .range = kAboveZero},
               e.within_s);
  fields.exclude("to_deg", "within_s");
}

}  // namespace weft::exchange
