// SPDX-License-Identifier: Apache-2.0
#include "solver/light_plan/light_plan.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/statistics.h"
#include "solver/in_double/pixel.h"
#include "solver/reflectance/lobe_fit.h"
#include "solver/reflectance/measured_lobe.h"
#include "solver/reflectance/pixel_fit.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::solver {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr std::size_t kNormals = 36;  // of each place
// The brightest reading comes to this share of a full sensor, as a scan is metered.
constexpr double kMetered = 0.8;
// Directions of a pixel's readings that are worse conditioned do not tell its normal.
constexpr double kWorstCondition = 1e6;
// Where more pixels than this have no normal, the cloth has none.
constexpr double kMostUnsolved = 0.5;
// Standard deviations within which 95 of 100 errors are.
constexpr double kSure = 2;

// Parameters of a reading: b of its pixel, the lobe, the two turns of its LED.
constexpr Eigen::Index kOfPixel = 3, kOfLobe = kLobeParameters, kTurns = 2;
constexpr Eigen::Index kParameters = kOfPixel + kOfLobe + kTurns;
// Shared parameters before those of the LEDs: the lobe and stray light.
constexpr Eigen::Index kBeforeLeds = kOfLobe + 1;
constexpr auto kErrors = static_cast<Eigen::Index>(kLedErrors);

constexpr auto kAlphaAt = static_cast<Eigen::Index>(LobeParameter::kLogAlpha);
constexpr auto kF0At = static_cast<Eigen::Index>(LobeParameter::kF0);
constexpr auto kAlongAt = static_cast<Eigen::Index>(LobeParameter::kLogAlong);
constexpr auto kAxisAt = static_cast<Eigen::Index>(LobeParameter::kAxis);
constexpr auto kBendAt = static_cast<Eigen::Index>(LobeParameter::kBend);

// A lobe's parameters are anywhere in its ranges before a photograph is taken; from `told` on they still are.
struct Range {
  double sigma, told;
};
constexpr std::array<Range, kLobeParameters> kRanges = {
    {{4, 1}, {0.6, 0.3}, {3, 1}, {kPi / 2, kPi / 4}, {kKnownBend, kNever}}};

using Steps = std::array<double, kParameters>;
constexpr Steps kSteps = {1e-5, 1e-5, 1e-5, 1e-4, 1e-5, 1e-4, 1e-4, 1e-4, 1e-5, 1e-5};

// A reading over its strength, apart: what the diffuse part sends and what the lobe does.
using DiffuseAndLobe = Eigen::Vector2d;

// One light over one pixel.
struct Lit {
  double strength = 0;
  DiffuseAndLobe x = DiffuseAndLobe::Zero();
  Eigen::Matrix<double, 2, kParameters> by = Eigen::Matrix<double, 2, kParameters>::Zero();

  bool shines() const { return strength > 0 && x.sum() > 0; }
};
using LitSites = std::vector<Lit>;

// How a photograph mixes the two parts, and what it holds of stray light.
struct Film {
  Eigen::RowVector2d mix;
  double stray;
};
const std::vector<Film>& films(bool has_polarisers) {
  static const std::vector<Film> none = {{{1, 1}, 1}}, pair = {{{0.5, 1}, 0.5}, {{0.5, kLeak}, 0.5}};
  return has_polarisers ? pair : none;
}

Lobe moved(Lobe lobe, Eigen::Index parameter, double step) {
  if (parameter == kAlphaAt) lobe.alpha *= std::exp(step);
  if (parameter == kF0At) lobe.f0 += step;
  const bool has_two = lobe.family == LobeFamily::kTwoGgx;
  if (parameter == kAlongAt) (has_two ? lobe.broad : lobe.along) *= std::exp(step);
  if (parameter == kAxisAt) (has_two ? lobe.broad_share : lobe.axis) += step;
  if (parameter == kBendAt) lobe.bend += step;
  return lobe;
}

// One LED over all sites.
class LightedSites {
 public:
  LightedSites(const ForeseenRig& rig, const ForeseenCloth& cloth, const NearLight& led)
      : rig_(rig), cloth_(cloth), led_(led), to_led_(led.position_mm - rig.places_mm.front()) {}

