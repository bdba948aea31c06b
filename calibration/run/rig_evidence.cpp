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
constexpr double kPatchSigma = 0.02;      // of a patch's reflectance since it was measured
constexpr std::size_t kFewestPoints = 4;  // without tags: six numbers say where a camera is
constexpr double kLeastSpread = 0.1;      // rms across the line that they are nearest to, frame heights
constexpr double kStray = 4;              // standard deviations
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

// Readings inside a polygon, photosite by photosite in one order for all photographs, and their channels.
struct PatchReadings {
  std::vector<double> values;
  std::vector<std::size_t> channels;
};

PatchReadings readings_in(const solve::Photographs& photographs, std::size_t k, const Polygon& polygon) {
  PatchReadings found;
  const Rect box = box_of(polygon, photographs.size);
  if (box.width() <= 0 || box.height() <= 0) return found;
  const solve::Planes planes = photographs.planes();
  Image<float> scratch({box.width(), box.height()});
  const std::vector<View<const float>> readings = readings_of(photographs.frames, k, box, scratch.plane());
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (!is_inside(polygon, x, y)) continue;
      for (std::size_t p = 0; p < readings.size(); ++p) {
        found.values.push_back(readings[p](x - box.x0, y - box.y0));
        found.channels.push_back(static_cast<std::size_t>(planes.channel_at(static_cast<int>(p), x, y)));
      }
    }
  }
  return found;
}

// Mean of each channel; NaN where a photosite is full or none is there.
std::array<double, 3> mean_of(const PatchReadings& readings) {
  std::array<double, 3> sum = {};
  std::array<int, 3> count = {};
  for (std::size_t i = 0; i < readings.values.size(); ++i) {
    sum[readings.channels[i]] += readings.values[i];
    ++count[readings.channels[i]];
  }
  for (std::size_t c = 0; c < 3; ++c)
    sum[c] = count[c] > 0 && std::isfinite(sum[c]) ? sum[c] / count[c] : kNoReading;
  return sum;
}

