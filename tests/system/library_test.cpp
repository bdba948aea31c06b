// SPDX-License-Identifier: Apache-2.0
// The library as a person uses it: found, tagged, undone, pruned.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

using testing::AllOf, testing::HasSubstr, testing::Not;

class Library : public SessionTest {
 protected:
  Library() {
    setenv("XDG_CACHE_HOME", (work_ / "cache").c_str(), 1);
    setenv("XDG_STATE_HOME", (work_ / "state").c_str(), 1);
    setenv("WEFT_LIBRARY", work_.path().c_str(), 1);
  }
  ~Library() override {
    for (const char* name : {"XDG_CACHE_HOME", "XDG_STATE_HOME", "WEFT_LIBRARY"}) unsetenv(name);
  }
  static Outcome library(std::vector<std::string> words) {
    words.insert(words.begin(), "library");
    words.emplace_back("--json");
    return run_weft(words);
  }
  static std::vector<std::string> found(std::vector<std::string> words) {
    words.insert(words.begin(), "find");
    std::vector<std::string> names;
    const Json page = library(words).json();
    for (const Json& session : page["sessions"]) names.push_back(session["name"]);
    return names;
  }
};

using Names = std::vector<std::string>;

TEST_F(Library, FindsASessionByATagThatWasGivenUndoneAndGivenAgain) {
  EXPECT_EQ(found({"--tag", "autumn"}), Names{});
  ASSERT_EQ(library({"tag", "cloth", "--add", "autumn,red", "--set", "id=4006381333931"}).exit_code, 0);
  EXPECT_EQ(found({"--tag", "autumn"}), Names{"cloth"});
  EXPECT_EQ(found({"--id", "4006381333931"}), Names{"cloth"});
  ASSERT_EQ(library({"undo"}).exit_code, 0);
  EXPECT_EQ(found({"--tag", "autumn"}), Names{});
  EXPECT_EQ(library({"undo"}).exit_code, 64) << "there is nothing more";
  ASSERT_EQ(library({"redo"}).exit_code, 0);
  EXPECT_EQ(found({"autumn", "red"}), Names{"cloth"});
}

TEST_F(Library, LeavesAShotOutOfSolvesUntilItIsTakenBack) {
  const Json before = run_weft({"solve", session_.string(), "-q", "--json"}).json();
  ASSERT_EQ(library({"tag", "cloth", "--set", "left_out=2"}).exit_code, 0);
  const Outcome without = run_weft({"solve", session_.string(), "-q", "--json"});
  ASSERT_EQ(without.exit_code, 0) << without.error;
  EXPECT_NE(without.json()["id"], before["id"]);
  ASSERT_EQ(library({"undo"}).exit_code, 0);
  EXPECT_EQ(run_weft({"solve", session_.string(), "-q", "--json"}).json()["id"], before["id"]);
}

TEST_F(Library, ChangesNoSolveWithWhatIsSaidOfACloth) {
  const Outcome before = run_weft({"solve", session_.string(), "-q", "--json"});
  ASSERT_EQ(library({"tag", "cloth", "--set", "fabric=<b>new</b>", "--add", "=cmd|' /C calc'!A0"}).exit_code,
            0);
  const Outcome after = run_weft({"solve", session_.string(), "-q", "--json"});
  EXPECT_EQ(after.json()["id"], before.json()["id"]);
  EXPECT_EQ(library({"show", "cloth"}).json()["current_solve"], before.json()["id"]);
}

TEST_F(Library, ShowsWhatWouldSteerATerminalAsWords) {
  const fs::path session = session_.parent_path() / "b\xff\x1b[31m\n.weft";
  fs::copy(session_, session, fs::copy_options::recursive);
  Json document = *read_json(session / "session.json", "weft.session", 1);
  document["fabric"] = "<script>\x1b[2J\n../../a =cmd|calc, \"" + std::string(10'000, 'y');
  document["metadata"] = {{"tags", {"<b>", "=cmd", "../red"}}, {"notes", "a\nb"}};
  ASSERT_TRUE(write_json(session / "session.json", document));

  const std::string listed = run_weft({"library", "find"}).output;
  EXPECT_THAT(listed, AllOf(Not(HasSubstr("\x1b")), HasSubstr("<script>"), HasSubstr("2 of 2 sessions")));
  EXPECT_EQ(std::ranges::count(listed, '\n'), 3) << "a line a session: " << listed;
  EXPECT_LT(listed.size(), 500U) << "long texts are cut";
  EXPECT_EQ(library({"find"}).json()["total"], 2) << "JSON although the name is no UTF-8";
  EXPECT_EQ(run_weft({"library", "list"}).output, listed) << "as find was also called";
  EXPECT_THAT(run_weft({"library", "--help"}).output, Not(HasSubstr("list")));

  const Outcome solved = run_weft({"solve", session.string(), "--json"});
  ASSERT_EQ(solved.exit_code, 0) << solved.error;
  EXPECT_THAT(solved.error, Not(HasSubstr("\x1b")));
  for (const fs::directory_entry& solve : fs::directory_iterator(session / "solve")) {
    const std::string page = bytes_of(solve.path() / "report.html");
    const std::size_t data = page.find("<script type"), drawing = page.find("<script>", data);
    EXPECT_EQ(page.find("<script"), data);
    EXPECT_EQ(page.find("<script", data + 1), drawing);
    EXPECT_EQ(page.find("<script", drawing + 1), std::string::npos);
  }
  const Outcome missing = run_weft({"solve", "nothing\x1b[31m"});
  EXPECT_EQ(missing.exit_code, 66);
  EXPECT_THAT(missing.error, Not(HasSubstr("\x1b")));
}

TEST_F(Library, ListsWhatItWouldPruneAndPrunesOnRequestAlone) {
  for (const char* level : {"preview", "fast", "standard"})
    ASSERT_EQ(run_weft({"solve", session_.string(), "-q", "--quality", level}).exit_code, 0);
  const Json listed = library({"prune"}).json();
  EXPECT_EQ(listed["solves"].size(), 2U) << "the last is the current one, and the newest";
  EXPECT_GT(listed["bytes"], 0);
  EXPECT_EQ(library({"show", "cloth"}).json()["solves"], 3);
  EXPECT_EQ(library({"prune", "--yes"}).json()["bytes"], listed["bytes"]);
  EXPECT_EQ(library({"show", "cloth"}).json()["solves"], 1);
}

TEST_F(Library, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(library({"show", "nothing"}).exit_code, 66);
  EXPECT_EQ(library({"tag", "cloth", "--set", "side=left"}).exit_code, 64);
  EXPECT_EQ(library({"tag", "cloth", "--set", "shots=none"}).exit_code, 64);
  EXPECT_EQ(library({"tag", "cloth", "--set", "current_solve=0000000000000000"}).exit_code, 66);
  EXPECT_EQ(library({"tag", "cloth.weft", "--add", "red"}).exit_code, 0) << "a folder's name is one";
  EXPECT_EQ(library({"tag", session_.string(), "--add", "blue"}).exit_code, 0) << "and the folder itself";
  EXPECT_EQ(library({"tag", "other.weft", "--add", "blue"}).exit_code, 66);
  EXPECT_EQ(library({"find", "--limit", "0"}).exit_code, 64);
}

}  // namespace
}  // namespace weft::test