  LitSites over(const std::vector<ClothSite>& sites) const {
    LitSites lit;
    lit.reserve(sites.size());
    for (const ClothSite& site : sites) lit.push_back(at(site));
    return lit;
  }

 private:
  DiffuseAndLobe seen(const ClothSite& site, const Lobe& lobe, Vec3 b, Vec3 led_mm) const {
    const LitFrom from(normalized(led_mm - site.place_mm), normalized(rig_.camera_mm - site.place_mm));
    const Vec3 n = normalized(b);
    const double cosine = dot(n, from.light), all = modelled(lobe, b, from, site.yarn);
    if (!lobe.shines() || !(cosine > 0)) return {all, 0};
    const double shine = cosine * specular(lobe, n, from, site.yarn);
    return {all - shine, shine};
  }

  DiffuseAndLobe moved_by(const ClothSite& site, Eigen::Index parameter, double step) const {
    const Vec3 b = cloth_.albedo * site.normal;
    if (parameter < kOfPixel) {
      const double d = step * cloth_.albedo;
      const Vec3 change = {parameter == 0 ? d : 0, parameter == 1 ? d : 0, parameter == 2 ? d : 0};
      return seen(site, cloth_.lobe, b + change, led_.position_mm) / cloth_.albedo;
    }
    if (parameter < kOfPixel + kOfLobe)
      return seen(site, moved(cloth_.lobe, parameter - kOfPixel, step), b, led_.position_mm);
    const Vec3 turn = turns(to_led_)[static_cast<std::size_t>(parameter - kOfPixel - kOfLobe)];
    return seen(site, cloth_.lobe, b, led_.position_mm + (step * length(to_led_)) * turn);
  }

  Lit at(const ClothSite& site) const {
    Lit lit;
    const Vec3 to_led = led_.position_mm - site.place_mm, l = normalized(to_led);
    lit.strength =
        led_.flux_rgb[1] * std::pow(std::max(0.0, -dot(l, led_.aim)), led_.mu) / dot(to_led, to_led);
    lit.x = seen(site, cloth_.lobe, cloth_.albedo * site.normal, led_.position_mm);
    if (!lit.shines()) return lit;
    for (Eigen::Index p = 0; p < kParameters; ++p) {
      const double step = kSteps[static_cast<std::size_t>(p)];
      lit.by.col(p) = (moved_by(site, p, step) - moved_by(site, p, -step)) / (2 * step);
    }
    return lit;
  }

  const ForeseenRig& rig_;
  const ForeseenCloth& cloth_;
  const NearLight& led_;
  Vec3 to_led_;
};

// One pixel with its own unknowns eliminated: the factor R of its weighted equations J = Q R.
struct Pixel {
  Eigen::Matrix3d factor;
  Vec3 normal;

  // Standard deviation of its normal, degrees. `shared`: what the errors of the shared parameters leave in
  // its equations.
  double normal_deg(const Eigen::Matrix3d& shared, double albedo) const {
    const Eigen::Matrix3d inverse =
        factor.triangularView<Eigen::Upper>().solve(Eigen::Matrix3d::Identity().eval());
    const Eigen::Matrix3d covariance = inverse * (Eigen::Matrix3d::Identity() + shared) * inverse.transpose();
    const Eigen::Vector3d n(normal.x, normal.y, normal.z);
    return degrees(std::sqrt(std::max(covariance.trace() - n.dot(covariance * n), 0.0)) / albedo);
  }
};

// The lights of one scan over the cloth.
class Scan {
 public:
  Scan(const ForeseenRig& rig, const ForeseenCloth& cloth, const std::vector<ClothSite>& sites,
       std::vector<const LitSites*> lights, const LightSet& set)
      : rig_(rig),
        cloth_(cloth),
        sites_(sites),
        lights_(std::move(lights)),
        films_(films(set.has_polarisers)),
        bracket_(set.bracket.value_or(0)),
        fitted_(parameters_of(cloth.lobe.family)),
        shared_(kBeforeLeds + kErrors * static_cast<Eigen::Index>(lights_.size())) {
    fitted_[static_cast<std::size_t>(kBendAt)] = true;
    meter();
    information_ = Eigen::MatrixXd::Zero(shared_, shared_);
    mixed_ = Eigen::MatrixXd::Zero(shared_, kOfPixel * static_cast<Eigen::Index>(sites.size()));
    for (std::size_t i = 0; i < sites.size(); ++i) add(i);
    information_.selfadjointView<Eigen::Lower>().rankUpdate(mixed_, -1);
    information_ = information_.selfadjointView<Eigen::Lower>().toDenseMatrix().eval();
    information_ *= cloth.pixels / static_cast<double>(sites.size());
  }

