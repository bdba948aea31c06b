// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/camera/markers.h"
#include "calibration/guide/owned_target.h"
#include "calibration/guide/sheet_lay.h"
#include "calibration/run/board_photographs.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

// What a person lays things by: where on the table the light falls and the calibration holds, and what is
// seen of tags and a board in the finder. Places in a picture are shares of its width and height, from its
// upper left corner, since a finder has fewer pixels than a photograph.

namespace weft::calibration {

/// A number for each cell of the frame, row by row.
struct FrameGrid {
  int columns = 0, rows = 0;  ///< 0: nothing is known
  std::vector<double> values;
};

/// A tag, or a board's outline, in shares of the picture.
struct FramedShape {
  std::string name;                 ///< "DICT_APRILTAG_36h11 3"
  std::vector<PixelPoint> corners;  ///< clockwise
};

/// What a calibration knows of the frame.
struct KnownFrame {
  CameraModel camera;
  double width_mm = 0, height_mm = 0;  ///< of the table in sight, along the frame's middle lines
  FrameGrid light;  ///< what level white cloth reads over all LEDs, of the brightest cell's; 0 to 1
  /// Predicted error of a normal 20 degrees steep, degrees; where calibrate lights has told.
  FrameGrid normal_deg;
  std::vector<Fiducial> fiducials;
};

/// Errors: those of read_calibration(); kBadData where it knows no camera.
Result<KnownFrame> known_frame(const std::filesystem::path& calibration);

/// What a person is about to lay there.
struct AimedThing {
  std::optional<PrintedBoard> board;
  std::optional<SheetAim> sheet;
  std::vector<OwnedTarget> owned;  ///< by the rig: named where they lie there instead
};

/// What a picture shows.
struct SeenFrame {
  std::vector<FramedShape> tags;
  /// How far tags that the calibration knows are from where it has them, rms; none where none is in sight.
  std::optional<double> off_mm;
  int fiducials = 0;                 ///< that these are
  std::optional<FramedShape> board;  ///< around the corners that were found of it
  int corners = 0;
  std::optional<FramedShape> sheet;  ///< around it
  std::string says;  ///< to the person: what is seen, and how a sheet lies otherwise than asked
};

/// Looks at a picture of the finder (JPEG) for tags of the table, and for what is to be laid there. kProtocol
/// where it is no picture.
Result<SeenFrame> seen_frame(const std::string& jpeg, const std::optional<KnownFrame>& known,
                             const AimedThing& aim);

/// {"width_mm", "height_mm", "light", "normal_deg" {"columns", "rows", "values"}, "tags" [{"name",
/// "corners"}]}.
Json json_of(const KnownFrame& known);
/// {"tags", "off_mm", "fiducials", "board", "corners", "sheet", "says"}.
Json json_of(const SeenFrame& seen);

}  // namespace weft::calibration
