// SPDX-License-Identifier: Apache-2.0
#include "core/image/color_spaces.h"

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace weft {
namespace {

constexpr Mat3 kXyzFromRec709 = {{{0.4124564, 0.3575761, 0.1804375},
                                  {0.2126729, 0.7151522, 0.0721750},
                                  {0.0193339, 0.1191920, 0.9503041}}};
constexpr Mat3 kRec709FromXyz = {{{3.2404542, -1.5371385, -0.4985314},
                                  {-0.9692660, 1.8760108, 0.0415560},
                                  {0.0556434, -0.2040259, 1.0572252}}};
// Bradford's adaptation from D50 to D65.
constexpr Mat3 kD65FromD50 = {{{0.9555766, -0.0230393, 0.0631636},
                               {-0.0282895, 1.0099416, 0.0210077},
                               {0.0122982, -0.0204830, 1.3299098}}};

constexpr double kEpsilon = 216.0 / 24389, kKappa = 24389.0 / 27;

std::array<double, 3> times(const Mat3& m, const std::array<double, 3>& v) {
  const Vec3 r = m * Vec3{v[0], v[1], v[2]};
  return {r.x, r.y, r.z};
}

double squared(double v) {
  return v * v;
}

// An angle in degrees, from 0 to below 360; 0 for a grey.
double hue_deg(double b, double a) {
  if (a == 0 && b == 0) return 0;
  const double h = degrees(std::atan2(b, a));
  return h < 0 ? h + 360 : h;
}

double cos_deg(double angle_in_degrees) {
  return std::cos(radians(angle_in_degrees));
}

}  // namespace

Xyz xyz_of_rec709(const Rgb& rgb) {
  return times(kXyzFromRec709, rgb);
}

Rgb rec709_of_xyz(const Xyz& xyz) {
  return times(kRec709FromXyz, xyz);
}

Rgb rec709_of_srgb(const Rgb& display) {
  Rgb linear = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const double v = display[c];
    linear[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return linear;
}

Rgb srgb_of_rec709(const Rgb& rgb) {
  Rgb display = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const double v = std::clamp(rgb[c], 0.0, 1.0);
    display[c] = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  }
  return display;
}

Lab lab_of_xyz(const Xyz& xyz, const Xyz& white) {
  const auto f = [](double t) { return t > kEpsilon ? std::cbrt(t) : (kKappa * t + 16) / 116; };
  const double x = f(xyz[0] / white[0]), y = f(xyz[1] / white[1]), z = f(xyz[2] / white[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Xyz xyz_of_lab(const Lab& lab, const Xyz& white) {
  const auto inverse = [](double f) { return f * f * f > kEpsilon ? f * f * f : (116 * f - 16) / kKappa; };
  const double y = (lab.L + 16) / 116;
  return {white[0] * inverse(y + lab.a / 500), white[1] * inverse(y), white[2] * inverse(y - lab.b / 200)};
}

Rgb rec709_of_lab_d50(const Lab& lab) {
  return rec709_of_xyz(times(kD65FromD50, xyz_of_lab(lab, kWhiteD50)));
}

Xyy xyy_of_xyz(const Xyz& xyz) {
  const double sum = xyz[0] + xyz[1] + xyz[2];
  const Xyz& of = sum > 0 ? xyz : kWhiteD65;
  const double all = of[0] + of[1] + of[2];
  return {of[0] / all, of[1] / all, xyz[1]};
}

Xyz xyz_of_xyy(const Xyy& xyy) {
  if (!(xyy[1] > 0)) return {};
  const double scale = xyy[2] / xyy[1];
  return {scale * xyy[0], xyy[2], scale * (1 - xyy[0] - xyy[1])};
}

double ciede2000(const Lab& first, const Lab& second) {
  const double mean_c = (std::hypot(first.a, first.b) + std::hypot(second.a, second.b)) / 2;
  const double c7 = std::pow(mean_c, 7), c25 = std::pow(25.0, 7);
  const double g = 0.5 * (1 - std::sqrt(c7 / (c7 + c25)));
  const double a1 = (1 + g) * first.a, a2 = (1 + g) * second.a;
  const double chroma1 = std::hypot(a1, first.b), chroma2 = std::hypot(a2, second.b);
  const double hue1 = hue_deg(first.b, a1), hue2 = hue_deg(second.b, a2);

  const bool grey = chroma1 * chroma2 == 0;
  double turn = grey ? 0 : hue2 - hue1;
  if (turn > 180) turn -= 360;
  if (turn < -180) turn += 360;
  const double dL = second.L - first.L, dC = chroma2 - chroma1;
  const double dH = 2 * std::sqrt(chroma1 * chroma2) * std::sin(radians(turn) / 2);

  const double L = (first.L + second.L) / 2, C = (chroma1 + chroma2) / 2;
  double h = hue1 + hue2;
  if (!grey) {
    if (std::abs(hue1 - hue2) > 180) h += h < 360 ? 360 : -360;
    h /= 2;
  }
  const double T = 1 - 0.17 * cos_deg(h - 30) + 0.24 * cos_deg(2 * h) + 0.32 * cos_deg(3 * h + 6) -
                   0.20 * cos_deg(4 * h - 63);
  const double theta = 30 * std::exp(-squared((h - 275) / 25));
  const double C7 = std::pow(C, 7);
  const double RC = 2 * std::sqrt(C7 / (C7 + c25));
  const double SL = 1 + 0.015 * squared(L - 50) / std::sqrt(20 + squared(L - 50));
  const double SC = 1 + 0.045 * C, SH = 1 + 0.015 * C * T;
  const double RT = -std::sin(radians(2 * theta)) * RC;
  const double l = dL / SL, c = dC / SC, t = dH / SH;
  return std::sqrt(std::max(l * l + c * c + t * t + RT * c * t, 0.0));
}

}  // namespace weft