  // `led_covariance` is of its lights, in their order.
  ForeseenSigma sigma(const Eigen::MatrixXd& led_covariance, RigErrors errors) const {
    const Eigen::Index leds = shared_ - kBeforeLeds;
    Eigen::MatrixXd rig = Eigen::MatrixXd::Zero(leds + 1, leds + 1);
    rig(0, 0) = kKnownStray * kKnownStray;
    rig.bottomRightCorner(leds, leds) = led_covariance;
    Eigen::MatrixXd all = information_;
    for (Eigen::Index p = 0; p < kOfLobe; ++p)
      all(p, p) += is_fitted(p) ? std::pow(kRanges[static_cast<std::size_t>(p)].sigma, -2) : 1;
    const Eigen::MatrixXd covariance =
        errors == RigErrors::kFitted ? fitted_with(rig, all) : taken_with(rig, all);
    if (!covariance.allFinite()) return nothing();
    ForeseenSigma sigma;
    say_lobe(covariance, sigma);
    say_normals(covariance, sigma);
    return sigma;
  }

 private:
  bool is_fitted(Eigen::Index p) const { return fitted_[static_cast<std::size_t>(p)]; }

  static ForeseenSigma nothing() {
    ForeseenSigma sigma;
    sigma.normal_deg = sigma.alpha = sigma.f0 = sigma.alpha_along = sigma.axis_deg = kNever;
    sigma.unsolved = 1;
    return sigma;
  }

