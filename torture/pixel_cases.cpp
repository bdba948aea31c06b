// SPDX-License-Identifier: Apache-2.0
#include "torture/pixel_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/oracles/hard_lights.h"
#include "bench/oracles/quad_oracle.h"
#include "core/solve/solve_record.h"
#include "solver/in_double/pixel.h"
#include "torture/plain_formula.h"

namespace weft::torture {
namespace {

using test::Trial;
using test::Truth;
using Spoil = std::function<void(Trial& trial)>;
using TruthOf = std::function<Truth(int x, int y)>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const Size kFrame = {320, 4};

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

TruthOf by_albedo(double low, double high) {
  return [=](int x, int y) {
    const double a = std::pow(10, low + (high - low) * x / 299);
    return Truth{cloth(x, y).normal, {a, a, a}};
  };
}

Truth black_cloth(int, int) {
  return {{0, 0, 1}, {0, 0, 0}};
}

// Four readings of three lights tell nothing of the light that is there twice.
void read_twice(Trial& trial) {
  trial.add_noise({1e-4, 0, 0}, 5);
  for (int x = 0; x < 300; ++x) trial.reading(4)(x, 0) = trial.reading(1)(x, 0);
}

std::vector<PixelCase> cases_of_lights() {
  const auto clustered = [](std::size_t count, double condition) {
    return distant_field(test::clustered_lights(count, condition));
  };
  // Twice the condition number squared times the rounding of float32, up to where double takes over.
  const std::array<std::pair<double, double>, 4> ladder = {{{3, 1e-4}, {20, 5e-3}, {1e3, 1e-4}, {1e5, 1e-4}}};
  std::vector<PixelCase> cases;
  for (const auto& [condition, within_deg] : ladder)
    cases.push_back({.number = "1",
                     .what = fmt::format("six lights that close up, condition {:g}", condition),
                     .field = clustered(6, condition),
                     .truth = facing_cluster,
                     .spoil = nothing(),
                     .within_deg = within_deg,
                     .is_hard = condition > 100});
  cases.push_back({.number = "1",
                   .what = "three LEDs almost in a plane with the cloth point, condition 1e6 to 1e8",
                   .field = test::coplanar_field(1e8),
                   .truth =
                       [](int, int) {
                         return Truth{{-0.5, 0, std::sqrt(0.75)}, {0.4, 0.4, 0.4}};
                       },
                   .spoil = becomes(3, 6, kNaN),
                   .flag = "ILL_CONDITIONED",
                   .tile = {test::kLinePixel, 0, test::kLinePixel + 100, 1}});
  cases.push_back({.number = "2",
                   .what = "one of four lights twice",
                   .field = distant_field(with_one_doubled()),
                   .truth = facing_cluster,
                   .spoil = read_twice,
                   .is_hard = false});
  cases.push_back({.number = "2",
                   .what = "eight copies of one light and one other",
                   .field = distant_field(three_and_seven_copies()),
                   .truth = facing_cluster,
                   .spoil = becomes(2, 3, kNaN),
                   .flag = "NO_SOLUTION",
                   .against = Against::kNothing});
  cases.push_back({.number = "3",
                   .what = "two lights",
                   .field = distant_field(ten_distant()),
                   .truth = level(),
                   .spoil = becomes(2, 10, kNaN),
                   .flag = "NO_SOLUTION",
                   .against = Against::kNothing});
  cases.push_back({.number = "4",
                   .what = "exactly three lights, condition 16",
                   .field = clustered(3, 16),
                   .truth = facing_cluster,
                   .spoil = nothing(),
                   .within_deg = 5e-3,
                   .flag = "ZERO_DOF",
                   .is_hard = false});
  return cases;
}

std::vector<PixelCase> cases_of_readings() {
  const LightField ten = distant_field(ten_distant());
  const NoiseModel noise = {0, 1e-6, 0};
  std::vector<PixelCase> cases;
  cases.push_back(
      {.number = "5",
       .what = "all readings below three sigma",
       .field = ten,
       .truth = black_cloth,
       .spoil = each(0, 10, [](float& r, int x) { r = 1e-3f * static_cast<float>(std::sin(x + 1)); }),
       .flag = "DARK",
       .against = Against::kNothing,
       .noise = noise});
  cases.push_back({.number = "6",
                   .what = "three of ten readings saturated",
                   .field = ten,
                   .truth = level(),
                   .spoil = becomes(2, 5, kInfinity),
                   .flag = "SATURATED"});
  cases.push_back({.number = "7",
                   .what = "zero albedo: noise alone",
                   .field = ten,
                   .truth = black_cloth,
                   .spoil = [noise](Trial& trial) { trial.add_noise(noise, 3); },
                   .flag = "DARK",
                   .against = Against::kNothing,
                   .noise = noise});
  cases.push_back({.number = "8",
                   .what = "intensities over twelve decades",
                   .field = distant_field(twelve_decades_of_light()),
                   .truth = level(),
                   .spoil = nothing()});
  cases.push_back({.number = "8",
                   .what = "albedo over twelve decades",
                   .field = ten,
                   .truth = by_albedo(-6, 6),
                   .spoil = nothing(),
                   .is_hard = false});
  cases.push_back({.number = "9",
                   .what = "a NaN among the readings",
                   .field = ten,
                   .truth = level(),
                   .spoil = becomes(4, 5, kNaN),
                   .flag = "INVALID_READING"});
  cases.push_back({.number = "9",
                   .what = "a negative reading",
                   .field = ten,
                   .truth = level(),
                   .spoil = becomes(4, 5, -0.01f),
                   .flag = "SHADOWED",
                   .against = Against::kTruth});
  cases.push_back({.number = "9",
                   .what = "denormal readings",
                   .field = ten,
                   .truth = by_albedo(-42, -39),
                   .spoil = nothing()});
  return cases;
}

std::vector<PixelCase> cases_of_scale() {
  std::vector<PixelCase> cases;
  cases.push_back({.number = "10",
                   .what = "normals of 60 to 95 degrees, lights behind them at 0",
                   .field = distant_field(dome()),
                   .truth = grazing,
                   .spoil = nothing(),
                   .flag = "SHADOWED",
                   .against = Against::kTruth});
  for (const auto& [factor, what] :
       {std::pair{1e-30, "intensities times 1e-30"}, {1e30, "intensities times 1e30"}})
    cases.push_back({.number = "14",
                     .what = what,
                     .field = distant_field(scaled(factor)),
                     .truth = level(),
                     .spoil = nothing()});
  cases.push_back({.number = "15",
                   .what = "lights and cloth turned by 25 degrees",
                   .field = distant_field(turned_lights()),
                   .truth = turned_cloth,
                   .spoil = nothing(),
                   .is_hard = false});
  return cases;
}

/// The worst of some angles; nothing once one of them is no number, or where there was none.
class Worst {
 public:
  void add(const std::optional<Vec3>& n, Vec3 exact) {
    is_number_ &= n.has_value();
    if (n) worst_ = std::max(worst_.value_or(0), angle_deg(*n, exact));
  }
  std::optional<double> deg() const { return is_number_ ? worst_ : std::nullopt; }

