// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "core/base/temporary_folder.h"
#include "core/solve/solve.h"
#include "tests/system/batch_test.h"
#include "tests/system/samples.h"

namespace weft::test {

namespace fs = std::filesystem;

fs::path simulated_session(int number) {
  static const TemporaryFolder folder;
  const fs::path session = folder.path() / fmt::format("cloth-{}.weft", number);
  if (!fs::exists(session)) {
    simulator::Scene scene = scene_named("golden", {160, 128});
    scene.seed += number;
    scene.fabric = fmt::format("twill {}", number);
    simulate(scene, session);
    // A truth is what no archive has.
    fs::remove_all(session / "truth");
  }
  return session;
}

fs::path BatchTest::session(int number) const {
  return archive() / fmt::format("cloth-{}.weft", number);
}

void BatchTest::fill_archive(int sessions) {
  fs::create_directories(archive());
  for (int i = 0; i < sessions; ++i) fs::copy(simulated_session(i), session(i), fs::copy_options::recursive);
}

Json BatchTest::plan(const std::vector<std::string>& more) const {
  std::vector<std::string> arguments = {"batch",  "plan", archive().string(), "-o", plan_file().string(),
                                        "--json", "-q"};
  if (std::ranges::find(more, "--sample") == more.end()) arguments.insert(arguments.end(), {"--sample", "0"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run_weft(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  return outcome.exit_code == 0 ? outcome.json() : Json::object();
}

Outcome BatchTest::run(const std::vector<std::string>& more, const RunOptions& options) const {
  std::vector<std::string> arguments = {"batch", "run", plan_file().string(), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_weft(arguments, options);
}

Outcome BatchTest::merge() const {
  return run_weft({"batch", "merge", plan_file().string(), "--json", "-q"});
}

Json BatchTest::report() const {
  return Json::parse(bytes_of(work_ / "night.results" / "report" / "report.json"));
}

std::vector<std::string> BatchTest::solves_of(const fs::path& session) {
  std::vector<std::string> ids;
  for (const Product& solve : list_solves(session)) ids.push_back(solve.id);
  return ids;
}

std::vector<std::string> BatchTest::half_made() const {
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(archive())) {
    if (entry.path().extension() == ".partial") found.push_back(entry.path().string());
  }
  return found;
}

}  // namespace weft::test
