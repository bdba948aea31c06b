// SPDX-License-Identifier: Apache-2.0
#include "solver/light_plan/light_plan.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bench/oracles/oracle_rig.h"
#include "solver/reflectance/lobe_fit.h"
#include "solver/reflectance/pixel_fit.h"
#include "tests/solver/light_plan/ten_leds.h"

namespace weft::solver {
namespace {

using test::Random;

ForeseenSigma sigma_of(const ForeseenRig& rig, const ForeseenCloth& cloth, LightSet set = {}) {
  const LightPlan plan(rig, cloth);
  if (set.leds.empty()) set.leds = plan.as_it_is().leds;
  return plan.sigma_of(set);
}

// A cloth under the ten LEDs, whose every reading is a function of all that is unknown: b of each site, the
// lobe (log alpha, f0, bend), stray light, and of each LED its strength and two turns.
class AllUnknowns {
 public:
  static constexpr Eigen::Index kLobe = 3;

  AllUnknowns(ForeseenRig rig, const ForeseenCloth& cloth)
      : rig_(std::move(rig)), cloth_(cloth), sites_(sites_of(rig_, cloth)) {
    for (const NearLight& led : rig_.leds) turns_.push_back(turns(led.position_mm));
  }

  const std::vector<ClothSite>& sites() const { return sites_; }
  Eigen::Index of_sites() const { return 3 * static_cast<Eigen::Index>(sites_.size()); }
  Eigen::Index of_rig() const { return 1 + 3 * static_cast<Eigen::Index>(rig_.leds.size()); }

  // Where the LEDs are for given errors.
  Vec3 led_mm(std::size_t k, const Eigen::VectorXd& rig_errors) const {
    const Vec3 at = rig_.leds[k].position_mm;
    const auto e = 1 + 3 * static_cast<Eigen::Index>(k);
    return at + length(at) * (rig_errors[e + 1] * turns_[k][0] + rig_errors[e + 2] * turns_[k][1]);
  }
  LitFrom from(std::size_t site, Vec3 led_mm) const {
    const Vec3 place = sites_[site].place_mm;
    return {normalized(led_mm - place), normalized(rig_.camera_mm - place)};
  }
  double reading(std::size_t site, std::size_t k, Vec3 b, const Eigen::Vector3d& lobe,
                 const Eigen::VectorXd& rig_errors) const {
    Lobe moved = cloth_.lobe;
    moved.alpha *= std::exp(lobe[0]);
    moved.f0 += lobe[1];
    moved.bend += lobe[2];
    const double gain = std::exp(rig_errors[1 + 3 * static_cast<Eigen::Index>(k)]);
    return gain * modelled(moved, b, from(site, led_mm(k, rig_errors)), sites_[site].yarn) + rig_errors[0];
  }
  double strength(std::size_t site, std::size_t k) const {
    const Vec3 v = rig_.leds[k].position_mm - sites_[site].place_mm;
    return std::max(0.0, -dot(normalized(v), rig_.leds[k].aim)) / dot(v, v);
  }
  Vec3 b(std::size_t site) const { return cloth_.albedo * sites_[site].normal; }

  // One over the variance of a reading, and 0 for one that would be taken for a shadow.
  double weight(std::size_t site, std::size_t k) const {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(of_rig());
    const auto x_of = [&](std::size_t i, std::size_t led) { return reading(i, led, b(i), {0, 0, 0}, none); };
    if (electrons_ == 0) {
      double brightest = 0;
      for (std::size_t i = 0; i < sites_.size(); ++i) {
        for (std::size_t led = 0; led < rig_.leds.size(); ++led)
          brightest = std::max(brightest, x_of(i, led) * strength(i, led));
      }
      electrons_ = 0.8 * rig_.full_well_electrons / brightest;
    }
    std::vector<double> all;
    for (std::size_t led = 0; led < rig_.leds.size(); ++led) all.push_back(x_of(site, led));
    const double x = all[k];
    std::sort(all.rbegin(), all.rend());
    if (x <= 0 || x < 0.15 * all[2]) return 0;
    const double unit = electrons_ * strength(site, k);
    return 1 / ((x * unit + 9) / (unit * unit) + std::pow(0.01 * std::max(x, 0.02), 2));
  }

