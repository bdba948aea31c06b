// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/probes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "calibration/camera/lens_fit.h"
#include "core/rig/camera.h"
#include "core/solve/solve_record.h"

namespace weft::app {
namespace {

constexpr std::int64_t kMostPixels = std::int64_t{4} << 20;
constexpr std::size_t kBins = 64;
constexpr int kMostSamples = 2000;

Json facts_of(View<const float> plane) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(plane.size().pixels()));
  double sum = 0, squares = 0;
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      const float v = plane(x, y);
      if (!std::isfinite(v)) continue;
      values.push_back(v);
      sum += double{v};
      squares += double{v} * double{v};
    }
  }
  if (values.empty()) return nullptr;
  const auto count = static_cast<double>(values.size());
  const double mean = sum / count;
  const auto quantile = [&](double share) {
    const auto place = static_cast<std::ptrdiff_t>(share * (count - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
  };
  const auto [least, most] = std::ranges::minmax(values);
  std::vector<std::int64_t> bins(kBins);
  const double scale = most > least ? static_cast<double>(kBins) / (double{most} - double{least}) : 0;
  for (const float v : values)
    ++bins[std::min(kBins - 1, static_cast<std::size_t>(scale * (double{v} - double{least})))];
  return {{"mean", mean},          {"deviation", std::sqrt(std::max(0.0, squares / count - mean * mean))},
          {"p5", quantile(0.05)},  {"p50", quantile(0.5)},
          {"p95", quantile(0.95)}, {"least", least},
          {"most", most},          {"bins", bins}};
}

double mean_of(View<const float> plane) {
  double sum = 0;
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) sum += double{plane(x, y)};
  }
  return sum / static_cast<double>(plane.size().pixels());
}

Rect reduced(Rect part, int level) {
  for (; level > 0; --level) part = {part.x0 / 2, part.y0 / 2, (part.x1 + 1) / 2, (part.y1 + 1) / 2};
  return part;
}

// As this camera sees it.
Vec3 place_seen(const CameraModel& camera, const Ground& ground, double x, double y) {
  const double each = ground.pixels_each, middle = (each - 1) / 2;
  return point_on_plane(camera, each * x + middle, each * y + middle, ground.height_mm);
}

// With its standard deviation.
Json length_of(const Ground& ground, const Line& line) {
  const auto between = [](Vec3 a, Vec3 b) { return std::hypot(b.x - a.x, b.y - a.y); };
  Json facts = {{"mm", between(place_on(ground, line.x0, line.y0), place_on(ground, line.x1, line.y1))},
                {"sigma_mm", nullptr}};
  if (ground.calibration == nullptr || !ground.calibration->camera_covariance) return facts;
  const auto length = [&](const CameraModel& seen) {
    return between(place_seen(seen, ground, line.x0, line.y0), place_seen(seen, ground, line.x1, line.y1));
  };
  facts["sigma_mm"] =
      calibration::propagated(*ground.calibration->camera, *ground.calibration->camera_covariance, length);
  return facts;
}

}  // namespace

Vec3 place_on(const Ground& ground, double x, double y) {
  if (ground.calibration == nullptr) return {ground.mm_per_pixel * x, -ground.mm_per_pixel * y, 0};
  return place_seen(*ground.calibration->camera, ground, x, y);
}

Result<Json> region_facts(const Layers& layers, const OpenLayer& open, Rect part) {
  int level = 0;
  while (reduced(part, level).pixels() > kMostPixels) ++level;
  const Rect read = reduced(part, level);
  Json facts = Json::object(), status = Json::object();
  for (const Layer& layer : layers.all) {
    const Result<std::shared_ptr<Pyramid>> pyramid = open(layer);
    if (!pyramid) return pyramid.error();
    if (layer.kind == LayerKind::kFlags) {
      for (std::size_t bit = 0; bit < kStatusNames.size(); ++bit) {
        const Result<Image<float>> share = (*pyramid)->read(level, read, static_cast<int>(bit));
        if (!share) return share.error();
        status[kStatusNames[bit].name] = mean_of(share->plane());
      }
      continue;
    }
    const Result<Image<float>> planes = (*pyramid)->read(level, read);
    if (!planes) return planes.error();
    Json channels = Json::object();
    for (int p = 0; p < planes->planes(); ++p)
      channels[layer.channels[static_cast<std::size_t>(p)]] = facts_of(planes->plane(p));
    facts[layer.name] = std::move(channels);
  }
  return Json{{"level", level},
              {"pixels", read.pixels()},
              {"layers", std::move(facts)},
              {"status", std::move(status)}};
}

Result<Json> line_facts(const Layers& layers, const OpenLayer& open, const Line& line, const Ground& ground) {
  Json facts = length_of(ground, line);

  std::array<std::shared_ptr<Pyramid>, 2> maps;
  const std::array<const char*, 2> names = {"normal", "albedo"};
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const Layer* layer = layers.find(names[i]);
    if (layer == nullptr)
      return Error{ErrorKind::kBadData, "there is no profile", names[i], "the map is not there",
                   "solve again"};
    Result<std::shared_ptr<Pyramid>> opened = open(*layer);
    if (!opened) return std::move(opened).error();
    maps[i] = std::move(*opened);
  }
  const double pixels = std::max(std::abs(line.x1 - line.x0), std::abs(line.y1 - line.y0));
  const int steps = std::clamp(static_cast<int>(std::lround(pixels)), 1, kMostSamples - 1);
  Json at_mm = Json::array(), heights = Json::array(), albedo = Json::array();
  double height = 0;
  Vec3 first, before, slope_before;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double x = line.x0 + t * (line.x1 - line.x0), y = line.y0 + t * (line.y1 - line.y0);
    const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
    const Rect pixel = {column, row, column + 1, row + 1};
    const Result<Image<float>> normal = maps[0]->read(0, pixel), color = maps[1]->read(0, pixel);
    if (!normal) return normal.error();
    if (!color) return color.error();
    const double nz = std::max(double{(*normal)(0, 0, 2)}, 1e-3);
    const Vec3 slope = {-double{(*normal)(0, 0, 0)} / nz, -double{(*normal)(0, 0, 1)} / nz, 0};
    const Vec3 place = place_on(ground, x, y);
    if (i == 0) first = place;
    if (i > 0) {
      height += 0.5 * ((slope.x + slope_before.x) * (place.x - before.x) +
                       (slope.y + slope_before.y) * (place.y - before.y));
    }
    at_mm.push_back(std::hypot(place.x - first.x, place.y - first.y));
    heights.push_back(height);
    albedo.push_back((*color)(0, 0, 1));
    before = place;
    slope_before = slope;
  }
  facts["profile"] = {
      {"mm", std::move(at_mm)}, {"height_mm", std::move(heights)}, {"albedo", std::move(albedo)}};
  return facts;
}

}  // namespace weft::app
