// SPDX-License-Identifier: Apache-2.0
#include "bench/numerics/numerics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "bench/numerics/plain_formula.h"
#include "bench/oracles/hard_lights.h"
#include "bench/oracles/oracle_rig.h"
#include "bench/oracles/quad_oracle.h"
#include "core/solve/solve_record.h"
#include "solver/in_double/pixel.h"

namespace weft::bench {
namespace {

using test::OracleRow;
using test::Trial;
using test::Truth;
using Spoil = std::function<void(Trial& trial)>;
using TruthOf = std::function<Truth(int x, int y)>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const Size kFrame = {320, 4};
const Rect kTile = {0, 0, 300, 1};

/// What the angles of a case are measured to.
enum class Against {
  kQuad,    ///< exact arithmetic on the readings that can be used
  kTruth,   ///< where readings in shadow do not fit the model
  kNothing  ///< where nothing can be known
};

struct Case {
  std::string number, what;
  LightField field;
  TruthOf truth;
  Spoil spoil;
  Against against = Against::kQuad;
  std::optional<NoiseModel> noise = {};
  Rect tile = kTile;
};

LightField distant_field(DistantLights lights) {
  return *LightField::make(std::move(lights), std::nullopt, kFrame, 0);
}

DistantLights ten_distant() {
  DistantLights lights;
  for (const NearLight& led : test::ten_leds().leds)
    lights.lights.push_back({normalized(led.position_mm), {1, 1, 1}});
  return lights;
}

Truth cloth(int x, int y, double most_deg = 15) {
  test::Random random(static_cast<std::uint64_t>(y) * 1000 + static_cast<std::uint64_t>(x));
  return {test::random_normal(random, most_deg), {0.4, 0.4, 0.4}};
}

/// A cloth that faces a cluster of lights.
Truth facing_cluster(int x, int y) {
  const Vec3 z = cloth(x, y, 10).normal, axis = test::cluster_axis(), across = {0, 1, 0};
  return {z.x * across + z.y * cross(axis, across) + z.z * axis, {0.4, 0.4, 0.4}};
}

TruthOf level() {
  return [](int x, int y) { return cloth(x, y); };
}

/// set(reading, x) for the readings of lights `from` to `to`.
template <typename Set>
Spoil each(std::size_t from, std::size_t to, const Set& set) {
  return [=](Trial& trial) {
    for (std::size_t k = from; k < to; ++k) {
      for (int x = 0; x < trial.normals.width(); ++x) set(trial.reading(k)(x, 0), x);
    }
  };
}
Spoil nothing() {
  return [](Trial&) {};
}
Spoil becomes(std::size_t from, std::size_t to, float value) {
  return each(from, to, [value](float& r, int) { r = value; });
}

DistantLights twelve_decades_of_light() {
  DistantLights lights = ten_distant();
  for (std::size_t k = 0; k < 10; ++k)
    lights.lights[k].irradiance_rgb.fill(std::pow(10, -6 + 12.0 * static_cast<double>((k * 7) % 10) / 9));
  return lights;
}

DistantLights with_one_doubled() {
  DistantLights lights = test::clustered_lights(4, 2);
  lights.lights.push_back(lights.lights[1]);
  return lights;
}

DistantLights three_and_seven_copies() {
  DistantLights lights = test::clustered_lights(3, 2);
  for (int k = 0; k < 7; ++k) lights.lights.push_back(lights.lights[0]);
  return lights;
}

/// Three rings, the lowest one degree above the table.
DistantLights dome() {
  DistantLights lights;
  for (const double zenith_deg : {30.0, 60.0, 89.0}) {
    for (int i = 0; i < 8; ++i) {
      const double azimuth = radians(45.0 * i + zenith_deg), zenith = radians(zenith_deg);
      lights.lights.push_back(
          {{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)},
           {1, 1, 1}});
    }
  }
  return lights;
}

Truth grazing(int x, int) {
  const double tilt = radians(60 + 35.0 * x / 299), azimuth = 0.7 * x;
  return {{std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)},
          {0.4, 0.4, 0.4}};
}

DistantLights scaled(double factor) {
  DistantLights lights = ten_distant();
  for (DistantLight& light : lights.lights) light.irradiance_rgb.fill(factor);
  return lights;
}

