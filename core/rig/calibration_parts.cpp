// SPDX-License-Identifier: Apache-2.0
#include "core/rig/calibration_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft {
namespace {

bool is_unit(Vec3 direction) {
  return std::abs(length(direction) - 1) <= 1e-6;
}

// Orthonormal, and no mirror.
bool is_rotation(const Mat3& m) {
  const Vec3 x = m * Vec3{1, 0, 0}, y = m * Vec3{0, 1, 0}, z = m * Vec3{0, 0, 1};
  const auto near = [](Vec3 a, Vec3 b) { return length(a - b) < 1e-6; };
  return near(cross(x, y), z) && near(cross(y, z), x) && near(cross(z, x), y) &&
         std::abs(length(x) - 1) < 1e-6;
}

// Its rows by their numbers.
Json rows_of(const ParameterCovariance& covariance) {
  Json rows = Json::array();
  for (auto row = covariance.matrix.begin(); row != covariance.matrix.end();) {
    const auto end = row + static_cast<std::ptrdiff_t>(covariance.parameters.size());
    rows.push_back(std::vector<double>(row, end));
    row = end;
  }
  return rows;
}

bool is_covariance(const Json& rows, std::size_t n) {
  const auto is_row = [n](const Json& row) {
    return row.is_array() && row.size() == n &&
           std::ranges::all_of(row, [](const Json& each) { return each.is_number(); });
  };
  if (!rows.is_array() || rows.size() != n || !std::ranges::all_of(rows, is_row)) return false;
  const auto at = [&](std::size_t row, std::size_t column) { return rows[row][column].get<double>(); };
  for (std::size_t i = 0; i < n; ++i) {
    if (!(at(i, i) >= 0)) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (!(std::abs(at(i, j) - at(j, i)) <= 1e-9 * std::sqrt(at(i, i) * at(j, j)))) return false;
    }
  }
  return true;
}

void describe_model(Fields& fields, CameraModel& c) {
  fields.value({"width", "Pixels", {1, kMostNumber}, kMustSay}, c.size.width);
  fields.value({"height", "Pixels", {1, kMostNumber}, kMustSay}, c.size.height);
  fields.value({"fx", "Focal length, pixels", kAboveZero, kMustSay}, c.fx);
  fields.value({"fy", "Focal length, pixels", kAboveZero, kMustSay}, c.fy);
  fields.value(
      {"cx", "Principal point; (0, 0) is the centre of the first photosite of the active area", {}, kMustSay},
      c.cx);
  fields.value({"cy", "Principal point, pixels", {}, kMustSay}, c.cy);
  for (const auto& [name, term] :
       {std::pair{"k1", &c.k1}, {"k2", &c.k2}, {"k3", &c.k3}, {"p1", &c.p1}, {"p2", &c.p2}})
    fields.value({name, "Distortion, as OpenCV has it", {}, kMustSay}, *term);
  fields.value({"camera_from_rig_rotation", "By rows", {}, kMustSay}, c.camera_from_rig_rotation);
  fields.require(is_rotation(c.camera_from_rig_rotation), "camera_from_rig_rotation", "must be a rotation");
  fields.value({"camera_from_rig_translation_mm", "Of the rig's origin", {}, kMustSay},
               c.camera_from_rig_translation_mm);
}

}  // namespace

void describe(Fields& fields, Fiducial& f) {
  fields.value({"dictionary", "As OpenCV names it", {}, kMustSay}, f.dictionary);
  fields.value({"id", "In the dictionary", {}, kMustSay}, f.id);
  fields.value({"corners_mm", "Rig frame; upper left of the upright tag first, then clockwise", {}, kMustSay},
               f.corners_mm);
}

void describe(Fields& fields, ParameterCovariance& c) {
  fields.value({"parameters", "Their names", {}, kMustSay}, c.parameters);
  Json rows = rows_of(c);
  fields.value({"matrix", "By rows, in the units of the parameters", {}, kMustSay}, rows);
  const bool is_good = is_covariance(rows, c.parameters.size());
  fields.require(is_good, "matrix",
                 "must be symmetric, a row and a column for each parameter, none negative on its diagonal");
  if (is_good) c.matrix.clear();
  for (const Json& row : is_good ? rows : Json::array())
    for (const Json& each : row) c.matrix.push_back(each.get<double>());
}

