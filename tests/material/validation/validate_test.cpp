// SPDX-License-Identifier: Apache-2.0
#include "material/validation/validate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/solve/solve_record.h"
#include "simulator/reflectance/ggx.h"
#include "tests/material/made_surface.h"

namespace weft::material {
namespace {

constexpr int kSide = 48;
constexpr double kPitch_mm = 0.02;

// A sine wave that goes on across the border, of albedo 0.4, with all maps of it.
struct Cloth {
  Surface surface;
  Image<float> height_mm{{kSide, kSide}}, openness{{kSide, kSide}}, normals{{kSide, kSide}, 3};

  Cloth() {
    const double turn = 2 * kPi / 12, high = 0.015;
    surface = made_surface({kSide, kSide}, [&](int x, int y) {
      return std::array{high * turn / kPitch_mm * std::cos(turn * x),
                        -high * turn / kPitch_mm * std::cos(turn * y)};
    });
    surface.is_tile = true;
    surface.lobe = Image<float>({kSide, kSide}, 4);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        height_mm(x, y) = static_cast<float>(high * (std::sin(turn * x) + std::sin(turn * y)));
        openness(x, y) = static_cast<float>(0.9 + 0.1 * std::sin(turn * x));
        const Vec3 n = normalized({-double{surface.slope(x, y, 0)}, -double{surface.slope(x, y, 1)}, 1});
        normals(x, y, 0) = static_cast<float>(n.x);
        normals(x, y, 1) = static_cast<float>(n.y);
        normals(x, y, 2) = static_cast<float>(n.z);
        const std::array<float, 4> lobe = {0.3F, 0.3F, 0, 0.04F};
        for (int p = 0; p < 4; ++p) surface.lobe(x, y, p) = lobe[static_cast<std::size_t>(p)];
      }
    }
  }

  MapsToValidate maps() const {
    return {&surface,
            openness.plane(),
            height_mm.plane(),
            {normals.plane(0), normals.plane(1), normals.plane(2)},
            {{{4, 4, 12, 12}, 0.4}},
            false,
            false};
  }

  void paint(const std::function<std::array<double, 3>(int, int)>& albedo) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const std::array<double, 3> rgb = albedo(x, y);
        for (int c = 0; c < 3; ++c)
          surface.albedo(x, y, c) = static_cast<float>(rgb[static_cast<std::size_t>(c)]);
      }
    }
  }
};

std::vector<Finding> findings_of(const MapsToValidate& maps) {
  Result<std::vector<Finding>> found = validate(maps);
  EXPECT_TRUE(found) << (found ? "" : found.error().message());
  return found ? std::move(*found) : std::vector<Finding>{};
}

Finding finding(const std::string& name, const MapsToValidate& maps) {
  for (Finding& found : findings_of(maps)) {
    if (found.verdict.name == name) return std::move(found);
  }
  ADD_FAILURE() << "no finding " << name;
  return {};
}

int marked_pixels(const Finding& found) {
  int count = 0;
  for (int y = 0; y < found.where.height(); ++y) {
    for (int x = 0; x < found.where.width(); ++x) count += found.where(x, y) != 0;
  }
  return count;
}

TEST(Validation, PassesAClothWithNothingWrong) {
  const Cloth cloth;
  const std::vector<Finding> found = findings_of(cloth.maps());
  EXPECT_EQ(found.size(), 14U);
  EXPECT_EQ(worst_of(found), Severity::kPassed);
  EXPECT_TRUE(verdicts_of(found).empty());
  for (const Finding& one : found) {
    EXPECT_EQ(one.severity, Severity::kPassed) << one.verdict.name << ": " << one.verdict.text;
    EXPECT_FALSE(one.verdict.text.empty());
    EXPECT_TRUE(one.verdict.remedy.empty());
  }
}

TEST(Validation, LooksOnlyAtMapsThatAreThere) {
  const Cloth cloth;
  Surface bare = made_surface({kSide, kSide}, [](int, int) { return std::array{0.0, 0.0}; });
  EXPECT_EQ(findings_of({.surface = &bare}).size(), 6U);
}

