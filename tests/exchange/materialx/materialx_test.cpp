// SPDX-License-Identifier: Apache-2.0
#include "exchange/materialx/materialx.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/exchange/materialx/mtlx_reader.h"
#include "tests/exchange/sample_material.h"

namespace weft::exchange {
namespace {

using testing::Contains;
using testing::HasSubstr;

const std::string kName = "Plain_weave___indigo____white";

SampleMaterial separate_sample() {
  SampleOptions options;
  options.packing = Packing::kSeparate;
  return sample_material(options);
}

template <typename T>
std::string refusal_of(const Result<T>& result) {
  return result ? "" : result.error().message();
}

XmlElement read(const Result<Document>& document) {
  EXPECT_TRUE(document) << refusal_of(document);
  return document ? read_xml(document->bytes) : XmlElement();
}

MaterialXOptions only(SurfaceModel model) {
  MaterialXOptions options;
  options.models = {model};
  return options;
}

/// Every node, graph and output that something names is there and has the type that is asked of it.
void expect_all_connected(const XmlElement& scope, const XmlElement& root) {
  std::set<std::string> names;
  for (const XmlElement& element : scope.children) {
    EXPECT_TRUE(names.insert(element.at("name")).second) << element.at("name") << " is there twice";
    if (element.tag == "nodegraph") {
      expect_all_connected(element, root);
      continue;
    }
    std::vector<XmlElement> uses = element.children;
    if (element.tag == "output") uses.push_back(element);
    for (const XmlElement& use : uses) {
      const XmlElement* source = nullptr;
      if (use.attributes.contains("nodegraph")) {
        const XmlElement* graph = root.child(use.at("nodegraph"));
        source = graph == nullptr ? nullptr : graph->child(use.at("output"));
      } else if (use.attributes.contains("nodename")) {
        source = scope.child(use.at("nodename"));
      } else {
        continue;
      }
      ASSERT_NE(source, nullptr) << element.at("name") << " names " << use.at("nodename") << use.at("output");
      EXPECT_EQ(source->at("type"), use.at("type")) << element.at("name") << "." << use.at("name");
    }
  }
}

TEST(MaterialX, ConnectsAllThatItNames) {
  const SampleMaterial sample = separate_sample();
  MaterialXOptions options;
  options.models = {SurfaceModel::kOpenPbr, SurfaceModel::kStandardSurface, SurfaceModel::kGltfPbr};
  options.has_displacement = true;
  const XmlElement packed = read(materialx_of(sample_material().material, options));
  expect_all_connected(packed, packed);
  const XmlElement all = read(materialx_of(sample.material, options));
  expect_all_connected(all, all);
  EXPECT_EQ(all.at("version"), "1.39");
  EXPECT_EQ(all.at("colorspace"), "lin_rec709");
  for (const std::string& name : {kName, kName + "_standard_surface", kName + "_gltf_pbr"}) {
    ASSERT_NE(all.child(name), nullptr) << name;
    EXPECT_EQ(all.child(name)->tag, "surfacematerial");
  }
}

// The alphas that each model makes of its inputs, by its own definition, are those of the material.
TEST(MaterialX, KeepsTheLobeInEveryModelsConvention) {
  const TexturedMaterial material = separate_sample().material;
  const XmlElement open = read(materialx_of(material, only(SurfaceModel::kOpenPbr)));
  const XmlElement standard = read(materialx_of(material, only(SurfaceModel::kStandardSurface)));
  for (const double roughness : {0.05, 0.3, 0.55, 1.0}) {
    for (const double strength : {0.0, 0.2, 0.5, 0.9}) {
      const std::map<std::string, double> texels = {{"image_roughness", roughness},
                                                    {"image_anisotropy", strength}};
      const Alphas truth = alphas_of(roughness, strength);
      const double r = value_of_input(open, "SR_" + kName, "specular_roughness", texels);
      const double a = value_of_input(open, "SR_" + kName, "specular_roughness_anisotropy", texels);
      const double along = r * r * std::sqrt(2 / (1 + (1 - a) * (1 - a)));
      EXPECT_NEAR(along, truth.along, 1e-12) << roughness << ", " << strength;
      EXPECT_NEAR((1 - a) * along, truth.across, 1e-12) << roughness << ", " << strength;
      const double rs = value_of_input(standard, "SR_" + kName, "specular_roughness", texels);
      const double as = value_of_input(standard, "SR_" + kName, "specular_anisotropy", texels);
      EXPECT_NEAR(rs * rs / std::sqrt(1 - as), truth.along, 1e-12) << roughness << ", " << strength;
      EXPECT_NEAR(rs * rs * std::sqrt(1 - as), truth.across, 1e-12) << roughness << ", " << strength;
    }
  }
}

TEST(MaterialX, KeepsTheLobeOfNumbersToo) {
  const XmlElement open = read(materialx_of(constant_material(), only(SurfaceModel::kOpenPbr)));
  const Alphas truth = alphas_of(0.55, 0.5);
  const double r = value_of_input(open, "SR_" + kName, "specular_roughness", {});
  const double a = value_of_input(open, "SR_" + kName, "specular_roughness_anisotropy", {});
  EXPECT_NEAR(r * r * std::sqrt(2 / (1 + (1 - a) * (1 - a))), truth.along, 1e-12);
  EXPECT_NEAR(1 - a, truth.across / truth.along, 1e-12);
}

TEST(MaterialX, KeepsSheenAsStrengthTimesColour) {
  const TexturedMaterial material = separate_sample().material;
  const std::map<std::string, double> texels = {{"image_sheen_color", 0.7}, {"image_sheen_roughness", 0.5}};
  const XmlElement open = read(materialx_of(material, only(SurfaceModel::kOpenPbr)));
  EXPECT_NEAR(value_of_input(open, "SR_" + kName, "fuzz_weight", texels) *
                  value_of_input(open, "SR_" + kName, "fuzz_color", texels),
              0.25 * 0.7, 1e-12);
  const XmlElement gltf = read(materialx_of(material, only(SurfaceModel::kGltfPbr)));
  EXPECT_NEAR(value_of_input(gltf, "SR_" + kName, "sheen_color", texels), 0.25 * 0.7, 1e-12);
  EXPECT_EQ(value_of_input(gltf, "SR_" + kName, "sheen_roughness", texels), 0.5);
  const XmlElement standard = read(materialx_of(material, only(SurfaceModel::kStandardSurface)));
  EXPECT_EQ(value_of_input(standard, "SR_" + kName, "sheen_roughness", texels), 0.25);
}

TEST(MaterialX, KeepsReflectanceByIndexAndWeight) {
  SampleOptions options;
  options.has_f0_texture = true;
  const XmlElement open = read(materialx_of(sample_material(options).material, only(SurfaceModel::kOpenPbr)));
  const double ior = value_of_input(open, "SR_" + kName, "specular_ior", {});
  const double weight = value_of_input(open, "SR_" + kName, "specular_weight", {{"image_f0", 0.6}});
  const double f0 = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1)) * weight;
  EXPECT_NEAR(f0, 0.05 * 0.6, 1e-12);
}

