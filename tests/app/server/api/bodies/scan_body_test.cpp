// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/scan_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace weft::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<capture::ScanRequest> read(const std::string& body, const capture::ScanRequest& otherwise = {}) {
  const Result<Json> json = parse_body(body);
  if (!json) return json.error();
  return read_scan_body(*json, 10, otherwise);
}

TEST(ScanBody, SaysEverythingAScanMayBe) {
  const Result<capture::ScanRequest> request =
      read(R"({"session": "satin_1", "fabric": "Satin, schräg", "cloth_height_mm": 1.5,
      "metadata": {"tags": ["red"], "weight": 120}, "exposure_us": 20000, "iso": 200, "f_number": 11,
      "leds": [3, 1], "repeat": false, "bracket": 0.25, "copy": false})");
  ASSERT_TRUE(request) << request.error().message();
  EXPECT_EQ(request->fabric, "Satin, schräg");
  EXPECT_EQ(request->cloth_height_mm, 1.5);
  EXPECT_EQ(request->metadata["weight"], 120);
  EXPECT_EQ(request->exposure, (capture::ExposureSettings{20000, 200, 11}));
  EXPECT_THAT(request->leds, ElementsAre(3, 1));
  EXPECT_FALSE(request->repeat);
  EXPECT_EQ(request->bracket, 0.25);
}

TEST(ScanBody, LeavesWhatItDoesNotNameAsItWas) {
  capture::Rig rig;
  rig.name = "north";
  rig.scan.exposure_us = 5000;
  rig.scan.cloth_height_mm = 2;
  rig.scan.copy = "backup";
  const Result<capture::ScanRequest> request =
      read(R"({"fabric": "wool", "iso": null})", request_of_rig(rig));
  ASSERT_TRUE(request) << request.error().message();
  EXPECT_EQ(request->rig, "north");
  EXPECT_EQ(request->exposure, (capture::ExposureSettings{5000, 100, 8}));
  EXPECT_EQ(request->cloth_height_mm, 2);
  EXPECT_EQ(request->copy, "backup");
  EXPECT_TRUE(read(R"({"copy": false})", request_of_rig(rig))->copy.empty());
  EXPECT_EQ(request->leds.size(), 10u);
  rig.leds = 3;
  EXPECT_THAT(read("{}", request_of_rig(rig))->leds, ElementsAre(1, 2, 3)) << "those of the rig file";
}

TEST(ScanBody, AsksForNoFilmAndNoLightBelowThatTheRigHasNot) {
  capture::Rig rig;
  EXPECT_FALSE(read(R"({"below": true})", request_of_rig(rig)));
  EXPECT_TRUE(read(R"({"below": false})", request_of_rig(rig)));
  EXPECT_THAT(read(R"({"polariser": ["crossed"]})", request_of_rig(rig)).error().message(),
              HasSubstr("the rig file has no [polariser]"));
  rig.below.emplace();
  rig.polariser.states = {Polariser::kCrossed, Polariser::kParallel};
  const Result<capture::ScanRequest> all = read("{}", request_of_rig(rig));
  EXPECT_TRUE(all->below);
  EXPECT_EQ(all->polariser.states, rig.polariser.states);
  EXPECT_TRUE(all->polariser.is_turned);
  const Result<capture::ScanRequest> fewer =
      read(R"({"below": false, "polariser": ["parallel"]})", request_of_rig(rig));
  ASSERT_TRUE(fewer) << fewer.error().message();
  EXPECT_FALSE(fewer->below);
  EXPECT_THAT(fewer->polariser.states, ElementsAre(Polariser::kParallel));
  EXPECT_TRUE(fewer->polariser.is_turned) << "the board has to turn it there";
  for (const char* wrong :
       {R"({"polariser": []})", R"({"polariser": "crossed"})", R"({"polariser": ["none"]})",
        R"({"polariser": ["crossed", "crossed"]})", R"({"below": 1})"})
    EXPECT_FALSE(read(wrong, request_of_rig(rig))) << wrong;

  Session session;
  session.document = {{"plan", {{"leds", {1, 2, 3}}, {"repeat", true}}}};
  EXPECT_FALSE(request_of_session(session, rig).below) << "as it was begun";
  EXPECT_TRUE(request_of_session(session, rig).polariser.states.empty());
  session.document["plan"]["polariser"] = {"parallel"};
  session.document["plan"]["below"] = true;
  EXPECT_TRUE(request_of_session(session, rig).below);
  EXPECT_THAT(request_of_session(session, rig).polariser.states, ElementsAre(Polariser::kParallel));
}

