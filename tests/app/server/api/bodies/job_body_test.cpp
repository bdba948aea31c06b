// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/job_body.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calibration/guide/planned_cloth.h"
#include "core/base/files.h"
#include "core/base/temporary_folder.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// A rig's folder with photographs, a calibration and a link that leads out, and one session.
class JobBody : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "photographs" / "board");
    fs::create_directories(folder_ / "calibrations" / "may");
    fs::create_directories(scratch_.path() / "elsewhere");
    fs::create_directory_symlink(scratch_.path() / "elsewhere", folder_ / "link");
  }
  Result<JobSpec> read(const std::string& body) const {
    const auto session = [](const std::string& name) -> Result<fs::path> {
      if (name == "satin") return fs::path("/scans/satin.weft");
      return Error{ErrorKind::kNoInput, "there is no such session", name, "", ""};
    };
    const auto material = [](const std::string& key) -> Result<material::MaterialPlace> {
      return key == "own" ? material::MaterialPlace{"library:own", "/materials/own.toml"}
                          : material::MaterialPlace{"library:" + key};
    };
    const auto build = [](const std::string& key, const std::string& id) -> Result<fs::path> {
      return fs::path("/materials") / key / (id.empty() ? "newest" : id);
    };
    JobPlaces places = {session, folder_, "north", "/scans", "/copies", rig_file_, material, build};
    places.session_folder = session;
    places.sessions_found =
        [](const std::map<std::string, std::string>& asked) -> Result<std::vector<fs::path>> {
      if (asked.contains("query")) return std::vector<fs::path>{"/scans/b.weft", "/scans/a.weft"};
      return std::vector<fs::path>{};
    };
    places.batches = batches();
    return read_job_body(Json::parse(body), places);
  }
  std::vector<std::string> arguments(const std::string& body) const {
    const Result<JobSpec> spec = read(body);
    return spec ? spec->arguments : std::vector<std::string>{spec.error().message()};
  }
  std::string path(const char* name) const { return (folder_ / name).string(); }

  fs::path batches() const { return scratch_.path() / "batches"; }

  const TemporaryFolder scratch_;
  const fs::path folder_ = scratch_.path() / "rig";
  fs::path rig_file_ = folder_ / "rig.toml";
};

using Words = std::vector<std::string>;

TEST_F(JobBody, BecomesAVerbWithItsArguments) {
  EXPECT_EQ(arguments(R"({"kind": "solve", "session": "satin", "quality": "robust"})"),
            (Words{"solve", "/scans/satin.weft", "--quality", "robust"}));
  EXPECT_EQ(arguments(R"({"kind": "solve", "session": "satin", "calibration": "calibrations/may"})"),
            (Words{"solve", "/scans/satin.weft", "--calibration", path("calibrations/may")}));
  EXPECT_EQ(arguments(R"({"kind": "calibrate_update", "moved": "photographs", "output": "new"})"),
            (Words{"calibrate", "update", path("photographs"), "--output", path("new")}));
  EXPECT_EQ(arguments(R"({"kind": "check", "moved": "photographs"})"),
            (Words{"calibrate", "check", "--session", path("photographs")}));
  EXPECT_EQ(arguments(R"({"kind": "price", "session": "satin"})"),
            (Words{"solve", "--explain", "--crops", "{files}", "/scans/satin.weft"}));
  EXPECT_EQ(arguments(R"({"kind": "copy", "session": "satin"})"),
            (Words{"copy", "/scans/satin.weft", "--to", "/copies"}));
  EXPECT_EQ(arguments(R"({"kind": "torture"})"), (Words{"torture", "--output", "/scans/torture.weft"}));
  EXPECT_EQ(arguments(R"({"kind": "sample"})"), (Words{"sample", "--output", "/scans/sample.weft"}));
  EXPECT_EQ(
      arguments(R"({"kind": "check", "session": "satin", "from": "calibrations/may"})"),
      (Words{"calibrate", "check", "--session", "/scans/satin.weft", "--from", path("calibrations/may")}));
  EXPECT_EQ(arguments(R"({"kind": "calibrate_camera", "input": "photographs/board", "squares_x": 9,
                          "output": "calibrations/june"})"),
            (Words{"calibrate", "camera", path("photographs/board"), "--rig", "north", "--output",
                   path("calibrations/june"), "--squares-x", "9"}));
  const Result<JobSpec> lights = read(R"({"kind": "calibrate_lights", "input": "photographs",
                                          "output": "new", "from": "calibrations/may", "request_id": "a"})");
  ASSERT_TRUE(lights) << lights.error().message();
  EXPECT_EQ(lights->needs, (Words{path("photographs"), path("calibrations/may")}));
  EXPECT_EQ(lights->of, "photographs");
  EXPECT_EQ(lights->request_id, "a");
}

