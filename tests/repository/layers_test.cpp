// SPDX-License-Identifier: Apache-2.0
// The layer table of the design: every #include of the tree against it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/repository/source_tree.h"

namespace weft::repository {
namespace {

using Prefixes = std::vector<std::string_view>;

/// What files below these folders may include of ours: files of those folders, and what stands here. The
/// first folder that fits a file decides. docs/architecture.md shows the same table.
struct Layer {
  Prefixes folders;
  Prefixes may_include;
  Prefixes but_not = {};
};

/// Headers of a library that only some folders may see.
struct Door {
  std::string_view headers;
  Prefixes only_under;
};

const std::vector<Layer> kLayers = {
    {{"core/image_io/"}, {"core/"}},
    {{"core/toml/"}, {"core/"}},
    {{"core/"}, {}, {"core/image_io/", "core/toml/"}},
    {{"capture/"}, {"core/", "firmware/protocol/"}},
    {{"solver/"}, {"core/"}, {"core/base/files", "core/base/process"}},
    {{"solve/files/", "solve/input/", "solve/report/", "solve/run/", "solve/session/"},
     {"capture/", "core/", "report/", "solve/", "solver/"}},
    {{"solve/"},
     {"core/", "solver/"},
     {"core/base/files", "core/base/process", "solve/files/", "solve/input/", "solve/report/", "solve/run/",
      "solve/session/"}},
    {{"calibration/guide/", "calibration/run/"},
     {"calibration/", "capture/", "core/", "report/", "solve/", "solver/"}},
    {{"calibration/"},
     {"core/"},
     {"core/base/files", "core/base/process", "calibration/guide/", "calibration/run/"}},
    {{"material/assets/", "material/read/", "material/run/"},
     {"calibration/", "capture/", "core/", "exchange/blocks/", "exchange/presets/", "material/", "report/",
      "solve/", "solver/"}},
    {{"material/"},
     {"core/"},
     {"core/base/files", "core/base/process", "material/assets/", "material/read/", "material/run/"}},
    {{"exchange/export/"},
     {"calibration/", "capture/", "core/", "exchange/", "material/", "report/", "solve/", "solver/"}},
    {{"exchange/"}, {"core/"}, {"core/base/files", "core/base/process", "exchange/export/"}},
    {{"library/catalogue/", "library/chain/", "library/import/", "library/run/"},
     {"calibration/", "capture/", "core/", "exchange/", "library/", "material/", "report/", "solve/",
      "solver/"}},
    {{"library/"},
     {"core/"},
     {"core/base/files", "core/base/process", "library/catalogue/", "library/chain/", "library/import/",
      "library/run/"}},
    {{"report/"}, {"core/"}},
    {{"simulator/"}, {"core/"}, {"core/rig/light_field", "core/rig/radiometry"}},
    {{"torture/"},
     {"bench/oracles/", "calibration/", "capture/", "core/", "exchange/", "material/", "solver/"}},
    {{"virtual_rig/program/"}, {"app/cli/exit_code", "core/", "simulator/", "virtual_rig/"}},
    {{"virtual_rig/"}, {"core/", "firmware/protocol/", "simulator/"}},
    {{"app/server/view/"},
     {"app/server/http/", "calibration/camera/", "capture/raw/", "core/", "report/", "solve/", "solver/"}},
    {{"app/server/"},
     {"calibration/guide/", "calibration/run/", "capture/", "core/", "exchange/export/", "firmware/protocol/",
      "library/", "material/assets/", "material/read/", "material/run/", "report/",
      "simulator/sample_request", "solve/run/", "solve/session/", "torture/torture_request",
      "virtual_rig/control_socket"}},
    {{"app/cli/"},
     {"app/server/", "calibration/guide/", "calibration/run/", "capture/", "core/", "exchange/export/",
      "exchange/presets/", "library/", "material/assets/", "material/read/", "material/run/", "report/",
      "simulator/", "solve/report/", "solve/run/", "solve/session/", "torture/", "virtual_rig/rig_process"}},
    {{"firmware/"}, {}},
    {{"bench/program/"}, {"app/cli/", "bench/", "capture/rig_devices/", "core/"}},
    {{"bench/"},
     {"app/server/", "calibration/", "capture/", "core/", "exchange/", "library/", "material/", "report/",
      "simulator/", "solve/", "solver/", "torture/", "virtual_rig/"}},
    {{"tests/"},
     {"app/", "bench/", "calibration/", "capture/", "core/", "exchange/", "firmware/", "library/",
      "material/", "report/", "simulator/", "solve/", "solver/", "torture/", "virtual_rig/"}},
};

/// What a path from the root of the repository begins with.
const Prefixes kRoots = {"app/",      "bench/",   "calibration/", "capture/",    "core/",      "exchange/",
                         "firmware/", "library/", "material/",    "report/",     "simulator/", "solve/",
                         "solver/",   "tests/",   "torture/",     "virtual_rig/"};

const std::vector<Door> kDoors = {
    {"CLI/", {"app/cli/", "tests/app/cli/", "virtual_rig/program/"}},
    {"OpenEXR/", {"core/image_io/", "tests/core/image_io/", "bench/"}},
    {"OpenImageIO/", {}},
    {"jpeglib.h", {"core/image_io/"}},
    {"png.h", {"core/image_io/"}},
    {"tiffio.h", {"core/image_io/", "tests/core/image_io/"}},
    {"libraw/", {"capture/raw/", "bench/"}},
    {"hwy/",
     {"core/", "exchange/blocks/", "solver/kernels/", "solver/reflectance/", "solver/transport/", "tests/"}},
    {"embree3/", {"simulator/transport/", "bench/"}},
    {"spdlog/", {"app/server/"}},
    {"squish.h", {"exchange/blocks/", "bench/", "tests/"}},
    {"kissfft/", {"core/", "bench/"}},
    {"sqlite3", {"library/"}},
    {"zlib.h", {"exchange/archive/", "tests/exchange/"}},
};

bool starts_with_any(std::string_view path, const Prefixes& prefixes) {
  return std::ranges::any_of(prefixes, [&](std::string_view prefix) { return path.starts_with(prefix); });
}

struct Include {
  bool quoted = false;
  std::string_view header;
};

std::optional<Include> include_of(std::string_view line) {
  const auto skip = [&](std::string_view word) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.starts_with(word)) return false;
    line.remove_prefix(word.size());
    return true;
  };
  if (!skip("#") || !skip("include")) return std::nullopt;
  const bool quoted = skip("\"");
  if (!quoted && !skip("<")) return std::nullopt;
  return Include{quoted, line.substr(0, line.find_first_of("\">"))};
}