  // The inverse of a symmetric matrix whose units are far apart; NaN where it has none.
  static Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) {
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * matrix * scale.asDiagonal());
    const Eigen::Index n = matrix.rows();
    if (factor.info() != Eigen::Success) return Eigen::MatrixXd::Constant(n, n, std::nan(""));
    return scale.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(n, n)) * scale.asDiagonal();
  }

  // The covariance of all shared parameters, the rig's errors fitted with the lobe within what is known of
  // them.
  Eigen::MatrixXd fitted_with(const Eigen::MatrixXd& rig, Eigen::MatrixXd all) const {
    all.bottomRightCorner(rig.rows(), rig.cols()) += inverse_of(rig);
    return inverse_of(all);
  }

  // The same where the fit knows nothing of the rig's errors e: the lobe then errs by K e more.
  Eigen::MatrixXd taken_with(const Eigen::MatrixXd& rig, const Eigen::MatrixXd& all) const {
    const Eigen::Index rest = rig.rows();
    Eigen::MatrixXd covariance(shared_, shared_);
    const Eigen::MatrixXd lobe = inverse_of(all.topLeftCorner<kOfLobe, kOfLobe>());
    const Eigen::MatrixXd k = lobe * all.topRightCorner(kOfLobe, rest);
    covariance.topLeftCorner<kOfLobe, kOfLobe>() = lobe + k * rig * k.transpose();
    covariance.topRightCorner(kOfLobe, rest) = -k * rig;
    covariance.bottomLeftCorner(rest, kOfLobe) = (-k * rig).transpose();
    covariance.bottomRightCorner(rest, rest) = rig;
    return covariance;
  }

  void meter() {
    double brightest = 0;
    for (const LitSites* light : lights_) {
      for (const Lit& lit : *light)
        brightest = std::max(brightest, lit.strength * (films_[0].mix * lit.x).value());
    }
    electrons_ = brightest > 0 ? kMetered * rig_.full_well_electrons / brightest : 0;
  }

  // The variance of a reading whose unit is so many electrons.
  double noise(double x, double a_unit) const {
    return (x * a_unit + rig_.read_noise_electrons * rig_.read_noise_electrons) / (a_unit * a_unit);
  }

  double weight(double x, double strength) const {
    const double a_unit = electrons_ * strength;
    double told = 1 / noise(x, a_unit);
    if (bracket_ > 0 && bracket_ * a_unit * x <= rig_.full_well_electrons)
      told += 1 / noise(x, bracket_ * a_unit);
    return 1 / (1 / told + std::pow(kLobeModelShare * std::max(x, kLeastModelled), 2));
  }

  // Below it a reading is taken for a cast shadow, as by a solve.
  double shadow_threshold(std::size_t site) const {
    std::vector<double> bright;
    for (const LitSites* light : lights_) {
      if ((*light)[site].shines()) bright.push_back((*light)[site].x.sum());
    }
    const auto rank = static_cast<std::size_t>(bright_rank(lights_.size()));
    if (bright.size() < rank) return 0;
    return kShadowShare * value_of_rank<double>(bright, bright.size() - rank);
  }

  void add(std::size_t site) {
    const double threshold = shadow_threshold(site);
    std::vector<std::size_t> used;
    for (std::size_t k = 0; k < lights_.size(); ++k) {
      const Lit& lit = (*lights_[k])[site];
      if (lit.shines() && lit.x.sum() >= threshold) used.push_back(k);
    }
    const auto readings = static_cast<Eigen::Index>(used.size() * films_.size());
    if (used.size() < 3) return;
    Eigen::Matrix<double, Eigen::Dynamic, 3> own(readings, 3);
    Eigen::Matrix<double, Eigen::Dynamic, kBeforeLeds> alike(readings, kBeforeLeds);
    Eigen::Matrix<double, Eigen::Dynamic, kErrors> of_led(readings, kErrors);
    Eigen::Index row = 0;
    for (const std::size_t k : used) {
      const Lit& lit = (*lights_[k])[site];
      for (const Film& film : films_) {
        const double x = (film.mix * lit.x).value(), root = std::sqrt(weight(x, lit.strength));
        const Eigen::Matrix<double, 1, kParameters> by = root * film.mix * lit.by;
        own.row(row) = by.leftCols<kOfPixel>();
        alike.row(row) << by.middleCols<kOfLobe>(kOfPixel), root * film.stray;
        for (Eigen::Index p = 0; p < kOfLobe; ++p) {
          if (!is_fitted(p)) alike(row, p) = 0;
        }
        of_led.row(row++) << root * x, by.rightCols<kTurns>();
      }
    }
    eliminate(site, used, own, alike, of_led);
  }

  void eliminate(std::size_t site, const std::vector<std::size_t>& used,
                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& own,
                 const Eigen::Matrix<double, Eigen::Dynamic, kBeforeLeds>& alike,
                 const Eigen::Matrix<double, Eigen::Dynamic, kErrors>& of_led) {
    const Eigen::HouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 3>> qr(own);
    Pixel pixel;
    pixel.factor = qr.matrixQR().topRows<3>().triangularView<Eigen::Upper>();
    const Eigen::Array3d sizes = pixel.factor.diagonal().cwiseAbs().array();
    if (!(sizes.minCoeff() * kWorstCondition > sizes.maxCoeff())) return;
    const Eigen::Matrix<double, Eigen::Dynamic, 3> q =
        qr.householderQ() * Eigen::Matrix<double, Eigen::Dynamic, 3>::Identity(own.rows(), 3);
    pixel.normal = sites_[site].normal;
    const Eigen::Index at = kOfPixel * static_cast<Eigen::Index>(pixels_.size());
    mixed_.block<kBeforeLeds, kOfPixel>(0, at) = alike.transpose() * q;
    information_.topLeftCorner<kBeforeLeds, kBeforeLeds>() += alike.transpose() * alike;
    const auto each = static_cast<Eigen::Index>(films_.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
      const Eigen::Index row = static_cast<Eigen::Index>(i) * each;
      const Eigen::Index column = kBeforeLeds + kErrors * static_cast<Eigen::Index>(used[i]);
      const auto mine = of_led.middleRows(row, each);
      mixed_.block<kErrors, kOfPixel>(column, at) = mine.transpose() * q.middleRows(row, each);
      const Eigen::Matrix<double, kBeforeLeds, kErrors> beside =
          alike.middleRows(row, each).transpose() * mine;
      information_.block<kErrors, kBeforeLeds>(column, 0) += beside.transpose();
      information_.block<kErrors, kErrors>(column, column) += mine.transpose() * mine;
    }
    pixels_.push_back(pixel);
  }

  void say_lobe(const Eigen::MatrixXd& c, ForeseenSigma& sigma) const {
    const Lobe& lobe = cloth_.lobe;
    const auto root = [&](Eigen::Index p) {
      const double one = std::sqrt(c(p, p));
      return is_fitted(p) && one < kRanges[static_cast<std::size_t>(p)].told ? one : kNever;
    };
    if (!lobe.shines()) {
      sigma.alpha = sigma.f0 = sigma.alpha_along = sigma.axis_deg = kNever;
      return;
    }
    sigma.alpha = lobe.alpha * root(kAlphaAt);
    sigma.f0 = root(kF0At);
    const bool has_yarn = lobe.family == LobeFamily::kAnisotropicGgx;
    sigma.axis_deg = has_yarn ? degrees(root(kAxisAt)) : kNever;
    const double along =
        std::sqrt(std::max(c(kAlphaAt, kAlphaAt) + c(kAlongAt, kAlongAt) + 2 * c(kAlphaAt, kAlongAt), 0.0));
    sigma.alpha_along =
        has_yarn && std::isfinite(root(kAlongAt) + root(kAlphaAt)) ? lobe.alpha * lobe.along * along : kNever;
    sigma.correlation = c(kAlphaAt, kF0At) / std::sqrt(c(kAlphaAt, kAlphaAt) * c(kF0At, kF0At));
    sigma.is_observable = kSure * sigma.alpha <= kAlphaAgrees && kSure * sigma.f0 <= kF0Agrees * lobe.f0 &&
                          sigma.correlation > kTailOnly;
  }

  void say_normals(const Eigen::MatrixXd& covariance, ForeseenSigma& sigma) const {
    double sum = 0, solved = 0;
    const Eigen::MatrixXd left = covariance * mixed_;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const auto mine = mixed_.middleCols<kOfPixel>(kOfPixel * static_cast<Eigen::Index>(i));
      const auto theirs = left.middleCols<kOfPixel>(kOfPixel * static_cast<Eigen::Index>(i));
      const double one = pixels_[i].normal_deg(mine.transpose() * theirs, cloth_.albedo);
      if (!(one < kWorstNormal_deg)) continue;
      sum += one;
      ++solved;
    }
    sigma.unsolved = 1 - solved / static_cast<double>(sites_.size());
    sigma.normal_deg = sigma.unsolved < kMostUnsolved ? sum / solved : kNever;
  }

  const ForeseenRig& rig_;
  const ForeseenCloth& cloth_;
  const std::vector<ClothSite>& sites_;
  std::vector<const LitSites*> lights_;
  const std::vector<Film>& films_;
  double bracket_;
  LobeParameters fitted_;
  Eigen::Index shared_;
  double electrons_ = 0;  // of a reading of 1 under a light of strength 1
  std::vector<Pixel> pixels_;
  Eigen::MatrixXd mixed_;  // Q^T S of each pixel, turned: what its own unknowns take of the shared ones
  Eigen::MatrixXd information_;
};

}  // namespace

