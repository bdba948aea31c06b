// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/reflectance/glossy_method.h"
#include "solver/reflectance/lobe_fit.h"
#include "tests/solver/reflectance/pixels.h"

// Whether errors of pixels that are solved with a lobe, of which not all is known, are as large as sigma
// says.

namespace weft::solver {
namespace {

using test::Trial;

constexpr Rect kTile = {0, 0, 64, 1};
constexpr int kFrames = 200;

struct OpenLobe {
  const char* name;
  Lobe lobe;
  std::vector<double> albedo;    ///< one, or red, green and blue
  std::array<double, 4> sigmas;  ///< of log alpha, f0, log along and axis
  double correlation;            ///< of log alpha and f0
};

LobeCovariance covariance_of(const OpenLobe& open) {
  LobeCovariance covariance = {};
  for (std::size_t p = 0; p < open.sigmas.size(); ++p) covariance[p][p] = open.sigmas[p] * open.sigmas[p];
  covariance[0][1] = covariance[1][0] = open.correlation * open.sigmas[0] * open.sigmas[1];
  return covariance;
}

Lobe drawn(const OpenLobe& open, Random& random) {
  const double z = random.normal(), independent = random.normal();
  Lobe lobe = open.lobe;
  lobe.alpha *= std::exp(open.sigmas[0] * z);
  const double c = open.correlation;
  lobe.f0 += open.sigmas[1] * (c * z + std::sqrt(1 - c * c) * independent);
  lobe.along *= std::exp(open.sigmas[2] * random.normal());
  lobe.axis += open.sigmas[3] * random.normal();
  return lobe;
}

// The same pixels in every frame; the lobe, and noise of as much as weights say, are drawn anew.
class Frames {
 public:
  explicit Frames(const OpenLobe& open)
      : open_(open),
        field_(*LightField::make(ten_distant(), std::nullopt, {kTile.x1, kTile.y1}, 0)),
        random_(20) {
    for (int x = 0; x < kTile.x1; ++x) normals_.push_back(random_normal(random_, 20));
  }

  // Errors over sigma, root of the mean of squares: of the normal, then of each channel of the albedo.
  std::vector<double> scatter(const Method& method) {
    const auto planes = static_cast<int>(open_.albedo.size());
    Trial trial(field_, kTile, planes, [&](int x, int) {
      return test::Truth{normals_[static_cast<std::size_t>(x)], {}};
    });
    std::vector<double> sums(open_.albedo.size() + 1, 0.0);
    int count = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
      photograph(trial);
      trial.solve(method);
      for (int x = 0; x < kTile.x1; ++x) {
        if ((trial.status(x, 0) & kGlossy) == 0) continue;
        sums[0] += std::pow(trial.error_deg(x, 0) / trial.sigma_normal_deg(x, 0), 2);
        for (int p = 0; p < planes; ++p) {
          const auto of = static_cast<std::size_t>(p);
          const double error = trial.albedo(x, 0, p) - open_.albedo[of];
          sums[1 + of] += std::pow(error / trial.sigma_albedo(x, 0, p), 2);
        }
        ++count;
      }
    }
    EXPECT_GT(count, 0.99 * kFrames * kTile.x1) << open_.name;
    for (double& sum : sums) sum = std::sqrt(sum / count);
    return sums;
  }

 private:
  static DistantLights ten_distant() {
    DistantLights distant;
    for (const Vec3& l : ten_directions()) distant.lights.push_back({l, {1, 1, 1}});
    return distant;
  }

  void photograph(Trial& trial) {
    const Lobe lobe = drawn(open_, random_);
    for (int x = 0; x < kTile.x1; ++x) {
      for (std::size_t k = 0; k < field_.count(); ++k) {
        const LitFrom from(field_.at(k, 1, x, 0).direction, {0, 0, 1});
        const double noise = kLobeModelShare * random_.normal();
        for (std::size_t p = 0; p < open_.albedo.size(); ++p) {
          const double bare =
              modelled(lobe, open_.albedo[p] * normals_[static_cast<std::size_t>(x)], from, 0);
          trial.reading(k, static_cast<int>(p))(x, 0) =
              static_cast<float>(bare + noise * std::max(bare, kLeastModelled));
        }
      }
    }
  }

  const OpenLobe& open_;
  LightField field_;
  Random random_;
  std::vector<Vec3> normals_;
};

std::vector<double> scatter_of(const OpenLobe& open, std::vector<Lobe> one_sigma_off) {
  const auto base = fast_method();
  const auto method = glossy_method(*base, {{open.lobe, std::move(one_sigma_off)}}, Sight(std::nullopt, 0));
  return Frames(open).scatter(*method);
}

const Lobe kSheet = {.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.04};
const std::array<OpenLobe, 5> kCloths = {
    OpenLobe{"ggx", kSheet, {0.4}, {0.05, 0.004, 0, 0}, 0.9},
    OpenLobe{"dark ggx",
             {.family = LobeFamily::kGgx, .alpha = 0.2, .f0 = 0.04},
             {0.05},
             {0.03, 0.002, 0, 0},
             -0.5},
    OpenLobe{"dark satin",
             {.family = LobeFamily::kAnisotropicGgx, .alpha = 0.35, .f0 = 0.05, .along = 0.4, .axis = 0.2},
             {0.06},
             {0.03, 0.002, 0.03, 0.02},
             0.3},
    OpenLobe{"beckmann",
             {.family = LobeFamily::kBeckmann, .alpha = 0.3, .f0 = 0.04},
             {0.2},
             {0.03, 0.003, 0, 0},
             0.5},
    OpenLobe{"red ggx", kSheet, {0.3, 0.06, 0.04}, {0.05, 0.004, 0, 0}, 0.9}};

TEST(GlossySigma, IsWhatPixelsScatterByWhoseLobeIsNotQuiteKnown) {
  for (const OpenLobe& open : kCloths) {
    const std::vector<double> all = scatter_of(open, one_sigma_off(open.lobe, covariance_of(open)));
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_GT(all[i], 0.8) << open.name << ": " << (i == 0 ? "normal" : "albedo");
      EXPECT_LT(all[i], 1.25) << open.name << ": " << (i == 0 ? "normal" : "albedo");
    }
    // Else the case would tell nothing of the lobe.
    const std::vector<double> of_readings = scatter_of(open, {});
    EXPECT_GT(*std::ranges::max_element(of_readings), 1.3) << open.name;
  }
}

}  // namespace
}  // namespace weft::solver
