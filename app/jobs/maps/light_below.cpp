// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/light_below.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "app/jobs/raw_picture.h"
#include "app/jobs/session_frames.h"
#include "capture/raw/raw_info.h"
#include "material/rectify.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using material::MapKind;

// Of full scale: a table that is darker tells nothing of what covers it.
constexpr float kLeastLight = 0.01F;

const Shot* shot_below(const Session& session) {
  const auto found = std::ranges::find_if(
      session.shots, [](const Shot& shot) { return shot.role == ShotRole::kBelow && !shot.superseded_by; });
  return found == session.shots.end() ? nullptr : &*found;
}

Error unfit(const Session& session, std::string why) {
  return {ErrorKind::kBadData, "opacity cannot be measured", session.folder.string(), std::move(why),
          "scan cloth and bare table with the light below, at one exposure"};
}

Result<Image<float>> picture_of(const Session& session, const Shot& shot, const Calibration& calibration) {
  const Result<capture::RawInfo> header = capture::read_raw_info(session.path_of(shot));
  if (!header) return header.error();
  const Result<RawFrame> frame = read_raw_shot(session, shot, header->size);
  if (!frame) return frame.error();
  return half_size_picture(*frame, *calibration.response);
}

// Light from below by cell, all colours together, less the dark shot: shares of full scale.
Result<Image<float>> light_of(const Session& session, const Calibration& calibration) {
  const Shot* below = shot_below(session);
  if (below == nullptr) return unfit(session, "it has no photograph by the light below");
  const Shot* dark = session.dark();
  if (dark == nullptr) return unfit(session, "it has no dark shot");
  const Result<Image<float>> lit = picture_of(session, *below, calibration);
  if (!lit) return lit.error();
  const Result<Image<float>> unlit = picture_of(session, *dark, calibration);
  if (!unlit) return unlit.error();
  Image<float> light(lit->size());
  for (int y = 0; y < light.height(); ++y) {
    for (int x = 0; x < light.width(); ++x) {
      for (int c = 0; c < 3; ++c) light(x, y) += ((*lit)(x, y, c) - (*unlit)(x, y, c)) / 3;
    }
  }
  return light;
}

material::TableGrid grid_of(const Json& rectified) {
  return {{rectified["width"].get<int>(), rectified["height"].get<int>()},
          rectified["mm_per_pixel"].get<double>(),
          rectified["height_mm"].get<double>(),
          rectified["turn_deg"].get<double>(),
          rectified["centre_mm"][0].get<double>(),
          rectified["centre_mm"][1].get<double>()};
}

}  // namespace

bool has_light_below(const Session& session) {
  return shot_below(session) != nullptr;
}

Result<ThroughCloth> light_through_cloth(const Session& session, const fs::path& bare,
                                         const Calibration& calibration, const Json& rectified, int threads) {
  if (!calibration.response || !calibration.camera)
    return unfit(session, "the calibration has no camera.json or no response.json");
  const Result<Session> table = read_complete_session(bare);
  if (!table) return table.error();
  const Result<Image<float>> cloth_light = light_of(session, calibration);
  if (!cloth_light) return cloth_light.error();
  const Result<Image<float>> table_light = light_of(*table, calibration);
  if (!table_light) return table_light.error();
  const Shot &a = *shot_below(session), &b = *shot_below(*table);
  if (a.exposure_us != b.exposure_us || a.iso != b.iso) {
    return unfit(*table, fmt::format("it was exposed for {} us at ISO {}, the cloth for {} us at ISO {}",
                                     b.exposure_us, b.iso, a.exposure_us, a.iso));
  }
  const Size size = cloth_light->size();
  if (!(size == table_light->size())) return unfit(*table, "its photographs are of another size");
  // A share that a photograph is full in is infinite.
  Image<float> share(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float through = (*cloth_light)(x, y), open = (*table_light)(x, y);
      share(x, y) = open > kLeastLight ? through / open : std::numeric_limits<float>::quiet_NaN();
      if (std::isinf(through) || std::isinf(open)) share(x, y) = std::numeric_limits<float>::infinity();
    }
  }
  const material::TableGrid grid = grid_of(rectified);
  const CameraModel camera = material::reduced_camera(*calibration.camera, 2);
  const Image<std::uint16_t> all_solved(size);
  ThroughCloth through = {Image<float>(grid.size), Image<std::uint8_t>(grid.size)};
  Image<float> nearest(grid.size);
  const std::array<View<const float>, 1> seen = {share.plane()};
  const std::array<View<float>, 1> mean_out = {through.share.plane()}, nearest_out = {nearest.plane()};
  rectify_rows(camera, grid, MapKind::kValue, seen, all_solved.plane(), 0, threads, mean_out);
  rectify_rows(camera, grid, MapKind::kChoice, seen, all_solved.plane(), 0, threads, nearest_out);
  for (int y = 0; y < grid.size.height; ++y) {
    for (int x = 0; x < grid.size.width; ++x) {
      through.saturated(x, y) = std::isinf(nearest(x, y)) ? 1 : 0;
      if (!std::isfinite(nearest(x, y))) through.share(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return through;
}

}  // namespace weft::app
