// SPDX-License-Identifier: Apache-2.0
// Whether what a job's body may hold is what its verb takes, by weft itself.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/server/api/bodies/job_body.h"
#include "app/server/api/bodies/job_kinds.h"
#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct Said {
  int exit_code = -1;
  std::string text;
};

Said said_by_weft(const std::vector<std::string>& arguments) {
  std::string command = std::string("'") + program_path("weft") + "'";
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  Said said;
  FILE* const out = popen((command + " -q --json-events 2>&1 </dev/null").c_str(), "re");
  if (out == nullptr) return said;
  std::array<char, 4096> block = {};
  for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), out)) > 0;)
    said.text.append(block.data(), n);
  const int status = pclose(out);
  if (WIFEXITED(status)) said.exit_code = WEXITSTATUS(status);
  return said;
}

/// A rig's folder in which nothing that a job works on can be read, so that a verb ends once it has read its
/// options.
class JobRanges : public testing::Test {
 protected:
  JobRanges() {
    fs::create_directories(folder_ / "photographs");
    places_.folder = folder_;
    places_.rig = "north";
    places_.rig_file = folder_ / "rig.toml";
    places_.session = [this](const std::string& name) -> Result<fs::path> { return folder_ / name; };
    places_.session_folder = places_.session;
    places_.batches = folder_ / "batches";
  }

  /// The least that a job of the kind is asked with; nothing where none of its fields is a number.
  Json least_body(const std::string& kind) const {
    Json body = {{"kind", kind}};
    if (kind == "calibrate_lights" || kind == "calibrate_camera") {
      body["input"] = body["from"] = "photographs";
      if (kind == "calibrate_camera") body["output"] = "new";
    } else if (kind == "calibrate_patches" || kind == "calibrate_update") {
      body["session"] = "satin";
      body["output"] = "new";
    } else if (kind == "batch_plan") {
      body["sessions"] = {"satin"};
    } else if (kind == "rig_plan") {
      body["roughness"] = 0.5;
    } else {
      body["session"] = "satin";
    }
    if (kind.starts_with("export")) body["presets"] = {"glb"};
    return body;
  }
  Result<JobSpec> read(const Json& body) const { return read_job_body(body, places_); }

  /// What the refusal of a field says its range is: "must be a whole number from 2 to 100".
  std::optional<std::array<double, 2>> range_of(const std::string& kind, const std::string& field) const {
    Json body = least_body(kind);
    body[field] = "no number";
    const Result<JobSpec> refused = read(body);
    if (refused || refused.error().where != field) return {};
    std::array<double, 2> range = {};
    const std::string& why = refused.error().why;
    const std::size_t from = why.find(" from ");
    if (from == why.npos || std::sscanf(why.c_str() + from, " from %lf to %lf", &range[0], &range[1]) != 2)
      return {};
    return range;
  }

  const TemporaryFolder scratch_;
  const fs::path folder_ = scratch_.path() / "rig";
  JobPlaces places_;
};

TEST_F(JobRanges, HoldNothingThatTheVerbRefuses) {
  const Json schemas = job_schemas();
  int fields = 0;
  for (const auto& [name, schema_of_kind] : schemas.items()) {
    if (!schema_of_kind.contains("properties")) continue;
    const Json& properties = schema_of_kind["properties"];
    const std::string kind = properties["kind"]["enum"][0];
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
      // Fields that exclude each other are asked for apart.
      std::vector<Json> bodies = {least_body(kind)};
      for (const auto& [field, schema] : properties.items()) {
        if (schema.value("type", "") != "number" && schema.value("type", "") != "integer") continue;
        const auto range = range_of(kind, field);
        if (!range) continue;
        ++fields;
        Json more = bodies.front();
        more[field] = (*range)[end];
        Json alone = least_body(kind);
        alone[field] = (*range)[end];
        if (read(more)) {
          bodies.front() = std::move(more);
        } else {
          bodies.push_back(std::move(alone));
        }
        Json beyond = least_body(kind);
        beyond[field] = end == 0 ? (*range)[0] - 1 : (*range)[1] + 1;
        EXPECT_FALSE(read(beyond)) << beyond.dump();
      }
      for (const Json& body : bodies) {
        if (body == least_body(kind)) continue;
        const Result<JobSpec> spec = read(body);
        ASSERT_TRUE(spec) << body.dump() << spec.error().message();
        const Said said = said_by_weft(spec->arguments);
        EXPECT_NE(said.exit_code, 64) << body.dump() << '\n' << said.text;
        EXPECT_NE(said.exit_code, -1) << body.dump();
      }
    }
  }
  EXPECT_GT(fields, 2 * 20) << "fields of all kinds, from both ends";
}

TEST_F(JobRanges, ABoardsSquaresAreWhole) {
  Json body = least_body("calibrate_camera");
  body["squares_x"] = 9.5;
  const Result<JobSpec> half = read(body);
  ASSERT_FALSE(half);
  EXPECT_EQ(
      half.error().message(),
      "job cannot be read: squares_x: must be a whole number from 3 to 100. see POST jobs in openapi.json.");
}

TEST_F(JobRanges, AWaveOfFiftyDegreesIsRefusedAtOnceWithItsRange) {
  Json body = least_body("calibrate_lights");
  body["flatness_deg"] = 50;
  const Result<JobSpec> refused = read(body);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "flatness_deg");
  EXPECT_EQ(refused.error().why, "must be a number from 0 to 2");
}

TEST_F(JobRanges, WhatTheVerbTakesApartIsNotTakenTogether) {
  for (const Json& more :
       {Json{{"quality", "fast"}, {"method", "seed"}}, Json{{"quality", "fast"}, {"to_deg", 1}},
        Json{{"method", "seed"}, {"within_s", 9}}}) {
    Json body = least_body("solve");
    body.update(more);
    EXPECT_FALSE(read(body)) << body.dump();
  }
  Json both = least_body("solve");
  both.update({{"to_deg", 1}, {"within_s", 9}});
  EXPECT_TRUE(read(both));
  Json blind = least_body("batch_plan");
  blind.update({{"to_deg", 1}, {"sample", 0}});
  EXPECT_FALSE(read(blind)) << "nothing is measured that a level could be chosen by";
}

// A usage error is found before any option is read, --json-events too.
TEST_F(JobRanges, AUsageErrorIsAnEventForWhoAskedForEvents) {
  const Said said = said_by_weft({"calibrate", "lights", "sheets", "--flatness", "50"});
  EXPECT_EQ(said.exit_code, 64) << said.text;
  const Json error = Json::parse(said.text.substr(0, said.text.find('\n')), nullptr, false);
  ASSERT_TRUE(error.is_object()) << said.text;
  EXPECT_EQ(error.value("event", ""), "error");
  EXPECT_EQ(error.value("kind", ""), "usage");
  EXPECT_NE(error.value("why", "").find("--flatness"), std::string::npos) << error.dump();
}

}  // namespace
}  // namespace weft::app
