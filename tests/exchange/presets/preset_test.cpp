// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/preset.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace weft::exchange {
namespace {

using testing::HasSubstr;

const char* const kGood = R"(schema = "weft.preset/1"
name = "mine"
says = "Of my own"
normal = "directx"
[[file]]
name = "{name}_n.png"
channels = ["normal.x", "normal.y", "normal.z"]
bits = 16
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_refused(const std::string& text, const std::vector<std::string>& words) {
  const Result<Preset> preset = preset_from_toml(text, "mine.toml");
  ASSERT_FALSE(preset) << text;
  EXPECT_EQ(preset.error().kind, ErrorKind::kBadData);
  for (const std::string& word : words) EXPECT_THAT(preset.error().message(), HasSubstr(word));
}

TEST(PresetFile, IsReadAsItIsWritten) {
  const Result<Preset> preset = preset_from_toml(kGood, "mine.toml");
  ASSERT_TRUE(preset) << preset.error().message();
  EXPECT_EQ(preset->name, "mine");
  ASSERT_EQ(preset->files.size(), 1U);
  EXPECT_EQ(preset->files[0].stored.bits, 16);
  EXPECT_EQ(preset->files[0].direction, NormalDirection::kDirectX);
  EXPECT_EQ(preset->roughness, RoughnessConvention::kRoot);
  EXPECT_EQ(named(preset->files[0].name, "linen"), "linen_n.png");
}

TEST(PresetFile, NamesTheNearestOfWhatItDoesNotKnow) {
  expect_refused(with(kGood, "bits", "bit"), {"mine.toml: file 1: bit", "the nearest is bits"});
  expect_refused(with(kGood, "normal.y", "normal.u"), {"file 1: channels", "no channel normal.u"});
  expect_refused(with(kGood, "directx", "directz"), {"mine.toml: normal", "did you mean 'directx'"});
  expect_refused(with(kGood, "bits = 16", "encoding = \"pgn\""), {"encoding", "did you mean 'png'"});
  expect_refused(with(kGood, "says", "say"), {"mine.toml: say", "the nearest is says"});
}

TEST(PresetFile, RefusesWhatAnEncodingCannotHold) {
  expect_refused(with(kGood, "bits = 16", "bits = 32"), {"file 1: bits", "png holds 8 or 16"});
  expect_refused(with(kGood, "bits = 16", "encoding = \"dds\""), {"blocks", "a dds has blocks"});
  expect_refused(with(kGood, "bits = 16", "encoding = \"exr\""), {"name", "does not end in .exr"});
  const std::string dds =
      with(with(kGood, "_n.png", "_n.dds"), "bits = 16", "encoding = \"dds\"\nblocks = \"bc5\"");
  expect_refused(dds, {"channels", "3 are named where dds, bc5 holds 2"});
  EXPECT_TRUE(preset_from_toml(with(dds, ", \"normal.z\"", ""), "mine.toml"));
  expect_refused(with(dds, "blocks = \"bc5\"", "blocks = \"bc6\""), {"blocks", "must be one of bc1, bc3"});
  expect_refused(with(kGood, "bits = 16", "blocks = \"bc5\""), {"only a dds has blocks"});
}

TEST(PresetFile, RefusesNamesThatSomeDiskDoesNotTake) {
  for (const char* name : {"../{name}.png", "con.png", "{name}?.png", "/{name}.png", "a//b.png"})
    expect_refused(with(kGood, "{name}_n.png", name), {"file 1: name"});
  const std::string twice = std::string(kGood) + R"([[file]]
name = "{name}_N.png"
channels = ["height"]
)";
  expect_refused(twice, {"file 2: name", "stands twice"});
}

TEST(PresetFile, OfBothDirectionsSaysWhichInEachFile) {
  const std::string both = with(kGood, "\"directx\"", "\"both\"");
  expect_refused(both, {"file 1: normal", "does not say which"});
  EXPECT_TRUE(preset_from_toml(both + "normal = \"opengl\"\n", "mine.toml"));
}

TEST(PresetFile, OfDocumentsHasTheRoughnessOfDocuments) {
  const std::string document = std::string(kGood) + "[[document]]\nkind = \"glb\"\nname = \"{name}.glb\"\n";
  EXPECT_TRUE(preset_from_toml(document, "mine.toml"));
  expect_refused(with(document, "normal = ", "roughness = \"alpha\"\nnormal = "),
                 {"document 1: kind", "root of alpha"});
}

TEST(ShippedPresets, AreReadAndNamedAsTheirFilesAre) {
  std::set<std::string> names;
  for (const ShippedPreset& shipped : shipped_presets()) {
    const Result<Preset> preset = preset_from_toml(shipped.toml, shipped.name);
    ASSERT_TRUE(preset) << preset.error().message();
    EXPECT_EQ(preset->name, shipped.name);
    EXPECT_FALSE(preset->says.empty()) << shipped.name;
    names.insert(shipped.name);
  }
  for (const char* name :
       {"exr",   "png16",     "tiff16",  "polyhaven", "ambientcg", "unreal",   "unity-hdrp", "unity-urp",
        "godot", "substance", "blender", "vizoo",     "u3m",       "u3ma",     "glb",        "mtlx",
        "usd",   "usdz",      "dds",     "arnold",    "renderman", "order1886"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(ShippedPresets, OfFigure15HaveItsFourMaps) {
  for (const ShippedPreset& shipped : shipped_presets()) {
    if (std::string(shipped.name) != "order1886") continue;
    const Result<Preset> preset = preset_from_toml(shipped.toml, shipped.name);
    ASSERT_TRUE(preset);
    ASSERT_EQ(preset->files.size(), 4U);
    EXPECT_EQ(preset->files[0].channels, (std::vector<std::string>{"normal.x", "normal.y"}));
    EXPECT_EQ(preset->files[0].stored.blocks, BlockFormat::kBc5);
    EXPECT_EQ(preset->files[3].channels,
              (std::vector<std::string>{"roughness", "occlusion", "cloth", "anisotropy"}));
    EXPECT_EQ(preset->files[3].stored.blocks, BlockFormat::kBc3);
  }
}

}  // namespace
}  // namespace weft::exchange
