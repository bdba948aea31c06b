// SPDX-License-Identifier: Apache-2.0
#include "bench/numerics/numerics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "bench/oracles/hard_lights.h"
#include "bench/oracles/oracle_rig.h"
#include "bench/oracles/quad_oracle.h"
#include "core/solve/solve_record.h"
#include "solver/in_double/pixel.h"
#include "torture/pixel_cases.h"
#include "torture/plain_formula.h"

namespace weft::bench {
namespace {

Json row_of(const torture::PixelCase& pixels) {
  const torture::PixelOutcome outcome = torture::outcome_of(pixels);
  const auto number = [](const std::optional<double>& deg) { return deg ? Json(*deg) : Json(); };
  Json row = {{"case", pixels.number}, {"what", pixels.what}};
  row["plain_float32_deg"] = number(outcome.plain_float32_deg);
  row["plain_double_deg"] = number(outcome.plain_double_deg);
  row["ours_deg"] = number(outcome.ours_deg);
  row["flags"] = torture::names_of_status(outcome.status);
  row["float32"] = outcome.percent[torture::PixelOutcome::kFloat32];
  row["double_normal_equations"] = outcome.percent[torture::PixelOutcome::kEquations];
  row["double_qr"] = outcome.percent[torture::PixelOutcome::kQr];
  row["double_svd"] = outcome.percent[torture::PixelOutcome::kSvd];
  row["unsolved"] = outcome.percent[torture::PixelOutcome::kUnsolved];
  return row;
}

}  // namespace

Rows numerics_cases() {
  Rows rows;
  for (const torture::PixelCase& pixels : torture::pixel_cases()) rows.push_back(row_of(pixels));
  return rows;
}

namespace {

using solver::PixelRow;

constexpr int kPixels = 300;
constexpr std::size_t kLights = 6;

/// The rows of one pixel under lights of a condition number, exact in float32 as far as float32 can tell
/// lights apart.
std::vector<std::vector<PixelRow>> pixels_at(double condition) {
  DistantLights lights = test::clustered_lights(kLights, std::min(condition, 1e7));
  const Vec3 axis = test::cluster_axis(), across = {0, 1, 0}, up = cross(axis, across);
  const double closer = std::max(1.0, condition / 1e7);
  std::vector<std::vector<PixelRow>> pixels;
  for (int x = 0; x < kPixels; ++x) {
    test::Random random(static_cast<std::uint64_t>(x));
    const Vec3 z = test::random_normal(random, 10), n = z.x * across + z.y * up + z.z * axis;
    std::vector<PixelRow> rows;
    for (const DistantLight& light : lights.lights) {
      const Vec3 aside = light.direction - dot(light.direction, axis) * axis;
      const Vec3 l = closer > 1 ? normalized(axis + (1 / closer) * aside) : light.direction;
      const double reading = static_cast<float>(0.4 * dot(n, l));
      rows.push_back({l, {1, 1, 1}, {reading, reading, reading}});
    }
    pixels.push_back(std::move(rows));
  }
  return pixels;
}

/// The level `fast` on these pixels, whose lights are the same.
struct Ours {
  std::vector<Vec3> normals;
  bool flagged = false;
};

Ours solve_ours(const std::vector<std::vector<PixelRow>>& pixels) {
  DistantLights lights;
  for (const PixelRow& row : pixels[0]) lights.lights.push_back({row.direction, {1, 1, 1}});
  const Size size = {kPixels, 1};
  const Result<LightField> field = LightField::make(lights, std::nullopt, size, 0);
  Ours ours;
  if (!field) {
    // A rig like this is refused as a whole; a pixel may still be left with such lights, and goes straight to
    // double.
    for (const std::vector<PixelRow>& rows : pixels) {
      const solver::PixelSolution s = solver::solve_pixel(rows, {1, true, {}});
      const Vec3 n = s.normal;
      ours.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
      ours.flagged |= (s.status & (kIllConditioned | kNoSolution)) != 0;
    }
    return ours;
  }
  test::Trial trial(*field, {0, 0, kPixels, 1}, 1, [](int, int) { return test::Truth{{0, 0, 1}, {}}; });
  for (std::size_t k = 0; k < kLights; ++k) {
    for (int x = 0; x < kPixels; ++x)
      trial.reading(k)(x, 0) = static_cast<float>(pixels[static_cast<std::size_t>(x)][k].reading[0]);
  }
  trial.solve(*solver::fast_method());
  for (int x = 0; x < kPixels; ++x) {
    ours.normals.push_back(trial.normal(x, 0));
    ours.flagged |= (trial.status(x, 0) & (kIllConditioned | kNoSolution)) != 0;
  }
  return ours;
}

}  // namespace

Rows numerics_curve() {
  Rows rows;
  for (double exponent = 0.125; exponent < 8.01; exponent += 0.125) {
    const std::vector<std::vector<PixelRow>> pixels = pixels_at(std::pow(10, exponent));
    const Ours ours = solve_ours(pixels);
    double condition = 0;
    std::array<double, 6> worst = {};
    for (std::size_t x = 0; x < pixels.size(); ++x) {
      const test::OracleSolution exact = test::solve_in_quad(test::oracle_rows(pixels[x], 1));
      condition = exact.condition;
      const auto note = [&](std::size_t method, const std::optional<Vec3>& n) {
        worst[method] = std::max(worst[method], n ? angle_deg(*n, exact.normal) : 180.0);
      };
      note(0, torture::plain_normal<float>(pixels[x]));
      note(1, torture::qr_normal<float>(pixels[x]));
      note(2, torture::svd_normal<float>(pixels[x]));
      note(3, torture::plain_normal<double>(pixels[x]));
      note(4, torture::svd_normal<double>(pixels[x]));
      note(5, ours.normals[x]);
    }
    rows.push_back({{"condition", condition},
                    {"float32_normal_equations_deg", worst[0]},
                    {"float32_qr_deg", worst[1]},
                    {"float32_svd_deg", worst[2]},
                    {"double_normal_equations_deg", worst[3]},
                    {"double_svd_deg", worst[4]},
                    {"ours_deg", worst[5]},
                    {"flagged", ours.flagged}});
  }
  return rows;
}

namespace {

// Millimetres of a page; text of 3 mm stays readable where the plot is printed at half size.
constexpr double kWidth = 180, kHeight = 110, kLeft = 22, kRight = 140, kTop = 8, kBottom = 92;
constexpr double kLeastError = 1e-13, kMostError = 180, kMostCondition = 1e8;

double x_of(double condition) {
  return kLeft + (kRight - kLeft) * std::log10(condition) / std::log10(kMostCondition);
}
double y_of(double error_deg) {
  const double share = std::log10(std::clamp(error_deg, kLeastError, kMostError) / kLeastError) /
                       std::log10(kMostError / kLeastError);
  return kBottom - (kBottom - kTop) * share;
}

struct Line {
  const char* key;
  const char* label;
  const char* colour;
  const char* dashes;  ///< what tells it apart without colour
  double width;
  double label_y;  ///< beside the right edge
};

constexpr std::array<Line, 6> kLines = {
    {{"float32_normal_equations_deg", "normal equations, float32", "#b2182b", "none", 0.5, 10},
     {"float32_svd_deg", "SVD, float32", "#d6604d", "2 1", 0.5, 16},
     {"float32_qr_deg", "QR, float32", "#e08214", "0.6 0.8", 0.5, 22},
     {"double_normal_equations_deg", "normal equations, double", "#2166ac", "none", 0.5, 34},
     {"double_svd_deg", "SVD, double", "#4393c3", "2 1", 0.5, 62},
     {"ours_deg", "weft solve --quality fast", "#000000", "none", 1.1, 46}}};

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, words);
}