TEST(MaterialX, SaysTrueSizeAndColourSpaceOfImages) {
  TexturedMaterial material = separate_sample().material;
  material.size_mm = {{80, 50.9}};
  MaterialXOptions options;
  options.uv_covers_mm = {{1000, 500}};
  const XmlElement document = read(materialx_of(material, options));
  const XmlElement* image = document.child("NG_" + kName)->child("image_base_color");
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(image->child("realworldimagesize")->at("value"), "0.08, 0.0509");
  EXPECT_EQ(image->child("realworldtilesize")->at("value"), "1, 0.5");
  EXPECT_EQ(image->child("realworldimagesize")->at("unit"), "meter");
  EXPECT_EQ(image->child("file")->at("colorspace"), "srgb_texture");
  EXPECT_EQ(document.child("NG_" + kName)->child("image_normal")->child("file")->at("colorspace"), "");
}

TEST(MaterialX, InventsNoSize) {
  SampleOptions sample;
  sample.size_mm.reset();
  const auto document = materialx_of(sample_material(sample).material);
  ASSERT_TRUE(document);
  EXPECT_THAT(document->bytes, testing::Not(HasSubstr("realworld")));
  EXPECT_THAT(read(document).at("doc"), HasSubstr("size not known"));
}

TEST(MaterialX, KeepsNamesThatXmlWouldRead) {
  const XmlElement document = read(materialx_of(constant_material()));
  EXPECT_THAT(document.at("doc"), HasSubstr("Plain weave, \"indigo\" & white"));
}

