// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/rig_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "solver/conditions/light_change.h"

namespace weft::calibration {
namespace {

constexpr std::size_t kMostLooks = 3;
constexpr double kPatchSigma = 0.02;  // of a patch's reflectance since it was measured
constexpr double kNoReading = std::numeric_limits<double>::quiet_NaN();

Image<std::uint8_t> grey_of(const solve::Photographs& photographs, std::size_t k) {
  if (const solve::Mosaics* mosaics = photographs.mosaics()) return grey_picture(mosaics->frames[k]);
  const Image<float>& rgb = std::get<solve::Developed>(photographs.frames).rgb[k];
  const std::array<View<const float>, 3> planes = {rgb.plane(0), rgb.plane(1), rgb.plane(2)};
  return grey_picture(planes);
}

using Polygon = std::vector<PixelPoint>;

PixelPoint centre_of(const Polygon& polygon) {
  PixelPoint sum;
  for (const PixelPoint& p : polygon) sum.x += p.x, sum.y += p.y;
  const auto n = static_cast<double>(polygon.size());
  return {sum.x / n, sum.y / n};
}

// By the number of edges to the right of it (Shimrat 1962).
bool is_inside(const Polygon& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const PixelPoint &a = polygon[i], &b = polygon[j];
    if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

Polygon inside_of(const WhitePatch& patch) {
  Polygon polygon;
  for (const auto& [x, y] : solver::well_inside(patch).polygon_px) polygon.push_back({x, y});
  return polygon;
}

Rect box_of(const Polygon& polygon, Size frame) {
  double x0 = frame.width, y0 = frame.height, x1 = 0, y1 = 0;
  for (const PixelPoint& p : polygon) {
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
    y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  }
  const auto within = [](double v, int most) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
  };
  // Even, so that the filter cell of the box is that of the frame.
  return {within(x0, frame.width) & ~1, within(y0, frame.height) & ~1, within(x1 + 1, frame.width),
          within(y1 + 1, frame.height)};
}

// Mean reading of each channel; NaN where a photosite is full or none is there.
std::array<double, 3> mean_in(const solve::Photographs& photographs, std::size_t k, const Polygon& polygon) {
  const Rect box = box_of(polygon, photographs.size);
  if (box.width() <= 0 || box.height() <= 0) return {kNoReading, kNoReading, kNoReading};
  std::array<double, 3> sum = {};
  std::array<int, 3> count = {};
  const solve::Planes planes = photographs.planes();
  Image<float> scratch({box.width(), box.height()});
  const std::vector<View<const float>> readings = readings_of(photographs.frames, k, box, scratch.plane());
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (!is_inside(polygon, x, y)) continue;
      for (std::size_t p = 0; p < readings.size(); ++p) {
        const auto channel = static_cast<std::size_t>(planes.channel_at(static_cast<int>(p), x, y));
        sum[channel] += readings[p](x - box.x0, y - box.y0);
        ++count[channel];
      }
    }
  }
  for (std::size_t c = 0; c < 3; ++c)
    sum[c] = count[c] > 0 && std::isfinite(sum[c]) ? sum[c] / count[c] : kNoReading;
  return sum;
}

}  // namespace

Result<std::vector<TagSighting>> tags_in(const solve::Photographs& photographs,
                                         const std::vector<std::string>& dictionaries) {
  std::map<std::pair<std::string, int>, std::vector<TagSighting>> seen;
  const std::size_t looks = std::min(kMostLooks, photographs.count());
  for (std::size_t i = 0; i < looks && !dictionaries.empty(); ++i) {
    const Image<std::uint8_t> grey = grey_of(photographs, i * photographs.count() / looks);
    for (const std::string& dictionary : dictionaries) {
      Result<std::vector<TagSighting>> tags = find_tags(grey.plane(), dictionary);
      if (!tags) return std::move(tags).error();
      for (TagSighting& tag : *tags) seen[{tag.dictionary, tag.id}].push_back(std::move(tag));
    }
  }
  std::vector<TagSighting> means;
  for (const auto& [name, sightings] : seen) {
    TagSighting& mean = means.emplace_back(sightings.front());
    for (std::size_t i = 0; i < 4; ++i) {
      Polygon corner;
      for (const TagSighting& each : sightings) corner.push_back(each.corners_px[i]);
      mean.corners_px[i] = centre_of(corner);
    }
  }
  return means;
}

double tag_height_mm(const std::vector<Fiducial>& fiducials) {
  double sum = 0;
  for (const Fiducial& fiducial : fiducials) {
    for (const Vec3 corner : fiducial.corners_mm) sum += corner.z;
  }
  return fiducials.empty() ? 0 : sum / (4 * static_cast<double>(fiducials.size()));
}

WhitePatch relocated(const WhitePatch& patch, const CameraModel& before, const CameraModel& now,
                     double plane_mm) {
  WhitePatch out = patch;
  for (auto& [x, y] : out.polygon_px) {
    const Vec3 p = project(now, point_on_plane(before, x, y, plane_mm));
    x = p.x, y = p.y;
  }
  return out;
}

Result<RigEvidence> rig_evidence(const Calibration& calibration, const solve::Photographs& photographs) {
  std::set<std::string> dictionaries;
  for (const Fiducial& fiducial : calibration.fiducials) dictionaries.insert(fiducial.dictionary);
  const double plane_mm = tag_height_mm(calibration.fiducials);
  Result<std::vector<TagSighting>> tags = tags_in(photographs, {dictionaries.begin(), dictionaries.end()});
  if (!tags) return std::move(tags).error();
  RigEvidence evidence = {std::move(*tags), {}};

  CameraModel now = *calibration.camera;
  if (const auto by_tags = find_movement(calibration, evidence)) now = by_tags->camera;
  for (const WhitePatch& patch : calibration.patches) {
    if (patch.polygon_px.size() < 3) continue;
    const double height_mm = patch.height_mm.value_or(plane_mm);
    const Polygon polygon = inside_of(relocated(patch, *calibration.camera, now, height_mm));
    LitPlace& place = evidence.places.emplace_back();
    const PixelPoint centre = centre_of(polygon);
    place.point_mm = point_on_plane(now, centre.x, centre.y, height_mm);
    place.x_px = centre.x, place.y_px = centre.y;
    place.surface = static_cast<int>(evidence.places.size());
    place.reflectance_sigma = kPatchSigma;
    place.reflectance_rgb = patch.reflectance_rgb;
    place.reading_rgb.assign(light_count(*calibration.lights), {kNoReading, kNoReading, kNoReading});
    for (std::size_t k = 0; k < photographs.count(); ++k) {
      place.reading_rgb[static_cast<std::size_t>(photographs.leds[k] - 1)] = mean_in(photographs, k, polygon);
    }
  }
  return evidence;
}

}  // namespace weft::calibration
