// SPDX-License-Identifier: Apache-2.0
// A map that is one number everywhere leaves as that number where a document says it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/base/temporary_folder.h"
#include "exchange/document.h"
#include "tests/material/read/small_set.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

std::string text_of(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  EXPECT_TRUE(text) << text.error().message();
  return text ? *text : "";
}

// The JSON of a binary glTF file.
Json gltf_in(const fs::path& file) {
  const std::string bytes = text_of(file);
  std::size_t size = 0;
  for (std::size_t i = 4; i-- > 0;) size = size << 8 | static_cast<unsigned char>(bytes.at(12 + i));
  return Json::parse(bytes.substr(20, size));
}

std::string names_in(const fs::path& folder) {
  std::string names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names += entry.path().filename().string() + "\n";
  return names + text_of(folder / "export.json");
}

TEST(OneNumber, IsAFactorInEveryDocument) {
  const TemporaryFolder folder;
  SmallSet{.is_rough_alike = true, .is_f0_alike = true}.write(folder.path() / "set");
  const auto exported = [&](const char* preset) {
    return exported_small(folder.path() / "set", preset, folder.path());
  };

  const fs::path glb = exported("glb");
  const Json gltf = gltf_in(glb / "cloth.glb"), material = gltf["materials"][0];
  EXPECT_NEAR(material["pbrMetallicRoughness"]["roughnessFactor"].get<double>(), std::sqrt(kSmallAlpha),
              1e-6);
  EXPECT_FALSE(material["pbrMetallicRoughness"].contains("metallicRoughnessTexture"));
  EXPECT_EQ(material["pbrMetallicRoughness"]["metallicFactor"], 0);
  EXPECT_TRUE(material.contains("occlusionTexture")) << "that one varies";
  EXPECT_NEAR(material["extensions"]["KHR_materials_ior"]["ior"].get<double>(), exchange::ior_of_f0(kSmallF0),
              1e-6);
  EXPECT_FALSE(material["extensions"].contains("KHR_materials_specular"));
  EXPECT_EQ(gltf["images"].size(), 3U) << "colour, normal, occlusion";
  EXPECT_THAT(names_in(glb), Not(HasSubstr("specular.png")));

  for (const char* preset : {"mtlx", "usd", "u3m"}) {
    const fs::path out = exported(preset);
    EXPECT_THAT(names_in(out), Not(HasSubstr("specular.png"))) << preset;
    EXPECT_THAT(names_in(out), Not(testing::AnyOf(HasSubstr("roughness.png"), HasSubstr("ROUGH.png"))))
        << preset;
    const std::string text =
        text_of(out / (std::string("cloth.") + (std::string(preset) == "usd" ? "usda" : preset)));
    EXPECT_THAT(text, HasSubstr("0.6")) << preset << ": the root of alpha";
  }
  const std::string engine = names_in(exported("blender"));
  EXPECT_THAT(engine, HasSubstr("cloth_rough.png")) << "an engine's slot wants its file";
}

TEST(OneNumber, OfAColourIsAFactorToo) {
  const TemporaryFolder folder;
  SmallSet{.is_albedo_alike = true}.write(folder.path() / "set");
  const Json gltf = gltf_in(exported_small(folder.path() / "set", "glb", folder.path()) / "cloth.glb");
  const Json& pbr = gltf["materials"][0]["pbrMetallicRoughness"];
  EXPECT_FALSE(pbr.contains("baseColorTexture"));
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(pbr["baseColorFactor"][c].get<double>(), kSmallAlbedo[c], 1e-6);
  EXPECT_TRUE(pbr.contains("metallicRoughnessTexture")) << "the roughness varies";
}

TEST(Names, BeyondAsciiStayApartInFilesAndDocuments) {
  const TemporaryFolder folder;
  std::string prims;
  for (const char* name : {"綿", "絹", "Grüner Loden"}) {
    SmallSet{.name = name}.write(folder.path() / "set");
    const fs::path out = folder.path() / name;
    const std::string file = name == std::string("Grüner Loden") ? "Grüner-Loden" : name;
    exported_small(folder.path() / "set", "usd", out);
    exported_small(folder.path() / "set", "glb", out);
    EXPECT_TRUE(fs::exists(out / "usd" / (file + ".usda"))) << names_in(out / "usd");
    EXPECT_EQ(gltf_in(out / "glb" / (file + ".glb"))["materials"][0]["name"], name) << "as people call it";
    const std::string usda = text_of(out / "usd" / (file + ".usda"));
    const std::string prim = usda.substr(usda.find("defaultPrim"), 40);
    EXPECT_EQ(prims.find(prim), std::string::npos) << prim << " names two cloths";
    prims += prim;
  }
}

}  // namespace
}  // namespace weft::material
