// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/last_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/field_json.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 2;

std::optional<LastCheck> read_result(const fs::path& folder, const std::string& calibration) {
  const Result<CheckResult> result = read_check_result(folder);
  if (!result || result->calibration != calibration) return std::nullopt;
  Result<CheckCost> cost = read_fields<CheckCost>(result->numbers, folder.string());
  if (!cost) return std::nullopt;
  return LastCheck{folder, result->date, result->passed, *cost, {}};
}

}  // namespace

void describe(Fields& fields, CheckResult& r) {
  fields.value({"date", "Of the evidence, ISO 8601", {}, kMustSay}, r.date);
  fields.value({"of", "sheets or session: what was looked at"}, r.of);
  fields.value({"rig", "Its name"}, r.rig);
  fields.value({"calibration", "Id of the one that was checked", {}, kMustSay}, r.calibration);
  fields.value({"passed", "The rig is as it was calibrated", {}, kMustSay}, r.passed);
  fields.value({"numbers", "Of its report", {}, kMustSay}, r.numbers);
  fields.require(seconds_of_iso_time(r.date).has_value(), "date", "must be a date and time of ISO 8601");
}

void describe(Fields& fields, CheckCost& c) {
  fields.value({"cost_mean_deg", "That normals are off on average, degrees", {}, kOrNull}, c.mean_deg);
  fields.value({"cost_worst_deg", "That normals are off at worst, degrees", {}, kOrNull}, c.worst_deg);
}

Result<CheckResult> read_check_result(const fs::path& folder) {
  const Result<Json> document = read_json(folder / kCheckResultFile, kCheckResultSchema, 1);
  if (!document) return document.error();
  return read_fields<CheckResult>(*document, (folder / kCheckResultFile).string());
}

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
      check.cost.mean_deg && check.cost.worst_deg
          ? fmt::format("normals would be off by {:.2g} degrees on average, {:.2g} at worst",
                        *check.cost.mean_deg, *check.cost.worst_deg)
          : "how far normals would be off it could not tell";
  return {ErrorKind::kBadData, "the rig has moved since it was calibrated", check.folder.string(),
          fmt::format("the check of {} did not pass: {}", check.date, cost), std::move(remedy)};
}

Json accepted_moved(const LastCheck& check, const std::string& why) {
  return {{"why", why},
          {"degrees", check.cost.mean_deg ? Json(*check.cost.mean_deg) : Json()},
          {"checked", check.date}};
}

}  // namespace weft::calibration
