// SPDX-License-Identifier: Apache-2.0
// Layers that are mixed while a material is drawn.
#include "material/assets/runtime.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/material/assets/made_maps.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Runtime, LayersAreBuiltBesideTheMaterialThatTheyAreMixedOver) {
  const Bench bench;
  bench.material("brick.toml",
                 "inherits = \"library:cloth/felt\"\n[runtime]\nweights = \"vertex-color\"\n"
                 "[[runtime.layer]]\nname = \"dust\"\nmaterial = \"library:dirt/dust\"\n"
                 "[[runtime.layer]]\nname = \"shine\"\nmaterial = \"library:cloth/satin\"\n");
  const BuildReport report = bench.built({"brick.toml"});
  EXPECT_EQ(report.built, 3);
  const Result<RuntimeStack> stack = runtime_stack_of(report.materials[0].folder);
  ASSERT_TRUE(stack) << stack.error().message();
  ASSERT_EQ(stack->layers.size(), 3U);
  EXPECT_EQ(stack->weights, "vertex-color");
  EXPECT_EQ(stack->layers[0].name, "brick");
  EXPECT_EQ(stack->layers[1].channel, "r");
  EXPECT_EQ(stack->layers[2].channel, "g");
  EXPECT_TRUE(fs::exists(stack->layers[2].folder / "material.json"));
  const Json document = layers_json(*stack, {{stack->layers[1].id, {"T_dust_BC.png"}}});
  EXPECT_EQ(document["schema"], "weft.layers/1");
  EXPECT_EQ(document["layers"][1]["files"][0], "T_dust_BC.png");
  EXPECT_FALSE(document["layers"][0].contains("channel"));
  fs::remove_all(stack->layers[1].folder);
  const Result<RuntimeStack> missing = runtime_stack_of(report.materials[0].folder);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message(), HasSubstr("dust"));
}

TEST(Runtime, WeightsOfAMapAreOnTheMaterialsGrid) {
  const Bench bench;
  const MadeSet set;
  set.write(bench / "cloth");
  Image<float> weights({24, 16}, 3);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 24; ++x) weights(x, y, 0) = 0.25f, weights(x, y, 1) = 0.5f, weights(x, y, 2) = 1;
  }
  const std::array<View<const float>, 3> planes = {weights.plane(0), weights.plane(1), weights.plane(2)};
  ASSERT_TRUE(write_image(bench / "weights.exr", planes, {"R", "G", "B"}, {}));
  bench.material("wet.toml",
                 "scan = \"cloth\"\n[runtime]\nweights = { map = \"weights.exr\" }\n"
                 "[[runtime.layer]]\nname = \"dust\"\nmaterial = \"library:dirt/dust\"\n"
                 "[[runtime.layer]]\nname = \"film\"\nmaterial = \"library:cloth/nylon\"\n");
  const BuildReport report = bench.built({"wet.toml"});
  ASSERT_EQ(report.materials.size(), 1U);
  EXPECT_EQ(report.materials[0].document["runtime"]["weights"], "weights.exr");
  const LoadedImage map = map_of(report.materials[0], "weights");
  EXPECT_EQ(map.info.size, set.size);
  EXPECT_EQ(map.channel("R")(5, 5), 0.25f);
  EXPECT_EQ(map.channel("G")(5, 5), 0.5f);
  EXPECT_EQ(map.channel("B")(5, 5), 0.0f) << "no layer takes it";
}

TEST(Runtime, RefusesAFifthMaterial) {
  const Bench bench;
  std::string text = "[runtime]\nweights = \"vertex-color\"\n";
  for (const char* name : {"a", "b", "c", "d"})
    text += std::string("[[runtime.layer]]\nname = \"") + name + "\"\nmaterial = \"library:dust\"\n";
  bench.material("many.toml", text);
  EXPECT_THAT(bench.refusal("many.toml"), HasSubstr("many.toml: runtime.layer: there are 4, and 3 at most"));
}

}  // namespace
}  // namespace weft::material
