// SPDX-License-Identifier: Apache-2.0
#include "library/import/import_request.h"

#include <algorithm>
#include <utility>

namespace weft::library {
namespace {

constexpr const char* kAutoBall = "auto";

void describe_rig(Fields& fields, ImportOptions& o) {
  fields.value({.name = "rig",
                .says = "Rig file: its calibration, its folder of sessions, its cloth height, where none is "
                        "named",
                .said = Said::kAtThisMachine},
               o.rig);
  fields.value({.name = "calibration",
                .says = "Calibration folder of the rig that took the photographs",
                .path = PathTo::kFolder},
               o.calibration);
  fields.value({.name = "output",
                .says = "Archive: the folder for sessions; default the rig's",
                .option = "-o,--output",
                .said = Said::kAtThisMachine},
               o.archive);
  fields.value({.name = "pattern",
                .says = "What names say: {session}/{fabric}_{led}.{ext}; also {index}, {any}; LED 0 or dark "
                        "is no LED",
                .is_sentence = true},
               o.pattern);
  fields.choice({.name = "order",
                 .says = "What tells LEDs: auto (numbers in names, else times and names where they agree), "
                         "time, name, light (the LED that explains a frame's brightness)"},
                o.order, kFrameOrderNames);
  fields.choice({.name = "link", .says = "How a session has its frames: hard (links), copy, symbolic"},
                o.link, kFrameLinkNames);
  fields.value({.name = "gap_s",
                .says = "Seconds between two sessions in one folder",
                .range = kAboveZero,
                .option = "--gap"},
               o.gap_s);
  fields.value({.name = "height_mm",
                .says = "Of the cloth's surface above the table, where no import.toml says it; default the "
                        "rig's, or 0",
                .option = "--height"},
               o.cloth_height_mm);
  fields.value(
      {.name = "missing",
       .says = "Take sessions that lack LEDs, where names or the light tell which, and photographs that lack "
               "some of their lights'"},
      o.takes_missing);
}

void describe_balls(Fields& fields, ImportRequest& r) {
  fields.value({.name = "ball",
                .says = "Tell the lights of photographs from a chrome, glossy or matt ball in them; each "
                        "folder is then one session"},
               r.has_ball);
  fields.value({.name = "ball_folder",
                .says = "Photographs of the ball alone under the same lamps, by name or in the same order",
                .path = PathTo::kFolder},
               r.balls.ball_folder);
  fields.value({.name = "ball_kind",
                .says = "What the ball is: auto, chrome, glossy, matt. Strengths of a mirror need it",
                .words = {kAutoBall, "chrome", "glossy", "matt"}},
               r.ball_kind);
  fields.value({.name = "ball_mm",
                .says = "Diameter of the balls, mm: two of them tell where lamps are; 0: not known",
                .range = kNotNegative,
                .option = "--ball-mm"},
               r.balls.ball.ball_mm);
}

}  // namespace

ImportOptions ImportRequest::options() const {
  ImportOptions options = import;
  if (!has_ball && balls.ball_folder.empty()) return options;
  options.balls = balls;
  options.balls->ball.fov_deg = import.reading.fov_deg.value_or(0);
  const auto kind = std::ranges::find(calibration::kBallKindNames, ball_kind);
  if (kind != calibration::kBallKindNames.end())
    options.balls->ball.kind = static_cast<calibration::BallKind>(kind - calibration::kBallKindNames.begin());
  return options;
}

void describe(Fields& fields, ImportRequest& r) {
  fields.value({.name = "folders",
                .says = "Folders of raws (NEF, CR2, DNG ...), linear TIFF or EXR frames, or photographs with "
                        "a light file",
                .need = kMustSay,
                .path = PathTo::kFolder,
                .option = ""},
               r.import.folders);
  describe_rig(fields, r.import);
  describe_balls(fields, r);
  describe(fields, r.import.reading);
  fields.value({.name = "dark",
                .says = "Of photographs that no rig took, the one with all lamps off",
                .path = PathTo::kFile},
               r.import.dark);
  fields.value({.name = "dry_run",
                .says = "Print the table of what was decided, and import nothing",
                .said = Said::kAtThisMachine},
               r.dry_run);
  fields.value({.name = "yes", .says = "Import without a question", .said = Said::kAtThisMachine}, r.yes);
  fields.exclude("yes", "dry_run");
}

}  // namespace weft::library
