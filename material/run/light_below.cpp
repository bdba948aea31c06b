// SPDX-License-Identifier: Apache-2.0
#include "material/run/light_below.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "capture/frames/raw_picture.h"
#include "capture/frames/session_frames.h"
#include "capture/raw/raw_info.h"
#include "core/rig/exposure_words.h"
#include "material/table_grid.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

// Share of full scale: a table that is darker tells nothing of what covers it.
constexpr float kLeastLight = 0.01F;
constexpr const char* kNoPhotograph = "it has no photograph by the light below";

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
  const Result<RawFrame> frame = capture::read_raw_shot(session, shot, header->size);
  if (!frame) return frame.error();
  return capture::half_size_picture(*frame, *calibration.response);
}

// Light from below by cell, all colours together, less the dark shot: shares of full scale.
Result<Image<float>> light_of(const Session& session, const Calibration& calibration) {
  const Shot* dark = session.dark();
  if (dark == nullptr) return unfit(session, "it has no dark shot");
  const Result<Image<float>> lit = picture_of(session, *shot_below(session), calibration);
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

TableGrid grid_of(const RectifyFacts& r) {
  return {r.size, r.mm_per_pixel, r.height_mm, r.turn_deg, r.centre_mm[0], r.centre_mm[1]};
}

Result<void> check_alike(const Session& cloth, const Session& table) {
  const Shot *a = shot_below(cloth), *b = shot_below(table);
  if (a == nullptr) return unfit(cloth, kNoPhotograph);
  if (b == nullptr) return unfit(table, kNoPhotograph);
  if (a->exposure_us == b->exposure_us && a->iso == b->iso) return {};
  return unfit(table,
               fmt::format("it was exposed for {} at ISO {}, the cloth for {} at ISO {}",
                           exposure_words(b->exposure_us), b->iso, exposure_words(a->exposure_us), a->iso));
}

// cloth / table by cell; infinite where a photograph is full, NaN where the table is dark.
Image<float> share_of(const Image<float>& cloth, const Image<float>& table) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Image<float> share(cloth.size());
  for (int y = 0; y < share.height(); ++y) {
    for (int x = 0; x < share.width(); ++x) {
      const float through = cloth(x, y), open = table(x, y);
      share(x, y) = open > kLeastLight ? through / open : std::numeric_limits<float>::quiet_NaN();
      if (std::isinf(through) || std::isinf(open)) share(x, y) = kInfinity;
    }
  }
  return share;
}

// Means say the share; the nearest cell says whether it can be told.
ThroughCloth on_grid(const Image<float>& share, const CameraModel& camera, const TableGrid& grid,
                     int threads) {
  const Image<std::uint16_t> all_solved(share.size());
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

}  // namespace

bool has_light_below(const Session& session) {
  return shot_below(session) != nullptr;
}

Result<ThroughCloth> light_through_cloth(const Session& session, const fs::path& bare,
                                         const Calibration& calibration, const RectifyFacts& rectified,
                                         int threads) {
  if (!calibration.response || !calibration.camera)
    return unfit(session, "the calibration has no camera.json or no response.json");
  const Result<Session> table = capture::read_complete_session(bare);
  if (!table) return table.error();
  if (Result<void> ok = check_alike(session, *table); !ok) return std::move(ok).error();
  const Result<Image<float>> cloth_light = light_of(session, calibration);
  if (!cloth_light) return cloth_light.error();
  const Result<Image<float>> table_light = light_of(*table, calibration);
  if (!table_light) return table_light.error();
  if (!(cloth_light->size() == table_light->size()))
    return unfit(*table, "its photographs are of another size");
  return on_grid(share_of(*cloth_light, *table_light), reduced_camera(*calibration.camera, 2),
                 grid_of(rectified), threads);
}

}  // namespace weft::material
