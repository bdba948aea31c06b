// SPDX-License-Identifier: Apache-2.0
#include "tests/system/workspace.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "core/base/files.h"

namespace weft::test {

namespace fs = std::filesystem;

Workspace::Workspace() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name =
      std::string("weft_") + test->test_suite_name() + "_" + test->name() + "_" + std::to_string(getpid());
  for (char& c : name) c = c == '/' ? '_' : c;
  path_ = fs::path(testing::TempDir()) / name;
  fs::remove_all(path_);
  fs::create_directories(path_);
}

Workspace::~Workspace() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

void put_bytes(const fs::path& file, std::string_view bytes) {
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  EXPECT_TRUE(out) << file;
}

void edit_json(const fs::path& file, const std::function<void(Json&)>& change) {
  Json document = Json::parse(bytes_of(file));
  change(document);
  put_bytes(file, document.dump(2));
}

std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  constexpr auto kEnterWhatMayBe = fs::directory_options::skip_permission_denied;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, kEnterWhatMayBe)) {
    const Result<std::string> digest =
        entry.is_directory() ? std::string("folder") : sha256_of_file(entry.path());
    contents[fs::relative(entry.path(), folder).string()] = digest ? *digest : digest.error().why;
  }
  return contents;
}

namespace {

/// "+ path" for what is new, "- path" for what is gone, "* path" for what has changed.
std::vector<std::string> changes(const std::map<std::string, std::string>& before,
                                 const std::map<std::string, std::string>& after) {
  std::vector<std::string> changes;
  for (const auto& [path, digest] : after) {
    const auto was = before.find(path);
    if (was == before.end()) {
      changes.push_back("+ " + path);
    } else if (was->second != digest) {
      changes.push_back("* " + path);
    }
  }
  for (const auto& [path, digest] : before) {
    if (after.count(path) == 0) changes.push_back("- " + path);
  }
  return changes;
}

}  // namespace

void expect_refusal(const Workspace& workspace, const std::vector<std::string>& arguments, int exit_code,
                    const std::vector<std::string>& words, const RunOptions& options) {
  const auto before = contents_of(workspace.path());
  const Outcome run = run_weft(arguments, options);
  EXPECT_EQ(run.exit_code, exit_code) << run.error;
  for (const std::string& word : words) EXPECT_THAT(run.error, testing::HasSubstr(word));
  EXPECT_EQ(run.output, "");
  EXPECT_THAT(changes(before, contents_of(workspace.path())), testing::IsEmpty()) << run.error;
}

}  // namespace weft::test
