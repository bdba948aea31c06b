// SPDX-License-Identifier: Apache-2.0
#include "exchange/u3m/u3m.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/json_document.h"
#include "exchange/archive/zip.h"
#include "tests/exchange/export_checks.h"
#include "tests/exchange/sample_material.h"

namespace weft::exchange {
namespace {

using testing::HasSubstr;

SampleMaterial separate_sample() {
  SampleOptions options;
  options.packing = Packing::kSeparate;
  return sample_material(options);
}

U3mOptions sample_options() {
  U3mOptions options;
  options.created = "2026-11-21T14:25:01Z";
  options.modified = "2026-11-21T15:25:01+01:00";
  options.digest = std::string(64, 'a');
  options.physics = {0.4, 140, {{0.6, "cotton"}, {0.25, "polyamide"}, {0.15, "nettle"}}, "taffeta"};
  return options;
}

template <typename T>
std::string refusal_of(const Result<T>& result) {
  return result ? "" : result.error().message();
}

Document written(const TexturedMaterial& material, const U3mOptions& options = sample_options()) {
  auto document = u3m_of(material, options);
  EXPECT_TRUE(document) << refusal_of(document);
  return document ? *document : Document();
}

Json json_of(const Document& document) {
  return Json::parse(document.bytes);
}

TEST(U3m, PassesItsOwnCheck) {
  const SampleMaterial sample = separate_sample();
  const Document document = written(sample.material);
  std::map<std::string, Size, std::less<>> pixels;
  for (const std::string& file : document.files) pixels[file] = {64, 64};
  EXPECT_EQ(refusal_of(check_u3m(document.bytes, pixels)), "");
  EXPECT_EQ(refusal_of(check_u3m(written(constant_material()).bytes)), "");
}

TEST(U3m, HasTheSameBytesTwice) {
  const SampleMaterial sample = separate_sample();
  EXPECT_EQ(written(sample.material).bytes, written(sample.material).bytes);
}

TEST(U3m, WritesMeansAsConstants) {
  const Json front = json_of(written(separate_sample().material))["material"]["front"];
  EXPECT_EQ(front["displacement"]["constant"], 0.0);
  EXPECT_EQ(front["displacement"]["texture"]["factor"], 0.16);
  EXPECT_EQ(front["displacement"]["texture"]["offset"], -0.08);
  EXPECT_EQ(front["specular_value"]["constant"], 0.5) << "4 of 8 percent";
  EXPECT_EQ(front["ior"]["constant"], 1.5);
  EXPECT_NEAR(front["basecolor"]["constant"]["r"].get<double>(), 0.6651850846308363, 1e-12) << "0.4 in sRGB";
  EXPECT_EQ(front["alpha"]["constant"], 1.0);
}

// Burley 2012: alphas are r^2 / q and r^2 q with q = sqrt(1 - 0.9 a).
TEST(U3m, KeepsTheMeanLobeInThePrincipledConvention) {
  const Json front = json_of(written(constant_material()))["material"]["front"];
  const double r = front["roughness"]["constant"].get<double>();
  const double q = std::sqrt(1 - 0.9 * front["anisotropy_value"]["constant"].get<double>());
  const Alphas truth = alphas_of(0.55, 0.5);
  EXPECT_NEAR(r * r / q, truth.along, 1e-12);
  EXPECT_NEAR(r * r * q, truth.across, 1e-12);
  EXPECT_NEAR(front["anisotropy_rotation"]["constant"].get<double>(),
              std::atan2(0.8, 0.6) / (2 * std::numbers::pi), 1e-12);
}

TEST(U3m, NamesFibresByItsListAndOthersByName) {
  const Json physics = json_of(written(constant_material()))["material"]["physics"];
  const Json& parts = physics["composition"]["parts"];
  EXPECT_EQ(parts[1]["type"], "Polyamid");
  EXPECT_TRUE(parts[1]["name"].is_null());
  EXPECT_EQ(parts[2]["type"], "other");
  EXPECT_EQ(parts[2]["name"], "nettle");
  EXPECT_EQ(physics["construction"]["type"], "TafFeta");
  EXPECT_EQ(physics["material_type"]["type"], "Woven");
  EXPECT_EQ(physics["devices"]["fab"], "null");
}

TEST(U3m, SaysNothingOfPhysicsThatNobodyKnows) {
  U3mOptions options = sample_options();
  options.physics = {};
  EXPECT_TRUE(json_of(written(constant_material(), options))["material"]["physics"].is_null());
}

TEST(U3m, WritesTimesInUtc) {
  const Json material = json_of(written(constant_material()))["material"];
  EXPECT_THAT(material["modified"], HasSubstr("2026-11-21T14:25:01"));
  EXPECT_EQ(material["id"], "aaaaaaaa-aaaa-4aaa-aaaa-aaaaaaaaaaaa");
}

TEST(U3m, RefusesAClothWithoutASize) {
  TexturedMaterial material = constant_material();
  material.size_mm.reset();
  EXPECT_THAT(refusal_of(u3m_of(material, sample_options())), HasSubstr("size_mm"));
}

TEST(U3m, RefusesTexturesThatItCannotRead) {
  const auto refusal = [&](auto change) {
    TexturedMaterial material = separate_sample().material;
    change(material);
    return refusal_of(u3m_of(material, sample_options()));
  };
  EXPECT_THAT(refusal([](auto& m) { m.roughness->texture->channels = "g"; }), HasSubstr("mean of all"));
  EXPECT_THAT(refusal([](auto& m) { m.roughness->texture->file = m.base_color.texture->file; }),
              HasSubstr("mean of all"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->file = "textures/normal.exr"; }), HasSubstr("PNG"));
  EXPECT_THAT(refusal([](auto& m) { m.base_color.texture->is_srgb = false; }), HasSubstr("sRGB"));
}

TEST(U3m, RefusesOptionsThatAreNone) {
  const auto refusal = [&](auto change) {
    U3mOptions options = sample_options();
    change(options);
    return refusal_of(u3m_of(constant_material(), options));
  };
  EXPECT_THAT(refusal([](auto& o) { o.created = "yesterday"; }), HasSubstr("created"));
  EXPECT_THAT(refusal([](auto& o) { o.digest = "abc"; }), HasSubstr("digest"));
  EXPECT_THAT(refusal([](auto& o) { o.physics.thickness_mm = -1; }), HasSubstr("thickness_mm"));
  EXPECT_THAT(refusal([](auto& o) { o.physics.weight_g_m2 = std::nan(""); }), HasSubstr("weight_g_m2"));
  EXPECT_THAT(refusal([](auto& o) { o.physics.composition[0].share = 0.5; }), HasSubstr("composition"));
  EXPECT_THAT(refusal([](auto& o) { o.description = "\xff"; }), HasSubstr("description"));
}

TEST(CheckU3m, RefusesBrokenTwins) {
  const SampleMaterial sample = separate_sample();
  const Json good = json_of(written(sample.material));
  const std::map<std::string, Size, std::less<>> pixels = {{"textures/base.png", {64, 64}}};
  const auto refusal = [&](const char* pointer, const Json& value) {
    Json broken = good;
    broken[Json::json_pointer(pointer)] = value;
    return refusal_of(check_u3m(broken.dump(), pixels));
  };
  ASSERT_EQ(refusal("/schema", "1.1"), "");
  const std::string front = "/material/front/", physics = "/material/physics/";
  for (const auto& [pointer, value] : std::vector<std::pair<std::string, Json>>{
           {"/schema", "1.0"},
           {"/more", 1},
           {"/material/id", "aaaaaaaa-aaaa-1aaa-aaaa-aaaaaaaaaaaa"},
           {"/material/name", ""},
           {"/material/created", "2026-11-21T14:25:01"},
           {front + "alpha/constant", 2},
           {front + "ior/constant", "1.5"},
           {front + "normal/constant/z", 1.5},
           {front + "basecolor/texture/mode", "screen"},
           {front + "basecolor/texture/image/path", "../base.png"},
           {front + "basecolor/texture/image/dpi/x", 72},
           {front + "basecolor/texture/image/width", 9},
           {front + "basecolor/texture/image/repeat/mode", "tile"},
           {front + "shader", "phong"},
           {front + "glitter", 1},
           {physics + "thickness", -1},
           {physics + "construction/type", "Taffeta"},
           {physics + "construction/name", "taffeta"},
           {physics + "composition/parts/2/name", nullptr},
           {physics + "composition/parts/0/ratio", 0.5},
           {physics + "composition/parts", Json::array()},
       }) {
    EXPECT_NE(refusal(pointer.c_str(), value), "") << pointer << " = " << value;
  }
  Json less = good;
  less["material"]["front"].erase("transmission");
  EXPECT_THAT(refusal_of(check_u3m(less.dump())), HasSubstr("/material/front/transmission"));
  EXPECT_THAT(refusal_of(check_u3m("{")), HasSubstr("no JSON"));
}

TEST(U3ma, IsAStrictArchiveOfTheDocumentAndItsFiles) {
  const SampleMaterial sample = separate_sample();
  const Document document = written(sample.material);
  const auto archive = u3ma_of("cloth.u3m", document, sample.bytes());
  ASSERT_TRUE(archive) << refusal_of(archive);
  EXPECT_EQ(refusal_of(check_zip(*archive, ZipKind::kStrict)), "");
  EXPECT_EQ(archive->find(document.bytes), 30u + std::string("cloth.u3m").size());
  EXPECT_THAT(refusal_of(u3ma_of("cloth.json", document, sample.bytes())), HasSubstr(".u3m"));
  EXPECT_THAT(refusal_of(u3ma_of("cloth.u3m", document, {})), HasSubstr("not given"));
}

}  // namespace
}  // namespace weft::exchange