TEST(Validation, NamesAlbedoThatIsTooDarkAndSaysWhenItMayBeRight) {
  Cloth cloth;
  cloth.paint([](int x, int) {
    return x < 12 ? std::array{0.008, 0.008, 0.008} : std::array{0.4, 0.4, 0.4};
  });
  MapsToValidate maps = cloth.maps();
  const Finding dark = finding("ALBEDO_DARK", maps);
  EXPECT_EQ(dark.severity, Severity::kError);
  EXPECT_NEAR(dark.number, 0.008, 1e-6);
  EXPECT_EQ(dark.limit, 0.0130);
  EXPECT_EQ(marked_pixels(dark), 12 * kSide - kSide)
      << "twelve columns less the one that is averaged with bright ones";
  maps.has_measured_black = true;
  const Finding black = finding("ALBEDO_DARK", maps);
  EXPECT_EQ(black.severity, Severity::kWarning);
  EXPECT_NE(black.verdict.text.find("velvet"), std::string::npos) << black.verdict.text;
}

TEST(Validation, NamesAlbedoThatIsTooBrightAndEnergyThatNoLightBrought) {
  Cloth cloth;
  cloth.paint([](int, int) { return std::array{0.9, 0.9, 0.9}; });
  EXPECT_EQ(finding("ALBEDO_BRIGHT", cloth.maps()).severity, Severity::kWarning);
  EXPECT_EQ(finding("ENERGY", cloth.maps()).severity, Severity::kPassed);
  cloth.paint([](int, int) { return std::array{0.98, 0.98, 0.98}; });
  EXPECT_EQ(finding("ALBEDO_BRIGHT", cloth.maps()).severity, Severity::kError);
  const Finding energy = finding("ENERGY", cloth.maps());
  EXPECT_EQ(energy.severity, Severity::kError);
  EXPECT_NEAR(energy.number, 1.02, 1e-6);
  EXPECT_EQ(marked_pixels(energy), kSide * kSide);
  cloth.paint([](int, int) { return std::array{0.95, 0.95, 0.95}; });
  EXPECT_EQ(finding("ENERGY", cloth.maps()).severity, Severity::kPassed);
  EXPECT_EQ(finding("LOBE_ENERGY", cloth.maps()).severity, Severity::kWarning)
      << "at 60 degrees Fresnel adds more than F0";
}

TEST(Validation, NamesColoursOutOfTheGamutAndTooPure) {
  Cloth cloth;
  cloth.paint([](int x, int) { return std::array{0.4, 0.3, x < 24 ? -0.01 : 0.2}; });
  const Finding gamut = finding("GAMUT", cloth.maps());
  EXPECT_EQ(gamut.severity, Severity::kWarning);
  EXPECT_NEAR(gamut.number, -0.01, 1e-6);
  EXPECT_GT(marked_pixels(gamut), 22 * kSide);
  cloth.paint([](int, int) { return std::array{0.5, 0.01, 0.2}; });
  EXPECT_NEAR(finding("SATURATION", cloth.maps()).number, 50, 1e-3);
  EXPECT_EQ(finding("SATURATION", cloth.maps()).severity, Severity::kWarning);
}

TEST(Validation, NamesAnF0ThatNoFibreHas) {
  Cloth cloth;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) cloth.surface.lobe(x, y, 3) = 0.5F;
  }
  MapsToValidate maps = cloth.maps();
  EXPECT_EQ(finding("F0", maps).severity, Severity::kWarning);
  EXPECT_EQ(finding("F0", maps).limit, 0.08);
  maps.is_metal = true;
  EXPECT_EQ(finding("F0", maps).severity, Severity::kPassed);
}

TEST(Validation, SeesLightThatIsLeftInTheAlbedo) {
  Cloth cloth;
  cloth.paint([&](int x, int y) {
    const double tone = 0.4 * std::exp(0.5 * (double{cloth.openness(x, y)} - 1));
    return std::array{tone, tone, tone};
  });
  const Finding shadows = finding("LIGHT_IN_ALBEDO_OPENNESS", cloth.maps());
  EXPECT_EQ(shadows.severity, Severity::kWarning);
  EXPECT_GT(shadows.number, 0.3);
  EXPECT_NE(shadows.verdict.text.find("shadows"), std::string::npos);
  cloth.paint([&](int x, int y) {
    const double tone = 0.4 * (1 + 0.05 * double{cloth.surface.slope(x, y, 0)});
    return std::array{tone, tone, tone};
  });
  EXPECT_LT(std::abs(finding("LIGHT_IN_ALBEDO_OPENNESS", cloth.maps()).number), 0.05);
  EXPECT_GT(finding("LIGHT_IN_ALBEDO_NORMALS", cloth.maps()).number, 0.9);
}