/// Why the file at `path` may not include this, or nothing.
std::string objection(std::string_view path, const Include& include) {
  for (const Door& door : kDoors) {
    if (!include.header.starts_with(door.headers)) continue;
    return starts_with_any(path, door.only_under) ? "" : "a library that another folder stands before";
  }
  const auto layer =
      std::ranges::find_if(kLayers, [&](const Layer& each) { return starts_with_any(path, each.folders); });
  if (layer == kLayers.end()) return "a folder that is not in the layer table";
  const bool rooted = starts_with_any(include.header, kRoots);
  if (!include.quoted && !rooted) return "";
  if (!rooted || include.header.find("..") != std::string_view::npos) {
    return "not a path from the root of the repository";
  }
  const bool allowed = (starts_with_any(include.header, layer->folders) ||
                        starts_with_any(include.header, layer->may_include)) &&
                       !starts_with_any(include.header, layer->but_not);
  return allowed ? "" : "forbidden by the layer table to " + std::string(layer->folders.front());
}

std::vector<std::string> forbidden_includes(std::string_view path, std::string_view text) {
  std::vector<std::string> found;
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto include = include_of(lines[i]);
    if (!include) continue;
    if (const std::string why = objection(path, *include); !why.empty()) {
      found.push_back(place(path, i + 1) + ": " + std::string(include->header) + ": " + why);
    }
  }
  return found;
}

std::string including(std::string_view header) {
  return "#include \"" + std::string(header) + "\"\n";
}

struct Case {
  const char* path;
  const char* header;
};

TEST(Layers, HoldInEveryFileOfTheTree) {
  int files = 0;
  for (const TextFile& file : text_files()) {
    if (!ends_in(file.path, {".h", ".cpp", ".c"})) continue;
    ++files;
    for (const std::string& found : forbidden_includes(file.path, file.text)) ADD_FAILURE() << found;
  }
  EXPECT_GT(files, 10) << "the sources were not found";
}