  // Weighted derivatives of all readings by all unknowns: b, lobe, rig.
  Eigen::MatrixXd jacobian() const {
    const auto lights = static_cast<Eigen::Index>(rig_.leds.size());
    const Eigen::Index unknowns = of_sites() + kLobe + of_rig();
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(sites_.size()) * lights, unknowns);
    for (std::size_t site = 0; site < sites_.size(); ++site) {
      for (std::size_t k = 0; k < rig_.leds.size(); ++k) {
        const Eigen::Index row = static_cast<Eigen::Index>(site) * lights + static_cast<Eigen::Index>(k);
        const double root = std::sqrt(weight(site, k));
        for (Eigen::Index p = 0; p < 3 + kLobe + of_rig(); ++p) {
          const Eigen::Index column = p < 3 ? 3 * static_cast<Eigen::Index>(site) + p : of_sites() + p - 3;
          j(row, column) = root * (moved(site, k, p, 1e-5) - moved(site, k, p, -1e-5)) / 2e-5;
        }
      }
    }
    return j;
  }

  Eigen::MatrixXd rig_covariance() const {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(of_rig(), of_rig());
    covariance(0, 0) = kKnownStray * kKnownStray;
    covariance.bottomRightCorner(of_rig() - 1, of_rig() - 1) =
        Eigen::Map<const Eigen::MatrixXd>(rig_.led_covariance.data(), of_rig() - 1, of_rig() - 1);
    return covariance;
  }

 private:
  double moved(std::size_t site, std::size_t k, Eigen::Index p, double step) const {
    Vec3 at = b(site);
    Eigen::Vector3d lobe = {0, 0, 0};
    Eigen::VectorXd rig = Eigen::VectorXd::Zero(of_rig());
    if (p < 3) {
      at = at + Vec3{p == 0 ? step : 0, p == 1 ? step : 0, p == 2 ? step : 0};
    } else if (p < 3 + kLobe) {
      lobe[p - 3] = step;
    } else {
      rig[p - 3 - kLobe] = step;
    }
    return reading(site, k, at, lobe, rig);
  }

  ForeseenRig rig_;
  ForeseenCloth cloth_;
  std::vector<ClothSite> sites_;
  std::vector<std::array<Vec3, 2>> turns_;
  mutable double electrons_ = 0;
};

ForeseenRig ten_leds_over_places() {
  ForeseenRig rig = ten_leds();
  rig.places_mm = {{0, 0, 0}, {70, -40, 0}, {-60, 50, 0}};
  return rig;
}

ForeseenCloth cloth_of_its_sites(double alpha, double albedo) {
  ForeseenCloth cloth = {.lobe = ggx_of(alpha, 0.04), .albedo = albedo, .relief_deg = 12};
  cloth.pixels = 108;
  return cloth;
}

// What all unknowns together leave of the normals and of the lobe.
struct Dense {
  double normal_deg, alpha, f0;
};
Dense dense_of(const AllUnknowns& all, const Eigen::MatrixXd& covariance, const ForeseenCloth& cloth) {
  double sum = 0;
  for (std::size_t i = 0; i < all.sites().size(); ++i) {
    const Eigen::Matrix3d own =
        covariance.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(i));
    const Vec3 m = all.sites()[i].normal;
    const Eigen::Vector3d n(m.x, m.y, m.z);
    sum += degrees(std::sqrt(own.trace() - n.dot(own * n)) / cloth.albedo);
  }
  const Eigen::Index at = all.of_sites();
  return {sum / static_cast<double>(all.sites().size()), cloth.lobe.alpha * std::sqrt(covariance(at, at)),
          std::sqrt(covariance(at + 1, at + 1))};
}

// The Schur complement over pixels against the inverse of one large matrix.
TEST(LightPlan, IsTheInverseOfTheWholeInformationWhereTheRigIsFitted) {
  for (const double albedo : {0.05, 0.4}) {
    const ForeseenCloth cloth = cloth_of_its_sites(0.3, albedo);
    const AllUnknowns all(ten_leds_over_places(), cloth);
    Eigen::MatrixXd information = all.jacobian().transpose() * all.jacobian();
    const Eigen::Index at = all.of_sites();
    information(at, at) += 1.0 / 16;
    information(at + 1, at + 1) += 1 / 0.36;
    information(at + 2, at + 2) += 1 / (kKnownBend * kKnownBend);
    information.bottomRightCorner(all.of_rig(), all.of_rig()) += all.rig_covariance().inverse();
    const Dense dense = dense_of(
        all, information.ldlt().solve(Eigen::MatrixXd::Identity(information.rows(), information.cols())),
        cloth);
    LightSet fitted;
    fitted.errors = RigErrors::kFitted;
    const ForeseenSigma sigma = sigma_of(ten_leds_over_places(), cloth, fitted);
    EXPECT_NEAR(sigma.normal_deg, dense.normal_deg, 1e-3 * dense.normal_deg);
    EXPECT_NEAR(sigma.alpha, dense.alpha, 1e-3 * dense.alpha);
    EXPECT_NEAR(sigma.f0, dense.f0, 1e-3 * dense.f0);
    EXPECT_EQ(sigma.unsolved, 0);
  }
}