void describe(Fields& fields, PointSpread& s) {
  fields.value({"sigma_px",
                "Behind the red, green and blue filter, pixels, without the photosite's own square",
                {0, 10},
                kMustSay},
               s.sigma_px);
}

void describe(Fields& fields, RadialShift& s) {
  fields.value({"scale",
                "At d it looks where green does at d (1 + scale + cubic r^2), r = d / focal length",
                {-0.01, 0.01},
                kMustSay},
               s.scale);
  fields.value({"cubic", "Of the radius", {-1, 1}, kMustSay}, s.cubic);
  fields.value({"sigma_scale", "A standard deviation; 0: it was not fitted", kNotNegative, kMustSay},
               s.sigma_scale);
  fields.value({"sigma_cubic", "A standard deviation; 0: it was not fitted", kNotNegative, kMustSay},
               s.sigma_cubic);
}

void describe(Fields& fields, LateralColor& l) {
  fields.object({"red", "How red looks shifted", {}, kMustSay}, l.red);
  fields.object({"blue", "How blue does", {}, kMustSay}, l.blue);
}

void describe(Fields& fields, CameraPart& p) {
  describe_model(fields, p.model);
  fields.list({"fiducials", "Tags that stay on the table; since 1.1", {}, kUnlessEmpty}, p.fiducials);
  fields.object({"covariance", "Of what was fitted; since 1.1", {}, kUnlessEmpty}, p.covariance);
  fields.object({"point_spread", "Of the lens, a Gaussian; since 1.2", {}, kUnlessEmpty}, p.spread);
  fields.object({"lateral_color", "Of the lens; since 1.3", {}, kUnlessEmpty}, p.lateral);
}

const char* schema_name(const CameraPart& p) {
  if (p.lateral) return "weft.camera/1.3";
  if (p.spread) return "weft.camera/1.2";
  return p.covariance || !p.fiducials.empty() ? "weft.camera/1.1" : "weft.camera/1";
}

void describe(Fields& fields, ExposureRatio& e) {
  fields.value({"exposure_us", "Microseconds", kAboveZero, kMustSay}, e.exposure_us);
  fields.value({"to_exposure_us", "Microseconds", kAboveZero, kMustSay}, e.to_exposure_us);
  fields.value({"ratio", "Light at the first over light at the second", kAboveZero, kMustSay}, e.ratio);
}

void describe(Fields& fields, Veil& v) {
  fields.value(
      {"share", "Of the light of a frame, which the lens scatters over all of it", {0, 0.2}, kMustSay},
      v.share);
  fields.value({"sigma_share", "A standard deviation", kNotNegative, kMustSay}, v.sigma_share);
  fields.value({"spread", "Of its Gaussian, frame diagonals", {0.05, 10}, kMustSay}, v.spread);
}

void describe(Fields& fields, CountLevels& l) {
  fields.value({"black", "Counts, of the filter cell by rows, as the files say", {}, kMustSay}, l.black);
  fields.value({"white", "Counts, as the files say", kAboveZero, kMustSay}, l.white);
  fields.value({"dark_rgb", "Counts without light: medians of dark shots, else black", {}, kMustSay},
               l.dark_rgb);
  fields.value({"full_rgb", "Counts at which each stops, 0 of one that was not seen to", {}, kUnlessEmpty},
               l.full_rgb);
  fields.require(l.full_rgb.empty() || l.full_rgb.size() == 3, "full_rgb", "must be three numbers");
}

void describe(Fields& fields, Response& r) {
  fields.value(
      {"electrons_per_count", "Photon noise of s counts has a variance of s over it", kAboveZero, kMustSay},
      r.electrons_per_count);
  fields.value(
      {"read_noise_counts", "Standard deviation without light, rounding included", kNotNegative, kMustSay},
      r.read_noise_counts);
  fields.value({"linearity", "a and b of v (1 + a v + b v^2), by channel", {}, kMustSay}, r.linearity);
  fields.list({"exposure_ratios", "That were measured; since 1.1", {}, kUnlessEmpty}, r.exposure_ratios);
  fields.value({"black_counts", "Measured, where a session has no dark shot; since 1.2"}, r.black_counts);
  fields.value({"iso", "Of the frames it was measured on, which sessions must share; since 1.3", kAboveZero},
               r.iso);
  fields.object({"levels", "Of the counts it was measured on; since 1.5", {}, kUnlessEmpty}, r.levels);
  fields.object({"veil", "Glare of the lens; since 1.4", {}, kUnlessEmpty}, r.veil);
}