TEST(Layers, ForbidEveryStepUpwardsOrSideways) {
  for (const auto& [path, header] :
       std::vector<Case>{{"core/image/image.cpp", "core/image_io/image_io.h"},
                         {"core/image/image.cpp", "solver/solve.h"},
                         {"core/image_io/exr.cpp", "capture/raw/decode_raw.h"},
                         {"core/image/image.cpp", "core/toml/toml_json.h"},
                         {"capture/scan.cpp", "calibration/lights.h"},
                         {"capture/scan.cpp", "firmware/board/main.h"},
                         {"calibration/lights.cpp", "capture/raw/decode_raw.h"},
                         {"calibration/lights.cpp", "solver/solve.h"},
                         {"solver/solve.cpp", "capture/raw/decode_raw.h"},
                         {"solver/solve.cpp", "material/mips.h"},
                         {"solver/solve.cpp", "tests/solver/weave.h"},
                         {"solver/solve.cpp", "solve/bands/bands.h"},
                         {"solve/bands/bands.cpp", "capture/raw/decode_raw.h"},
                         {"solve/bands/bands.cpp", "solve/run/solve_session.h"},
                         {"material/mips.cpp", "solver/solve.h"},
                         {"report/html.cpp", "solve/run/solve_session.h"},
                         {"solve/run/solve_session.cpp", "app/cli/terminal.h"},
                         {"solve/run/solve_session.cpp", "simulator/simulate.h"},
                         {"app/server/routes.cpp", "solve/bands/bands.h"},
                         {"solve/bands/bands.cpp", "solve/input/session_input.h"},
                         {"solve/run/solve_session.cpp", "calibration/run/calibrate_lights.h"},
                         {"solve/run/solve_session.cpp", "calibration/camera/lens_fit.h"},
                         {"calibration/run/calibrate_lights.cpp", "material/run/maps.h"},
                         {"material/run/maps.cpp", "exchange/export/export.h"},
                         {"material/maps/height.cpp", "core/base/files.h"},
                         {"exchange/export/export.cpp", "library/run/run_batch.h"},
                         {"app/cli/demo.cpp", "bench/report.h"},
                         {"app/cli/demo.cpp", "virtual_rig/virtual_rig.h"},
                         {"bench/report.cpp", "tests/core/image_io/scratch_folder.h"},
                         {"bench/report.cpp", "app/cli/terminal.h"},
                         {"torture/maps.cpp", "app/cli/terminal.h"},
                         {"solver/solve.cpp", "torture/hard_case.h"},
                         {"app/cli/torture.cpp", "bench/oracles/quad_oracle.h"},
                         {"simulator/scene.cpp", "virtual_rig/virtual_rig.h"},
                         {"simulator/camera.cpp", "core/rig/light_field.h"},
                         {"simulator/camera.cpp", "core/rig/radiometry.h"},
                         {"simulator/camera.cpp", "core/rig/radiometry_tiles.h"},
                         {"simulator/camera.cpp", "solver/solve.h"},
                         {"simulator/camera.cpp", "firmware/board/main.h"},
                         {"firmware/board/main.c", "core/base/result.h"}}) {
    EXPECT_EQ(forbidden_includes(path, including(header)).size(), 1U) << path << " includes " << header;
    const std::string angled = "#include <" + std::string(header) + ">\n";
    EXPECT_EQ(forbidden_includes(path, angled).size(), 1U) << path << " includes " << angled;
  }
}

/// Subjects in their order. The lower half of each is mathematics over `core`; the folders of its upper half
/// open files and may name the subjects before it.
const Prefixes kSubjects = {"solver/",   "solve/",   "calibration/", "material/",
                            "exchange/", "library/", "app/"};

std::size_t subject_of(std::string_view path) {
  return static_cast<std::size_t>(
      std::ranges::find_if(kSubjects, [&](std::string_view each) { return path.starts_with(each); }) -
      kSubjects.begin());
}

/// The folders of the upper half of a subject, or nothing.
Prefixes upper_half_of(std::string_view subject) {
  for (const Layer& layer : kLayers) {
    const std::string_view first = layer.folders.front();
    if (first.starts_with(subject) && first != subject) return layer.folders;
  }
  return {};
}