// By Rayleigh's quantiles, each turned by the golden angle.
std::vector<ClothSite> sites_of(const ForeseenRig& rig, const ForeseenCloth& cloth) {
  const double rms = std::tan(radians(cloth.relief_deg / kMeanOfRms));
  std::vector<ClothSite> sites;
  for (const Vec3 place : rig.places_mm) {
    for (std::size_t i = 0; i < kNormals; ++i) {
      const auto number = static_cast<double>(sites.size());
      const double azimuth = kPi * (3 - std::sqrt(5.0)) * number;
      const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kNormals);
      const double slope = rms * std::sqrt(-std::log1p(-share));
      const bool is_weft = std::fmod((number + 0.5) * (std::sqrt(5.0) - 1) / 2, 1.0) < cloth.weft_share;
      sites.push_back({place, normalized({slope * std::cos(azimuth), slope * std::sin(azimuth), 1}),
                       is_weft ? kPi / 2 : 0});
    }
  }
  return sites;
}

struct LightPlan::Parts {
  ForeseenRig rig;
  ForeseenCloth cloth;
  std::vector<ClothSite> sites;
  std::vector<LitSites> lit;  // by LED of the rig

  ForeseenSigma sigma_of(const LightSet& set, const LitSites* added) const {
    std::vector<const LitSites*> lights;
    for (const std::size_t k : set.leds) lights.push_back(&lit[k]);
    if (added) lights.push_back(added);
    return Scan(rig, cloth, sites, lights, set).sigma(covariance_of(set), set.errors);
  }