TEST_F(JobBody, PlansABatchOfNamedOrFoundSessions) {
  const auto place = [&](const char* name) { return (batches() / name).string(); };
  EXPECT_EQ(arguments(R"({"kind": "batch_plan", "find": {"query": "wool"}, "within_s": 28800, "sample": 3})"),
            (Words{"batch", "plan", "--list", place("0001/sessions.txt"), "--plan", place("0001/plan.jsonl"),
                   "--within", "28800s", "--sample", "3"}));
  EXPECT_EQ(read_text(batches() / "0001" / "sessions.txt").value(), "/scans/a.weft\n/scans/b.weft\n");
  const Result<JobSpec> named =
      read(R"({"kind": "batch_plan", "sessions": ["satin", "satin"], "name": "autumn", "to_deg": 0.5})");
  ASSERT_TRUE(named) << named.error().message();
  EXPECT_EQ(named->of, "autumn");
  EXPECT_EQ(named->wants["sessions"], 1) << "their number, and no list that every answer repeats";
  EXPECT_EQ(read_text(batches() / "autumn" / "sessions.txt").value(), "/scans/satin.weft\n");
  EXPECT_EQ(read(R"({"kind": "batch_plan", "sessions": ["satin"], "name": "autumn"})").error().kind,
            ErrorKind::kCannotCreate);
  const Result<JobSpec> corrected =
      read(R"({"kind": "batch_plan", "sessions": ["satin"], "calibration": "calibrations/may"})");
  ASSERT_TRUE(corrected) << corrected.error().message();
  EXPECT_EQ(corrected->of, "0002");
  EXPECT_EQ(corrected->needs, (Words{path("calibrations/may")}));
  EXPECT_EQ((Words(corrected->arguments.end() - 2, corrected->arguments.end())),
            (Words{"--calibration", path("calibrations/may")}));
}

TEST_F(JobBody, RefusesABatchThatCannotBePlannedAndBeginsNone) {
  const auto kind_of = [&](const char* body) {
    const Result<JobSpec> spec = read(body);
    return spec ? std::optional<ErrorKind>() : spec.error().kind;
  };
  for (const char* wrong :
       {R"({"kind": "batch_plan"})", R"({"kind": "batch_plan", "sessions": []})",
        R"({"kind": "batch_plan", "sessions": "satin"})", R"({"kind": "batch_plan", "sessions": [7]})",
        R"({"kind": "batch_plan", "find": "wool"})", R"({"kind": "batch_plan", "find": {"limit": "3"}})",
        R"({"kind": "batch_plan", "find": {"query": 3}})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "find": {"query": "a"}})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "quality": "best"})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "quality": "fast", "to_deg": 1})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "within_s": 0})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "sample": 2.5})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "least_change_deg": -1})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "name": "../out"})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "name": ""})",
        R"({"kind": "batch_plan", "sessions": ["satin"], "output": "/tmp"})", R"({"kind": "batch_run"})",
        R"({"kind": "batch_run", "batch": 1})", R"({"kind": "batch_run", "batch": "a", "at_once": 0})"})
    EXPECT_EQ(kind_of(wrong), ErrorKind::kUsage) << wrong;
  for (const char* none :
       {R"({"kind": "batch_plan", "sessions": ["satin", "velvet"]})", R"({"kind": "batch_plan", "find": {}})",
        R"({"kind": "batch_run", "batch": "none"})", R"({"kind": "batch_run", "batch": "../none"})"})
    EXPECT_EQ(kind_of(none), ErrorKind::kNoInput) << none;
  EXPECT_TRUE(!fs::exists(batches()) || fs::is_empty(batches()));
}