TEST(Layers, LetNoSubjectNameOneThatComesLater) {
  for (const Layer& layer : kLayers) {
    const std::size_t own = subject_of(layer.folders.front());
    if (own == kSubjects.size()) continue;
    for (const std::string_view named : layer.may_include) {
      const std::size_t other = subject_of(named);
      if (other == kSubjects.size() || other <= own) continue;
      // A later one's mathematics alone may be named.
      EXPECT_NE(named, kSubjects[other]) << layer.folders.front();
      EXPECT_FALSE(starts_with_any(named, upper_half_of(kSubjects[other]))) << layer.folders.front();
    }
  }
}

TEST(Layers, KeepALowerHalfFromFilesAndFromItsUpperHalf) {
  for (const std::string_view subject : kSubjects) {
    const auto lower = std::ranges::find(kLayers, Prefixes{subject}, &Layer::folders);
    if (lower == kLayers.end()) continue;
    Prefixes kept_from = upper_half_of(subject);
    kept_from.insert(kept_from.begin(), {"core/base/files", "core/base/process"});
    EXPECT_EQ(lower->but_not, kept_from) << subject;
    EXPECT_THAT(lower->may_include, testing::IsSubsetOf(Prefixes{"core/", "solver/"})) << subject;
  }
}

TEST(Layers, AllowWhatTheTableAllows) {
  for (const auto& [path, header] :
       std::vector<Case>{{"core/image_io/exr.cpp", "core/image_io/image_io.h"},
                         {"capture/scan.cpp", "firmware/protocol/protocol.h"},
                         {"calibration/lights.cpp", "core/rig/radiometry.h"},
                         {"solver/normals/seed.cpp", "solver/solve.h"},
                         {"material/mips.cpp", "core/image_io/image_io.h"},
                         {"material/run/maps.cpp", "calibration/guide/planned_cloth.h"},
                         {"material/run/maps.cpp", "material/maps/height.h"},
                         {"solve/run/solve_session.cpp", "capture/frames/session_frames.h"},
                         {"simulator/camera.cpp", "core/rig/lights.h"},
                         {"virtual_rig/board.cpp", "firmware/protocol/protocol.h"},
                         {"app/cli/main.cpp", "simulator/scene/scene.h"},
                         {"bench/solve.cpp", "solver/solve.h"},
                         {"tests/system/demo_test.cpp", "app/cli/exit_code.h"},
                         {"firmware/board/main.c", "firmware/protocol/protocol.h"}}) {
    EXPECT_THAT(forbidden_includes(path, including(header)), testing::IsEmpty());
  }
}

TEST(Layers, KeepEachLibraryBehindItsDoor) {
  for (const auto& [path, header] : std::vector<Case>{{"core/json.cpp", "OpenEXR/ImfHeader.h"},
                                                      {"core/image_io/exr.cpp", "OpenImageIO/imageio.h"},
                                                      {"app/cli/main.cpp", "png.h"},
                                                      {"capture/scan.cpp", "libraw/libraw.h"},
                                                      {"simulator/dng.cpp", "libraw/libraw.h"},
                                                      {"solver/solve.cpp", "hwy/highway.h"}}) {
    const std::string angled = "#include <" + std::string(header) + ">\n";
    EXPECT_EQ(forbidden_includes(path, angled).size(), 1U) << path << " includes " << header;
    EXPECT_EQ(forbidden_includes(path, including(header)).size(), 1U) << path << " includes " << header;
  }
  for (const auto& [path, header] : std::vector<Case>{{"core/image_io/exr.cpp", "OpenEXR/ImfHeader.h"},
                                                      {"capture/raw/decode_raw.cpp", "libraw/libraw.h"},
                                                      {"bench/raw.cpp", "libraw/libraw.h"},
                                                      {"solver/kernels/fast.cpp", "hwy/foreach_target.h"}}) {
    EXPECT_THAT(forbidden_includes(path, including(header)), testing::IsEmpty());
  }
}

/// Folder by folder, what its files include of other folders.
using Arrows = std::map<std::string, std::set<std::string>>;

std::string folder_of(std::string_view path) {
  return std::string(path.substr(0, std::min(path.rfind('/'), path.size())));
}

Arrows arrows_of(const std::vector<TextFile>& files) {
  Arrows arrows;
  for (const TextFile& file : files) {
    for (const std::string_view line : lines_of(file.text)) {
      const auto include = include_of(line);
      if (!include || !starts_with_any(include->header, kRoots)) continue;
      const std::string from = folder_of(file.path), to = folder_of(include->header);
      if (from != to) arrows[from].insert(to);
    }
  }
  return arrows;
}

