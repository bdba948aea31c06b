// SPDX-License-Identifier: Apache-2.0
#include "library/run/change_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/image_io/encode_image.h"
#include "library/run/solve_change.h"
#include "report/preview.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr int kSide = 128, kEnlarged = 2;

// The window with what lies around it, inside the frame.
Rect shown(const WorstWindow& worst, Size size) {
  const int width = std::min(kSide, size.width), height = std::min(kSide, size.height);
  const int x0 = std::clamp(worst.x + worst.side / 2 - width / 2, 0, size.width - width);
  const int y0 = std::clamp(worst.y + worst.side / 2 - height / 2, 0, size.height - height);
  return {x0, y0, x0 + width, y0 + height};
}

Result<Image<float>> part_of(const fs::path& file, const std::array<std::string, 3>& channels,
                             const WorstWindow& worst) {
  const Result<MapRows> map = MapRows::open(file, channels);
  if (!map) return map.error();
  return map->read(shown(worst, map->size()));
}

report::Picture enlarge(const report::Picture& picture) {
  report::Picture large({picture.width() * kEnlarged, picture.height() * kEnlarged}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < large.height(); ++y) {
      for (int x = 0; x < large.width(); ++x) large(x, y, c) = picture(x / kEnlarged, y / kEnlarged, c);
    }
  }
  return large;
}

Result<std::string> png_of(const report::Picture& picture) {
  std::vector<std::uint8_t> samples;
  samples.reserve(static_cast<std::size_t>(picture.size().pixels()) * 3);
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      for (int c = 0; c < 3; ++c)
        samples.push_back(
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(picture(x, y, c), 0.0F, 1.0F))));
    }
  }
  return encode_image(samples, picture.size(), 3, PictureFormat::kPng);
}

Image<float> angles_between(const Image<float>& before, const Image<float>& after) {
  Image<float> angles(before.size());
  const std::array<View<const float>, 3> a = {after.plane(0), after.plane(1), after.plane(2)};
  const std::array<View<const float>, 3> b = {before.plane(0), before.plane(1), before.plane(2)};
  report::angular_error_deg(a, b, angles.plane());
  return angles;
}

}  // namespace

Result<std::string> draw_change(const fs::path& before, const fs::path& after, const PlannedSolve& planned,
                                const MapChange& change) {
  const std::array<std::string, 3> xyz = {"X", "Y", "Z"}, rgb = {"R", "G", "B"};
  const Result<Image<float>> old = part_of(before / "normal.exr", xyz, change.worst);
  if (!old) return old.error();
  const Result<Image<float>> now = part_of(after / "normal.exr", xyz, change.worst);
  if (!now) return now.error();
  const Result<Image<float>> albedo = part_of(after / "albedo.exr", rgb, change.worst);
  if (!albedo) return albedo.error();
  if (old->size() != now->size() || albedo->size() != now->size()) {
    return Error{ErrorKind::kBadData, "solves differ in size", after.string(), "",
                 "compare solves of one size"};
  }
  const Image<float> angles = angles_between(*old, *now);
  const double scale = report::round_full_scale(angles.plane());
  const double brightness = report::display_scale(*albedo);
  std::vector<report::Panel> panels;
  panels.push_back({"before", planned.before, enlarge(report::normal_picture(*old))});
  panels.push_back({"after", planned.solve, enlarge(report::normal_picture(*now))});
  panels.push_back({"after, relit", "", enlarge(report::relit_picture(*albedo, *now, brightness))});
  panels.push_back({"change", fmt::format("{:.3g}° in the window", change.worst.mean_deg),
                    enlarge(report::heat_picture(angles.plane(), scale))});
  const std::string title = fmt::format("{}  mean {:.3g}°, 95 % under {:.3g}°  at {}, {}",
                                        fs::path(planned.session).stem().string(), change.mean_deg,
                                        change.p95_deg, change.worst.x, change.worst.y);
  return png_of(report::contact_sheet(title, panels, static_cast<int>(panels.size())));
}

}  // namespace weft::library
