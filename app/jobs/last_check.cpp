// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/last_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 2;

std::optional<LastCheck> read_result(const fs::path& folder, const std::string& calibration) {
  const Result<Json> result = read_json(folder / kCheckResultFile, kCheckResultSchema, 1);
  if (!result) return std::nullopt;
  JsonFields fields(*result, folder.string());
  LastCheck check = {folder, fields.text("date"), false, {}, {}, {}};
  const std::string of = fields.text("calibration");
  const Json passed = result->value("passed", Json());
  JsonFields numbers(fields.object("numbers"), folder.string());
  check.mean_deg = numbers.optional_number("cost_mean_deg");
  check.worst_deg = numbers.optional_number("cost_worst_deg");
  if (!fields.status() || !passed.is_boolean() || of != calibration) return std::nullopt;
  check.passed = passed.get<bool>();
  return check;
}

}  // namespace

std::optional<LastCheck> last_check_of(const fs::path& calibration, const std::string& id) {
  std::optional<LastCheck> last;
  std::string passed_last;
  std::error_code failed;
  fs::recursive_directory_iterator walk(absolute_folder(calibration).parent_path(),
                                        fs::directory_options::skip_permission_denied, failed);
  for (; !failed && walk != fs::recursive_directory_iterator(); walk.increment(failed)) {
    std::error_code ignored;
    if (!walk->is_directory(ignored)) continue;
    if (walk.depth() + 1 >= kDeepest || is_there(walk->path() / "session.json"))
      walk.disable_recursion_pending();
    std::optional<LastCheck> check = read_result(walk->path(), id);
    if (check && check->passed) passed_last = std::max(passed_last, check->date);
    if (check && (!last || check->date > last->date)) last = std::move(check);
  }
  if (last) last->passed_last = passed_last;
  return last;
}

Error moved_since(const LastCheck& check, std::string remedy) {
  const std::string cost =
      check.mean_deg && check.worst_deg
          ? fmt::format("normals would be off by {:.2g} degrees on average, {:.2g} at worst", *check.mean_deg,
                        *check.worst_deg)
          : "how far normals would be off it could not tell";
  return {ErrorKind::kBadData, "the rig has moved since it was calibrated", check.folder.string(),
          fmt::format("the check of {} did not pass: {}", check.date, cost), std::move(remedy)};
}

Json accepted_moved(const LastCheck& check, const std::string& why) {
  return {
      {"why", why}, {"degrees", check.mean_deg ? Json(*check.mean_deg) : Json()}, {"checked", check.date}};
}

}  // namespace weft::app