/// A way along the arrows from `at` back to a folder of `way`, or nothing. `done` has no circle behind it.
std::vector<std::string> circle_from(const std::string& at, const Arrows& arrows,
                                     std::vector<std::string> way, std::set<std::string>& done) {
  const auto seen = std::ranges::find(way, at);
  const bool is_circle = seen != way.end();
  std::vector<std::string> circle(seen, way.end());
  circle.push_back(at);
  if (is_circle) return circle;
  way.push_back(at);
  if (done.contains(at) || !arrows.contains(at)) return {};
  for (const std::string& next : arrows.at(at)) {
    if (auto found = circle_from(next, arrows, way, done); !found.empty()) return found;
  }
  done.insert(at);
  return {};
}

std::vector<std::string> circle_of(const Arrows& arrows) {
  std::set<std::string> done;
  for (const auto& [folder, next] : arrows) {
    if (auto circle = circle_from(folder, arrows, {}, done); !circle.empty()) return circle;
  }
  return {};
}

TEST(Layers, FormNoCircleOfFolders) {
  std::vector<TextFile> sources;
  for (TextFile& file : text_files()) {
    if (ends_in(file.path, {".h", ".cpp", ".c"}) && !file.path.starts_with("tests/"))
      sources.push_back(std::move(file));
  }
  EXPECT_THAT(circle_of(arrows_of(sources)), testing::IsEmpty());
}

TEST(Layers, SeeACircleOfThreeFolders) {
  const std::vector<TextFile> sources = {
      {"solver/a/a.cpp", including("solver/b/b.h")},
      {"solver/b/b.cpp", including("solver/c/c.h")},
      {"solver/c/c.cpp", including("solver/a/a.h") + including("core/image/image.h")}};
  EXPECT_EQ(circle_of(arrows_of(sources)).size(), 4U) << "there and back again";
}

/// The words between single back quotes.
std::vector<std::string> quoted_words(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t open = text.find('`'); open != std::string_view::npos; open = text.find('`', open)) {
    const std::size_t close = text.find('`', open + 1);
    if (close == std::string_view::npos) break;
    words.emplace_back(text.substr(open + 1, close - open - 1));
    open = close + 1;
  }
  return words;
}

TEST(Layers, AreTheTableOfTheArchitecturePage) {
  std::map<std::vector<std::string>, std::vector<std::string>> table;
  for (const TextFile& file : text_files()) {
    if (file.path != "docs/architecture.md") continue;
    for (const std::string_view line : lines_of(file.text)) {
      if (!line.starts_with("| `")) continue;
      const std::size_t last = line.rfind('|', line.size() - 2);
      const std::vector<std::string> folders = quoted_words(line.substr(0, line.find('|', 1)));
      if (folders.front().ends_with('/')) table[folders] = quoted_words(line.substr(last));
    }
  }
  std::map<std::vector<std::string>, std::vector<std::string>> layers;
  for (const Layer& layer : kLayers) {
    std::vector<std::string>& row = layers[{layer.folders.begin(), layer.folders.end()}];
    row.assign(layer.may_include.begin(), layer.may_include.end());
    row.insert(row.end(), layer.but_not.begin(), layer.but_not.end());
  }
  EXPECT_EQ(table, layers);
}

TEST(Layers, WantPathsFromTheRootAndFoldersOfTheTable) {
  EXPECT_EQ(forbidden_includes("solver/solve.cpp", including("solve.h")).size(), 1U);
  EXPECT_EQ(forbidden_includes("solver/solve.cpp", including("core/../capture/scan.h")).size(), 1U);
  EXPECT_EQ(forbidden_includes("helpers/solve.cpp", including("core/image/image.h")).size(), 1U);
}

TEST(Layers, NameFileAndLineAndReadOnlyIncludes) {
  const auto found = forbidden_includes("core/a.cpp",
                                        "#include <vector>\n"
                                        "// #include \"solver/a.h\"\n"
                                        " # include\t\"solver/a.h\"  // why\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0], testing::StartsWith("core/a.cpp:3: solver/a.h: "));
}

}  // namespace
}  // namespace weft::repository