std::string axes() {
  std::string svg;
  for (int decade = 0; decade <= 8; ++decade) {
    const double x = x_of(std::pow(10, decade));
    svg += fmt::format("<path class=\"grid\" d=\"M{:.2f} {} V{}\"/>\n", x, kTop, kBottom);
    svg += text(x, kBottom + 4.5, "middle", decade == 0 ? "1" : fmt::format("1e{}", decade));
  }
  for (int decade = -12; decade <= 2; decade += 2) {
    const double y = y_of(std::pow(10, decade));
    svg += fmt::format("<path class=\"grid\" d=\"M{} {:.2f} H{}\"/>\n", kLeft, y, kRight);
    svg += text(kLeft - 1.5, y + 1, "end", decade == 0 ? "1" : fmt::format("1e{}", decade));
  }
  svg += text((kLeft + kRight) / 2, kBottom + 11, "middle", "condition number of the light directions");
  svg += fmt::format(
      "<text transform=\"translate(5 {:.1f}) rotate(-90)\" text-anchor=\"middle\">worst of 300 "
      "pixels, degrees</text>\n",
      (kTop + kBottom) / 2);
  return svg;
}

std::string curve_of(const Rows& rows, const Line& line) {
  std::string points;
  for (const Json& row : rows) {
    points += fmt::format("{:.2f},{:.2f} ", x_of(row["condition"]), y_of(row[line.key]));
  }
  const double end = y_of(rows.back()[line.key]);
  return fmt::format("<polyline points=\"{}\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"/>\n",
                     points, line.colour, line.width, line.dashes) +
         fmt::format("<path d=\"M{} {:.2f} L{} {:.2f}\" stroke=\"{}\" stroke-width=\"0.2\"/>\n", kRight + 0.5,
                     end, kRight + 3.5, line.label_y - 1, line.colour) +
         text(kRight + 4, line.label_y, "start", line.label);
}

// From where on pixels say that they are ill conditioned.
std::string flagged(const Rows& rows) {
  const auto first =
      std::find_if(rows.begin(), rows.end(), [](const Json& row) { return row["flagged"].get<bool>(); });
  if (first == rows.end()) return {};
  const double x = x_of((*first)["condition"]);
  return fmt::format("<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\" fill=\"#e4e4e4\"/>\n", x,
                     kTop, kRight - x, kBottom - kTop) +
         text((x + kRight) / 2, kTop - 2, "middle", "flagged");
}

}  // namespace

std::string numerics_plot(const Rows& curve) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 "
      "{} {}\">\n",
      kWidth, kHeight, kWidth, kHeight);
  svg +=
      "<style>text{font:3px sans-serif;fill:#000}.grid{stroke:#bbb;stroke-width:.15}polyline{fill:none;"
      "stroke-linejoin:round}</style>\n";
  svg += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n", kWidth, kHeight);
  svg += flagged(curve) + axes();
  for (const Line& line : kLines) svg += curve_of(curve, line);
  return svg + "</svg>\n";
}

}  // namespace weft::bench