TEST(MaterialX, RefusesOptionsThatMakeNoSense) {
  const TexturedMaterial material = constant_material();
  MaterialXOptions options;
  options.models = {};
  EXPECT_THAT(refusal_of(materialx_of(material, options)), HasSubstr("models"));
  options.models = {SurfaceModel::kGltfPbr, SurfaceModel::kGltfPbr};
  EXPECT_THAT(refusal_of(materialx_of(material, options)), HasSubstr("twice"));
  TexturedMaterial no_size = material;
  no_size.size_mm.reset();
  options = {};
  options.uv_covers_mm = {{8, 8}};
  EXPECT_THAT(refusal_of(materialx_of(no_size, options)), HasSubstr("size"));
}

TEST(MaterialXMix, LaysEachMaterialOverThoseBelow) {
  TexturedMaterial dust = constant_material();
  dust.name = "dust";
  dust.size_mm = {{20, 30}};
  const std::vector<TexturedMaterial> layers = {separate_sample().material, dust, separate_sample().material};
  for (const bool has_map : {false, true}) {
    RuntimeWeights weights;
    if (has_map) weights.texture = Texture{"weights.png", {64, 64}, 8, "rgb", false, 1, 0};
    const auto document = materialx_mix_of("layered", layers, weights);
    const XmlElement root = read(document);
    expect_all_connected(root, root);
    const XmlElement* top = root.child("mix_3_layered");
    ASSERT_NE(top, nullptr);
    EXPECT_EQ(top->child("bg")->at("nodename"), "mix_2_layered");
    EXPECT_EQ(top->child("fg")->at("nodename"), "SR_layered_3_" + kName);
    const XmlElement* weight = root.child("NG_layered_weights")->child("weight_3");
    ASSERT_NE(weight, nullptr);
    EXPECT_EQ(weight->child("index")->at("value"), "1") << "the third material is weighed by G";
    EXPECT_EQ(root.child("layered")->child("surfaceshader")->at("nodename"), "mix_3_layered");
    const bool names_map = std::ranges::count(document->files, "weights.png") == 1;
    EXPECT_EQ(names_map, has_map);
  }
}

TEST(MaterialXMix, KeepsEveryMaterialsOwnSize) {
  SampleOptions large;
  large.packing = Packing::kSeparate;
  large.size_mm = {{24, 16}};
  TexturedMaterial second = sample_material(large).material;
  second.name = "large";
  const std::vector<TexturedMaterial> layers = {separate_sample().material, second};
  const XmlElement root = read(materialx_mix_of("two", layers, {}));
  const XmlElement* image = root.child("NG_two_2_large")->child("image_normal");
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(image->child("realworldimagesize")->at("value"), "0.024, 0.016");
  EXPECT_EQ(image->child("realworldtilesize")->at("value"), "0.008, 0.008") << "UV are those of the first";
}

TEST(MaterialXMix, RefusesLayersWithoutACommonScale) {
  TexturedMaterial no_size = constant_material();
  no_size.size_mm.reset();
  const std::vector<TexturedMaterial> mixed = {constant_material(), no_size};
  EXPECT_THAT(refusal_of(materialx_mix_of("x", mixed, {})), HasSubstr("scale"));
  const std::vector<TexturedMaterial> five(5, constant_material());
  EXPECT_THAT(refusal_of(materialx_mix_of("x", five, {})), HasSubstr("1 to 4"));
  RuntimeWeights weights;
  weights.texture = Texture{"weights.png", {64, 64}, 8, "r", false, 1, 0};
  const std::vector<TexturedMaterial> two(2, constant_material());
  EXPECT_THAT(refusal_of(materialx_mix_of("x", two, weights)), HasSubstr("weights"));
}

}  // namespace
}  // namespace weft::exchange