TEST(LightPlan, IsWhatTheRigsErrorsDoToAFitThatKnowsNothingOfThem) {
  const ForeseenCloth cloth = cloth_of_its_sites(0.3, 0.2);
  const AllUnknowns all(ten_leds_over_places(), cloth);
  const Eigen::MatrixXd j = all.jacobian();
  const Eigen::Index rig = all.of_rig(), own = j.cols() - rig, at = all.of_sites();
  Eigen::MatrixXd information = j.leftCols(own).transpose() * j.leftCols(own);
  information(at, at) += 1.0 / 16;
  information(at + 1, at + 1) += 1 / 0.36;
  information(at + 2, at + 2) += 1 / (kKnownBend * kKnownBend);
  const Eigen::MatrixXd noise = information.ldlt().solve(Eigen::MatrixXd::Identity(own, own));
  const Eigen::MatrixXd answer = noise * j.leftCols(own).transpose() * j.rightCols(rig);
  const Dense dense = dense_of(all, noise + answer * all.rig_covariance() * answer.transpose(), cloth);
  const ForeseenSigma sigma = sigma_of(ten_leds_over_places(), cloth);
  EXPECT_NEAR(sigma.normal_deg, dense.normal_deg, 1e-3 * dense.normal_deg);
  EXPECT_NEAR(sigma.alpha, dense.alpha, 1e-3 * dense.alpha);
  EXPECT_NEAR(sigma.f0, dense.f0, 1e-3 * dense.f0);
}

// Photographs of a rig that is not where it is thought, with noise, fitted by the solver's own fit.
TEST(LightPlan, ForetellsTheScatterOfTheFitOverTwoHundredRigsAndDrawsOfNoise) {
  constexpr int kDraws = 200;
  const ForeseenRig rig = ten_leds_over_places();
  const ForeseenCloth cloth = cloth_of_its_sites(0.2, 0.1);
  const AllUnknowns all(rig, cloth);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(all.of_rig());
  const Eigen::VectorXd spread = all.rig_covariance().diagonal().cwiseSqrt();
  Random random(11);
  double alpha2 = 0, f02 = 0;
  std::vector<double> angle2(all.sites().size());
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::VectorXd errors = spread.unaryExpr([&](double sigma) { return sigma * random.normal(); });
    LobeSamples samples(rig.leds.size());
    LobeFit start;
    start.lobe = cloth.lobe;
    for (std::size_t i = 0; i < all.sites().size(); ++i) {
      std::vector<LobeReading> pixel;
      for (std::size_t k = 0; k < rig.leds.size(); ++k) {
        const double weight = all.weight(i, k);
        const double noise = weight > 0 ? random.normal() / std::sqrt(weight) : 0;
        pixel.push_back({all.from(i, all.led_mm(k, none)),
                         all.reading(i, k, all.b(i), {0, 0, 0}, errors) + noise, weight});
      }
      samples.add(pixel);
      start.b.push_back(all.b(i));
      start.yarn.push_back(0);
    }
    LobeFitOptions options = {.fitted = parameters_of(LobeFamily::kGgx), .threads = 1};
    options.fitted[static_cast<std::size_t>(LobeParameter::kBend)] = true;
    const LobeFit fit = fit_lobe(samples, start, options);
    alpha2 += std::pow(fit.lobe.alpha - cloth.lobe.alpha, 2);
    f02 += std::pow(fit.lobe.f0 - cloth.lobe.f0, 2);
    for (std::size_t i = 0; i < all.sites().size(); ++i)
      angle2[i] += std::pow(angle_deg(fit.b[i], all.sites()[i].normal), 2);
  }
  double normal_deg = 0;
  for (const double sum : angle2) normal_deg += std::sqrt(sum / kDraws) / static_cast<double>(angle2.size());
  const ForeseenSigma sigma = sigma_of(rig, cloth);
  EXPECT_NEAR(normal_deg / sigma.normal_deg, 1, 0.1) << normal_deg;
  EXPECT_NEAR(std::sqrt(alpha2 / kDraws) / sigma.alpha, 1, 0.25) << std::sqrt(alpha2 / kDraws);
  EXPECT_NEAR(std::sqrt(f02 / kDraws) / sigma.f0, 1, 0.25) << std::sqrt(f02 / kDraws);
}

