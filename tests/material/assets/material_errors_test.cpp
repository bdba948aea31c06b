// SPDX-License-Identifier: Apache-2.0
// What a person is told of a material that cannot be used: the file, the key, why, what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/files.h"
#include "tests/material/assets/made_maps.h"
#include "tests/material/assets/written.h"

namespace weft::material {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string said_of(const std::string& text) {
  return refused({{"cloth.toml", text}}, "cloth.toml");
}

TEST(MaterialErrors, OfTheTextNameFileKeyAndTheNearestWord) {
  EXPECT_THAT(said_of("[surface]\nrougness = 0.5\n"),
              HasSubstr("/m/cloth.toml: [surface] rougness: there is no such key; the nearest is roughness"));
  EXPECT_THAT(said_of("inherit = \"a.toml\"\n"),
              HasSubstr("/m/cloth.toml: inherit: there is no such key; the nearest is inherits"));
  EXPECT_THAT(said_of("[[layer]]\nname = \"dust\"\nmaterial = \"library:dust\"\nmsk = 1\n"),
              HasSubstr("/m/cloth.toml: [[layer]] dust: msk: there is no such key; the nearest is mask"));
  EXPECT_THAT(said_of("[surface]\nroughness = \n"), HasSubstr("/m/cloth.toml: line 3"));
  EXPECT_THAT(said_of("[[layer]]\nname = \"dust\"\nmaterial = \"library:dust\"\nonly = [\"albdo\"]\n"),
              HasSubstr("there is no parameter albdo; the nearest is albedo"));
}

TEST(MaterialErrors, OfValuesNameRangeAndUnit) {
  EXPECT_THAT(said_of("[surface]\nroughness = 1.5\n"),
              HasSubstr("[surface] roughness: 1.5 is out of 0 to 1 (roughness)"));
  EXPECT_THAT(said_of("[surface]\nheight_mm = 1000\n"), HasSubstr("1000 is out of -100 to 100 (mm)"));
  EXPECT_THAT(said_of("[surface]\nmetallic = 0.5\n"),
              HasSubstr("metallic: 0.5 is neither 0 nor 1; mix a metal and another material by layers"));
  EXPECT_THAT(said_of("[surface]\nalbedo = 0.5\n"), HasSubstr("albedo: it must be 3 numbers or a map"));
  EXPECT_THAT(said_of("[surface]\nroughness = nan\n"), HasSubstr("it must be a number or a map"));
  EXPECT_THAT(said_of("[surface]\nnormal = [0, 0, -1]\n"), HasSubstr("its z must be above 0"));
  EXPECT_THAT(said_of("[surface]\nheight_mm = { map = \"h.exr\", unit = \"um\" }\n"),
              HasSubstr("height_mm: it is in mm, and the map in um; convert the map, or say scale"));
  EXPECT_THAT(said_of("[surface]\nalbedo_tint = { map = \"h.exr\" }\n"), HasSubstr("it cannot be a map"));
  EXPECT_THAT(said_of("[surface]\nalbedo = { scan = \"x.weft\" }\n"), HasSubstr("a map is written { map"));
  EXPECT_THAT(said_of("size_mm = [0, 8]\n"), HasSubstr("size_mm: it must be 2 numbers of 0.001 to 100000"));
}

TEST(MaterialErrors, OfLayersAndParents) {
  EXPECT_THAT(said_of("inherits = [\"a.toml\", \"b.toml\"]\n"),
              HasSubstr("a material inherits one other; compose further ones with a [[layer]] each"));
  EXPECT_THAT(said_of("[[layer]]\nmaterial = \"library:dust\"\n"), HasSubstr("[[layer]] 1: it has no name"));
  EXPECT_THAT(said_of("[[layer]]\nname = \"a\"\nmaterial = \"library:dust\"\n[[layer]]\nname = "
                      "\"a\"\nmaterial = \"library:dust\"\n"),
              HasSubstr("there are two of this name"));
  EXPECT_THAT(said_of("[[layer]]\nname = \"a\"\nmaterial = \"library:dust\"\nturn_deg = 45\n"),
              HasSubstr("turn_deg: it must be a multiple of 90"));
  EXPECT_THAT(said_of("[[layer]]\nname = \"a\"\nmaterial = \"library:dust\"\nmask = 2\n"),
              HasSubstr("mask: a number must be 0 to 1"));
  EXPECT_THAT(said_of("[[layer]]\nname = \"a\"\nmaterial = \"library:dust\"\nmask = { from = \"height\", "
                      "kind = \"level\" }\n"),
              HasSubstr("a level needs at_mm"));
  EXPECT_THAT(said_of("unset = [\"surface.colour\"]\n"),
              HasSubstr("surface.colour is nothing that can be unset"));
}

TEST(MaterialErrors, OfANewerSchemaNameTheVersionNeeded) {
  const MaterialPlace place = written_place("new.toml");
  const Result<MaterialFile> newer = parse_material("schema = \"weft.material/2\"\n", place);
  ASSERT_FALSE(newer);
  EXPECT_THAT(
      newer.error().message(),
      HasSubstr("it is weft.material/2, and this weft reads weft.material/1; a newer weft is needed"));
  EXPECT_TRUE(parse_material("schema = \"weft.material/1.3\"\n", place));
  const Result<MaterialFile> none = parse_material("[surface]\n", place);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("schema: it must be \"weft.material/1\""));
}

