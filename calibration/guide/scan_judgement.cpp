// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/scan_judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibration/color/chart.h"
#include "calibration/lights/paper_evenness.h"
#include "calibration/run/chart_pictures.h"
#include "capture/raw/decode_raw.h"
#include "capture/scan/histogram.h"
#include "core/rig/calibration.h"

namespace weft::calibration {
namespace {

/// A lamp whose light is subtracted still flickers, and takes a share of the counts.
constexpr double kMostRoom = 0.05;
constexpr int kEachOf = 3;

const Shot* first_of(const Session& session, ShotRole role) {
  const auto found = std::ranges::find_if(
      session.shots, [role](const Shot& shot) { return shot.role == role && !shot.superseded_by; });
  return found == session.shots.end() ? nullptr : &*found;
}

/// The sum of every third LED's photograph, linear.
Result<Image<float>> lit_picture(const Session& session, const std::filesystem::path& from) {
  const Result<Calibration> before = read_calibration(from);
  std::optional<Image<float>> sum;
  int lit = 0;
  for (const Shot& shot : session.shots) {
    if (shot.role != ShotRole::kLit || shot.superseded_by || lit++ % kEachOf != 0) continue;
    Result<ChartPicture> picture =
        read_chart_picture(session.path_of(shot), before ? &*before : nullptr, from, {});
    if (!picture) return picture.error();
    if (!sum) {
      sum = std::move(picture->rgb);
      continue;
    }
    for (int plane = 0; plane < 3; ++plane) {
      const View<float> to = sum->plane(plane);
      const View<const float> more = std::as_const(picture->rgb).plane(plane);
      for (int y = 0; y < to.height(); ++y) {
        for (int x = 0; x < to.width(); ++x) to(x, y) += more(x, y);
      }
    }
  }
  if (sum) return std::move(*sum);
  return Error{ErrorKind::kBadData, "no LED was lit", session.folder.string(), "", "scan it once more"};
}

}  // namespace

std::string lamp_in(const Session& session) {
  const Shot* dark = first_of(session, ShotRole::kDark);
  if (dark == nullptr) return "";
  const Result<RawFrame> frame = capture::decode_raw(session.path_of(*dark));
  if (!frame) return frame.error().message();
  const double bright = capture::brightness_of(*frame).bright;
  if (bright <= kMostRoom) return "";
  return fmt::format(
      "a lamp of the room is on: without any LED the picture is {:.0f} percent full, {:.0f} may be",
      100 * bright, 100 * kMostRoom);
}

std::string unevenness_of(const Session& session, const CameraModel& camera, const TaggedSheet& sheet,
                          const SheetPose& pose) {
  int lit = 0;
  for (const Shot& shot : session.shots) {
    if (shot.role != ShotRole::kLit || shot.superseded_by || lit++ % kEachOf != 0) continue;
    const Result<RawFrame> frame = capture::decode_raw(session.path_of(shot));
    if (!frame) return frame.error().message();
    const auto uneven = find_unevenness(*frame, camera, sheet.sheet, pose.rig_from_sheet);
    if (!uneven) continue;
    return fmt::format(
        "the paper is not smooth: under LED {} it is {:.0f} percent {} around ({:.0f}, {:.0f}) than "
        "it should be; a fold, a stain or a shadow",
        shot.led, 100 * std::abs(uneven->departure), uneven->departure > 0 ? "brighter" : "darker",
        uneven->at.x, uneven->at.y);
  }
  return "";
}

ChartLook look_at_chart_scan(const Session& session, const std::filesystem::path& set,
                             const std::filesystem::path& from) {
  const Result<Image<float>> picture = lit_picture(session, from);
  if (!picture) return {picture.error().message(), ""};
  const auto corners = find_chart(*picture);
  if (!corners) return {"no chart was found in the picture: " + corners.error().why, ""};
  const Size size = picture->size();
  std::vector<std::array<double, 2>> outline;
  for (const auto& [x, y] : *corners) outline.push_back({(x + 0.5) / size.width, (y + 0.5) / size.height});
  const auto patches = read_patches(*picture, *corners);
  if (!patches) return {patches.error().message(), "", outline};
  const Result<ChartColors> colors = read_chart_colors(set);
  if (!colors) return {colors.error().message(), "", outline};
  if (const Result<void> known = check_measured(*picture, *colors, session.folder.filename().string());
      !known)
    return {known.error().message(), "", outline};
  const ChartSide side = side_of(*patches, colors->reference);
  if (side == ChartSide::kMirrored)
    return {"the chart is mirrored: its columns or rows run backwards", "", outline};
  if (side == ChartSide::kNoChart)
    return {"this is not the chart: its patches do not have the colours that they should", "", outline};
  const bool runs_left = (*corners)[1][0] < (*corners)[0][0];
  const bool is_turned = runs_left != (side == ChartSide::kUpsideDown);
  return {"", is_turned ? "it lies upside down, and is read so" : "", outline};
}

}  // namespace weft::calibration
