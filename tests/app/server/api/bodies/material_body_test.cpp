// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/material_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "app/server/api/bodies/library_materials.h"
#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "material/assets/resolve.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A library with one material of two layers.
class MaterialBody : public testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_DATA_HOME", scratch_.path().c_str(), 1);
    fs::create_directories(material::user_materials_folder());
    ASSERT_TRUE(write_file(material::user_materials_folder() / "dusty.toml", R"(schema = "weft.material/1"
inherits = "library:cloth/wool"
[[layer]]
name = "dust"
material = "library:dirt/dust"
alpha = 0.5
[[layer]]
name = "stain"
material = "library:cloth/denim"
mask = 0.25
)"));
  }
  void TearDown() override { unsetenv("XDG_DATA_HOME"); }

  static Result<NewMaterialBody> read(const std::string& body) {
    return read_material_body(Json::parse(body), material::user_materials_folder());
  }
  static std::string layers_of(const std::string& key) {
    const Result<material::ResolvedMaterial> resolved =
        material::resolve_material(library_material(key).value(), material::materials_on_disk());
    if (!resolved) return resolved.error().message();
    std::string words;
    for (const material::MaterialLayer& layer : resolved->layers) {
      const auto alpha = layer.values.find("alpha");
      words += layer.name + " " + (alpha == layer.values.end() ? "-" : alpha->second.value.dump()) + "; ";
    }
    return words;
  }

  const TemporaryFolder scratch_;
};

TEST_F(MaterialBody, BecomesAFileThatInheritsWithItsLayersInTheirOrder) {
  const Result<NewMaterialBody> made = read(
      R"({"name": "clean", "inherits": "dusty", "layers": [{"name": "stain", "alpha": 0.75}, {"name": "dust"}]})");
  ASSERT_TRUE(made) << made.error().message();
  EXPECT_EQ(made->file, material::user_materials_folder() / "clean.toml");
  EXPECT_FALSE(fs::exists(made->file)) << "nothing is written";
  ASSERT_TRUE(write_file(made->file, made->text));
  EXPECT_THAT(layers_of("dusty"), HasSubstr("dust")) << "the other stays as it was";
  EXPECT_THAT(layers_of("clean"), testing::MatchesRegex("stain .*0.75.*; dust .*0.5.*; "));

  const Result<NewMaterialBody> again =
      read(R"({"name": "clean", "inherits": "dusty", "layers": [{"name": "dust", "remove": true}]})");
  ASSERT_TRUE(again) << again.error().message();
  ASSERT_TRUE(write_file(again->file, again->text));
  EXPECT_EQ(layers_of("clean"), "stain -; ") << "what this call made it may make anew";
}

TEST_F(MaterialBody, ReplacesNothingThatAPersonWrote) {
  const Result<NewMaterialBody> made = read(R"({"name": "dusty", "inherits": "cloth:wool", "layers": []})");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::kCannotCreate);
}

TEST_F(MaterialBody, SaysWhatIsWrongWithIt) {
  for (const char* wrong :
       {R"({})", R"({"name": "a", "inherits": "dusty"})",
        R"({"name": "../a", "inherits": "dusty", "layers": []})",
        R"({"name": "a", "inherits": "dusty", "layers": [{"name": "dust", "alpha": 2}]})",
        R"({"name": "a", "inherits": "dusty", "layers": [{"alpha": 0.5}]})",
        R"({"name": "a", "inherits": "dusty", "layers": [{"name": "dust", "mask": 1}]})"}) {
    const Result<NewMaterialBody> made = read(wrong);
    ASSERT_FALSE(made) << wrong;
    EXPECT_EQ(made.error().kind, ErrorKind::kUsage) << wrong;
  }
  EXPECT_EQ(read(R"({"name": "a", "inherits": "none", "layers": []})").error().kind, ErrorKind::kNoInput);
  const Result<NewMaterialBody> absent =
      read(R"({"name": "a", "inherits": "dusty", "layers": [{"name": "dust\"\n[surface]", "alpha": 0}]})");
  ASSERT_FALSE(absent) << "a layer that is not there: " << absent->text;
  EXPECT_EQ(absent.error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace weft::app
