// SPDX-License-Identifier: Apache-2.0
// Every file that a person writes answers a misspelt key alike.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "calibration/run/board_photographs.h"
#include "calibration/run/chart_pictures.h"
#include "calibration/run/check.h"
#include "calibration/run/scale_file.h"
#include "calibration/run/sheet_files.h"
#include "capture/camera/camera_profile.h"
#include "capture/rig.h"
#include "core/base/files.h"
#include "exchange/presets/preset.h"
#include "library/import/description.h"
#include "material/assets/material_file.h"
#include "material/run/recipe.h"
#include "tests/core/image_io/scratch_folder.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSheet =
    "width_mm = 100\nheight_mm = 100\n[[tag]]\nid = 0\nside_mm = 10\ncentre_mm = [0, 0]\n";

struct WrittenFile {
  const char* name;
  std::string text;
  const char *key, *nearest;
  std::function<std::string(const fs::path&)> refusal;
};

template <typename Read>
auto refusal_of(Read read) {
  return [read](const fs::path& file) {
    const auto found = read(file);
    return found ? std::string("it is read") : found.error().message();
  };
}

std::string text_in(const fs::path& file) {
  return *read_text(file);
}

std::vector<WrittenFile> calibration_files() {
  const auto board = refusal_of([](const fs::path& file) { return calibration::read_board_file(file, {}); });
  const auto chart =
      refusal_of([](const fs::path& file) { return calibration::read_chart_colors(file.parent_path()); });
  const auto check = refusal_of([](const fs::path& file) {
    EXPECT_TRUE(write_file(file.parent_path() / "session.json", "{}"));
    EXPECT_TRUE(write_file(file.parent_path() / "sheet.toml", kSheet));
    return calibration::calibrate_check({.input = file.parent_path(), .output = file.parent_path() / "out"},
                                        {});
  });
  return {{"board.toml", "square_x = 3", "square_x", "squares_x", board},
          {"sheet.toml", "reflectence = 1\n" + std::string(kSheet), "reflectence", "reflectance",
           refusal_of(calibration::read_sheet_file)},
          {"scale.toml", "heigth_mm = 1", "heigth_mm", "height_mm", refusal_of(calibration::read_scale_file)},
          {"chart.toml", "editoin = \"2014\"", "editoin", "edition", chart},
          {"check.toml", "[[plane]]\ntilt = 3", "plane 1: tilt", "tilt_deg", check}};
}

std::vector<WrittenFile> files_of_rig() {
  const auto profile =
      refusal_of([](const fs::path& file) { return capture::read_camera_profile(file.string()); });
  return {
      {"rig.toml", "[board]\nprot = \"/dev/ttyACM0\"", "[board]: prot", "port",
       refusal_of(capture::read_rig)},
      {"body.toml", "model = \"Z 6\"\n[widgets]\nshuter = \"s\"", "[widgets]: shuter", "shutter", profile},
      {"import.toml", "fabrik = \"wool\"", "fabrik", "fabric", refusal_of(library::read_description)}};
}

std::vector<WrittenFile> files_of_maps() {
  const auto preset = refusal_of(
      [](const fs::path& file) { return exchange::preset_from_toml(text_in(file), file.string()); });
  const auto material = refusal_of([](const fs::path& file) {
    return material::parse_material(text_in(file), {.name = file.string(), .file = file});
  });
  const std::string weft = "schema = \"weft.material/1\"\n";
  return {
      {"preset.toml", "[[file]]\nbit = 8", "file 1: bit", "bits", preset},
      {"recipe.toml", "[[step]]\ndo = \"tile\"\nrepeat = [1, 1]", "step 1: repeat", "repeats",
       refusal_of(material::read_recipe)},
      {"steps.toml", "[[stp]]\ndo = \"tile\"", "stp", "step", refusal_of(material::read_recipe)},
      {"cloth.toml", weft + "inherit = \"x\"", "inherit", "inherits", material},
      {"look.toml", weft + "[surface]\nrougness = 1", "[surface] rougness", "roughness", material},
      {"layer.toml", weft + "[[layer]]\nname = \"dust\"\nmsk = 1", "[[layer]] dust: msk", "mask", material}};
}

TEST(WrittenFiles, AnswerAMisspeltKeyAlike) {
  for (const auto& files : {calibration_files(), files_of_rig(), files_of_maps()}) {
    for (const WrittenFile& written : files) {
      const ScratchFolder folder;
      const fs::path file = folder / written.name;
      ASSERT_TRUE(write_file(file, written.text));
      EXPECT_THAT(written.refusal(file),
                  testing::HasSubstr(file.string() + ": " + written.key +
                                     ": there is no such key; the nearest is " + written.nearest));
    }
  }
}

}  // namespace
}  // namespace weft::app
