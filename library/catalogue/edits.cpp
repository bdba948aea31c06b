// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/edits.h"

#include <utility>

#include "core/base/files.h"
#include "core/base/iso_time.h"

namespace weft::library {
namespace {

constexpr const char* kEditsSchema = "weft.edits";

bool is_edit(const Json& edit) {
  const auto has = [&](const char* key, bool is_kind) { return edit.contains(key) && is_kind; };
  return edit.is_object() && has("session", edit.value("session", Json()).is_string()) &&
         has("before", edit.value("before", Json()).is_object()) &&
         has("after", edit.value("after", Json()).is_object());
}

bool is_list_of_edits(const Json& list) {
  if (!list.is_array()) return false;
  for (const Json& edit : list) {
    if (!is_edit(edit)) return false;
  }
  return true;
}

}  // namespace

Result<Edits> Edits::open(const std::filesystem::path& file) {
  const Result<bool> there = look_for(file);
  if (!there) return there.error();
  if (!*there) return Edits(file, Json::array(), Json::array());
  Result<Json> document = read_json(file, kEditsSchema, 1);
  if (!document) return std::move(document).error();
  Json done = document->value("done", Json()), undone = document->value("undone", Json());
  if (!is_list_of_edits(done) || !is_list_of_edits(undone)) {
    return Error{ErrorKind::kBadData, "list of edits cannot be used", file.string(),
                 "it holds something else than edits", "delete it: only undo is lost"};
  }
  return Edits(file, std::move(done), std::move(undone));
}

Result<void> Edits::add(const MetadataChange& change, const std::string& by) {
  done_.push_back({{"session", change.folder.string()},
                   {"before", change.before},
                   {"after", change.after},
                   {"by", by},
                   {"time", iso_time_now()}});
  while (done_.size() > kMostEdits) done_.erase(done_.begin());
  undone_ = Json::array();
  return write();
}

Result<MetadataChange> Edits::undo() {
  return move(done_, undone_, "before", "after");
}

Result<MetadataChange> Edits::redo() {
  return move(undone_, done_, "after", "before");
}

Result<MetadataChange> Edits::move(Json& from, Json& to, const char* set, const char* expected) {
  if (from.empty()) {
    return Error{ErrorKind::kUsage, "there is nothing to take back", file_.string(), "",
                 "the last twenty changes can be undone, and made again until another follows"};
  }
  Json edit = from.back();
  Provided provided;
  provided.values = edit[expected];
  Result<MetadataChange> change = change_metadata(edit["session"].get<std::string>(), edit[set], provided);
  if (!change) return change;
  from.erase(from.size() - 1);
  to.push_back(std::move(edit));
  if (Result<void> ok = write(); !ok) return std::move(ok).error();
  return change;
}

Result<void> Edits::write() const {
  return write_json(file_,
                    {{"schema", std::string(kEditsSchema) + "/1"}, {"done", done_}, {"undone", undone_}});
}

}  // namespace weft::library
