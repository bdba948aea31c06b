// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/target.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "simulator/targets/range.h"

namespace weft::simulator {
namespace {

constexpr Range kCoordinate_mm = {-1e4, 1e4};
constexpr Range kAngle_deg = {-360, 360};
constexpr Range kReflectance = {0, 1};

/// Turned by `tilt` from z towards the horizontal direction `azimuth`, about the axis between them.
Vec3 tilted(Vec3 v, double tilt, double azimuth) {
  const Vec3 towards = {std::cos(azimuth), std::sin(azimuth), 0};
  const double along = dot(v, towards);
  const double c = std::cos(tilt);
  const double s = std::sin(tilt);
  return v + ((c - 1) * along + s * v.z) * towards + Vec3{0, 0, (c - 1) * v.z - s * along};
}

}  // namespace

Target::Target(const TargetSettings& settings, Pattern pattern, const PaperSheet& sheet)
    : pattern_(std::move(pattern)),
      sheet_(sheet),
      non_lambertian_(settings.sheet.non_lambertian),
      centre_mm_(settings.centre_mm) {
  const double tilt = radians(settings.tilt_deg);
  const double azimuth = radians(settings.azimuth_deg);
  const double rotation = radians(settings.rotation_deg);
  u_axis_ = tilted({std::cos(rotation), std::sin(rotation), 0}, tilt, azimuth);
  v_axis_ = tilted({-std::sin(rotation), std::cos(rotation), 0}, tilt, azimuth);
  normal_ = tilted({0, 0, 1}, tilt, azimuth);
}

Result<Target> Target::make(const TargetSettings& settings, std::int64_t seed, int number) {
  if (auto ok = check({{"centre_mm", settings.centre_mm.x, kCoordinate_mm},
                       {"centre_mm", settings.centre_mm.y, kCoordinate_mm},
                       {"centre_mm", settings.centre_mm.z, kCoordinate_mm},
                       {"tilt_deg", settings.tilt_deg, {0, 85}},
                       {"azimuth_deg", settings.azimuth_deg, kAngle_deg},
                       {"rotation_deg", settings.rotation_deg, kAngle_deg}});
      !ok)
    return ok.error();
  if (auto ok = check_sheet(settings.sheet); !ok) return ok.error();
  auto pattern = make_pattern(settings.pattern);
  if (!pattern) return pattern.error();
  return Target(settings, *std::move(pattern), PaperSheet(settings.sheet, seed, number));
}

Vec3 Target::place_mm(double u_mm, double v_mm) const {
  return centre_mm_ + u_mm * u_axis_ + v_mm * v_axis_;
}

std::optional<TargetHit> Target::hit(const ViewRay& ray) const {
  const double towards = dot(normal_, ray.direction);
  if (!(towards < 0)) return std::nullopt;
  const double t = dot(normal_, centre_mm_ - ray.origin_mm) / towards;
  if (!(t > 0)) return std::nullopt;
  const Vec3 place = ray.origin_mm + t * ray.direction - centre_mm_;
  // The plane holds t: along it, the point moves by t (per - direction (n . per) / (n . direction)).
  const auto moved = [&](Vec3 per) { return t * (per - (dot(normal_, per) / towards) * ray.direction); };
  const Vec3 dx = moved(ray.per_x);
  const Vec3 dy = moved(ray.per_y);
  const TargetSpot spot = {dot(place, u_axis_), dot(place, v_axis_),
                           std::hypot(dot(dx, u_axis_), dot(dy, u_axis_)),
                           std::hypot(dot(dx, v_axis_), dot(dy, v_axis_))};
  if (!(std::abs(spot.u_mm) < (width_mm() + spot.width_mm) / 2)) return std::nullopt;
  if (!(std::abs(spot.v_mm) < (height_mm() + spot.height_mm) / 2)) return std::nullopt;
  return TargetHit{spot, t * length(ray.direction)};
}

TargetPoint Target::at(const TargetSpot& spot) const {
  const SheetPoint sheet = sheet_.at(spot);
  const Vec3 across = sheet.slope_u * u_axis_ + sheet.slope_v * v_axis_;
  return {place_mm(spot.u_mm, spot.v_mm) + sheet.height_mm * normal_, normalized(normal_ - across),
          sheet.brightness, pattern_.coverage(spot)};
}

Result<std::vector<Spectrum>> inks_of(const TargetSettings& settings, std::span<const Spectrum> chart) {
  constexpr std::size_t kChartPatches = 24;
  if (auto ok = check({{"white", settings.white, kReflectance}, {"black", settings.black, kReflectance}});
      !ok)
    return ok.error();
  std::vector<Spectrum> inks = {flat_spectrum(settings.white), flat_spectrum(settings.black)};
  if (const auto* scale = std::get_if<GreyScaleSettings>(&settings.pattern)) {
    for (const double reflectance : scale->reflectances) {
      if (auto ok = check({{"reflectances", reflectance, kReflectance}}); !ok) return ok.error();
      inks.push_back(flat_spectrum(reflectance));
    }
  }
  if (kind_of(settings.pattern) == TargetKind::kChart) {
    if (chart.size() != kChartPatches) {
      return Error{ErrorKind::kBadData, "the chart's patches are not known", "chart",
                   fmt::format("there are {} reflectances", chart.size()),
                   fmt::format("give {}, row by row from the upper left", kChartPatches)};
    }
    inks.insert(inks.end(), chart.begin(), chart.end());
  }
  return inks;
}

}  // namespace weft::simulator