TEST(MaterialErrors, LayersInACircleAreShown) {
  const Bench bench;
  bench.material("a.toml", "[[layer]]\nname = \"b\"\nmaterial = \"b.toml\"\n");
  bench.material("b.toml", "[[layer]]\nname = \"a\"\nmaterial = \"a.toml\"\n");
  const std::string a = (bench / "a.toml").string(), b = (bench / "b.toml").string();
  EXPECT_THAT(bench.refusal("a.toml"),
              HasSubstr("layers lie on each other in a circle: " + a + " -> " + b + " -> " + a));
}

TEST(MaterialErrors, OfFilesThatAreNotThere) {
  const Bench bench;
  bench.material("map.toml", "[surface]\nnormal = { map = \"gone.exr\" }\n");
  EXPECT_THAT(bench.refusal("map.toml", ErrorKind::kNoInput),
              AllOf(HasSubstr("map.toml: surface.normal"), HasSubstr("gone.exr")));
  bench.material("mask.toml",
                 "[[layer]]\nname = \"dust\"\nmaterial = \"library:dust\"\nmask = { map = \"gone.png\" }\n");
  EXPECT_THAT(bench.refusal("mask.toml", ErrorKind::kNoInput),
              AllOf(HasSubstr("mask.toml: layer.dust.mask"), HasSubstr("gone.png")));
  bench.material("layer.toml", "[[layer]]\nname = \"dust\"\nmaterial = \"gone.toml\"\n");
  EXPECT_THAT(bench.refusal("layer.toml", ErrorKind::kNoInput),
              AllOf(HasSubstr("layer.toml: [[layer]] dust"), HasSubstr("gone.toml")));
  bench.material("scan.toml", "scan = \"gone.weft\"\n");
  EXPECT_THAT(bench.refusal("scan.toml", ErrorKind::kNoInput),
              AllOf(HasSubstr("scan.toml: scan"), HasSubstr("make them first with weft maps")));
  bench.material("library.toml", "inherits = \"library:coton\"\n");
  EXPECT_THAT(bench.refusal("library.toml", ErrorKind::kNoInput),
              HasSubstr("the nearest is library:cloth/cotton"));
}