const char* schema_name(const Response& r) {
  if (r.levels) return "weft.response/1.5";
  if (r.veil) return "weft.response/1.4";
  if (r.iso) return "weft.response/1.3";
  if (r.black_counts) return "weft.response/1.2";
  return r.exposure_ratios.empty() ? "weft.response/1" : "weft.response/1.1";
}

void describe(Fields& fields, ColorCurve& c) {
  fields.value({"before", "Affine, 3 x 4 by rows, in xyY", {}, kMustSay}, c.before);
  fields.value({"cubic", "c0 to c3 a channel", {}, kMustSay}, c.cubic);
  fields.value({"after", "Affine, 3 x 4 by rows", {}, kMustSay}, c.after);
}

void describe(Fields& fields, ColorTransform& c) {
  fields.value({"rec709_from_camera", "By rows", {}, kMustSay}, c.rec709_from_camera);
  fields.require(std::ranges::all_of(c.rec709_from_camera,
                                     [](const auto& r) { return std::abs(r[0] + r[1] + r[2] - 1) <= 1e-6; }),
                 "rec709_from_camera", "must be three rows of three numbers that sum to 1");
  fields.value({"covariance", "9 x 9 by rows, of its entries by rows; none where unknown", {}, kMustSay},
               c.covariance);
  fields.require(c.covariance.empty() || c.covariance.size() == 81, "covariance",
                 "must be 81 numbers, or none");
  fields.object({"curve", "In place of the matrix", {}, kUnlessEmpty}, c.curve);
}

const char* schema_name(const ColorTransform& /*color*/) {
  return "weft.color/1";
}

namespace {

void require_bright(Fields& fields, const char* field, const std::array<double, 3>& rgb) {
  fields.require(std::ranges::min(rgb) > 0, field, "must be above 0 in every channel");
}

}  // namespace

void describe(Fields& fields, NearLight& l) {
  fields.value({"position_mm", "Rig frame", {}, kMustSay}, l.position_mm);
  fields.value({"aim", "Unit, from the LED to the table", {}, kMustSay}, l.aim);
  fields.require(is_unit(l.aim), "aim", "must have unit length");
  fields.value({"mu", "Lobe exponent; 1: Lambertian", kNotNegative, kMustSay}, l.mu);
  fields.value({"flux_rgb", "Reading times mm^2 over s at ISO 100", {}, kMustSay}, l.flux_rgb);
  require_bright(fields, "flux_rgb", l.flux_rgb);
  fields.value({"log_gain_quadratic", "1, u, v, u^2, u v, v^2 over the frame"}, l.log_gain_quadratic);
}

void describe(Fields& fields, GainSpline& s) {
  fields.value({"columns", "Coefficients across the frame", {}, kMustSay}, s.columns);
  fields.value({"rows", "Coefficients down the frame", {}, kMustSay}, s.rows);
  fields.value({"coefficients", "Row by row; none: no gain", {}, kMustSay}, s.coefficients);
  const bool is_full =
      s.columns >= 4 && s.rows >= 4 &&
      s.coefficients.size() == static_cast<std::size_t>(s.columns) * static_cast<std::size_t>(s.rows);
  fields.require(s.coefficients.empty() || is_full, "coefficients",
                 "must be none, or columns x rows numbers with at least 4 x 4");
}

void describe(Fields& fields, NearLights& n) {
  fields.list({"leds", "LED 1 is the first", {}, kMustSay}, n.leds);
  std::vector<GainSpline> splines(n.log_gain_rgb.begin(), n.log_gain_rgb.end());
  fields.list({"log_gain_rgb", "By channel, shared by all LEDs", {}, kMustSay}, splines);
  fields.require(splines.size() == 3, "log_gain_rgb", "must be three splines");
  if (splines.size() == 3) std::ranges::move(splines, n.log_gain_rgb.begin());
}

