// SPDX-License-Identifier: Apache-2.0
#include "exchange/gltf/glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/json_document.h"
#include "tests/exchange/export_checks.h"
#include "tests/exchange/sample_material.h"

namespace weft::exchange {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal_of(const Result<void>& result) {
  return result ? "" : result.error().message();
}
std::string refusal_of(const Result<Document>& result) {
  return result ? "" : result.error().message();
}

Document written(const SampleMaterial& sample, const GlbOptions& options = {}) {
  auto document = glb_of(sample.material, sample.bytes(), options);
  EXPECT_TRUE(document) << (document ? "" : document.error().message());
  return document ? *document : Document();
}

std::size_t word_at(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

Json json_of(const std::string& glb) {
  return Json::parse(std::string_view(glb).substr(20, word_at(glb, 12)));
}

std::string rebuilt(const std::string& glb, const Json& asset) {
  std::string text = asset.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = glb.substr(20 + word_at(glb, 12));
  const auto word = [](std::size_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((value >> shift) & 0xff);
    return bytes;
  };
  return "glTF" + word(2) + word(20 + text.size() + rest.size()) + word(text.size()) + "JSON" + text + rest;
}

TEST(Glb, PassesItsOwnCheckWithAllExtensions) {
  SampleOptions options;
  options.has_f0_texture = true;
  const Document glb = written(sample_material(options), {{10, 5}, AlphaMode::kMask});
  EXPECT_EQ(refusal_of(check_glb(glb.bytes)), "");
  EXPECT_THAT(json_of(glb.bytes)["extensionsUsed"],
              ElementsAre("KHR_materials_anisotropy", "KHR_materials_ior", "KHR_materials_sheen",
                          "KHR_materials_specular", "KHR_texture_transform"));
}

TEST(Glb, HasTheSameBytesTwice) {
  const SampleMaterial sample = sample_material();
  EXPECT_EQ(written(sample).bytes, written(sample).bytes);
}

TEST(Glb, TakesImagesAlongAsTheyAre) {
  const SampleMaterial sample = sample_material();
  const std::string glb = written(sample).bytes;
  const Json asset = json_of(glb);
  const std::size_t binary = 20 + word_at(glb, 12) + 8;
  for (const Json& image : asset["images"]) {
    const Json& view = asset["bufferViews"][image["bufferView"].get<std::size_t>()];
    const std::string taken =
        glb.substr(binary + view["byteOffset"].get<std::size_t>(), view["byteLength"].get<std::size_t>());
    EXPECT_TRUE(taken == sample.files.at(image["name"])) << image["name"] << " has other bytes";
  }
}

TEST(Glb, LeavesOutATextureThatNothingUses) {
  const Document glb = written(sample_material());
  EXPECT_THAT(glb.files, testing::Not(testing::Contains("textures/height.png")));
  EXPECT_EQ(json_of(glb.bytes)["images"].size(), glb.files.size());
  EXPECT_THAT(glb.left_out, testing::Contains(HasSubstr("height_mm")));
}

TEST(Glb, SharesOneTextureBetweenOcclusionAndRoughness) {
  const Json material = json_of(written(sample_material()).bytes)["materials"][0];
  EXPECT_EQ(material["occlusionTexture"]["index"],
            material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"]);
  EXPECT_EQ(material["pbrMetallicRoughness"]["metallicFactor"], 0.0);
  EXPECT_EQ(material["pbrMetallicRoughness"]["roughnessFactor"], 1.0);
  EXPECT_EQ(material["extensions"]["KHR_materials_sheen"]["sheenColorFactor"], Json({0.25, 0.25, 0.25}));
}

TEST(Glb, SaysNumbersWhereThereAreNoTextures) {
  const auto glb = glb_of(constant_material(), {});
  ASSERT_TRUE(glb);
  const Json asset = json_of(glb->bytes), material = asset["materials"][0];
  EXPECT_FALSE(asset.contains("textures"));
  EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"], Json({0.4, 0.2, 0.1, 1.0}));
  const Json& anisotropy = material["extensions"]["KHR_materials_anisotropy"];
  EXPECT_NEAR(anisotropy["anisotropyRotation"].get<double>(), std::atan2(0.8, 0.6), 1e-12);
  EXPECT_EQ(material["extensions"]["KHR_materials_ior"]["ior"], 1.5) << "of a reflectance of 4 percent";
  EXPECT_FALSE(material.contains("alphaMode")) << "opacity is 1 everywhere";
}

TEST(Glb, CutsHolesByAMaskUnlessAskedToBlend) {
  const SampleMaterial sample = sample_material();
  EXPECT_EQ(json_of(written(sample).bytes)["materials"][0]["alphaMode"], "MASK");
  const Document blended = written(sample, {{1, 1}, AlphaMode::kBlend});
  EXPECT_EQ(json_of(blended.bytes)["materials"][0]["alphaMode"], "BLEND");
}

TEST(Glb, InventsNoSize) {
  SampleOptions options;
  options.size_mm.reset();
  options.size = {64, 32};
  const Json asset = json_of(written(sample_material(options)).bytes);
  EXPECT_TRUE(asset["asset"]["extras"]["weft"]["size_mm"].is_null());
  EXPECT_THAT(asset["asset"]["extras"]["weft"]["size_note"], HasSubstr("not known"));
  EXPECT_EQ(asset["accessors"][0]["max"], Json({0.5, 0.25, 0.0}));
}

TEST(Glb, SaysWhereItCameFrom) {
  const Json asset = json_of(written(sample_material()).bytes)["asset"];
  EXPECT_EQ(asset["extras"]["weft"]["provenance"]["session"], "indigo.weft");
}

TEST(Glb, RefusesTexturesWhereItDoesNotReadThem) {
  const SampleMaterial sample = sample_material();
  const auto refusal = [&](auto change) {
    TexturedMaterial material = sample.material;
    change(material);
    return refusal_of(glb_of(material, sample.bytes()));
  };
  EXPECT_THAT(refusal([](auto& m) { m.roughness->texture->channels = "r"; }), HasSubstr("roughness"));
  EXPECT_THAT(refusal([](auto& m) { m.occlusion->texture->channels = "b"; }), HasSubstr("occlusion"));
  EXPECT_THAT(refusal([](auto& m) { m.opacity->texture->file = "textures/orm.png"; }), HasSubstr("opacity"));
  EXPECT_THAT(refusal([](auto& m) { m.anisotropy->texture->channels = "r"; }), HasSubstr("anisotropy"));
  EXPECT_THAT(refusal([](auto& m) { m.anisotropy_direction->texture.reset(); }), HasSubstr("direction"));
  EXPECT_THAT(refusal([](auto& m) { m.sheen_roughness->texture->channels = "r"; }), HasSubstr("sheen"));
  EXPECT_THAT(refusal([](auto& m) { m.base_color.texture->is_srgb = false; }), HasSubstr("sRGB"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->file = "none.png"; }), HasSubstr("not given"));
  EXPECT_THAT(refusal([](auto& m) { m.normal->texture->size.width = 65; }), HasSubstr("65 x 64"));
}

TEST(Glb, RefusesSeveralTilesOfWhatDoesNotRepeat) {
  SampleMaterial sample = sample_material();
  sample.material.repeats = false;
  EXPECT_THAT(refusal_of(glb_of(sample.material, sample.bytes(), {{2, 1}, AlphaMode::kMask})),
              HasSubstr("does not repeat"));
  EXPECT_EQ(json_of(written(sample).bytes)["samplers"][0]["wrapS"], 33071) << "clamped to its edge";
}

TEST(CheckGlb, RefusesBrokenContainers) {
  const std::string glb = written(sample_material()).bytes;
  for (std::size_t i = 0; i < 24; ++i) {
    std::string broken = glb;
    broken[i] = static_cast<char>(broken[i] ^ 4);
    EXPECT_NE(refusal_of(check_glb(broken)), "") << "byte " << i;
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{27}, std::size_t{100}, glb.size() - 4}) {
    EXPECT_NE(refusal_of(check_glb(glb.substr(0, size))), "") << size << " bytes";
  }
  EXPECT_NE(refusal_of(check_glb(glb + "1234")), "");
}

TEST(CheckGlb, RefusesWhatPointsNowhere) {
  const std::string glb = written(sample_material()).bytes;
  const Json asset = json_of(glb);
  ASSERT_EQ(refusal_of(check_glb(rebuilt(glb, asset))), "");
  const auto refusal = [&](const char* pointer, const Json& value) {
    Json broken = asset;
    broken[Json::json_pointer(pointer)] = value;
    return refusal_of(check_glb(rebuilt(glb, broken)));
  };
  EXPECT_THAT(refusal("/asset/version", "1.0"), HasSubstr("/asset/version"));
  EXPECT_THAT(refusal("/buffers/0/byteLength", 12), HasSubstr("/buffers/0"));
  EXPECT_THAT(refusal("/bufferViews/1/byteOffset", 2), HasSubstr("/bufferViews/1"));
  EXPECT_THAT(refusal("/bufferViews/5/byteLength", 100000000), HasSubstr("/bufferViews/5"));
  EXPECT_THAT(refusal("/accessors/0/count", 5), HasSubstr("/accessors/0"));
  EXPECT_THAT(refusal("/accessors/4/componentType", 5125), HasSubstr("/accessors/4"));
  EXPECT_THAT(refusal("/images/0/mimeType", "image/jpeg"), HasSubstr("/images/0"));
  EXPECT_THAT(refusal("/textures/0/source", 99), HasSubstr("/textures/0"));
  EXPECT_THAT(refusal("/materials/0/normalTexture/index", 99), HasSubstr("normalTexture"));
}

}  // namespace
}  // namespace weft::exchange
