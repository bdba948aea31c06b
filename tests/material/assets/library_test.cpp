// SPDX-License-Identifier: Apache-2.0
// What weft brings along, and the user's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "material/assets/new_material.h"
#include "material/assets/resolve.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Library : public testing::Test {
 protected:
  void SetUp() override { ::setenv("XDG_DATA_HOME", folder_.path().c_str(), 1); }
  void TearDown() override { ::unsetenv("XDG_DATA_HOME"); }
  void put(const std::string& name, const std::string& text) const {
    const fs::path file = user_materials_folder() / name;
    fs::create_directories(file.parent_path());
    ASSERT_TRUE(write_file(file, "schema = \"weft.material/1\"\n" + text));
  }
  TemporaryFolder folder_;
};

TEST_F(Library, HasTenClothsWhoseEveryValueSaysWhy) {
  int cloths = 0;
  for (const ShippedMaterial& each : shipped_materials()) {
    SCOPED_TRACE(each.name);
    cloths += std::string(each.name).starts_with("cloth/");
    const Result<MaterialPlace> place = find_material(std::string(kLibraryPrefix) + each.name, {});
    ASSERT_TRUE(place);
    const Result<ResolvedMaterial> material = resolve_material(*place, materials_on_disk());
    ASSERT_TRUE(material) << material.error().message();
    EXPECT_TRUE(material->surface.contains("albedo"));
    EXPECT_TRUE(material->top.contains("notes"));
    // Each line of [surface] has its reason behind it.
    const std::string text = each.text;
    for (std::size_t at = text.find("[surface]\n") + 10; at < text.size();) {
      const std::size_t end = text.find('\n', at);
      const std::string line = text.substr(at, end - at);
      if (line.find('=') != std::string::npos) {
        EXPECT_THAT(line, HasSubstr(" # "));
      }
      at = end + 1;
    }
  }
  EXPECT_EQ(cloths, 10);
}

TEST_F(Library, OfTheUserComesBeforeThatOfWeft) {
  put("cloth/satin.toml", "[surface]\nroughness = 0.4\n");
  put("mine/loden.toml", "inherits = \"library:cloth/wool\"\n");
  put("mine/build/0123/stray.toml", "nonsense");
  std::set<std::string> names;
  for (const MaterialPlace& place : list_materials()) names.insert(place.name);
  EXPECT_TRUE(names.contains("library:mine/loden"));
  EXPECT_EQ(names.size(), shipped_materials().size() + 1);
  const Result<MaterialPlace> satin = find_material("library:cloth/satin", {}),
                              loden = find_material("library:loden", {});
  ASSERT_TRUE(satin && loden);
  EXPECT_FALSE(satin->is_shipped());
  const Result<ResolvedMaterial> material = resolve_material(*loden, materials_on_disk());
  ASSERT_TRUE(material) << material.error().message();
  EXPECT_EQ(material->surface.at("cloth").from, "library:cloth/wool");
}

TEST_F(Library, RefusesALastPartThatTwoHave) {
  put("mine/cotton.toml", "");
  const Result<MaterialPlace> place = find_material("library:cotton", {});
  ASSERT_FALSE(place);
  EXPECT_THAT(place.error().message(), HasSubstr("cloth/cotton and mine/cotton both end so"));
}

TEST_F(Library, ANewMaterialResolvesAndIsNeverWrittenOverAnother) {
  const NewMaterial wanted = {.file = folder_.path() / "my cloth.toml",
                              .inherits = "library:denim",
                              .scan = {},
                              .layers = {"library:dust", "library:dust"}};
  ASSERT_TRUE(write_new_material(wanted));
  const Result<MaterialPlace> place = find_material((folder_.path() / "my cloth.toml").string(), {});
  const Result<ResolvedMaterial> material = resolve_material(*place, materials_on_disk());
  ASSERT_TRUE(material) << material.error().message();
  ASSERT_EQ(material->layers.size(), 2U);
  EXPECT_EQ(material->layers[1].name, "dust-2");
  const Result<void> again = write_new_material(wanted);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kCannotCreate);
  const Result<void> lost = write_new_material(
      {.file = folder_.path() / "b.toml", .inherits = "gone.toml", .scan = {}, .layers = {}});
  ASSERT_FALSE(lost);
  EXPECT_FALSE(is_there(folder_.path() / "b.toml"));
}

}  // namespace
}  // namespace weft::material