  Eigen::MatrixXd covariance_of(const LightSet& set) const {
    const auto kept = static_cast<Eigen::Index>(set.leds.size());
    const Eigen::Index lights = kept + (set.added ? 1 : 0);
    const auto row = kErrors * static_cast<Eigen::Index>(rig.leds.size());
    const Eigen::Map<const Eigen::MatrixXd> all(rig.led_covariance.data(), row, row);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kErrors * lights, kErrors * lights);
    for (Eigen::Index i = 0; i < kept; ++i) {
      for (Eigen::Index j = 0; j < kept; ++j) {
        covariance.block<kErrors, kErrors>(kErrors * i, kErrors * j) = all.block<kErrors, kErrors>(
            kErrors * static_cast<Eigen::Index>(set.leds[static_cast<std::size_t>(i)]),
            kErrors * static_cast<Eigen::Index>(set.leds[static_cast<std::size_t>(j)]));
      }
    }
    if (set.added) {
      const std::vector<double> typical = typical_led_covariance({*set.added}, rig.places_mm.front());
      covariance.bottomRightCorner<kErrors, kErrors>() =
          Eigen::Map<const Eigen::Matrix<double, kErrors, kErrors>>(typical.data());
    }
    Eigen::VectorXd faded = Eigen::VectorXd::Zero(kErrors * lights);
    for (Eigen::Index i = 1; i < lights; ++i)
      faded(kErrors * i) = set.fade * static_cast<double>(i) / static_cast<double>(lights - 1);
    return covariance + faded * faded.transpose();
  }

  LitSites lit_by(const NearLight& led) const { return LightedSites(rig, cloth, led).over(sites); }
};

LightPlan::LightPlan(ForeseenRig rig, ForeseenCloth cloth) {
  auto parts = std::make_unique<Parts>();
  parts->rig = std::move(rig);
  parts->cloth = cloth;
  parts->sites = sites_of(parts->rig, parts->cloth);
  for (const NearLight& led : parts->rig.leds) parts->lit.push_back(parts->lit_by(led));
  parts_ = std::move(parts);
}

LightPlan::~LightPlan() = default;
LightPlan::LightPlan(LightPlan&&) noexcept = default;

const ForeseenRig& LightPlan::rig() const {
  return parts_->rig;
}

const ForeseenCloth& LightPlan::cloth() const {
  return parts_->cloth;
}

LightSet LightPlan::as_it_is() const {
  LightSet set;
  set.leds.resize(parts_->rig.leds.size());
  std::iota(set.leds.begin(), set.leds.end(), std::size_t{0});
  return set;
}

ForeseenSigma LightPlan::sigma_of(const LightSet& lights) const {
  if (!lights.added) return parts_->sigma_of(lights, nullptr);
  const LitSites added = parts_->lit_by(*lights.added);
  return parts_->sigma_of(lights, &added);
}

std::vector<ForeseenSigma> LightPlan::moved_to(const NearLight& place) const {
  const LitSites added = parts_->lit_by(place);
  std::vector<ForeseenSigma> sigmas;
  for (std::size_t k = 0; k < parts_->rig.leds.size(); ++k) {
    LightSet set = as_it_is();
    set.leds.erase(set.leds.begin() + static_cast<std::ptrdiff_t>(k));
    set.added = place;
    sigmas.push_back(parts_->sigma_of(set, &added));
  }
  return sigmas;
}

}  // namespace weft::solver
