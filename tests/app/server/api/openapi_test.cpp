// SPDX-License-Identifier: Apache-2.0
// The OpenAPI file, put together from the parts in app/server/api, against the running daemon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "app/server/api/bodies/batch_place.h"
#include "app/server/http/error_reply.h"
#include "core/base/files.h"
#include "core/base/sha256.h"
#include "exchange/presets/export_facts.h"
#include "tests/app/server/api/json_schema.h"
#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"
#include "tests/library/batch/sample_plan.h"
#include "virtual_rig/control_socket.h"

namespace weft::app {
namespace {

using std::chrono::seconds;
using testing::IsEmpty;

TEST(JsonSchema, FindsWhatDoesNotFit) {
  const Json document = {{"defs", {{"Led", {{"type", "integer"}, {"minimum", 1}}}}}};
  const Json schema = {{"type", "object"},
                       {"required", Json::array({"led"})},
                       {"additionalProperties", false},
                       {"properties",
                        {{"led", {{"$ref", "#/defs/Led"}}},
                         {"role", {{"type", "string"}, {"enum", {"lit", "dark"}}}},
                         {"why", {{"type", "string"}, {"nullable", true}}},
                         {"bins", {{"type", "array"}, {"items", {{"type", "number"}}}}}}}};
  const auto found = [&](const char* text) { return misfits(Json::parse(text), schema, document); };
  EXPECT_THAT(found(R"({"led": 2, "role": "lit", "why": null, "bins": [1, 2.5]})"), IsEmpty());
  for (const char* wrong :
       {R"({})", R"([])", R"({"led": 0})", R"({"led": 1.5})", R"({"led": 1, "role": "red"})",
        R"({"led": 1, "role": null})", R"({"led": 1, "bins": ["a"]})", R"({"led": 1, "x": 1})"}) {
    EXPECT_EQ(found(wrong).size(), 1U) << wrong;
  }
  EXPECT_EQ(misfits(1, {{"type", "integer"}, {"oneOf", Json::array()}}, document).size(), 1U);
}

/// A daemon with a finished session "done", an unfinished one, and its own description.
class OpenApi : public testing::Test {
 protected:
  void SetUp() override {
    scripted_.before = [this](int frame) -> Result<void> {
      if (frame == 2 && holding_) gate_.pass();
      return {};
    };
    scripted_.refuse = {2, 2, ShotRole::kLit, {}, {"swapped", 0.9, 0.2}, "LED 2 lights where LED 3 should"};
    HttpLimits limits;
    limits.heartbeat_s = 0.3;
    server_ = scripted_.started(limits);
    port_ = server_->port();
    document_ = ask(port_, "GET", "/api/v1/openapi.json").json();
    ASSERT_EQ(ask(port_, "POST", "/api/v1/scan", R"({"fabric": "satin", "session": "done"})").status, 202);
    wait_for_state(port_, "idle");
    scripted_.leave_unfinished("left");
  }
  void TearDown() override { gate_.open(); }

  const Json& operation(const std::string& method, const std::string& path) const {
    std::string lower = method;
    std::ranges::transform(lower, lower.begin(), [](char c) { return static_cast<char>(c | 0x20); });
    return document_.at("paths").at(path).at(lower);
  }

  /// Asks, and holds the answer against what the file says of this call.
  Answer conforming(const std::string& method, const std::string& path, const std::string& target,
                    const std::string& body = "", const HeaderLines& headers = {}) {
    SCOPED_TRACE(method + " " + target + " " + body);
    const Answer answer = ask(port_, method, target, body, headers);
    const Json& responses = operation(method, path).at("responses");
    const std::string status = std::to_string(answer.status);
    if (!responses.contains(status)) {
      ADD_FAILURE() << status << " is not described: " << answer.body;
      return answer;
    }
    const Json& described = followed(responses[status], document_);
    if (!described.contains("content")) {
      EXPECT_EQ(answer.body, "");
      return answer;
    }
    const Json& content = described.at("content");
    const std::string type = content.begin().key();
    EXPECT_THAT(answer.head, testing::HasSubstr("Content-Type: " + type));
    if (type == "application/json") {
      EXPECT_THAT(misfits(answer.json(), content[type]["schema"], document_), IsEmpty()) << answer.body;
    }
    return answer;
  }