struct Observed {
  const char* what;
  ForeseenCloth cloth;
  bool as_it_is, beside_the_camera, with_polarisers;
};

// As was measured with other means (docs/measured/calibration.md).
TEST(LightPlan, SaysByWhichLightsALobeIsObservable) {
  const Lobe satin = {.family = LobeFamily::kAnisotropicGgx, .alpha = 0.45, .f0 = 0.05, .along = 0.35};
  const Lobe velvet = {.family = LobeFamily::kCloth, .alpha = 0.3, .f0 = 0.05};
  const std::vector<Observed> cases = {
      {"satin", {.lobe = satin, .albedo = 0.4, .relief_deg = 19, .weft_share = 0.2}, true, true, true},
      {"narrow lobe, level", {.lobe = ggx_of(0.1, 0.04), .albedo = 0.3, .relief_deg = 0}, false, true, false},
      {"narrow lobe, slopes", {.lobe = ggx_of(0.1, 0.04), .albedo = 0.3, .relief_deg = 7}, true, true, true},
      {"broad lobe, light", {.lobe = ggx_of(0.6, 0.04), .albedo = 0.3, .relief_deg = 0}, false, false, true},
      {"velvet", {.lobe = velvet, .albedo = 0.02, .relief_deg = 19}, false, false, true}};
  for (const Observed& each : cases) {
    LightSet beside, pair;
    beside.added = led_at(ten_leds(), {8, 45});
    pair.has_polarisers = true;
    EXPECT_EQ(sigma_of(ten_leds_over_a_frame(), each.cloth).is_observable, each.as_it_is) << each.what;
    EXPECT_EQ(sigma_of(ten_leds_over_a_frame(), each.cloth, beside).is_observable, each.beside_the_camera)
        << each.what;
    EXPECT_EQ(sigma_of(ten_leds_over_a_frame(), each.cloth, pair).is_observable, each.with_polarisers)
        << each.what;
  }
}

TEST(LightPlan, FittingTheRigNeverErrsMoreThanTakingIt) {
  for (const double alpha : {0.1, 0.3, 0.6}) {
    const ForeseenCloth cloth = {.lobe = ggx_of(alpha, 0.04), .albedo = 0.2, .relief_deg = 10};
    LightSet fitted;
    fitted.errors = RigErrors::kFitted;
    const ForeseenSigma taken = sigma_of(ten_leds(), cloth), least = sigma_of(ten_leds(), cloth, fitted);
    EXPECT_LT(least.alpha, taken.alpha);
    EXPECT_LT(least.f0, taken.f0);
    EXPECT_LE(least.normal_deg, taken.normal_deg);
  }
}

struct Hard {
  const char* what;
  ForeseenRig rig;
  ForeseenCloth cloth;
  bool is_normal_told, is_lobe_told;
};

std::vector<Hard> hard_cases() {
  const ForeseenRig three = rig_with({led_from(35, 0), led_from(35, 120), led_from(35, 240)});
  const ForeseenRig two = rig_with({led_from(35, 0), led_from(35, 120)});
  const ForeseenRig one_place =
      rig_with({led_from(35, 0), led_from(35, 0), led_from(35, 0), led_from(35, 0)});
  const ForeseenRig in_a_plane =
      rig_with({led_from(60, 0), led_from(30, 0), led_from(30, 180), led_from(60, 180)});
  ForeseenRig twice = ten_leds(), backwards = ten_leds();
  twice.leds[9] = twice.leds[8];
  for (NearLight& led : backwards.leds) led.aim = -1.0 * led.aim;
  const ForeseenCloth cloth = {.lobe = ggx_of(0.3, 0.04), .albedo = 0.3, .relief_deg = 10};
  const auto with = [&](double alpha, double f0, double albedo, double relief_deg) {
    return ForeseenCloth{.lobe = ggx_of(alpha, f0), .albedo = albedo, .relief_deg = relief_deg};
  };
  return {{"three lights", three, cloth, false, false},
          {"three lights on matt cloth", three, {.lobe = {}, .albedo = 0.5, .relief_deg = 10}, true, false},
          {"two lights", two, cloth, false, false},
          {"four lights in one place", one_place, cloth, false, false},
          {"lights in a plane", in_a_plane, with(0.3, 0.04, 0.3, 0), false, false},
          {"one LED twice", twice, cloth, true, true},
          {"LEDs that shine away", backwards, cloth, false, false},
          {"alpha 1", ten_leds(), with(1, 0.04, 0.3, 10), true, false},
          {"alpha 0.02", ten_leds(), with(0.02, 0.04, 0.3, 0), true, false},
          {"f0 0", ten_leds(), with(0.3, 0, 0.3, 10), true, false},
          {"f0 0.6 on black", ten_leds(), with(0.3, 0.6, 1e-3, 10), true, true},
          {"one normal in one place", ten_leds(), with(0.25, 0.04, 0.3, 0), true, false},
          {"one normal all over the frame", ten_leds_over_a_frame(), with(0.25, 0.04, 0.3, 0), true, true},
          {"black", ten_leds(), with(0.3, 0.04, 1e-4, 10), true, true},
          {"cliffs", ten_leds(), with(0.3, 0.04, 0.3, 70), true, true},
          {"matt", ten_leds(), {.lobe = {}, .albedo = 0.5}, true, false}};
}

