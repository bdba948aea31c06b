// SPDX-License-Identifier: Apache-2.0
// Maps over HTTP, as a viewer asks for them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "app/server/rig_server.h"
#include "bench/server/served_rig.h"
#include "tests/app/server/raw_client.h"
#include "tests/app/server/view/asked_session.h"

namespace weft::app {
namespace {

using testing::HasSubstr;

class ServedMaps : public AskedSession {
 protected:
  void SetUp() override {
    auto server = bench::server_without_devices("maps", root() / "scans", root() / "state");
    ASSERT_TRUE(server) << server.error().message();
    server_ = std::move(*server);
  }
  Answer get(const std::string& path) const { return ask(server_->port(), "GET", "/api/v1/" + path); }
  std::string solve() const { return "sessions/asked/solves/" + solve_.id; }

  std::unique_ptr<RigServer> server_;
};

TEST_F(ServedMaps, NamesItsSolvesAndTheirLayers) {
  const Json solves = get("sessions/asked/solves").json();
  ASSERT_EQ(solves["solves"].size(), 1U);
  EXPECT_EQ(solves["solves"][0]["id"], solve_.id);
  EXPECT_EQ(solves["truth"], true);
  const Json one = get(solve()).json();
  EXPECT_EQ(one["levels"], 2) << "128 x 96 is small on any line";
  EXPECT_NEAR(one["mm_per_pixel"].get<double>(), kMmPerPixel, 1e-6);
  EXPECT_EQ(one["layers"].size(), 7U) << one["layers"].dump();
}

TEST_F(ServedMaps, GivesEveryLayerAsValuesAndAsAPicture) {
  const auto pixels = static_cast<std::size_t>(kFrame.pixels());
  for (const auto& [layer, bytes] : {std::pair<std::string, std::size_t>("normal", 4),
                                     {"albedo", 6},
                                     {"sigma", 2},
                                     {"sigma_noise", 2},
                                     {"sigma_model", 2},
                                     {"residual", 2},
                                     {"status", 1}}) {
    const Answer raw = get(fmt::format("{}/tiles/{}/0/0_0.raw", solve(), layer));
    ASSERT_EQ(raw.status, 200) << layer << raw.body;
    EXPECT_EQ(raw.body.size(), bytes * pixels) << layer;
    EXPECT_THAT(raw.head, HasSubstr("immutable")) << layer;
    const Answer png = get(fmt::format("{}/tiles/{}/0/0_0.png", solve(), layer));
    ASSERT_EQ(png.status, 200) << layer << png.body;
    EXPECT_EQ(png.body.substr(1, 3), "PNG") << layer;
  }
  const Answer relit = get(solve() + "/tiles/relit/0/0_0.jpg?light=0.5,0,0.8&exposure=1");
  ASSERT_EQ(relit.status, 200) << relit.body;
  EXPECT_THAT(relit.head, HasSubstr("image/jpeg"));
  const Answer frame = get("sessions/asked/frames/1/tiles/0/0_0.raw");
  ASSERT_EQ(frame.status, 200) << frame.body;
  EXPECT_EQ(frame.body.size(), 6 * pixels);
}

TEST_F(ServedMaps, FindNoDifferenceBetweenASolveAndItself) {
  const Answer tile = get(solve() + "/tiles/difference/0/0_0.raw?with=" + solve_.id);
  ASSERT_EQ(tile.status, 200) << tile.body;
  EXPECT_EQ(std::ranges::count(tile.body, '\0'), static_cast<std::ptrdiff_t>(tile.body.size()));
  const Json same = get(fmt::format("compare?a=asked/{0}&b=asked/{0}", solve_.id)).json();
  EXPECT_EQ(same["normal"]["max_deg"], 0);
  const Json truth = get(fmt::format("compare?a=asked/{}&b=asked/truth", solve_.id)).json();
  EXPECT_GT(truth["normal"]["median_deg"].get<double>(), 0.05);
}

TEST_F(ServedMaps, HaveAThumbnailOfTheClothRelitThatIsKeptForEver) {
  const Json listed = get("sessions").json();
  ASSERT_EQ(listed["total"], 1) << listed.dump();
  const std::string path = listed["sessions"][0]["thumbnail"];
  EXPECT_EQ(path, "/api/v1/" + solve() + "/swatch.jpg");
  const Answer picture = ask(server_->port(), "GET", path);
  ASSERT_EQ(picture.status, 200) << picture.body;
  EXPECT_THAT(picture.head, HasSubstr("image/jpeg"));
  EXPECT_THAT(picture.head, HasSubstr("immutable"));
  const bool is_good = listed["sessions"][0]["verdict"]["grade"] == "good";
  EXPECT_EQ(get("sessions?warned=true").json()["total"], is_good ? 0 : 1) << listed;
  EXPECT_EQ(get("sessions?warned=perhaps").status, 400);
}

TEST_F(ServedMaps, DifferInAlbedoPixelByPixelAsTheComparisonSays) {
  const Answer same = get(solve() + "/tiles/albedo_difference/0/0_0.raw?with=" + solve_.id);
  ASSERT_EQ(same.status, 200) << same.body;
  EXPECT_EQ(std::ranges::count(same.body, '\0'), static_cast<std::ptrdiff_t>(same.body.size()));
  const Answer tile = get(solve() + "/tiles/albedo_difference/0/0_0.raw?with=truth");
  ASSERT_EQ(tile.status, 200) << tile.body;
  double sum = 0;
  for (std::size_t at = 0; at < tile.body.size(); at += 2) {
    const auto low = static_cast<unsigned char>(tile.body[at]),
               high = static_cast<unsigned char>(tile.body[at + 1]);
    const int bits = low | high << 8, exponent = bits >> 10 & 31;
    sum += std::ldexp(exponent == 0 ? bits & 1023 : (bits & 1023) + 1024, std::max(exponent, 1) - 25);
  }
  const Json truth = get(fmt::format("compare?a=asked/{}&b=asked/truth", solve_.id)).json();
  const double percent = 100 * truth["albedo"]["mean_rel"].get<double>();
  EXPECT_GT(percent, 0.01);
  EXPECT_NEAR(sum / static_cast<double>(kFrame.pixels()), percent, 1e-2 * percent);
}

TEST_F(ServedMaps, TellAPixelsReadingsOnceTheyAreRead) {
  const std::string path = solve() + "/pixel?x=100&y=90";
  Answer answer = get(path);
  const auto most = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (answer.status == 202 && std::chrono::steady_clock::now() < most) {
    EXPECT_TRUE(answer.json()["readings"].is_null());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    answer = get(path);
  }
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Json pixel = answer.json();
  EXPECT_EQ(pixel["readings"]["readings"].size(), 10U);
  EXPECT_EQ(pixel["maps"]["normal"].size(), 3U);
  EXPECT_NEAR(pixel["table_mm"][0].get<double>(), (100 - 127.5) * kMmPerPixel, kMmPerPixel);
}

TEST_F(ServedMaps, RefuseWhatIsNotThereAndWhatCannotBeRead) {
  for (const auto& [path, status] : {std::pair<std::string, int>("/tiles/normal/2/0_0.raw", 404),
                                     {"/tiles/normal/-1/0_0.raw", 404},
                                     {"/tiles/normal/0/1_0.raw", 404},
                                     {"/tiles/normal/0/0_-1.raw", 404},
                                     {"/tiles/normal/0/0_0.gif", 404},
                                     {"/tiles/normal/0/0_0.jpg", 400},
                                     {"/tiles/velvet/0/0_0.raw", 404},
                                     {"/tiles/relit/0/0_0.raw", 404},
                                     {"/tiles/relit/0/0_0.jpg?light=0,0,0", 400},
                                     {"/tiles/relit/0/0_0.jpg?light=1,nan,0", 400},
                                     {"/tiles/relit/0/0_0.jpg?exposure=1e9", 400},
                                     {"/tiles/sigma/0/0_0.png?least=2&most=1", 400},
                                     {"/tiles/status/0/0_0.raw?bit=GOOD", 404},
                                     {"/tiles/difference/0/0_0.raw", 404},
                                     {"/tiles/difference/0/0_0.raw?with=no", 404},
                                     {"/pixel?x=256&y=0", 400},
                                     {"/pixel?x=1.5&y=0", 400},
                                     {"/region?x=0&y=0&w=257&h=1", 400},
                                     {"/line?x0=0&y0=0&x1=nan&y1=4", 400},
                                     {"/line?x0=0&y0=0&x1=4", 400}}) {
    const Answer answer = get(solve() + path);
    EXPECT_EQ(answer.status, status) << path << answer.body;
    EXPECT_FALSE(answer.json()["error"]["what"].get<std::string>().empty()) << path;
  }
  EXPECT_EQ(get("sessions/asked/solves/0000000000000000").json()["error"]["code"], "no_such_solve");
  EXPECT_EQ(get("compare?a=asked&b=asked").status, 400);
}

}  // namespace
}  // namespace weft::app