void describe(Fields& fields, DistantLight& l) {
  fields.value({"direction", "Unit, from the surface to the light", {}, kMustSay}, l.direction);
  fields.require(is_unit(l.direction), "direction", "must have unit length");
  fields.value({"irradiance_rgb", "Reading of a white surface that faces it", {}, kMustSay},
               l.irradiance_rgb);
  require_bright(fields, "irradiance_rgb", l.irradiance_rgb);
}

void describe(Fields& fields, DistantLights& d) {
  fields.list({"lights", "Light 1 is the first", {}, kMustSay}, d.lights);
}

void describe(Fields& fields, WhitePatch& p) {
  fields.value({"polygon_px", "Corners on the active area", {}, kMustSay}, p.polygon_px);
  fields.require(p.polygon_px.size() >= 3, "polygon_px", "must have three corners or more");
  fields.value({"reflectance_rgb", "As it was measured", {}, kMustSay}, p.reflectance_rgb);
  require_bright(fields, "reflectance_rgb", p.reflectance_rgb);
  fields.value({"delta", "It reflects 1 - delta (1 - cosine) of Lambert's law; since 1.2", {}, kUnlessEmpty},
               p.delta);
  fields.require(std::abs(p.delta) < 1, "delta", "must be between -1 and 1");
  fields.value({"height_mm", "Where it lies, rig frame; without it at the cloth's height; since 1.2"},
               p.height_mm);
}

void describe(Fields& fields, FixedPoint& p) {
  constexpr std::size_t kDigits = std::size_t{2} * kPointCells * kPointCells;
  fields.value({"id", "Stays the same when it is measured again", {}, kMustSay}, p.id);
  fields.value({"x_px", "Its middle, on the active area", {}, kMustSay}, p.x_px);
  fields.value({"y_px", "Its middle, on the active area", {}, kMustSay}, p.y_px);
  fields.value({"sigma_px", "Of either, a standard deviation", kNotNegative, kMustSay}, p.sigma_px);
  fields.value({"cell_px", "Side of a cell of its picture, pixels", {2, 1000}, kMustSay}, p.cell_px);
  fields.require(p.cell_px % 2 == 0, "cell_px", "must be even");
  fields.value({"grey", "20 x 20 cells by rows, two hexadecimal digits each, ff the brightest", {}, kMustSay},
               p.grey);
  fields.require(
      p.grey.size() == kDigits && p.grey.find_first_not_of("0123456789abcdef") == std::string::npos, "grey",
      "must be 800 hexadecimal digits");
}

void describe(Fields& fields, LightsPart& p) {
  constexpr std::array<const char*, 2> kKinds = {"near", "distant"};
  NearLights near;
  DistantLights distant;
  if (auto* lights = std::get_if<NearLights>(&p.lights)) near = std::move(*lights);
  if (auto* lights = std::get_if<DistantLights>(&p.lights)) distant = std::move(*lights);
  std::size_t kind = p.lights.index();
  fields.choice({"kind", "LEDs, or lights so far away that all pixels see the same", {}, kMustSay}, kind,
                kKinds);
  fields.only_if(kind == 0, [&] { describe(fields, near); });
  fields.only_if(kind == 1, [&] { describe(fields, distant); });
  p.lights = kind == 0 ? Lights(std::move(near)) : Lights(std::move(distant));
  fields.list({"patches", "Of known reflectance, in the frame of every scan; since 1.1", {}, kUnlessEmpty},
              p.patches);
  fields.object({"covariance", "Of what was fitted; since 1.1", {}, kUnlessEmpty}, p.covariance);
  fields.list({"points", "That stay where they are beside the cloth; since 1.3", {}, kUnlessEmpty}, p.points);
}

const char* schema_name(const LightsPart& p) {
  if (!p.points.empty()) return "weft.lights/1.3";
  const bool is_newer = std::ranges::any_of(
      p.patches, [](const WhitePatch& each) { return each.delta != 0 || each.height_mm; });
  if (is_newer) return "weft.lights/1.2";
  return p.patches.empty() && !p.covariance ? "weft.lights/1" : "weft.lights/1.1";
}

}  // namespace weft