// How far the mean of all channels may be off, relative, by how photosites differ between photographs: the
// paper's grain is in all of them alike.
double sigma_of(const std::vector<PatchReadings>& all) {
  std::vector<const PatchReadings*> read;
  std::vector<std::array<double, 3>> means;
  for (const PatchReadings& each : all) {
    const std::array<double, 3> mean = mean_of(each);
    if (!std::ranges::all_of(mean, [](double m) { return m > 0; })) continue;
    read.push_back(&each);
    means.push_back(mean);
  }
  if (read.size() < 2) return 0;
  const std::vector<std::size_t>& channels = read.front()->channels;
  std::array<double, 3> squares = {};
  std::array<int, 3> count = {};
  for (std::size_t i = 0; i < channels.size(); ++i) {
    double sum = 0, sum_of_squares = 0;
    for (std::size_t k = 0; k < read.size(); ++k) {
      const double share = read[k]->values[i] / means[k][channels[i]];
      sum += share;
      sum_of_squares += share * share;
    }
    const auto n = static_cast<double>(read.size());
    squares[channels[i]] += (sum_of_squares - sum * sum / n) / (n - 1);
    ++count[channels[i]];
  }
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += squares[c] / count[c] / count[c];
  return std::sqrt(std::max(sum, 0.0)) / 3;
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

std::vector<PointSighting> points_in(const solve::Photographs& photographs, const Calibration& calibration) {
  std::vector<PointSighting> seen;
  const solve::Mosaics* mosaics = photographs.mosaics();
  for (const FixedPoint& point : calibration.points) {
    const int reach = point_reach_cells(*calibration.camera, point.cell_px);
    const Rect box = search_box(point, reach, photographs.size);
    if (box == Rect()) continue;
    Image<float> cells(cells_in(box, point.cell_px));
    for (std::size_t k = 0; k < photographs.count(); ++k) {
      if (mosaics != nullptr) {
        add_cells(mosaics->frames[k].counts.plane(), box, point.cell_px, 1, cells);
        continue;
      }
      const Image<float>& rgb = std::get<solve::Developed>(photographs.frames).rgb[k];
      for (int c = 0; c < 3; ++c) add_cells(rgb.plane(c), box, point.cell_px, c == 1 ? 2 : 1, cells);
    }
    if (std::optional<PointSighting> found = find_point(point, cells, box)) seen.push_back(std::move(*found));
  }
  return seen;
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

FixedPoint relocated(const FixedPoint& point, const CameraModel& before, const CameraModel& now,
                     double plane_mm) {
  FixedPoint out = point;
  const Vec3 p = project(now, point_on_plane(before, point.x_px, point.y_px, plane_mm));
  out.x_px = p.x, out.y_px = p.y;
  return out;
}

namespace {

double height_of(const WhitePatch& patch, const Calibration& calibration) {
  return patch.height_mm.value_or(tag_height_mm(calibration.fiducials));
}

WhitePatch patch_now(const WhitePatch& patch, const Calibration& calibration, const CameraModel& now) {
  return relocated(patch, *calibration.camera, now, height_of(patch, calibration));
}

// Where the camera is to the table; as calibrated where nothing tells.
CameraModel camera_by(const Calibration& calibration, const RigEvidence& of_place) {
  const Result<Movement> moved = find_movement(calibration, of_place);
  return moved ? moved->camera : *calibration.camera;
}

// How far a point is from where a camera has it, in standard deviations.
double departure_of(const PlacedPoint& point, const CameraModel& camera) {
  const Vec3 p = project(camera, point.point_mm);
  return std::hypot(p.x - point.seen_px.x, p.y - point.seen_px.y) /
         std::hypot(MovementOptions().corner_sigma_px, point.sigma_px);
}

// Whether points say how a camera is turned: a camera may turn about a line of them unseen.
bool are_spread(const std::vector<PlacedPoint>& points, Size frame) {
  if (points.size() < kFewestPoints) return false;
  Polygon places;
  for (const PlacedPoint& point : points) places.push_back(point.seen_px);
  const PixelPoint middle = centre_of(places);
  double xx = 0, yy = 0, xy = 0;
  const auto n = static_cast<double>(places.size());
  for (const PixelPoint& p : places) {
    const double x = p.x - middle.x, y = p.y - middle.y;
    xx += x * x / n, yy += y * y / n, xy += x * y / n;
  }
  const double across = std::sqrt(std::max(xx + yy - std::hypot(xx - yy, 2 * xy), 0.0) / 2);
  return across >= kLeastSpread * frame.height;
}

// What tells of the camera to the table.
RigEvidence place_evidence(const Calibration& calibration, const RigSightings& sightings) {
  RigEvidence evidence = {sightings.tags, {}, {}};
  const double height_mm = tag_height_mm(calibration.fiducials);
  for (const PointSighting& seen : sightings.points) {
    const auto known = std::ranges::find(calibration.points, seen.id, &FixedPoint::id);
    if (known == calibration.points.end()) continue;
    evidence.points.push_back({point_on_plane(*calibration.camera, known->x_px, known->y_px, height_mm),
                               {seen.x_px, seen.y_px},
                               std::hypot(known->sigma_px, seen.sigma_px)});
  }
  for (std::size_t most = evidence.points.size() / 3; most > 0; --most) {
    const CameraModel now = camera_by(calibration, evidence);
    const auto worst = std::ranges::max_element(
        evidence.points, {}, [&](const PlacedPoint& point) { return departure_of(point, now); });
    if (departure_of(*worst, now) < kStray) break;
    evidence.points.erase(worst);
  }
  if (sightings.tags.empty() && !are_spread(evidence.points, calibration.camera->size))
    evidence.points.clear();
  return evidence;
}

}  // namespace

Result<RigSightings> sightings_in(const Calibration& calibration, const solve::Photographs& photographs) {
  std::set<std::string> dictionaries;
  for (const Fiducial& fiducial : calibration.fiducials) dictionaries.insert(fiducial.dictionary);
  Result<std::vector<TagSighting>> tags = tags_in(photographs, {dictionaries.begin(), dictionaries.end()});
  if (!tags) return std::move(tags).error();
  RigSightings seen = {std::move(*tags), {}, points_in(photographs, calibration)};
  const CameraModel now = camera_by(calibration, place_evidence(calibration, seen));
  for (const WhitePatch& patch : calibration.patches) {
    if (patch.polygon_px.size() < 3) continue;
    const Polygon polygon = inside_of(patch_now(patch, calibration, now));
    const PixelPoint centre = centre_of(polygon);
    SeenPatch& place = seen.patches.emplace_back();
    place.x_px = centre.x, place.y_px = centre.y;
    place.reading_rgb.assign(light_count(*calibration.lights), {kNoReading, kNoReading, kNoReading});
    std::vector<PatchReadings> readings;
    for (std::size_t k = 0; k < photographs.count(); ++k) {
      readings.push_back(readings_in(photographs, k, polygon));
      place.reading_rgb[static_cast<std::size_t>(photographs.leds[k] - 1)] = mean_of(readings.back());
    }
    place.sigma = sigma_of(readings);
  }
  return seen;
}

RigEvidence evidence_of(const Calibration& calibration, const RigSightings& sightings) {
  RigEvidence evidence = place_evidence(calibration, sightings);
  const CameraModel now = camera_by(calibration, evidence);
  for (const WhitePatch& patch : calibration.patches) {
    if (patch.polygon_px.size() < 3) continue;
    const Polygon polygon = inside_of(patch_now(patch, calibration, now));
    const auto seen = std::ranges::find_if(
        sightings.patches, [&](const SeenPatch& each) { return is_inside(polygon, each.x_px, each.y_px); });
    if (seen == sightings.patches.end()) continue;
    LitPlace& place = evidence.places.emplace_back();
    place.point_mm = point_on_plane(now, seen->x_px, seen->y_px, height_of(patch, calibration));
    place.x_px = seen->x_px, place.y_px = seen->y_px;
    place.surface = static_cast<int>(evidence.places.size());
    place.reflectance_sigma = kPatchSigma;
    place.reflectance_rgb = patch.reflectance_rgb;
    place.delta = patch.delta;
    place.reading_rgb = seen->reading_rgb;
    place.reading_sigma = seen->sigma;
  }
  return evidence;
}

}  // namespace weft::calibration
