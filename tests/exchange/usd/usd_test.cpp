// SPDX-License-Identifier: Apache-2.0
#include "exchange/usd/usd.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "exchange/archive/zip.h"
#include "tests/exchange/export_checks.h"
#include "tests/exchange/sample_material.h"

namespace weft::exchange {
namespace {

using testing::HasSubstr;
using testing::Not;

SampleMaterial separate_sample() {
  SampleOptions options;
  options.packing = Packing::kSeparate;
  return sample_material(options);
}

Document written(const TexturedMaterial& material, const UsdOptions& options = {}) {
  auto document = usda_of(material, options);
  EXPECT_TRUE(document) << (document ? "" : document.error().message());
  return document ? *document : Document();
}

template <typename T>
std::string refusal_of(const Result<T>& result) {
  return result ? "" : result.error().message();
}

/// Prims by their paths with what stands in them, read by the braces at the ends of lines.
std::map<std::string, std::string> prims_of(const std::string& usda) {
  std::map<std::string, std::string> prims;
  std::vector<std::string> path;
  std::string next, line;
  std::istringstream lines(usda);
  const std::regex head("^\\s*def \\w+ \"(\\w+)\".*");
  for (std::smatch match; std::getline(lines, line);) {
    const std::string bare = std::regex_replace(line, std::regex("^\\s+"), "");
    if (std::regex_match(line, match, head)) next = match[1];
    if (bare == "{") {
      path.push_back((path.empty() ? "" : path.back()) + "/" + next);
    } else if (bare == "}" && !path.empty() && line.size() <= 4 * path.size()) {
      path.pop_back();
    } else if (!path.empty()) {
      prims[path.back()] += bare + "\n";
    }
  }
  EXPECT_TRUE(path.empty()) << "a brace is left open";
  return prims;
}

TEST(Usda, ConnectsNothingToWhatIsNotThere) {
  const auto prims = prims_of(written(separate_sample().material).bytes);
  int connections = 0;
  const std::regex connection("\\.connect = <([^>]+)\\.(outputs:\\w+)>");
  for (const auto& [path, body] : prims) {
    for (auto it = std::sregex_iterator(body.begin(), body.end(), connection); it != std::sregex_iterator();
         ++it, ++connections) {
      const std::string prim = (*it)[1], output = (*it)[2];
      ASSERT_TRUE(prims.contains(prim)) << prim;
      EXPECT_THAT(prims.at(prim), HasSubstr(output)) << "asked of " << prim << " by " << path;
    }
  }
  EXPECT_EQ(connections, 11) << "of the material, five textures at the surface and at their coordinates";
}

TEST(Usda, IsInMetresWithYUp) {
  const std::string usda = written(separate_sample().material, {{10, 5}, ""}).bytes;
  EXPECT_THAT(usda, HasSubstr("metersPerUnit = 1\n"));
  EXPECT_THAT(usda, HasSubstr("upAxis = \"Y\"\n"));
  EXPECT_THAT(usda,
              HasSubstr("points = [(-0.04, -0.02, 0), (0.04, -0.02, 0), (0.04, 0.02, 0), (-0.04, 0.02, 0)]"));
  EXPECT_THAT(usda, HasSubstr("primvars:st = [(0, 0), (10, 0), (10, 5), (0, 5)]"));
  EXPECT_THAT(usda, HasSubstr("double2 size_mm = (8, 8)"));
}

TEST(Usda, ReadsNormalsRawAndColoursAsSrgb) {
  const auto prims = prims_of(written(separate_sample().material).bytes);
  const std::string looks = "/Plain_weave___indigo____white/Looks/Plain_weave___indigo____white/";
  EXPECT_THAT(prims.at(looks + "normal"), HasSubstr("inputs:scale = (2, 2, 2, 1)"));
  EXPECT_THAT(prims.at(looks + "normal"), HasSubstr("inputs:bias = (-1, -1, -1, 0)"));
  EXPECT_THAT(prims.at(looks + "normal"), HasSubstr("sourceColorSpace = \"raw\""));
  EXPECT_THAT(prims.at(looks + "base_color"), HasSubstr("sourceColorSpace = \"sRGB\""));
  EXPECT_THAT(prims.at(looks + "base_color"), Not(HasSubstr("inputs:scale")));
  EXPECT_THAT(prims.at(looks + "roughness"), HasSubstr("wrapS = \"repeat\""));
}

TEST(Usda, ScalesTexelsOfNumbers) {
  TexturedMaterial material = separate_sample().material;
  material.roughness->texture->scale = 0.5;
  material.roughness->texture->offset = 0.25;
  const std::string usda = written(material).bytes;
  EXPECT_THAT(usda, HasSubstr("inputs:scale = (0.5, 0.5, 0.5, 0.5)"));
  EXPECT_THAT(usda, HasSubstr("inputs:bias = (0.25, 0.25, 0.25, 0.25)"));
}

TEST(Usda, NamesTheMaterialXFileWhereOneIsGiven) {
  const Document beside = written(separate_sample().material, {{1, 1}, "looks/cloth.mtlx"});
  EXPECT_THAT(beside.bytes, HasSubstr("prepend references = @looks/cloth.mtlx@</MaterialX/Materials/"
                                      "Plain_weave___indigo____white>"));
  EXPECT_THAT(beside.files, testing::Contains("looks/cloth.mtlx"));
}

TEST(Usda, EscapesTextsAndAssets) {
  TexturedMaterial material = constant_material();
  material.name = "a \"b\" \\ c";
  EXPECT_THAT(written(material).bytes, HasSubstr("doc = \"a \\\"b\\\" \\\\ c\""));
  material = separate_sample().material;
  material.normal->texture->file = "textures/a@b.png";
  EXPECT_THAT(written(material).bytes, HasSubstr("@@@textures/a@b.png@@@"));
}

TEST(Usda, InventsNoSize) {
  SampleOptions options;
  options.size_mm.reset();
  const std::string usda = written(sample_material(options).material).bytes;
  EXPECT_THAT(usda, HasSubstr("the size is not known"));
  EXPECT_THAT(usda, Not(HasSubstr("size_mm")));
}

TEST(Usda, SaysWhatItLeavesOut) {
  const Document document = written(separate_sample().material);
  EXPECT_THAT(document.left_out, testing::Contains(HasSubstr("sheen")));
  EXPECT_THAT(document.left_out, testing::Contains(HasSubstr("anisotropy")));
  EXPECT_THAT(document.files, Not(testing::Contains("textures/sheen.png")));
}

TEST(Usdz, AlignsTheLayerAndItsTextures) {
  const SampleMaterial sample = separate_sample();
  const auto usdz = usdz_of("cloth.usda", written(sample.material), sample.bytes());
  ASSERT_TRUE(usdz) << usdz.error().message();
  EXPECT_EQ(refusal_of(check_zip(*usdz, ZipKind::kAligned)), "");
  EXPECT_EQ(usdz->find("#usda 1.0"), 64u) << "the layer comes first";
  for (const char* file : {"textures/base.png", "textures/normal.png", "textures/opacity.png"}) {
    EXPECT_EQ(usdz->find(sample.files.at(file)) % 64, 0u) << file;
  }
}

TEST(Usdz, RefusesWhatAPackageMayNotHold) {
  const SampleMaterial sample = separate_sample();
  const Document beside = written(sample.material, {{1, 1}, "cloth.mtlx"});
  FileBytes files = sample.bytes();
  files["cloth.mtlx"] = "<materialx/>";
  EXPECT_THAT(refusal_of(usdz_of("cloth.usda", beside, files)), HasSubstr("cloth.mtlx"));
  const Document plain = written(sample.material);
  EXPECT_THAT(refusal_of(usdz_of("cloth.usda", plain, {})), HasSubstr("not given"));
  files["textures/normal.png"] = std::string_view("II*\0tiff", 8);
  EXPECT_THAT(refusal_of(usdz_of("cloth.usda", plain, files)), HasSubstr("textures/normal.png"));
  EXPECT_THAT(refusal_of(usdz_of("cloth.png", plain, sample.bytes())), HasSubstr(".usda"));
}

}  // namespace
}  // namespace weft::exchange
