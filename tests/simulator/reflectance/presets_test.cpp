// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/presets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "tests/simulator/reflectance/measured.h"

namespace weft::simulator {
namespace {

using testing::HasSubstr;

TEST(Presets, AreFoundByNameAndSayWhatEachParameterIs) {
  std::set<std::string> names;
  for (const ClothPreset& each : presets()) {
    names.insert(each.name);
    const Result<ClothPreset> found = preset(each.name);
    ASSERT_TRUE(found) << each.name;
    EXPECT_EQ(found->reflectance, each.reflectance);
    EXPECT_EQ(found->albedo, each.albedo);
    ASSERT_FALSE(found->parameters.empty());
    EXPECT_EQ(found->parameters.back().name, "albedo");
  }
  EXPECT_EQ(names, (std::set<std::string>{"matte-cotton", "wool", "velvet", "two-tone-velvet", "satin",
                                          "dark-satin"}));
}

TEST(Presets, AMisspeltNameIsAnErrorThatNamesTheNearestFirst) {
  const auto why = [](const char* name) { return preset(name).error().why; };
  EXPECT_EQ(preset("velvte").error().kind, ErrorKind::kBadData);
  EXPECT_EQ(preset("velvte").error().where, "velvte");
  EXPECT_THAT(why("velvte"), testing::StartsWith("there are velvet, "));
  EXPECT_THAT(why("satn"), testing::StartsWith("there are satin, "));
  EXPECT_THAT(why("dark satin"), testing::StartsWith("there are dark-satin, "));
  for (const ClothPreset& each : presets()) EXPECT_THAT(why(""), HasSubstr(each.name));
}

TEST(Presets, HaveTheParametersOfTheirTableAndReflectWhatItSays) {
  const auto grey = [](double value) { return Rgb{value, value, value}; };
  struct Row {
    const char* name;
    Reflectance reflectance;
    Rgb albedo;
    std::array<double, 3> reflected;  ///< green, in light from everywhere, seen from 0, 60 and 85 degrees
  };
  for (const Row& row :
       {Row{"matte-cotton", MultipleScattering{0.2}, {0.6, 0.57, 0.5}, {0.540, 0.503, 0.521}},
        Row{"wool", Cloth{0.7, 4, grey(0.046)}, {0.3, 0.24, 0.18}, {0.234, 0.241, 0.260}},
        Row{"velvet", Cloth{0.3, 4, grey(0.05)}, {0.04, 0.012, 0.012}, {0.021, 0.025, 0.051}},
        Row{"two-tone-velvet", Cloth{0.35, 4, {0.04, 0.09, 0.2}}, {0.06, 0.01, 0.02}, {0.024, 0.032, 0.072}},
        Row{"satin", AnisotropicGgx{0.45, 0.65, grey(0.05)}, {0.45, 0.4, 0.36}, {0.422, 0.442, 0.572}},
        Row{"dark-satin", AnisotropicGgx{0.35, 0.6, grey(0.05)}, grey(0.06), {0.102, 0.126, 0.285}}}) {
    const ClothPreset found = preset(row.name).value();
    EXPECT_EQ(found.reflectance, row.reflectance) << row.name;
    EXPECT_EQ(found.albedo, row.albedo) << row.name;
    const double zeniths_deg[] = {0, 60, 85};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(directional_albedo(found.reflectance, found.albedo, at_angles(zeniths_deg[i], 20), 300),
                  row.reflected[i], 1e-3)
          << row.name << " from " << zeniths_deg[i];
    }
  }
}

}  // namespace
}  // namespace weft::simulator