TEST_F(JobBody, PlansLightsForTheRigOfTheDaemonAndNoOther) {
  const Words plan = {"rig", "plan", "--picture", "{files}/plan.svg", path("rig.toml")};
  const auto planned = [&](const char* body, Words said) {
    Words all = plan;
    all.insert(all.end(), said.begin(), said.end());
    EXPECT_EQ(arguments(body), all) << body;
  };
  planned(R"({"kind": "rig_plan"})", {});
  planned(R"({"kind": "rig_plan", "cloth": "velvet", "aim": "normal"})",
          {"--cloth", "velvet", "--aim", "normal"});
  planned(
      R"({"kind": "rig_plan", "roughness": 0.25, "f0": 0.5, "albedo": 0.125, "relief_deg": 0, "pace": 3})",
      {"--roughness", "0.25", "--f0", "0.5", "--albedo", "0.125", "--relief", "0", "--pace", "3"});
  for (const calibration::NamedCloth& each : calibration::planned_cloths())
    EXPECT_TRUE(read(R"({"kind": "rig_plan", "cloth": ")" + each.name + R"("})")) << each.name;
  EXPECT_EQ(read(R"({"kind": "rig_plan"})")->of, "north");

  for (const char* wrong :
       {R"({"kind": "rig_plan", "cloth": "lace"})",
        R"({"kind": "rig_plan", "cloth": "satin", "roughness": 0.2})", R"({"kind": "rig_plan", "f0": 0.1})",
        R"({"kind": "rig_plan", "roughness": 2})", R"({"kind": "rig_plan", "aim": "sheen"})",
        R"({"kind": "rig_plan", "rig": "/etc/weft/south.toml"})"}) {
    const Result<JobSpec> spec = read(wrong);
    ASSERT_FALSE(spec) << wrong;
    EXPECT_EQ(spec.error().kind, ErrorKind::kUsage) << wrong;
  }
  rig_file_.clear();
  EXPECT_EQ(read(R"({"kind": "rig_plan"})").error().kind, ErrorKind::kNoInput);
}

TEST_F(JobBody, HasARecipeAsTheTextThatItsVerbReads) {
  EXPECT_EQ(
      arguments(
          R"({"kind": "maps", "session": "satin", "solve": "ab12", "draft": true, "maps": ["height", "cavity"],
                          "mm_per_pixel": 0.125, "preview": true, "steps": {"steps": [{"do": "flatten"}]}})"),
      (Words{"maps", "/scans/satin.weft", "--solve", "ab12", "--draft", "--mm-per-pixel", "0.125", "--steps",
             R"({"steps":[{"do":"flatten"}]})", "--preview", "--maps", "height,cavity"}));
  EXPECT_EQ(arguments(R"({"kind": "finish", "session": "satin", "recipe": "detail", "preview": false})"),
            (Words{"finish", "/scans/satin.weft", "--recipe", "detail"}));
  for (const char* wrong :
       {R"("steps": [])", R"("steps": {"steps": [{"do": "fold"}]})",
        R"("steps": {"steps": [{"do": "crop", "left_mm": -1}]})", R"("steps": "flat")",
        R"("recipe": "/etc/passwd")", R"("recipe": "tile", "steps": {"steps": []})", R"("preview": 1)",
        R"("maps": [])", R"("maps": ["--help"])", R"("maps": "height")"}) {
    const Result<JobSpec> spec = read(R"({"kind": "maps", "session": "satin", )" + std::string(wrong) + "}");
    ASSERT_FALSE(spec) << wrong;
    EXPECT_EQ(spec.error().kind, ErrorKind::kUsage) << wrong;
  }
  const Result<JobSpec> third = read(
      R"({"kind": "maps", "session": "satin", "steps": {"steps": [{"do": "tile"}, {"do": "crop", "at": 3}]}})");
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().where, "steps");
  EXPECT_NE(third.error().why.find("step 2"), std::string::npos) << third.error().why;
}