 private:
  std::optional<double> worst_;
  bool is_number_ = true;
};

// A kernel's own answer is another than that of double to the last bit.
PixelOutcome::Path path_of(const Trial& trial, int x, const solver::PixelSolution& in_double) {
  if ((trial.status(x, 0) & kNoSolution) != 0) return PixelOutcome::kUnsolved;
  const Vec3 n = in_double.normal;
  const bool same = trial.normals(x, 0, 0) == static_cast<float>(n.x) &&
                    trial.normals(x, 0, 1) == static_cast<float>(n.y) &&
                    trial.normals(x, 0, 2) == static_cast<float>(n.z) &&
                    trial.residual(x, 0) == static_cast<float>(in_double.residual);
  if (!same) return PixelOutcome::kFloat32;
  switch (in_double.path) {
    case solver::EquationsSolvedBy::kSvd:
      return PixelOutcome::kSvd;
    case solver::EquationsSolvedBy::kQr:
      return PixelOutcome::kQr;
    default:
      return PixelOutcome::kEquations;
  }
}

}  // namespace

std::vector<PixelCase> pixel_cases() {
  std::vector<PixelCase> cases = cases_of_lights();
  for (const auto& more : {cases_of_readings(), cases_of_scale()})
    cases.insert(cases.end(), more.begin(), more.end());
  return cases;
}

PixelOutcome outcome_of(const PixelCase& pixels) {
  Trial trial(pixels.field, pixels.tile, 1, pixels.truth);
  pixels.spoil(trial);
  trial.solve(*solver::fast_method(), pixels.noise);
  Worst plain_float32, plain_double, ours;
  PixelOutcome outcome;
  for (int x = 0; x < pixels.tile.width(); ++x) {
    const std::vector<solver::PixelRow> rows = trial.rows(x, 0);
    const bool solved = (trial.status(x, 0) & kNoSolution) == 0;
    outcome.status |= trial.status(x, 0);
    outcome.percent[path_of(trial, x, solver::solve_pixel(rows, {1, true, pixels.noise}))] +=
        100.0 / pixels.tile.width();
    if (!solved && pixels.against != Against::kNothing) continue;
    const Vec3 exact = pixels.against == Against::kQuad
                           ? test::solve_in_quad(test::oracle_rows(rows, 1)).normal
                           : pixels.truth(x, 0).normal;
    plain_float32.add(plain_normal<float>(rows), exact);
    plain_double.add(plain_normal<double>(rows), exact);
    if (pixels.against != Against::kNothing) ours.add(trial.normal(x, 0), exact);
  }
  outcome.plain_float32_deg = plain_float32.deg();
  outcome.plain_double_deg = plain_double.deg();
  outcome.ours_deg = ours.deg();
  return outcome;
}

std::string names_of_status(int status) {
  std::string names;
  for (const StatusName& name : kStatusNames) {
    if ((status & name.bit) != 0) names += (names.empty() ? "" : " ") + std::string(name.name);
  }
  return names;
}

std::vector<HardCase> hard_solves() {
  std::vector<HardCase> solves;
  for (const PixelCase& pixels : pixel_cases()) {
    if (!pixels.is_hard) continue;
    const PixelOutcome outcome = outcome_of(pixels);
    solves.push_back({.stage = "solver",
                      .what = pixels.what,
                      .unit = "degrees",
                      .plain = outcome.plain_float32_deg,
                      .ours = outcome.ours_deg,
                      .flag = names_of_status(outcome.status),
                      .within = pixels.within_deg,
                      .must_say = pixels.flag});
  }
  return solves;
}

}  // namespace weft::torture
