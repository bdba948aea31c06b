// SPDX-License-Identifier: Apache-2.0
#include "exchange/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/exchange/sample_material.h"

namespace weft::exchange {
namespace {

using testing::HasSubstr;

std::string refusal_of(const Result<void>& result) {
  return result ? "" : result.error().message();
}

TEST(PortablePath, IsWhatEverySystemCanHold) {
  for (const char* path : {"a", "textures/a b.png", "t/\xc3\xa4.png", "connection.png", "com10"}) {
    EXPECT_EQ(refusal_of(check_portable_path(path)), "") << path;
  }
  for (const char* path : {"", "/a", "a/", "a//b", ".", "a/../b", "~/a", "a:b", "a\\b", "a*", "$HOME/a",
                           "a%b", "con", "t/Nul.png", "COM1.x", "a. ", "a.", "\xff", "a\nb"}) {
    EXPECT_NE(refusal_of(check_portable_path(path)), "") << path;
  }
  EXPECT_EQ(refusal_of(check_portable_path(std::string(255, 'a'))), "");
  EXPECT_NE(refusal_of(check_portable_path(std::string(256, 'a'))), "");
}

TEST(Identifier, IsOneOfMaterialXAndUsd) {
  EXPECT_EQ(identifier_of("Twill 2/1"), "Twill_2_1");
  EXPECT_EQ(identifier_of("2/1"), "_2_1");
  EXPECT_EQ(identifier_of("\xe7\xb6\xbf").substr(0, 6), "cloth_");
  EXPECT_NE(identifier_of("\xe7\xb6\xbf"), identifier_of("\xe7\xb5\xb9")) << "cotton and silk in Japanese";
  EXPECT_NE(identifier_of("Gr\xc3\xbcn"), identifier_of("Gr\xc3\xb6n"));
  EXPECT_EQ(identifier_of("Gr\xc3\xbcn").find_first_not_of("Gr_n0123456789abcdef"), std::string::npos);
  EXPECT_EQ(identifier_of(""), "cloth");
}

TEST(NumberText, IsTheShortestThatReadsBack) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-0.0), "0");
  EXPECT_EQ(number_text(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(numbers_text({1, 0.5, -2}), "1, 0.5, -2");
}

TEST(IorOfF0, IsFresnelsAtNormalIncidence) {
  for (const double ior : {1.0, 1.33, 1.5, 2.4}) {
    const double f0 = std::pow((ior - 1) / (ior + 1), 2);
    EXPECT_NEAR(ior_of_f0(f0), ior, 1e-12);
  }
  EXPECT_TRUE(std::isfinite(ior_of_f0(1)));
}

TEST(CheckMaterial, NamesTheParameterThatCannotBeWritten) {
  const TexturedMaterial good = sample_material().material;
  ASSERT_EQ(refusal_of(check_material(good)), "");
  ASSERT_EQ(refusal_of(check_material(constant_material())), "");
  const auto refusal = [&](auto change) {
    TexturedMaterial material = good;
    change(material);
    const auto checked = check_material(material);
    return checked ? std::string() : checked.error().where + " | " + checked.error().message();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal([](auto& m) { m.name = ""; }), HasSubstr("name |"));
  EXPECT_THAT(refusal([](auto& m) { m.name = "a\x01"; }), HasSubstr("name |"));
  EXPECT_THAT(refusal([](auto& m) { m.size_mm = {{0, 8}}; }), HasSubstr("size_mm |"));
  EXPECT_THAT(refusal([&](auto& m) { m.size_mm = {{8, nan}}; }), HasSubstr("size_mm |"));
  EXPECT_THAT(refusal([&](auto& m) { m.base_color.constant[1] = nan; }), HasSubstr("base_color |"));
  EXPECT_THAT(refusal([](auto& m) { m.base_color.constant[0] = -0.1; }), HasSubstr("base_color |"));
  EXPECT_THAT(refusal([](auto& m) { m.roughness->constant[0] = 1.1; }), HasSubstr("roughness |"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->constant = {}; }), HasSubstr("no length"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->channels = "rg"; }), HasSubstr("normal |"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->is_srgb = true; }), HasSubstr("no colour"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->scale = -1; }), HasSubstr("normal |"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->bits = 10; }), HasSubstr("10 bits"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->size.height = 0; }), HasSubstr("no pixels"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->file = "../n.png"; }), HasSubstr("../n.png"));
  EXPECT_THAT(refusal([](auto& m) { m.occlusion->texture->scale = 2; }), HasSubstr("occlusion |"));
  EXPECT_THAT(refusal([](auto& m) { m.provenance.emplace_back("solve", "\xff"); }), HasSubstr("solve |"));
}

}  // namespace
}  // namespace weft::exchange