TEST(ScanBody, GoesOnAsItsSessionWasBegun) {
  Session session;
  session.fabric = "linen";
  session.cloth_height_mm = 3;
  session.document = {{"plan", {{"leds", {2, 5}}, {"repeat", false}, {"bracket", 4}}},
                      {"metadata", {{"id", "7"}}}};
  const Result<capture::ScanRequest> request = read(R"({"session": "a"})", request_of_session(session, {}));
  ASSERT_TRUE(request) << request.error().message();
  EXPECT_EQ(request->fabric, "linen");
  EXPECT_EQ(request->cloth_height_mm, 3);
  EXPECT_THAT(request->leds, ElementsAre(2, 5));
  EXPECT_FALSE(request->repeat);
  EXPECT_EQ(request->bracket, 4);
  EXPECT_EQ(request->metadata["id"], "7");
}

TEST(ScanBody, RefusesEachFieldThatIsWrongByName) {
  for (const auto& [body, field] : std::vector<std::pair<std::string, std::string>>{
           {R"({"fabric": ""})", "fabric"},
           {R"({"fabric": 7})", "fabric"},
           {R"({"fabric": "a\nb"})", "fabric"},
           {R"({"fabric": ")" + std::string(201, 'a') + R"("})", "fabric"},
           {R"({"session": "../a"})", "session"},
           {R"({"session": ".hidden"})", "session"},
           {R"({"session": "a/b"})", "session"},
           {R"({"session": "a\u0000b"})", "session"},
           {R"({"cloth_height_mm": "2"})", "cloth_height_mm"},
           {R"({"cloth_height_mm": 1e4})", "cloth_height_mm"},
           {R"({"exposure_us": -1})", "exposure_us"},
           {R"({"iso": 0})", "iso"},
           {R"({"f_number": []})", "f_number"},
           {R"({"metadata": [1]})", "metadata"},
           {R"({"leds": []})", "leds"},
           {R"({"leds": [0]})", "leds"},
           {R"({"leds": [11]})", "leds"},
           {R"({"leds": [1, 1]})", "leds"},
           {R"({"leds": [1.5]})", "leds"},
           {R"({"leds": [99999999999]})", "leds"},
           {R"({"repeat": 1})", "repeat"},
           {R"({"bracket": 0})", "bracket"},
           {R"({"copy": "/etc"})", "copy"}}) {
    const Result<capture::ScanRequest> request = read(body);
    ASSERT_FALSE(request) << body;
    EXPECT_EQ(request.error().kind, ErrorKind::kUsage) << body;
    EXPECT_EQ(request.error().where, field) << body;
    EXPECT_FALSE(request.error().remedy.empty()) << body;
  }
}

TEST(ScanBody, ProposesTheFieldThatWasMeant) {
  const Result<capture::ScanRequest> request = read(R"({"fabrik": "wool"})");
  ASSERT_FALSE(request);
  EXPECT_THAT(request.error().why, HasSubstr("'fabric'"));
}

TEST(ScanBody, RefusesWhatIsNoFlatJsonObject) {
  const std::string deep = std::string(30000, '[') + std::string(30000, ']');
  for (const std::string& body : std::vector<std::string>{
           "{", "[]", "1", "null", "{\"a\": 1} x", "{'a': 1}", "\xff", "{\"fabric\": \"\xff\"}",
           "{\"iso\": 1e999}", "{\"metadata\": " + deep + "}", deep, std::string(60000, '{')}) {
    const Result<capture::ScanRequest> request = read(body);
    ASSERT_FALSE(request) << body.substr(0, 40);
    EXPECT_EQ(request.error().kind, ErrorKind::kUsage);
    EXPECT_EQ(request.error().where, "body") << body.substr(0, 40);
  }
  EXPECT_TRUE(read(""));
  EXPECT_TRUE(read(" \r\n"));
}

}  // namespace
}  // namespace weft::app