  /// Holds each event against its schema; how many there are of each name.
  std::map<std::string, int> conforming_events(const std::string& heard) const {
    const Json& schemas = operation("GET", "/api/v1/events").at("responses").at("200").at("x-events");
    std::map<std::string, int> told;
    for (std::size_t at = heard.find("event: "); at != heard.npos; at = heard.find("event: ", at + 1)) {
      const std::string name = heard.substr(at + 7, heard.find('\n', at) - at - 7);
      const std::size_t data = heard.find("data: ", at) + 6, end = heard.find('\n', data);
      if (end == heard.npos) break;
      const Json event = Json::parse(heard.substr(data, end - data), nullptr, false);
      ++told[name];
      if (!schemas.contains(name)) {
        ADD_FAILURE() << name << " is not described";
        continue;
      }
      EXPECT_THAT(misfits(event, schemas[name], document_), IsEmpty()) << event;
    }
    return told;
  }

  ScriptedRig scripted_{"openapi"};
  bool holding_ = false;
  Gate gate_;
  std::unique_ptr<RigServer> server_;
  int port_ = 0;
  Json document_;
};

TEST_F(OpenApi, NamesEveryCallAndNoOther) {
  std::vector<std::string> described;
  for (const auto& [path, operations] : document_["paths"].items()) {
    for (const auto& [method, operation] : operations.items()) {
      std::string upper = method;
      std::ranges::transform(upper, upper.begin(), [](char c) { return static_cast<char>(c & ~0x20); });
      described.push_back(upper + " " + path);
      EXPECT_TRUE(operation.contains("summary")) << path;
    }
  }
  EXPECT_THAT(described, testing::UnorderedElementsAreArray(server_->calls()));
}

TEST_F(OpenApi, DescribesEveryAnswerOfEveryCall) {
  const std::string session = "/api/v1/sessions/{name}", frame = session + "/frames/{index}";
  const std::string here = "/api/v1/sessions/done", first = here + "/frames/0";
  for (const char* path : {"/api/v1/healthz", "/api/v1/openapi.json", "/api/v1/rig", "/api/v1/sessions"}) {
    EXPECT_EQ(conforming("GET", path, path).status, 200);
  }
  EXPECT_EQ(conforming("GET", "/api/v1/next-name", "/api/v1/next-name?fabric=blue%20wool").status, 200);
  EXPECT_EQ(conforming("GET", session, here).status, 200);
  EXPECT_EQ(conforming("GET", session, "/api/v1/sessions/none").status, 404);
  EXPECT_EQ(conforming("GET", session, "/api/v1/sessions/.none").status, 400);
  for (const char* what : {"/thumbnail", "/histogram", "/raw"}) {
    EXPECT_EQ(conforming("GET", frame + what, first + what).status, 200);
    EXPECT_EQ(conforming("GET", frame + what, here + "/frames/77" + what).status, 404);
    EXPECT_EQ(conforming("GET", frame + what, here + "/frames/x" + what).status, 400);
  }
  const Json kept = conforming("GET", session, here).json()["frames"][0];
  EXPECT_EQ(kept["histogram"].is_object(), true);
  const std::string digest = kept["sha256"];
  EXPECT_EQ(conforming("GET", frame + "/thumbnail", kept["thumbnail"], "",
                       {{"If-None-Match", "\"thumbnail-" + digest + "\""}})
                .status,
            304);
  const std::string raw = kept["raw"];
  EXPECT_EQ(sha256_of(conforming("GET", frame + "/raw", raw).body), digest);
  EXPECT_EQ(conforming("GET", frame + "/raw", raw, "", {{"Range", "bytes=0-9"}}).status, 206);
  EXPECT_EQ(conforming("GET", frame + "/raw", raw, "", {{"Range", "bytes=999999999-"}}).status, 416);
  EXPECT_EQ(conforming("GET", frame + "/raw", raw, "", {{"If-None-Match", '"' + digest + '"'}}).status, 304);
  for (const char* what : {"/thumbnail", "/raw"}) {
    EXPECT_EQ(conforming("GET", frame + what, first + what + "?sha256=" + std::string(64, '0')).status, 404);
    EXPECT_THAT(ask(port_, "GET", first + what).head, testing::HasSubstr("private, no-cache"));
    EXPECT_THAT(ask(port_, "GET", first + what + "?sha256=" + digest).head, testing::HasSubstr("immutable"));
  }

  const Session left = read_session(scripted_.session("left")).value();
  std::filesystem::resize_file(left.path_of(left.shots[0]), 100);
  std::error_code still_written_to;
  std::filesystem::remove_all(scripted_.rig.daemon.state / "pictures", still_written_to);
  EXPECT_EQ(conforming("GET", frame + "/thumbnail", "/api/v1/sessions/left/frames/0/thumbnail").status, 422);

  EXPECT_EQ(conforming("POST", "/api/v1/login", "/api/v1/login", R"({"token": "any"})").status, 200);
  EXPECT_EQ(conforming("POST", "/api/v1/login", "/api/v1/login", "{}").status, 400);
  EXPECT_EQ(conforming("POST", "/api/v1/logout", "/api/v1/logout").status, 200);

  holding_ = true;
  const char* const scan = "/api/v1/scan";
  EXPECT_EQ(conforming("POST", scan, scan, "{}").status, 400);
  EXPECT_EQ(conforming("POST", scan, scan, std::string(70000, ' ')).status, 413);
  EXPECT_EQ(conforming("POST", scan, scan, R"({"fabric": "a", "session": "done"})").status, 409);
  for (const char* step : {"/api/v1/scan/pause", "/api/v1/scan/resume", "/api/v1/scan/cancel"}) {
    EXPECT_EQ(conforming("POST", step, step, "[]").status, 400);
  }
  EXPECT_EQ(conforming("POST", "/api/v1/scan/pause", "/api/v1/scan/pause").status, 409);
  EXPECT_EQ(conforming("POST", scan, scan, R"({"fabric": "wool", "dry_run": true})").status, 200);
  const char* const price = "/api/v1/scan/price";
  EXPECT_EQ(conforming("POST", price, price, "{}").json()["rows"][0]["asked"], true);
  EXPECT_EQ(conforming("POST", price, price, R"({"to_deg": 0.001})").status, 400);
  EXPECT_EQ(conforming("POST", scan, scan, R"({"fabric": "wool"})").status, 202);
  EXPECT_EQ(conforming("POST", scan, scan, R"({"fabric": "wool"})").status, 409);
  for (const char* step : {"/api/v1/scan/pause", "/api/v1/scan/resume", "/api/v1/scan/cancel"}) {
    EXPECT_EQ(conforming("POST", step, step, "{}").status, 202);
  }
  gate_.open();
  wait_for_state(port_, "idle");
}

TEST_F(OpenApi, DescribesTheMachine) {
  const Json version = conforming("GET", "/api/v1/version", "/api/v1/version").json();
  EXPECT_EQ(version["camera"]["serial"], "SN-0042") << "of the scan before";
  EXPECT_EQ(version["firmware_protocol"], 1);

  const std::string log = "/api/v1/log";
  const Json whole = conforming("GET", log, log).json();
  EXPECT_EQ(whole["lines"][0]["event"], "daemon_began");
  EXPECT_EQ(whole["lines"].back()["event"], "scan_complete");
  EXPECT_EQ(whole["after"], Json());
  const Json first = conforming("GET", log, log + "?after=0&limit=2").json();
  ASSERT_EQ(first["lines"].size(), 2U);
  EXPECT_EQ(first["after"], first["lines"][1]["number"]);
  const Json next = conforming("GET", log, log + "?after=" + first["after"].dump()).json();
  EXPECT_EQ(next["lines"].size(), whole["lines"].size() - 2);
  for (const char* wrong : {"?after=-1", "?after=x", "?limit=0", "?limit=9x"})
    EXPECT_EQ(conforming("GET", log, log + wrong).status, 400) << wrong;

  const Json disk = conforming("GET", "/api/v1/disk", "/api/v1/disk").json();
  EXPECT_EQ(disk["sessions"]["folder"], scripted_.rig.scan.sessions.string());
  EXPECT_EQ(disk["copy"], Json());
  EXPECT_EQ(disk["state"]["scans_left"], disk["state"]["free_bytes"].get<std::uint64_t>() / 396'000'000);

  const auto part = [](const Json& doctor, const std::string& name) {
    for (const Json& finding : doctor["findings"]) {
      if (finding["part"] == name) return finding;
    }
    return Json();
  };
  Json doctor = conforming("GET", "/api/v1/doctor", "/api/v1/doctor").json();
  EXPECT_EQ(doctor["leaves_alone"], false);
  EXPECT_EQ(part(doctor, "board")["verdict"], "fault") << "there is none here";
  EXPECT_EQ(part(doctor, "calibration")["verdict"], "warning");
  holding_ = true;
  ASSERT_EQ(ask(port_, "POST", "/api/v1/scan", R"({"fabric": "wool"})").status, 202);
  wait_for_state(port_, "scanning");
  doctor = conforming("GET", "/api/v1/doctor", "/api/v1/doctor").json();
  EXPECT_EQ(doctor["leaves_alone"], true);
  EXPECT_EQ(part(doctor, "board"), Json());
  EXPECT_NE(part(doctor, "disk"), Json());
  gate_.open();
  wait_for_state(port_, "idle");
}

TEST_F(OpenApi, DescribesJobs) {
  const std::string jobs = "/api/v1/jobs", job = jobs + "/{id}";
  EXPECT_EQ(conforming("GET", jobs, jobs).json()["jobs"], Json::array());
  for (const char* wrong :
       {"{}", R"({"kind": "solve"})", R"({"kind": "bake", "session": "done"})",
        R"({"kind": "solve", "session": "done", "quality": "--help"})",
        R"({"kind": "solve", "session": "../done"})", R"({"kind": "solve", "session": "done", "threads": 1})",
        R"({"kind": "solve", "session": "done", "within_s": "soon"})"}) {
    EXPECT_EQ(conforming("POST", jobs, jobs, wrong).status, 400) << wrong;
  }
  EXPECT_EQ(conforming("POST", jobs, jobs, R"({"kind": "solve", "session": "none"})").status, 404);
  EXPECT_EQ(conforming("POST", jobs, jobs, R"({"kind": "check", "input": "none"})").status, 404);

  const char* body = R"({"kind": "solve", "session": "done", "quality": "fast", "request_id": "a"})";
  const Answer asked = conforming("POST", jobs, jobs, body);
  ASSERT_EQ(asked.status, 202) << asked.body;
  const std::string id = asked.json()["id"], here = jobs + "/" + id;
  EXPECT_EQ(conforming("POST", jobs, jobs, body).json()["id"], id) << "the same request";
  EXPECT_EQ(conforming("GET", job, here).json()["of"], "done");
  EXPECT_EQ(conforming("GET", jobs, jobs + "?limit=1").json()["jobs"].size(), 1U);
  EXPECT_EQ(conforming("GET", jobs, jobs + "?limit=many").status, 400);
  EXPECT_EQ(conforming("GET", job + "/log", here + "/log").status, 200);
  EXPECT_EQ(conforming("GET", job, jobs + "/000099").status, 404);
  // The scripted frames are no photographs: however it ends, it ends.
  for (int i = 0; i < 3000 && ask(port_, "GET", here).json()["ended"] == ""; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(conforming("GET", job, here).json()["state"], "failed");
  EXPECT_EQ(conforming("POST", job + "/first", here + "/first").status, 400) << "it has ended";
  EXPECT_EQ(conforming("POST", job + "/cancel", here + "/cancel").status, 400);
  EXPECT_EQ(conforming("POST", job + "/retry", here + "/retry").status, 202);
  EXPECT_EQ(conforming("DELETE", job, here).json()["state"], "failed");
  EXPECT_EQ(conforming("DELETE", job, here).status, 404) << "it is forgotten";
  EXPECT_EQ(conforming("GET", job, here).status, 404);
}

TEST_F(OpenApi, DescribesBatches) {
  const std::string batches = "/api/v1/batches", one = batches + "/{name}", here = batches + "/night";
  EXPECT_EQ(conforming("GET", batches, batches).json()["batches"], Json::array());
  for (const char* below : {"", "/report"})
    EXPECT_EQ(conforming("GET", one + below, here + below).status, 404) << below;
  const std::filesystem::path places = scripted_.rig.daemon.state / kBatchFolder;
  ASSERT_TRUE(begin_batch(places, "night", {"/archive/a.weft"}));
  EXPECT_EQ(conforming("GET", one, here).json()["plan"], Json()) << "it is not made";
  library::BatchPlan plan = library::sample_plan(2);
  plan.left_out.push_back({"/archive/b.weft", library::SkipReason::kThere, "", "it is there", 9});
  ASSERT_TRUE(write_file(plan_of_batch(places, "night"), library::text_of(plan)));
  EXPECT_EQ(conforming("GET", batches, batches).json()["batches"].size(), 1U);
  EXPECT_EQ(conforming("GET", one, here).json()["plan"]["jobs"].size(), 2U);
  EXPECT_EQ(conforming("GET", one + "/report", here + "/report").json()["missing"], 2);
  const std::string file = one + "/files/{file}", page = here + "/files/report.html";
  EXPECT_EQ(conforming("GET", file, page).status, 404);
  std::filesystem::create_directories(report_of_batch(places, "night"));
  ASSERT_TRUE(write_file(report_of_batch(places, "night") / "report.html", "<h1>Night</h1>"));
  EXPECT_EQ(ask(port_, "GET", page).status, 200);
  const std::string accept = one + "/accept", accept_here = here + "/accept";
  EXPECT_EQ(conforming("POST", accept, accept_here, R"({"dry_run": true})").json()["left"], 2);
  EXPECT_EQ(conforming("POST", accept, accept_here, R"({"all": true})").status, 400);
  EXPECT_EQ(conforming("DELETE", one, here).status, 200);
  EXPECT_EQ(conforming("DELETE", one, here).status, 404);
}

TEST_F(OpenApi, DescribesTheLibrary) {
  const std::string sessions = "/api/v1/sessions", tags = "/api/v1/library/tags";
  const std::string metadata = "/api/v1/sessions/{name}/metadata";
  const std::string done = "/api/v1/sessions/done/metadata", undo = "/api/v1/undo", redo = "/api/v1/redo";
  EXPECT_EQ(conforming("POST", undo, undo, "{}").status, 400) << "there is nothing yet";
  const Answer changed = conforming("PATCH", metadata, done,
                                    R"({"tags": ["autumn", "<b>"], "weight_g_m2": 210, "revision": 0})");
  EXPECT_EQ(changed.status, 200) << changed.body;
  EXPECT_EQ(changed.json()["words"], "tags: <b>, autumn; weight_g_m2: 210 of done");
  EXPECT_EQ(conforming("POST", metadata, done, R"({"notes": "x", "revision": 0})").status, 409);
  EXPECT_EQ(conforming("POST", metadata, "/api/v1/sessions/none/metadata", R"({"notes": "x"})").status, 404);
  EXPECT_EQ(conforming("POST", metadata, done, R"({"current_solve": "0000000000000000"})").status, 404);
  for (const char* wrong :
       {"{}", R"({"side": "left"})", R"({"shots": []})", R"({"revision": -1, "notes": ""})"})
    EXPECT_EQ(conforming("POST", metadata, done, wrong).status, 400) << wrong;

  const auto found = [&](const std::string& query) {
    return conforming("GET", sessions, sessions + "?" + query).json()["total"];
  };
  EXPECT_EQ(found("tag=autumn"), 1);
  EXPECT_EQ(found("query=autumn%20sat"), 1);
  EXPECT_EQ(found("tag=autumn&from=2000&to=2999"), 1);
  EXPECT_EQ(found("tag=autumn&to=2001"), 0);
  // What others put there is seen within a second.
  for (int i = 0; i < 200 && found("limit=1") != 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(found("limit=1"), 2) << "the unfinished one is another";
  EXPECT_EQ(conforming("GET", sessions, sessions + "?limit=0").status, 400);
  EXPECT_EQ(conforming("GET", sessions, sessions + "?colour=red").status, 400);
  EXPECT_EQ(conforming("GET", tags, tags).json()["tags"].size(), 2U);
  EXPECT_EQ(conforming("POST", undo, undo, "{}").status, 200);
  EXPECT_EQ(found("tag=autumn"), 0);
  EXPECT_EQ(conforming("POST", redo, redo, "{}").status, 200);
  EXPECT_EQ(found("tag=autumn"), 1);
}

TEST_F(OpenApi, DescribesWhatLeaves) {
  const std::string of = "/api/v1/sessions/{name}/exports", here = "/api/v1/sessions/done/exports";
  const std::string file = of + "/{preset}/files/{file}", there = here + "/glb/files/";
  const Json presets = conforming("GET", "/api/v1/presets", "/api/v1/presets").json()["presets"];
  const bool has_glb = std::ranges::any_of(presets, [](const Json& each) { return each["name"] == "glb"; });
  EXPECT_TRUE(has_glb) << presets;
  EXPECT_EQ(conforming("GET", of, here).json()["exports"].size(), 0U);
  EXPECT_EQ(conforming("GET", file, there + "a.glb").status, 404);

  const std::filesystem::path folder = scripted_.session("done") / "export" / "glb";
  std::filesystem::create_directories(folder / "maps");
  ASSERT_TRUE(write_file(folder / "maps" / "a.png", "texels"));
  ASSERT_TRUE(write_file(folder / "secret.txt", "none of theirs"));
  const std::string digest = sha256_of("texels");
  exchange::ExportFacts facts = {.id = "a",
                                 .preset = "glb",
                                 .name = "a",
                                 .title = "a",
                                 .normal = "opengl",
                                 .roughness = "root",
                                 .size = {2, 2}};
  for (const char* name : {"maps/a.png", "../../session.json"}) {
    facts.files.push_back(
        {.file = name, .sha256 = digest, .bytes = 6, .size = {2, 2}, .encoding = "png, 8 bits"});
  }
  ASSERT_TRUE(write_json(folder / "export.json", json_of(facts)));
  const Json listed = conforming("GET", of, here).json()["exports"];
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0]["preset"], "glb");
  EXPECT_EQ(listed[0]["document"]["files"].size(), 2U);
  const Answer texels = conforming("GET", file, there + "maps:a.png");
  EXPECT_EQ(texels.status, 200);
  EXPECT_EQ(texels.body, "texels");
  EXPECT_THAT(texels.head, testing::HasSubstr("attachment; filename=\"a.png\""));
  EXPECT_EQ(conforming("GET", file, there + "maps:a.png", "", {{"If-None-Match", '"' + digest + '"'}}).status,
            304);
  EXPECT_EQ(conforming("GET", file, there + "maps:a.png", "", {{"Range", "bytes=2-3"}}).body, "xe");
  for (const char* other :
       {"secret.txt", "export.json", "..:..:session.json", "..%2F..%2Fsession.json", ".."})
    EXPECT_NE(ask(port_, "GET", there + other).status, 200) << other;
  EXPECT_EQ(conforming("GET", file, here + "/../files/a").status, 404);
}

TEST_F(OpenApi, DescribesMaterials) {
  const std::string of = "/api/v1/materials";
  const Json list = conforming("GET", of, of).json()["materials"];
  const auto cotton =
      std::ranges::find_if(list, [](const Json& each) { return each["key"] == "cloth:cotton"; });
  ASSERT_NE(cotton, list.end()) << list;
  EXPECT_EQ((*cotton)["is_own"], false);
  const Json resolved = conforming("GET", of + "/{name}", of + "/cloth:dark-satin").json();
  EXPECT_EQ(resolved["generations"].size(), 2U) << resolved;
  EXPECT_EQ(conforming("GET", of + "/{name}", of + "/none").status, 404);
  EXPECT_EQ(conforming("GET", of + "/{name}/builds", of + "/cloth:cotton/builds").status, 200);
  const std::string build = of + "/{name}/builds/{id}", none = of + "/cloth:cotton/builds/0";
  EXPECT_EQ(conforming("GET", build, none).status, 404);
  EXPECT_EQ(conforming("GET", build + "/exports", none + "/exports").status, 404);
  EXPECT_EQ(conforming("GET", build + "/pixel", none + "/pixel?x=0&y=0").status, 404);
  EXPECT_EQ(conforming("POST", "/api/v1/jobs", "/api/v1/jobs", R"({"kind": "material", "material": "none"})")
                .status,
            404);
}

/// Clients tell errors apart by these words.
TEST_F(OpenApi, NamesTheCodeOfEveryErrorThatTheServerDecides) {
  const auto code = [&](const std::string& method, const std::string& target, const std::string& body = "",
                        const HeaderLines& headers = {}) {
    return ask(port_, method, target, body, headers).json()["error"].value("code", "");
  };
  const std::string scan = "/api/v1/scan";
  EXPECT_EQ(code("GET", "/api/v1/rig", "", {{"Host", "evil.example"}}), "foreign_host");
  EXPECT_EQ(code("GET", "/api/v1/rig", "", {{"Origin", "http://evil.example"}}), "foreign_page");
  EXPECT_EQ(code("OPTIONS", "/api/v1/rig"), "wrong_method");
  EXPECT_EQ(code("DELETE", "/api/v1/rig"), "wrong_method");
  EXPECT_EQ(code("GET", "/api/v1/none"), "no_such_call");
  EXPECT_EQ(code("GET", "/api/v1/rig", "", {{"Content-Length", "x"}}), "unreadable");
  EXPECT_EQ(code("POST", scan, "{}", {{"Content-Type", "text/plain"}}), "not_json");
  EXPECT_EQ(code("POST", scan, "{}"), "no_fabric");
  EXPECT_EQ(code("POST", scan, R"({"fabric": "a", "session": "done"})"), "session_exists");
  EXPECT_EQ(code("POST", scan + "/pause", "{}"), "no_scan");
  EXPECT_EQ(code("POST", "/api/v1/rig/test-shot", R"({"led": 1, "exposure_us": 1000})"), "devices_closed");
  EXPECT_EQ(code("GET", "/api/v1/rig/test-shots/1"), "no_such_shot");
  EXPECT_EQ(code("POST", "/api/v1/undo", "{}"), "nothing_to_undo");
  EXPECT_EQ(code("GET", "/api/v1/sessions/none"), "no_such_session");
  EXPECT_EQ(code("GET", "/api/v1/sessions/done/frames/77/raw"), "no_such_frame");
  EXPECT_EQ(code("GET", "/api/v1/sessions/done/frames/0/raw", "", {{"Range", "bytes=999999999-"}}),
            "beyond_file");
  EXPECT_EQ(code("GET", "/api/v1/jobs/000099"), "no_such_job");
  EXPECT_EQ(code("PATCH", "/api/v1/sessions/done/metadata", R"({"notes": "x", "revision": 7})"),
            "changed_meanwhile");
  EXPECT_EQ(code("PATCH", "/api/v1/sessions/done/metadata", R"({"side": "left"})"), "") << "of another room";
  holding_ = true;
  ASSERT_EQ(ask(port_, "POST", scan, R"({"fabric": "wool"})").status, 202);
  EXPECT_EQ(code("POST", scan, R"({"fabric": "wool"})"), "rig_busy");
  ASSERT_EQ(ask(port_, "POST", "/api/v1/control", R"({"name": "Ann"})").status, 200);
  EXPECT_EQ(code("POST", scan + "/cancel", "{}"), "controls_held");
  gate_.open();
  wait_for_state(port_, "idle");
}

TEST_F(OpenApi, DescribesWhatARigThatIsNotThereCanBeTold) {
  const std::string here = "/api/v1/rig/virtual";
  const auto asked = [&](const char* body) { return conforming("POST", here, here, body); };
  EXPECT_EQ(conforming("GET", "/api/v1/rig", "/api/v1/rig").json()["virtual"], false);
  EXPECT_EQ(conforming("GET", here, here).json()["error"]["code"], "rig_is_real");
  EXPECT_EQ(asked(R"({"line": "board unplug"})").status, 404);

  server_.reset();
  scripted_.rig.daemon.virtual_control = scripted_.rig.file.parent_path() / "control";
  server_ = scripted_.started();
  port_ = server_->port();
  EXPECT_EQ(conforming("GET", "/api/v1/rig", "/api/v1/rig").json()["virtual"], true);
  EXPECT_EQ(conforming("GET", here, here).status, 503) << "nobody plays it";
  const auto rig = virtual_rig::ControlSocket::listen(
      scripted_.rig.daemon.virtual_control, [](const std::string& line) -> std::string {
        if (line == "status") return R"({"shots": 3})";
        if (line == "commands") return R"([{"line": "board NAME", "does": "it", "example": "board unplug"}])";
        return line == "board unplug" ? "ok" : "error: no such command";
      });
  ASSERT_TRUE(rig) << rig.error().message();
  const Json told = conforming("GET", here, here).json();
  EXPECT_EQ(told["status"]["shots"], 3);
  EXPECT_EQ(told["lines"][0]["example"], "board unplug");
  EXPECT_EQ(asked(R"({"line": "board unplug"})").json()["said"], "ok");
  for (const char* wrong : {"{}", R"({"line": 1})", R"({"line": ""})", R"({"line": "board x"})",
                            R"({"line": "table cloth /etc/passwd"})", R"({"line": "board unplug\nend"})"}) {
    EXPECT_EQ(asked(wrong).status, 400) << wrong;
  }
  ASSERT_EQ(ask(port_, "POST", "/api/v1/control", R"({"name": "Ann"})").status, 200);
  EXPECT_EQ(asked(R"({"line": "board unplug"})").status, 409);
}

TEST_F(OpenApi, DescribesHowEachCallIsGuarded) {
  for (const std::string& call : server_->calls()) {
    const std::string method = call.substr(0, call.find(' ')), path = call.substr(call.find(' ') + 1);
    std::string target = path;
    if (const auto at = target.find("{name}"); at != target.npos) target.replace(at, 6, "done");
    if (const auto at = target.find("{id}"); at != target.npos) target.replace(at, 4, "000001");
    if (const auto at = target.find("{index}"); at != target.npos) target.replace(at, 7, "0");
    EXPECT_EQ(conforming(method, path, target, "", {{"Host", "evil.example"}}).status, 421);
    EXPECT_EQ(conforming(method, path, target, "", {{"Origin", "http://evil.example"}}).status, 403);
    EXPECT_EQ(conforming(method, path, target, "", {{"Content-Length", "x"}}).status, 400);
    if (method == "POST" || method == "PATCH") {
      EXPECT_EQ(conforming(method, path, target, "", {{"Content-Type", "text/plain"}}).status, 415);
    }
  }
}

TEST_F(OpenApi, DescribesItsEvents) {
  RawClient greeted(port_);
  greeted.say(request_text(port_, "GET", "/api/v1/events"));
  const std::string greeting = greeted.hear(seconds(5), "event: ");
  const std::size_t boot = greeting.find("id: ") + 4;
  const std::string first = greeting.substr(boot, greeting.find('.', boot) - boot) + ".0";
  RawClient follower(port_);
  follower.say(request_text(port_, "GET", "/api/v1/events", "", {{"Last-Event-ID", first}}));
  const std::string heard = follower.hear(seconds(5), "\"phase\":\"complete\"");
  EXPECT_THAT(heard, testing::HasSubstr("Content-Type: text/event-stream"));
  const std::map<std::string, int> told = conforming_events(heard);
  EXPECT_EQ(told.at("frame"), 5) << "four that are kept and one that is refused";
  EXPECT_GE(told.at("status"), 5);

  RawClient stranger(port_);
  stranger.say(request_text(port_, "GET", "/api/v1/events", "", {{"Last-Event-ID", "1.1"}}));
  const std::map<std::string, int> late =
      conforming_events(stranger.hear(seconds(5), "event: heartbeat") + stranger.hear(seconds(5), "\n\n"));
  EXPECT_EQ(late.at("gap"), 1);
  EXPECT_EQ(late.at("status"), 1);
  EXPECT_GE(late.at("heartbeat"), 1);

  ASSERT_EQ(ask(port_, "POST", "/api/v1/control", R"({"name": "Ann"})").status, 200);
  EXPECT_EQ(conforming_events(greeted.hear(seconds(5), "\"Ann\"}") + greeted.hear(seconds(5), "\n\n"))
                .at("control"),
            1);
  ASSERT_EQ(ask(port_, "POST", "/api/v1/jobs", R"({"kind": "price", "session": "done"})").status, 202);
  EXPECT_GE(
      conforming_events(greeted.hear(seconds(5), "\"kind\":\"price\"") + greeted.hear(seconds(5), "\n\n"))
          .at("job"),
      1);
}

/// Fields of the request that the file names are those that the daemon takes.
TEST_F(OpenApi, DescribesEveryFieldOfARequest) {
  holding_ = true;
  for (const auto& [field, schema] :
       document_["components"]["schemas"]["ScanRequest"]["properties"].items()) {
    const Json body = {{field, nullptr}};
    const Answer answer = ask(port_, "POST", "/api/v1/scan", body.dump());
    EXPECT_EQ(answer.status, 400) << answer.body;
    EXPECT_EQ(answer.json()["error"]["where"], "fabric")
        << field << " is known, and what is missing is the fabric";
  }
  EXPECT_EQ(ask(port_, "POST", "/api/v1/scan", R"({"colour": 1})").json()["error"]["where"], "colour");
}

}  // namespace
}  // namespace weft::app
