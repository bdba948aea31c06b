// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/photograph_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "calibration/guide/printed_target.h"
#include "calibration/run/sheet_files.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/field_json.h"
#include "core/rig/calibration.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSetFile = "set.json";
/// The file that a part's thing is described in; null where there is nothing to say of it.
const char* description_of(SetPart part) {
  switch (part) {
    case SetPart::kBoard:
      return "board.toml";
    case SetPart::kSheet:
    case SetPart::kCheck:
    case SetPart::kMoved:
      return "sheet.toml";
    case SetPart::kChart:
      return "chart.toml";
    case SetPart::kResponse:
    case SetPart::kTrap:
      break;
  }
  return nullptr;
}

Result<void> check_description(const PhotographSet& set) {
  if (set.part == SetPart::kBoard) {
    const Result<PrintedBoard> board = read_board_file(set.board_file(), {});
    return board ? Result<void>() : board.error();
  }
  if (set.is_of_sheets()) {
    const Result<TaggedSheet> sheet = read_sheet_file(set.sheet_file());
    return sheet ? Result<void>() : sheet.error();
  }
  return {};
}

/// What a person said of the thing, else what the newest set of such a thing says.
Result<std::string> described(const SetRequest& request) {
  const char* name = description_of(request.part);
  if (name == nullptr) return std::string();
  std::string text = request.description.empty()
                         ? newest_description(absolute_folder(request.folder).parent_path(), request.part)
                         : request.description;
  if (!text.empty() || request.part == SetPart::kChart) return text;
  return Error{ErrorKind::kUsage, fmt::format("nobody said what the {} is", fs::path(name).stem().string()),
               name, "its size and pattern must be known to find it",
               fmt::format("print one: weft target {}; or write a {} (docs/calibration.md) and name it",
                           fs::path(name).stem().string(), name)};
}

Error not_this_set(const SetRequest& request, const std::string& why) {
  return {ErrorKind::kCannotCreate, "the photographs cannot be added to this folder", request.folder.string(),
          why, "name another folder, or one that is not there yet"};
}

Result<PhotographSet> taken_up(const SetRequest& request) {
  Result<PhotographSet> set = read_set(request.folder);
  if (!set) return set;
  if (set->part != request.part)
    return not_this_set(request, fmt::format("it is a set of part {}", name_of(set->part)));
  if (set->rig != request.rig) return not_this_set(request, "its photographs are of the rig " + set->rig);
  if (Result<void> ok = check_description(*set); !ok) return ok.error();
  return set;
}

}  // namespace

const char* name_of(SetPart part) {
  return kSetPartNames[static_cast<std::size_t>(part)];
}

std::optional<SetPart> set_part_of(const std::string& name) {
  const auto found = std::ranges::find(kSetPartNames, name);
  if (found == kSetPartNames.end()) return std::nullopt;
  return static_cast<SetPart>(found - kSetPartNames.begin());
}

void describe(Fields& fields, PhotographSet& s) {
  fields.keep(s.document);
  fields.choice({"part", "The step of a calibration that they are for", {}, kMustSay}, s.part, kSetPartNames);
  fields.value({"rig", "Whose they are", {}, kMustSay}, s.rig);
  fields.value({"created", "When it was begun, ISO 8601", {}, kMustSay}, s.created);
  fields.value({"from", "Folder of the calibration that was known before; empty: none", {}, kMustSay},
               s.from);
  fields.value(
      {"exposure_us", "Of its photographs, microseconds; 0: not metered yet", kNotNegative, kMustSay},
      s.exposure_us);
  fields.value(
      {"asked", "By photograph: the pose that a person was asked for (mm, degrees, pixels), or null"},
      s.asked);
  fields.value({"why", "By session that weft left out: why"}, s.why);
}

std::string newest_description(const fs::path& sets, SetPart part) {
  const char* name = description_of(part);
  if (name == nullptr) return "";
  fs::path newest;
  std::error_code ignored;
  const auto look_at = [&](const fs::path& each) {
    const bool is_newer =
        newest.empty() || fs::last_write_time(each, ignored) > fs::last_write_time(newest, ignored);
    if (is_there(each) && is_newer) newest = each;
  };
  look_at(sets.parent_path() / kTargetsFolder / name);
  for (const auto& set : fs::directory_iterator(sets, ignored)) look_at(set.path() / name);
  const Result<std::string> text = newest.empty() ? Result<std::string>("") : read_text(newest);
  return text ? *text : "";
}

Result<PhotographSet> begin_set(const SetRequest& request) {
  if (is_there(request.folder / kSetFile)) return taken_up(request);
  std::error_code failed;
  if (is_there(request.folder) && !fs::is_empty(request.folder, failed))
    return not_this_set(request, "there is something in it, and no set.json");
  const Result<std::string> description = described(request);
  if (!description) return description.error();
  if (!request.from.empty()) {
    if (const Result<Calibration> before = read_calibration(request.from); !before) return before.error();
  }
  PhotographSet set;
  set.folder = absolute_folder(request.folder);
  set.part = request.part;
  set.rig = request.rig;
  set.created = iso_time_now();
  set.from = request.from.empty() ? fs::path() : absolute_folder(request.from);
  if (Result<void> made = make_writable_folder(set.folder); !made) return made.error();
  Result<void> written;
  if (!description->empty()) written = write_file(set.folder / description_of(set.part), *description);
  if (written) written = check_description(set);
  if (written) written = write_set(set);
  if (written) return set;
  fs::remove_all(set.folder, failed);
  return written.error();
}

Result<PhotographSet> read_set(const fs::path& folder) {
  const fs::path file = folder / kSetFile;
  const Result<Json> document = read_json(file, "weft.set", 1);
  if (!document) return document.error();
  Result<PhotographSet> set = read_fields<PhotographSet>(*document, file.string());
  if (set) set->folder = absolute_folder(folder);
  return set;
}

Result<void> write_set(const PhotographSet& set) {
  Json document = {{"schema", "weft.set/1"}};
  write_fields(document, set);
  return write_json(set.folder / kSetFile, document);
}

Result<void> leave_out(const PhotographSet& set, const std::string& name, bool out) {
  const fs::path used = set.folder / name, unused = set.left_out() / name;
  const fs::path &from = out ? used : unused, &to = out ? unused : used;
  const bool is_plain =
      !name.empty() && fs::path(name).filename() == fs::path(name) && !name.starts_with('.');
  if (!is_plain || !is_there(from) || name == kSetFile) {
    return Error{ErrorKind::kNoInput, "there is no such photograph", name,
                 out ? "the set does not have it" : "it was not left out", "name one of the set's"};
  }
  if (is_there(to)) {
    return Error{ErrorKind::kCannotCreate, "there is one of this name already", to.string(), "",
                 "remove it, or rename it"};
  }
  if (Result<void> made = make_writable_folder(to.parent_path()); !made) return made;
  std::error_code failed;
  fs::rename(from, to, failed);
  if (failed) return cannot_write(to, failed.value());
  return sync_path(to.parent_path());
}

}  // namespace weft::calibration