TEST(LightPlan, SaysANumberOrNothingInHardCasesAndNeverNaN) {
  for (const Hard& each : hard_cases()) {
    for (const bool has_polarisers : {false, true}) {
      for (const RigErrors errors : {RigErrors::kTaken, RigErrors::kFitted}) {
        LightSet set;
        set.has_polarisers = has_polarisers;
        set.errors = errors;
        const ForeseenSigma sigma = sigma_of(each.rig, each.cloth, set);
        for (const double value :
             {sigma.normal_deg, sigma.alpha, sigma.f0, sigma.alpha_along, sigma.axis_deg})
          EXPECT_GT(value, 0) << each.what;
        EXPECT_TRUE(std::isfinite(sigma.correlation)) << each.what;
        EXPECT_TRUE(sigma.unsolved >= 0 && sigma.unsolved <= 1) << each.what << ": " << sigma.unsolved;
        if (!has_polarisers && errors == RigErrors::kTaken) {
          EXPECT_EQ(std::isfinite(sigma.normal_deg), each.is_normal_told)
              << each.what << ": " << sigma.normal_deg;
          EXPECT_EQ(sigma.is_observable, each.is_lobe_told)
              << each.what << ": " << sigma.alpha << ", " << sigma.f0 << ", " << sigma.correlation;
        }
      }
    }
  }
}

TEST(LightPlan, SaysNothingOfRoughnessAlongAYarnThatALobeHasNot) {
  const ForeseenSigma sigma = sigma_of(ten_leds(), {.lobe = ggx_of(0.3, 0.04)});
  EXPECT_TRUE(std::isinf(sigma.alpha_along) && std::isinf(sigma.axis_deg));
}

// docs/conditions.md: LEDs 5 percent dimmer at the end turn the mean normal by 0.40 degrees.
TEST(LightPlan, ForeseesWhatFadingWasMeasuredToCost) {
  const ForeseenCloth cloth = {.lobe = {}, .albedo = 0.5, .relief_deg = 10};
  const LightPlan plan(ten_leds(), cloth);
  LightSet set = plan.as_it_is();
  const double still = plan.sigma_of(set).normal_deg;
  set.fade = 0.05;
  const double faded = plan.sigma_of(set).normal_deg;
  EXPECT_NEAR(std::sqrt(faded * faded - still * still), 0.40, 0.15) << still << " and " << faded;
}

TEST(LightPlan, ReadsDarkClothUnderHighlightsBetterWithABracket) {
  const ForeseenCloth dark = {.lobe = ggx_of(0.2, 0.05), .albedo = 0.02, .relief_deg = 10};
  ForeseenRig noisy = ten_leds();
  noisy.full_well_electrons = 1000;
  const LightPlan plan(noisy, dark);
  LightSet set = plan.as_it_is();
  const double plain = plan.sigma_of(set).normal_deg;
  set.bracket = 16;
  const double longer = plan.sigma_of(set).normal_deg;
  EXPECT_LT(longer, 0.8 * plain);
  set.bracket = 0.01;
  const double shorter = plan.sigma_of(set).normal_deg;
  EXPECT_LE(shorter, plain);
  EXPECT_GT(shorter, 0.95 * plain) << "a hundredth of the light";
}

TEST(LightPlan, IsWorseUnderARigThatIsKnownWorse) {
  const ForeseenCloth cloth = {.lobe = ggx_of(0.3, 0.04), .albedo = 0.2, .relief_deg = 10};
  ForeseenRig rough = ten_leds();
  for (double& each : rough.led_covariance) each *= 100;
  const ForeseenSigma fine = sigma_of(ten_leds(), cloth), worse = sigma_of(rough, cloth);
  EXPECT_GT(worse.normal_deg, 3 * fine.normal_deg);
  EXPECT_GT(worse.alpha, 3 * fine.alpha);
}

}  // namespace
}  // namespace weft::solver