Vec3 turned(Vec3 v) {
  const Vec3 axis = normalized({1, 2, 3});
  const double c = std::cos(radians(25)), s = std::sin(radians(25));
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

DistantLights turned_lights() {
  DistantLights lights = ten_distant();
  for (DistantLight& light : lights.lights) light.direction = turned(light.direction);
  return lights;
}

Truth turned_cloth(int x, int y) {
  const Truth still = cloth(x, y);
  return {turned(still.normal), still.albedo};
}

std::vector<Case> all_cases() {
  const auto clustered = [](double condition) { return distant_field(test::clustered_lights(6, condition)); };
  const LightField ten = distant_field(ten_distant());
  const NoiseModel noise = {0, 1e-6, 0};
  const Truth black = {{0, 0, 1}, {0, 0, 0}};
  const auto black_cloth = [black](int, int) { return black; };
  const auto noisy = [noise](Trial& trial) { trial.add_noise(noise, 3); };
  const auto by_albedo = [](double low, double high) {
    return [=](int x, int y) {
      const double a = std::pow(10, low + (high - low) * x / 299);
      return Truth{cloth(x, y).normal, {a, a, a}};
    };
  };
  const Rect beside_line = {test::kLinePixel, 0, test::kLinePixel + 100, 1};
  const auto towards_leds = [](int, int) { return Truth{{-0.5, 0, std::sqrt(0.75)}, {0.4, 0.4, 0.4}}; };
  std::vector<Case> cases;
  for (const double condition : {3.0, 20.0, 1e3, 1e5})
    cases.push_back({"1", fmt::format("six lights that close up, condition {:g}", condition),
                     clustered(condition), facing_cluster, nothing()});
  cases.push_back({"1",
                   "three LEDs almost in a plane with the cloth point, condition 1e6 to 1e8",
                   test::coplanar_field(1e8),
                   towards_leds,
                   becomes(3, 6, kNaN),
                   Against::kQuad,
                   {},
                   beside_line});
  cases.push_back(
      {"2", "one of four lights twice", distant_field(with_one_doubled()), facing_cluster, [](Trial& trial) {
         trial.add_noise({1e-4, 0, 0}, 5);
         for (int x = 0; x < 300; ++x) trial.reading(4)(x, 0) = trial.reading(1)(x, 0);
       }});
  cases.push_back({"2", "eight copies of one light and one other", distant_field(three_and_seven_copies()),
                   facing_cluster, becomes(2, 3, kNaN), Against::kNothing});
  cases.push_back({"3", "two lights", ten, level(), becomes(2, 10, kNaN), Against::kNothing});
  cases.push_back({"4", "exactly three lights, condition 16", distant_field(test::clustered_lights(3, 16)),
                   facing_cluster, nothing()});
  cases.push_back({"5", "all readings below three sigma", ten, black_cloth,
                   each(0, 10, [](float& r, int x) { r = 1e-3f * static_cast<float>(std::sin(x + 1)); }),
                   Against::kNothing, noise});
  cases.push_back({"6", "three of ten readings saturated", ten, level(), becomes(2, 5, kInfinity)});
  cases.push_back({"7", "zero albedo: noise alone", ten, black_cloth, noisy, Against::kNothing, noise});
  cases.push_back(
      {"8", "intensities over twelve decades", distant_field(twelve_decades_of_light()), level(), nothing()});
  cases.push_back({"8", "albedo over twelve decades", ten, by_albedo(-6, 6), nothing()});
  cases.push_back({"9", "a NaN among the readings", ten, level(), becomes(4, 5, kNaN)});
  cases.push_back({"9", "a negative reading", ten, level(), becomes(4, 5, -0.01f), Against::kTruth});
  cases.push_back({"9", "denormal readings", ten, by_albedo(-42, -39), nothing()});
  cases.push_back({"10", "normals of 60 to 95 degrees, lights behind them at 0", distant_field(dome()),
                   grazing, nothing(), Against::kTruth});
  cases.push_back({"14", "intensities times 1e-30", distant_field(scaled(1e-30)), level(), nothing()});
  cases.push_back({"14", "intensities times 1e30", distant_field(scaled(1e30)), level(), nothing()});
  cases.push_back({"15", "lights and cloth turned by 25 degrees", distant_field(turned_lights()),
                   turned_cloth, nothing()});
  return cases;
}

/// The worst of some angles; nothing once one of them is no number.
class Worst {
 public:
  void add(const std::optional<Vec3>& n, Vec3 exact) {
    if (n) {
      worst_ = std::max(worst_, angle_deg(*n, exact));
    } else {
      is_number_ = false;
    }
  }
  Json json() const { return is_number_ ? Json(worst_) : Json(); }

 private:
  double worst_ = 0;
  bool is_number_ = true;
};

/// What solved a pixel in the end: a kernel's own answer is another than that of double to the last bit.
enum Path { kFloat32, kEquations, kQr, kSvd, kUnsolved };

Path path_of(const Trial& trial, int x, const solver::PixelSolution& in_double) {
  if ((trial.status(x, 0) & kNoSolution) != 0) return kUnsolved;
  const Vec3 n = in_double.normal;
  const bool same = trial.normals(x, 0, 0) == static_cast<float>(n.x) &&
                    trial.normals(x, 0, 1) == static_cast<float>(n.y) &&
                    trial.normals(x, 0, 2) == static_cast<float>(n.z) &&
                    trial.residual(x, 0) == static_cast<float>(in_double.residual);
  if (!same) return kFloat32;
  switch (in_double.path) {
    case solver::EquationsSolvedBy::kSvd:
      return kSvd;
    case solver::EquationsSolvedBy::kQr:
      return kQr;
    default:
      return kEquations;
  }
}

std::string flags_of(int status) {
  std::string flags;
  for (const StatusName& name : kStatusNames) {
    if ((status & name.bit) != 0) flags += (flags.empty() ? "" : " ") + std::string(name.name);
  }
  return flags;
}

Json row_of(const Case& c) {
  Trial trial(c.field, c.tile, 1, c.truth);
  c.spoil(trial);
  trial.solve(*solver::fast_method(), c.noise);
  Worst plain_float32, plain_double, ours;
  int flags = 0;
  std::array<int, 5> paths = {};
  for (int x = 0; x < c.tile.width(); ++x) {
    const std::vector<solver::PixelRow> rows = trial.rows(x, 0);
    flags |= trial.status(x, 0);
    ++paths[path_of(trial, x, solver::solve_pixel(rows, {1, true, c.noise}))];
    if (c.against == Against::kNothing) continue;
    const bool solved = (trial.status(x, 0) & kNoSolution) == 0;
    const Vec3 exact = c.against == Against::kTruth ? c.truth(x, 0).normal
                       : solved                     ? test::solve_in_quad(test::oracle_rows(rows, 1)).normal
                                                    : Vec3{0, 0, 1};
    if (!solved) continue;
    ours.add(trial.normal(x, 0), exact);
    plain_float32.add(plain_normal<float>(rows), exact);
    plain_double.add(plain_normal<double>(rows), exact);
  }
  const bool known = c.against != Against::kNothing;
  Json row = {{"case", c.number}, {"what", c.what}};
  row["plain_float32_deg"] = known ? plain_float32.json() : Json();
  row["plain_double_deg"] = known ? plain_double.json() : Json();
  row["ours_deg"] = known ? ours.json() : Json();
  row["flags"] = flags_of(flags);
  const auto percent = [&](Path path) { return 100.0 * paths[path] / c.tile.width(); };
  row["float32"] = percent(kFloat32);
  row["double_normal_equations"] = percent(kEquations);
  row["double_qr"] = percent(kQr);
  row["double_svd"] = percent(kSvd);
  row["unsolved"] = percent(kUnsolved);
  return row;
}

}  // namespace

Rows numerics_cases() {
  Rows rows;
  for (const Case& c : all_cases()) rows.push_back(row_of(c));
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
      note(0, plain_normal<float>(pixels[x]));
      note(1, qr_normal<float>(pixels[x]));
      note(2, svd_normal<float>(pixels[x]));
      note(3, plain_normal<double>(pixels[x]));
      note(4, svd_normal<double>(pixels[x]));
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
