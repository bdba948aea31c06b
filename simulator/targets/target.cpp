// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/sampling/random.h"
#include "simulator/targets/range.h"

namespace weft::simulator {
namespace {

// Shots that no scene has.
constexpr std::uint32_t kGrainStream = 0xFFFFFFFE;
constexpr std::uint32_t kWaveStream = 0xFFFFFFFD;
constexpr double kMostGrains = 4;  // along a side of a box
constexpr std::uint32_t kMostSizes = 64;

/// Uniform between -sqrt(3) and sqrt(3): mean 0, variance 1.
double even(std::uint32_t bits) {
  return std::sqrt(3.0) * (2 * uniform(bits, 0) - 1);
}

/// Places of grains along one side of a box, in grains.
struct Side {
  double from, to;
  std::int64_t first() const { return static_cast<std::int64_t>(std::floor(from)); }
  std::int64_t last() const { return static_cast<std::int64_t>(std::floor(to)); }
  double share(std::int64_t grain) const {
    if (first() == last()) return 1;
    const auto start = static_cast<double>(grain);
    return (std::min(to, start + 1) - std::max(from, start)) / (to - from);
  }
};

/// Neither numbers without end nor those that are none get through: fmin and fmax pass NaN over.
Side side(double centre_mm, double width_mm, double grain_mm) {
  constexpr double kFarthest = 1e9;  // whole numbers of 32 bits tell nearer grains apart
  const double centre = std::fmax(std::fmin(centre_mm / grain_mm, kFarthest), -kFarthest);
  const double half = std::fmin(width_mm / grain_mm, kMostGrains) / 2;
  return {centre - half, centre + half};
}

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

PaperSheet::PaperSheet(const SheetSettings& settings, std::int64_t seed, int number)
    : grain_mm_(settings.grain_mm),
      grain_albedo_(settings.grain_percent / 100),
      grain_slope_(std::tan(radians(settings.grain_deg)) / std::sqrt(2.0)),
      key_{static_cast<std::uint32_t>(seed),
           static_cast<std::uint32_t>(static_cast<std::uint64_t>(seed) >> 32)},
      number_(static_cast<std::uint32_t>(number)) {
  const double slope = std::tan(radians(settings.waviness_deg)) * std::sqrt(2.0 / kWaves);
  for (std::size_t i = 0; i < kWaves; ++i) {
    const auto bits = philox({static_cast<std::uint32_t>(i), 0, kWaveStream, number_}, key_);
    const double k = 2 * kPi / settings.wavelength_mm * std::exp2(uniform(bits[0], 0) - 0.5);
    const double direction = kPi * (static_cast<double>(i) + uniform(bits[1], 0)) / kWaves;
    waves_[i] = {k * std::cos(direction), k * std::sin(direction), slope / k, 2 * kPi * uniform(bits[2], 0)};
  }
}

void PaperSheet::add_waves(const TargetSpot& spot, SheetPoint& point) const {
  for (const Wave& wave : waves_) {
    const double angle = wave.k_u * spot.u_mm + wave.k_v * spot.v_mm + wave.phase;
    point.height_mm += wave.amplitude_mm * std::sin(angle);
    point.slope_u += wave.amplitude_mm * wave.k_u * std::cos(angle);
    point.slope_v += wave.amplitude_mm * wave.k_v * std::cos(angle);
  }
}

void PaperSheet::add_grain(const TargetSpot& spot, SheetPoint& point) const {
  double grain_mm = grain_mm_;
  double strength = 1;
  std::uint32_t size = 0;
  for (; std::max(spot.width_mm, spot.height_mm) > kMostGrains * grain_mm && size < kMostSizes; ++size) {
    grain_mm *= 2;
    strength /= 2;
  }
  const Side u = side(spot.u_mm, spot.width_mm, grain_mm);
  const Side v = side(spot.v_mm, spot.height_mm, grain_mm);
  for (std::int64_t j = v.first(); j <= v.last(); ++j) {
    for (std::int64_t i = u.first(); i <= u.last(); ++i) {
      const auto bits = philox({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), kGrainStream,
                                number_ * kMostSizes + size},
                               key_);
      const double share = strength * u.share(i) * v.share(j);
      point.brightness += share * grain_albedo_ * even(bits[0]);
      point.slope_u += share * grain_slope_ * even(bits[1]);
      point.slope_v += share * grain_slope_ * even(bits[2]);
    }
  }
}

SheetPoint PaperSheet::at(const TargetSpot& spot) const {
  SheetPoint point;
  if (waves_[0].amplitude_mm > 0) add_waves(spot, point);
  if (grain_albedo_ > 0 || grain_slope_ > 0) add_grain(spot, point);
  return point;
}

Result<void> check_sheet(const SheetSettings& settings) {
  return check({{"waviness_deg", settings.waviness_deg, {0, 10}},
                {"wavelength_mm", settings.wavelength_mm, {1, 1e4}},
                {"grain_percent", settings.grain_percent, {0, 20}},
                {"grain_deg", settings.grain_deg, {0, 20}},
                {"grain_mm", settings.grain_mm, {0.01, 10}},
                {"non_lambertian", settings.non_lambertian, {-0.5, 1}}});
}

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
