// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/color/chart_reference.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

// Pictures of a colour chart, linear in the camera's channels.

namespace weft::calibration {

/// A photograph of the chart under some lamp, or the solved albedo of a session.
struct ChartPicture {
  std::filesystem::path source;
  bool is_albedo = false;  ///< solved: evenly lit, with the white balance of the LEDs
  double pixels = 2;       ///< of the source to one of the picture, across
  Image<float> rgb;        ///< planes R, G, B; +infinity where the sensor was full
  ShotMetadata camera;     ///< what a raw photograph says; else empty
};

/// The files and sessions to look at: `input` itself if it is a session or a picture, else what lies in it by
/// name. kNoInput if there is none.
Result<std::vector<std::filesystem::path>> list_chart_pictures(const std::filesystem::path& input);

/// Reads one. Raw photographs are made linear by the response of `from` (may be null) and taken at half size;
/// of a session (.weft) the albedo is solved by `standard` with the calibration folder `calibration` (empty:
/// its own), in the camera's channels, at half size; developed photographs must be linear, so JPEG is
/// refused.
Result<ChartPicture> read_chart_picture(const std::filesystem::path& file, const Calibration* from,
                                        const std::filesystem::path& calibration, const JobContext& context);

/// The reference colours: published ones of the classic chart, or those of chart.toml in `input` where there
/// is one. Its keys: `edition` ("2014", or "before 2014"), or 24 colours as `lab_d50` ([[L, a, b], ...]),
/// `rec709` (linear, white 1) or `srgb` (8 bits). kBadData names what is wrong.
struct ChartColors {
  ChartReference reference;
  std::string name;          ///< for people
  bool is_measured = false;  ///< chart.toml has them
};
Result<ChartColors> read_chart_colors(const std::filesystem::path& input);

/// Tags beside a chart that weft printed (weft target chart), whose colours are those of the printer.
inline constexpr const char* kPrintedChartDictionary = "DICT_APRILTAG_36h11";
inline constexpr int kPrintedChartTag = 572, kPrintedChartTags = 4;

/// kBadData, with `where`, of a picture of such a chart where nobody measured its colours.
Result<void> check_measured(const Image<float>& rgb, const ChartColors& colors, const std::string& where);

/// What chart.toml says of a chart whose colours are published.
struct ChartEdition {
  std::string edition = "2014";
};
void describe(Fields& fields, ChartEdition& chart);

}  // namespace weft::calibration