TEST(MaterialErrors, OfMapsThatDoNotFit) {
  const Bench bench;
  MadeSet().write(bench / "cloth");
  MadeSet({.size = {32, 32}}).write(bench / "other");
  bench.material("sizes.toml",
                 "scan = \"cloth\"\n[surface]\nalbedo = { scan = \"other\", map = \"albedo\" }\n");
  EXPECT_THAT(bench.refusal("sizes.toml"), AllOf(HasSubstr("32 x 32"), HasSubstr("48 x 32")));
  bench.material("unit.toml", "[surface]\nroughness = { scan = \"cloth\", map = \"height\" }\n");
  EXPECT_THAT(bench.refusal("unit.toml"), HasSubstr("roughness is in roughness, and the map height in mm"));
  bench.material("no_map.toml", "[surface]\nmetallic = { scan = \"cloth\", map = \"metalic\" }\n");
  EXPECT_THAT(
      bench.refusal("no_map.toml"),
      AllOf(HasSubstr("has no map metalic; it has albedo, normal, height"), HasSubstr("weft maps --maps")));
  bench.material("square.toml", "scan = \"cloth\"\nsize_mm = [12, 12]\n");
  EXPECT_THAT(bench.refusal("square.toml"), HasSubstr("they must be square"));
  bench.material("small.toml", "scan = \"other\"\n");
  bench.material("fit.toml", "scan = \"cloth\"\n[[layer]]\nname = \"weave\"\nmaterial = \"small.toml\"\n");
  EXPECT_THAT(
      bench.refusal("fit.toml"),
      AllOf(HasSubstr("fit.toml: [[layer]] weave: it repeats every 8 x 8 mm, which does not fit 12 x 8 mm"),
            HasSubstr("say tile_mm")));
}

TEST(MaterialErrors, OfAMaskByAHeightThatIsNotThere) {
  const Bench bench;
  bench.material("flat.toml",
                 "[[layer]]\nname = \"dust\"\nmaterial = \"library:dust\"\nmask = { from = \"height\" }\n");
  EXPECT_THAT(bench.refusal("flat.toml"),
              HasSubstr("flat.toml: layer.dust.mask: it follows the height, and nothing below has one"));
  MadeSet().write(bench / "cloth");
  bench.material("fine.toml",
                 "scan = \"cloth\"\n[[layer]]\nname = \"dust\"\nmaterial = \"library:dust\"\nmask = { from = "
                 "\"height\", radius_mm = 0.1 }\n");
  EXPECT_THAT(bench.refusal("fine.toml"), HasSubstr("radius_mm is under a pixel, which is 0.25 mm"));
}

TEST(MaterialErrors, OfARelativeAlbedo) {
  const Bench bench;
  MadeSet().write(bench / "x.weft/maps/0011");
  const Result<void> solved =
      write_json(bench / "solve.json", {{"schema", "weft.solve/1"}, {"albedo_scale", "relative"}});
  ASSERT_TRUE(solved);
  std::filesystem::create_directories(bench / "x.weft/solve/aabb");
  std::filesystem::rename(bench / "solve.json", bench / "x.weft/solve/aabb/solve.json");
  bench.material("relative.toml", "scan = \"x.weft\"\n");
  EXPECT_THAT(bench.refusal("relative.toml"),
              AllOf(HasSubstr("surface.albedo"), HasSubstr("the albedo of this scan is only relative"),
                    HasSubstr("say scale")));
  bench.material(
      "scaled.toml",
      "scan = \"x.weft\"\n[surface]\nalbedo = { scan = \"x.weft\", map = \"albedo\", scale = 0.5 }\n");
  EXPECT_EQ(bench.built({"scaled.toml"}).built, 1);
}

TEST(MaterialErrors, OfPixelsThatAreNoNumbersNameThePlace) {
  const Bench bench;
  Image<float> map({8, 4});
  map(5, 2) = 128;
  ASSERT_TRUE(write_image(bench / "rough.exr", std::array{View<const float>(map.plane())}, {"Y"}, {}));
  bench.material("rough.toml", "[surface]\nroughness = { map = \"rough.exr\" }\n");
  const Result<BuildReport> report = bench.build({"rough.toml"});
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message(),
              AllOf(HasSubstr("rough.toml: surface.roughness"),
                    HasSubstr("at column 5, row 2 is 128, out of 0 to 1"), HasSubstr("say scale")));
  EXPECT_FALSE(std::filesystem::exists(bench / "build"));
  bench.material("channel.toml", "[surface]\nroughness = { map = \"rough.exr\", channel = \"G\" }\n");
  const Result<BuildReport> channel = bench.build({"channel.toml"});
  ASSERT_FALSE(channel);
  EXPECT_THAT(channel.error().message(), HasSubstr("it has no channel G; it has Y"));
}

}  // namespace
}  // namespace weft::material