TEST_F(JobBody, ExportsMapsOfASessionOrABuiltMaterial) {
  EXPECT_EQ(
      arguments(R"({"kind": "export", "session": "satin", "set": "ab12", "presets": ["unreal", "glb"]})"),
      (Words{"export", "/scans/satin.weft", "--maps", "ab12", "--preset", "unreal,glb"}));
  EXPECT_EQ(arguments(R"({"kind": "export_price", "session": "satin", "presets": ["exr"], "name": "red"})"),
            (Words{"export", "--explain", "/scans/satin.weft", "--preset", "exr", "--name", "red"}));
  EXPECT_EQ(arguments(R"({"kind": "export", "material": "dusty", "set": "ab", "presets": ["glb"]})"),
            (Words{"export", "/materials/dusty/ab", "--preset", "glb"}));
  EXPECT_EQ(arguments(R"({"kind": "export", "material": "dusty", "presets": ["glb"]})"),
            (Words{"export", "/materials/dusty/newest", "--preset", "glb"}));
  EXPECT_EQ(arguments(R"({"kind": "material", "material": "cotton"})"),
            (Words{"material", "build", "--output", (material::user_materials_folder() / "build").string(),
                   "library:cotton"}));
  EXPECT_EQ(arguments(R"({"kind": "material", "material": "own"})"),
            (Words{"material", "build", "/materials/own.toml"}));
  EXPECT_EQ(read(R"({"kind": "material", "material": "cotton"})")->of, "cotton");
  for (const char* wrong :
       {R"({"kind": "export", "session": "satin"})", R"({"kind": "export", "presets": ["glb"]})",
        R"({"kind": "export", "session": "satin", "material": "a", "presets": ["glb"]})",
        R"({"kind": "export", "session": "satin", "presets": ["../glb"]})",
        R"({"kind": "export", "material": "a", "set": 1, "presets": ["glb"]})", R"({"kind": "material"})"}) {
    const Result<JobSpec> spec = read(wrong);
    ASSERT_FALSE(spec) << wrong;
    EXPECT_EQ(spec.error().kind, ErrorKind::kUsage) << wrong;
  }
}

TEST_F(JobBody, LeadsNowhereElse) {
  for (const char* input : {"..", "../elsewhere", "photographs/../../elsewhere", "/etc", "-o", ".hidden", "",
                            "photographs//board", "photographs/", "a b", "photographs/board\\n"}) {
    const Result<JobSpec> spec = read(std::string(R"({"kind": "check", "input": ")") + input + R"("})");
    ASSERT_FALSE(spec) << input;
    EXPECT_EQ(spec.error().kind, ErrorKind::kUsage) << input;
  }
  EXPECT_EQ(read(R"({"kind": "check", "input": "link"})").error().kind, ErrorKind::kNoInput);
  const char* through_link =
      R"({"kind": "calibrate_response", "input": "photographs", "output": "link/new"})";
  EXPECT_EQ(read(through_link).error().kind, ErrorKind::kNoInput);
}

TEST_F(JobBody, IsRefusedBeforeItsVerbRuns) {
  const auto kind_of = [&](const char* body) {
    const Result<JobSpec> spec = read(body);
    return spec ? ErrorKind::kInternal : spec.error().kind;
  };
  for (const char* wrong :
       {"{}", R"({"kind": "bake", "session": "satin"})", R"({"kind": "solve"})",
        R"({"kind": "solve", "session": 7})", R"({"kind": "solve", "session": "satin", "quality": "best"})",
        R"({"kind": "solve", "session": "satin", "method": "--help"})",
        R"({"kind": "solve", "session": "satin", "within_s": 0})",
        R"({"kind": "solve", "session": "satin", "within_s": "soon"})",
        R"({"kind": "solve", "session": "satin", "threads": 1})",
        R"({"kind": "rectify", "session": "satin", "mm_per_pixel": -1})",
        R"({"kind": "check", "session": "satin", "input": "photographs"})", R"({"kind": "check"})",
        R"({"kind": "calibrate_response", "input": "photographs"})",
        R"({"kind": "price", "session": "satin", "request_id": "a b"})"}) {
    EXPECT_EQ(kind_of(wrong), ErrorKind::kUsage) << wrong;
  }
  EXPECT_EQ(kind_of(R"({"kind": "solve", "session": "none"})"), ErrorKind::kNoInput);
  EXPECT_EQ(kind_of(R"({"kind": "check", "input": "none"})"), ErrorKind::kNoInput);
  EXPECT_EQ(kind_of(R"({"kind": "calibrate_grey", "session": "satin", "output": "calibrations/may"})"),
            ErrorKind::kCannotCreate);
}

}  // namespace
}  // namespace weft::app
