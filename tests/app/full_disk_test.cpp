// SPDX-License-Identifier: Apache-2.0
// A disk that is full under jobs and catalogue: refused in words, and nothing that was there is lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "bench/server/served_rig.h"
#include "core/base/json_document.h"
#include "core/rig/session.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

using testing::HasSubstr;

class FullDisk : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(served_.start(program_folder(), in_sources("testdata/scenes/satin.toml"), 0.02));
    ASSERT_TRUE(served_.serve());
    ASSERT_TRUE(served_.client().post("/api/v1/scan",
                                      {{"session", "cloth"}, {"fabric", "satin"}, {"exposure_us", 20000}}));
    ASSERT_TRUE(comes("/api/v1/rig", [](const Json& rig) { return rig["state"] == "idle"; }));
    ASSERT_TRUE(comes("/api/v1/jobs", [](const Json& page) {  // the look at the rig, and the preview
      return page["jobs"].size() == 2 && page["jobs"][0]["state"] == "done" &&
             page["jobs"][1]["state"] == "done";
    }));
  }

  bool comes(const std::string& path, const std::function<bool(const Json&)>& is_so) const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < until) {
      const Result<Json> answer = served_.client().get(path);
      if (answer && is_so(*answer)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  Result<Json> tag() const {
    return served_.client().post("/api/v1/sessions/cloth/metadata", {{"tags", {"red"}}});
  }
  Result<Json> solve() const {
    return served_.client().post("/api/v1/jobs",
                                 {{"kind", "solve"}, {"session", "cloth"}, {"quality", "fast"}});
  }

  ServedRig served_;
};

TEST_F(FullDisk, UnderJobsAndCatalogueIsSaidAndLosesNothing) {
  ASSERT_TRUE(served_.rig().say("disk full"));
  const Result<Json> job = solve();
  ASSERT_FALSE(job);
  EXPECT_THAT(job.error().message(), HasSubstr("No space left"));
  EXPECT_EQ(served_.client().get("/api/v1/jobs")->at("jobs").size(), 2u) << "what is refused does not wait";
  const Result<Json> tagged = tag();
  ASSERT_FALSE(tagged);
  EXPECT_THAT(tagged.error().message(), HasSubstr("No space left"));
  const Result<Session> session = read_session(served_.rig().folder() / "scans" / "cloth.weft");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->shots.size(), 13u);
  const Result<Json> page = served_.client().get("/api/v1/sessions?query=satin");
  ASSERT_TRUE(page) << page.error().message();
  EXPECT_EQ(page->at("total"), 1) << "what is known is still found";
  EXPECT_EQ(served_.client().get("/api/v1/sessions?tag=red")->at("total"), 0);

  ASSERT_TRUE(served_.rig().say("disk room"));
  ASSERT_TRUE(tag());
  EXPECT_EQ(served_.client().get("/api/v1/sessions?tag=red")->at("total"), 1);
  ASSERT_TRUE(solve()) << "the same request, once there is room";
  EXPECT_TRUE(comes("/api/v1/jobs", [](const Json& all) {
    return all["jobs"].size() == 3 && all["jobs"][0]["state"] == "done" && all["jobs"][1]["state"] == "done";
  }));
  served_.kill_daemon();
  ASSERT_TRUE(served_.serve());
  EXPECT_EQ(served_.client().get("/api/v1/jobs")->at("jobs").size(), 3u) << "after a restart too";
}

}  // namespace
}  // namespace weft::bench
