// SPDX-License-Identifier: Apache-2.0
// Materials that inherit and layer at random, and text that is cut and mixed at random.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "material/assets/tree.h"
#include "tests/material/assets/written.h"

namespace weft::material {
namespace {

struct RandomTree {
  std::vector<int> parent;               // -1: none
  std::vector<std::vector<int>> layers;  // that each file names

  std::string text(std::size_t i) const {
    std::string text;
    if (parent[i] >= 0) text += "inherits = \"" + std::to_string(parent[i]) + ".toml\"\n";
    text += "[surface]\nroughness = 0." + std::to_string(1 + i % 8) + "\n";
    for (const int layer : layers[i])
      text += "[[layer]]\nname = \"of" + std::to_string(i) + "on" + std::to_string(layer) +
              "\"\nmaterial = \"/m/" + std::to_string(layer) + ".toml\"\n";
    return text;
  }
  // All layers that a material has, its own and inherited; nothing where parents go in a circle or too far.
  std::optional<std::set<int>> all_layers(int i) const {
    std::set<int> all;
    for (int steps = 0; i >= 0; ++steps, i = parent[static_cast<std::size_t>(i)]) {
      if (steps == kMostGenerations) return {};
      all.insert(layers[static_cast<std::size_t>(i)].begin(), layers[static_cast<std::size_t>(i)].end());
    }
    return all;
  }
  // By depth-first search, without the code that is tested.
  bool is_buildable(int i, std::set<int> above = {}) const {
    if (!above.insert(i).second) return false;
    const auto below = all_layers(i);
    if (!below) return false;
    return std::ranges::all_of(*below, [&](int each) { return is_buildable(each, above); });
  }
};

RandomTree random_tree(std::mt19937& random, int count) {
  RandomTree tree;
  std::uniform_int_distribution<int> any(-1, count - 1), few(0, 9);
  for (int i = 0; i < count; ++i) {
    // Mostly downwards, so that some trees have no circle.
    const bool is_wild = few(random) == 0;
    std::uniform_int_distribution<int> lower(-1, i - 1);
    tree.parent.push_back(is_wild ? any(random) : lower(random));
    std::set<int> layers;
    for (int n = few(random) / 4; n > 0; --n) {
      const int layer = few(random) == 0 ? any(random) : lower(random);
      if (layer >= 0) layers.insert(layer);
    }
    tree.layers.emplace_back(layers.begin(), layers.end());
  }
  return tree;
}

TEST(RandomTrees, AreBuildableOrRefusedAsASearchForCirclesSays) {
  std::mt19937 random(20);
  int good = 0, bad = 0;
  for (int round = 0; round < 300; ++round) {
    const RandomTree tree = random_tree(random, 2 + round % 9);
    Written files;
    for (std::size_t i = 0; i < tree.parent.size(); ++i) files[std::to_string(i) + ".toml"] = tree.text(i);
    const MaterialSource source = source_of(files);
    for (std::size_t i = 0; i < tree.parent.size(); ++i) {
      DigestCache digests({});
      const Result<MaterialTree> planned =
          plan_materials({written_place(std::to_string(i) + ".toml")}, source, digests);
      const bool should = tree.is_buildable(static_cast<int>(i));
      ASSERT_EQ(planned.has_value(), should) << "round " << round << ", material " << i << ": "
                                             << (planned ? "planned" : planned.error().message());
      (should ? good : bad) += 1;
      if (!planned) {
        EXPECT_EQ(planned.error().kind, ErrorKind::kBadData);
        EXPECT_NE(planned.error().message().find(" -> "), std::string::npos) << planned.error().message();
        continue;
      }
      // What lies below stands before what lies on it.
      for (std::size_t n = 0; n < planned->nodes.size(); ++n) {
        for (const std::size_t below : planned->nodes[n].layers) EXPECT_LT(below, n);
      }
    }
  }
  EXPECT_GT(good, 100);
  EXPECT_GT(bad, 100);
}

TEST(RandomTexts, AreReadOrRefusedAndNothingElse) {
  const std::string whole =
      "schema = \"weft.material/1\"\ninherits = \"library:cloth/cotton\"\nsize_mm = [8, 8]\nunset = "
      "[\"surface.cloth\"]\n"
      "[surface]\nalbedo = [0.5, 0.4, 0.3]\nnormal = { scan = \"x.weft\", map = \"normal\", y = \"down\" }\n"
      "[[layer]]\nname = \"dust\"\nmaterial = \"library:dust\"\nmask = { from = \"height\", kind = "
      "\"cavity\", levels = [0.5, 0] }\n"
      "only = [\"albedo\"]\nturn_deg = 90\ntile_mm = [4, 4]\n[over]\nmetallic = 1\n[runtime]\nweights = "
      "\"vertex-color\"\n";
  ASSERT_TRUE(parse_material(whole, written_place("whole.toml")));
  std::mt19937 random(7);
  int refusals = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = whole;
    for (int edits = 1 + round % 4; edits > 0; --edits) {
      const std::size_t at = random() % text.size(), length = random() % 12;
      if (random() % 2) {
        text.erase(at, length);
      } else {
        text.insert(at, whole.substr(random() % whole.size(), length));
      }
      if (random() % 5 == 0 && !text.empty())
        text[random() % text.size()] = static_cast<char>(random() % 256);
      if (text.empty()) break;
    }
    const Result<MaterialFile> read = parse_material(text, written_place("cut.toml"));
    if (read) continue;
    ++refusals;
    EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
    EXPECT_NE(read.error().where.find("cut.toml"), std::string::npos) << read.error().message();
    EXPECT_FALSE(read.error().why.empty());
  }
  EXPECT_GT(refusals, 1000);
}

}  // namespace
}  // namespace weft::material