TEST(Validation, SeesASeam) {
  Cloth cloth;
  EXPECT_LE(finding("SEAM", cloth.maps()).number, 1 + 1e-6);
  for (int y = 0; y < kSide; ++y) cloth.surface.slope(0, y, 0) += 0.6F;
  const Finding seam = finding("SEAM", cloth.maps());
  EXPECT_EQ(seam.severity, Severity::kPassed) << "a step inside is no seam: " << seam.verdict.text;
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) cloth.surface.slope(x, y, 1) += static_cast<float>(0.1 * x);
  }
  const Finding ramp = finding("SEAM", cloth.maps());
  EXPECT_EQ(ramp.severity, Severity::kError);
  EXPECT_GT(ramp.number, 10);
  EXPECT_EQ(marked_pixels(ramp), 2 * kSide);
}

TEST(Validation, OfWovenClothSeesACropOfPartsOfRepeatsAndNoneOfWholeOnes) {
  for (const simulator::Family family :
       {simulator::Family::kSmooth, simulator::Family::kPlain, simulator::Family::kDeep}) {
    const simulator::GeometrySettings geometry = simulator::family_settings(family);  // yarns of 0.5 mm
    Surface tile = woven_surface({100, 100}, geometry), crop = woven_surface({87, 100}, geometry);
    tile.is_tile = crop.is_tile = true;
    EXPECT_EQ(finding("SEAM", {.surface = &tile}).severity, Severity::kPassed);
    EXPECT_EQ(finding("SEAM", {.surface = &crop}).severity, Severity::kError)
        << finding("SEAM", {.surface = &crop}).verdict.text;
  }
}

TEST(Validation, BelievesTheHeightOfAWeaveWithAllItsCreases) {
  for (const simulator::Family family :
       {simulator::Family::kSmooth, simulator::Family::kPlain, simulator::Family::kDeep}) {
    const simulator::GeometrySettings geometry = simulator::family_settings(family);
    const Surface surface = woven_surface({100, 100}, geometry);
    const simulator::Surface cloth = simulator::surface_of(geometry);
    Image<float> height({100, 100});
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 100; ++x) {
        height(x, y) =
            static_cast<float>(simulator::point_at(cloth, (x - 50) * 0.02, (50 - y) * 0.02).height_mm);
      }
    }
    const Finding found = finding("HEIGHT_OFF_SLOPES", {.surface = &surface, .height_mm = height.plane()});
    EXPECT_EQ(found.severity, Severity::kPassed) << found.verdict.text;
  }
}

TEST(Validation, SeesNormalsThatAreNone) {
  Cloth cloth;
  cloth.normals(3, 3, 2) = std::numeric_limits<float>::quiet_NaN();
  cloth.normals(4, 3, 2) = -cloth.normals(4, 3, 2);
  cloth.normals(5, 3, 0) = 2;
  const Finding lengths = finding("NORMAL_LENGTH", cloth.maps());
  EXPECT_EQ(lengths.severity, Severity::kError);
  EXPECT_EQ(marked_pixels(lengths), 3);
}

TEST(Validation, SeesAHeightOfAnotherScaleAndOneUpsideDown) {
  Cloth cloth;
  EXPECT_LT(finding("HEIGHT_OFF_SLOPES", cloth.maps()).number, 1);
  for (const double factor : {1000.0, -1.0}) {
    Cloth wrong;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) wrong.height_mm(x, y) *= static_cast<float>(factor);
    }
    const Finding off = finding("HEIGHT_OFF_SLOPES", wrong.maps());
    EXPECT_EQ(off.severity, Severity::kError) << factor;
    EXPECT_EQ(off.verdict.remedy.find("over") != std::string::npos, factor < 0) << off.verdict.remedy;
  }
}

TEST(Validation, NamesNoRemedyThatWasTakenAlready) {
  Cloth cloth;
  cloth.paint([&](int x, int y) {
    const double tone = 0.97 * std::exp(0.5 * (double{cloth.openness(x, y)} - 1)) +
                        0.02 * double{cloth.surface.slope(x, y, 0)};
    return std::array{tone, tone, tone};
  });
  MapsToValidate maps = cloth.maps();
  const auto remedies = [&] {
    std::string all;
    for (const Verdict& verdict : verdicts_of(findings_of(maps)))
      all += verdict.name + ": " + verdict.remedy + "\n";
    return all;
  };
  const auto count = [&](const std::string& words) {
    const std::string all = remedies();
    int found = 0;
    for (std::size_t at = all.find(words); at != std::string::npos; at = all.find(words, at + 1)) ++found;
    return found;
  };
  maps.level = "standard";
  EXPECT_EQ(count("--quality reference"), 3) << remedies();
  maps.level = "reference";
  EXPECT_EQ(count("--quality"), 0) << remedies();
  EXPECT_GE(count("white patch"), 1) << remedies();
  maps.is_colour_changed = true;
  EXPECT_EQ(count("white patch"), 0) << "what a step made brighter is no fault of the patch: " << remedies();
  EXPECT_GE(count("step color"), 1) << remedies();
}

TEST(Validation, WarnsOfAHeightThatItIntegratedAndAsksForNoOtherUnit) {
  Cloth cloth;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) cloth.height_mm(x, y) *= 0.5F;
  }
  MapsToValidate maps = cloth.maps();
  EXPECT_EQ(finding("HEIGHT_OFF_SLOPES", maps).severity, Severity::kError);
  maps.is_height_of_slopes = true;
  for (const auto& [level, wanted] : {std::pair{"fast", "--quality reference"}, {"reference", "leave it"}}) {
    maps.level = level;
    const Finding off = finding("HEIGHT_OFF_SLOPES", maps);
    EXPECT_EQ(off.severity, Severity::kWarning);
    EXPECT_NE(off.verdict.remedy.find(wanted), std::string::npos) << level << off.verdict.remedy;
    EXPECT_EQ(off.verdict.remedy.find("unit"), std::string::npos) << off.verdict.remedy;
  }
}

TEST(Validation, ChecksTexelDensityAndKnownGreys) {
  Cloth cloth;
  cloth.surface.mm_per_pixel = 20;
  EXPECT_EQ(finding("TEXEL_DENSITY", cloth.maps()).severity, Severity::kWarning);
  cloth.paint([](int, int) { return std::array{0.4, 0.4, 0.44}; });
  const Finding greys = finding("GREYS", cloth.maps());
  EXPECT_EQ(greys.severity, Severity::kError);
  EXPECT_NEAR(greys.number, 0.1, 1e-6);
  EXPECT_EQ(marked_pixels(greys), 64);
}

TEST(Validation, LooksAtNoHoleAndNoPixelWithoutASolution) {
  Cloth cloth;
  cloth.surface.opacity = Image<float>({kSide, kSide});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool hole = x < 20;
      cloth.surface.opacity(x, y) = hole ? 0.0F : 1.0F;
      if (hole) cloth.surface.albedo(x, y, 0) = 1e6F;
      if (y < 5) {
        cloth.surface.status(x, y) = kNoSolution;
        cloth.surface.albedo(x, y, 1) = -1;
      }
    }
  }
  EXPECT_EQ(finding("ALBEDO_BRIGHT", cloth.maps()).severity, Severity::kPassed);
  EXPECT_EQ(finding("GAMUT", cloth.maps()).severity, Severity::kPassed);
}

TEST(Validation, IsRefusedWithoutAnythingToLookAt) {
  EXPECT_FALSE(validate({}));
  Cloth cloth;
  MapsToValidate maps = cloth.maps();
  const Image<float> other({3, 3});
  maps.height_mm = other.plane();
  EXPECT_FALSE(validate(maps));
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) cloth.surface.status(x, y) = kNoSolution;
  }
  EXPECT_FALSE(validate(cloth.maps()));
}

TEST(Validation, KnowsWhatALobeReflectsAsTheSimulatorDoes) {
  for (const double alpha : {0.1, 0.3, 0.7, 1.0}) {
    for (const double view_deg : {0.0, 60.0}) {
      // Quadrature over light directions of the simulator's lobe.
      const Vec3 v = {std::sin(radians(view_deg)), 0, std::cos(radians(view_deg))};
      const simulator::GgxLobe lobe(alpha, alpha);
      constexpr int kPolar = 400, kAzimuths = 200;
      double sum = 0;
      for (int i = 0; i < kPolar; ++i) {
        for (int j = 0; j < kAzimuths; ++j) {
          const Vec3 l = simulator::from_cosine((i + 0.5) / kPolar, (j + 0.5) / kAzimuths);
          const simulator::Facet facet = simulator::facet_between(l, v);
          sum += simulator::schlick(0.04, facet.cosine) * lobe.evaluate(l, v, facet) * l.z;
        }
      }
      sum *= 2 * kPi / (kPolar * kAzimuths);
      EXPECT_NEAR(ggx_directional_albedo(alpha, 0.04, view_deg), sum, 0.002) << alpha << ' ' << view_deg;
    }
  }
}

}  // namespace
}  // namespace weft::material
