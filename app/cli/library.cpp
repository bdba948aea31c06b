// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

#include "app/cli/exit_code.h"
#include "app/cli/library_place.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "core/rig/session.h"
#include "library/catalogue/catalogue.h"
#include "library/catalogue/edits.h"
#include "library/catalogue/metadata.h"
#include "library/catalogue/prune.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostShown = 60;  // bytes of a text in a list
using library::Catalogue;
using library::Entry;

struct FindArguments {
  LibraryPlace place;
  std::vector<std::string> words;
  library::Query query;
  std::optional<int> after;
};

struct TagArguments {
  LibraryPlace place;
  std::string session;
  std::vector<std::string> add, remove, set;
};

struct PruneArguments {
  FindArguments find;
  int keep = 1;
  bool yes = false;
};

// A text on one line of a terminal, cut after so many bytes where it is longer.
std::string in_line(std::string text, std::size_t most = std::string::npos) {
  std::ranges::replace(text, '\n', ' ');
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0) == 0x80) --most;  // inside a character
  return text.substr(0, most) + "…";
}

std::string line_of(const Entry& e) {
  std::string tags;
  for (const std::string& tag : e.metadata.tags) tags += " #" + tag;
  return fmt::format("{:.10}  {:<28} {:<24} {:<11} {:>2} solve{} {}", e.taken, in_line(e.name, kMostShown),
                     in_line(e.fabric, kMostShown), in_line(e.state, kMostShown), e.solves,
                     e.solves == 1 ? " " : "s", in_line(tags, kMostShown));
}

Result<int> find(const FindArguments& a, const CommonArguments& common) {
  Result<Catalogue> catalogue = fresh_catalogue(a.place, common);
  if (!catalogue) return std::move(catalogue).error();
  library::Query query = a.query;
  for (const std::string& word : a.words) query.words += word + " ";
  if (a.after) query.after = *a.after;
  const Result<library::CataloguePage> page = catalogue->find(query);
  if (!page) return page.error();
  if (common.json) {
    Json sessions = Json::array();
    for (const Entry& entry : page->entries) sessions.push_back(json_of(entry));
    print_json({{"sessions", std::move(sessions)},
                {"total", page->total},
                {"after", page->after ? Json(*page->after) : Json()}});
    return kDone;
  }
  for (const Entry& entry : page->entries) print(line_of(entry));
  print(fmt::format("{} of {} sessions", page->entries.size(), page->total));
  if (page->after) note(fmt::format("more with --after {}", *page->after));
  return kDone;
}

Result<int> show(const LibraryPlace& place, const std::string& session, const CommonArguments& common) {
  Result<Catalogue> catalogue = fresh_catalogue(place, common);
  if (!catalogue) return std::move(catalogue).error();
  const Result<Entry> entry = catalogue->find_one(session);
  if (!entry) return entry.error();
  const Json document = json_of(*entry);
  if (common.json) {
    print_json(document);
    return kDone;
  }
  for (const auto& [key, value] : document.items()) {
    if (value.is_null() || value == "" || value == 0 || value == Json::array()) continue;
    const std::string said = key == "error"      ? entry->error->message()
                             : value.is_string() ? value.get<std::string>()
                                                 : value.dump();
    print(fmt::format("{:<14} {}", key, in_line(said)));
  }
  return kDone;
}

// What the arguments make of an entry's metadata.
Result<Json> fields_of(const TagArguments& a, const Entry& entry) {
  Json fields = Json::object();
  std::vector<std::string> tags = entry.metadata.tags;
  for (const std::string& tag : a.remove) std::erase(tags, tag);
  tags.insert(tags.end(), a.add.begin(), a.add.end());
  if (!a.add.empty() || !a.remove.empty()) fields["tags"] = tags;
  for (const std::string& pair : a.set) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos) {
      return Error{ErrorKind::kUsage, "field cannot be read", pair.substr(0, 60), "it must be KEY=VALUE",
                   "write --set composition=\"80 % wool\""};
    }
    const std::string key = pair.substr(0, equals), value = pair.substr(equals + 1);
    const bool is_amount = key == "weight_g_m2" || key == "thickness_mm";
    const Json number = is_amount ? Json::parse(value, nullptr, false) : Json();
    fields[key] = value.empty() ? Json() : number.is_number() ? number : Json(value);
    if (key == "left_out") fields[key] = Json::parse("[" + value + "]", nullptr, false);
  }
  return fields;
}

fs::path edits_file() {
  return folder_of_user("XDG_STATE_HOME", ".local/state") / "edits.json";
}

Result<library::Edits> user_edits() {
  const fs::path file = edits_file();
  if (Result<void> ok = make_writable_folder(file.parent_path()); !ok) return std::move(ok).error();
  return library::Edits::open(file);
}

Result<int> print_change(const library::MetadataChange& change, const CommonArguments& common) {
  if (common.json) {
    print_json({{"session", change.folder.string()},
                {"before", change.before},
                {"after", change.after},
                {"revision", change.revision}});
  } else {
    print(in_line(library::words_of(change)));
  }
  return kDone;
}

// A session's folder is itself, wherever it lies; else it is a name or an id of the library's.
Result<Entry> entry_to_tag(const TagArguments& a, const CommonArguments& common) {
  if (!is_there(fs::path(a.session) / "session.json")) {
    Result<Catalogue> catalogue = fresh_catalogue(a.place, common);
    if (!catalogue) return std::move(catalogue).error();
    const fs::path named = a.session;
    return catalogue->find_one(named.extension() == ".weft" ? named.stem().string() : a.session);
  }
  const Result<Session> session = read_session(a.session);
  if (!session) return session.error();
  Result<library::Metadata> metadata = library::metadata_of(*session);
  if (!metadata) return std::move(metadata).error();
  Entry entry;
  entry.folder = absolute_folder(a.session);
  entry.metadata = std::move(*metadata);
  return entry;
}

Result<int> tag(const TagArguments& a, const CommonArguments& common) {
  const Result<Entry> entry = entry_to_tag(a, common);
  if (!entry) return entry.error();
  const Result<Json> fields = fields_of(a, *entry);
  if (!fields) return fields.error();
  Result<library::Edits> edits = user_edits();
  if (!edits) return std::move(edits).error();
  const Result<library::MetadataChange> change = library::change_metadata(entry->folder, *fields);
  if (!change) return change.error();
  if (!change->after.empty()) {
    const char* user = std::getenv("USER");
    if (Result<void> ok = edits->add(*change, user != nullptr ? user : ""); !ok) return std::move(ok).error();
  }
  return print_change(*change, common);
}

Result<int> take_back(bool again, const CommonArguments& common) {
  Result<library::Edits> edits = user_edits();
  if (!edits) return std::move(edits).error();
  const Result<library::MetadataChange> change = again ? edits->redo() : edits->undo();
  if (!change) return change.error();
  return print_change(*change, common);
}

Result<int> rebuild(const LibraryPlace& place, const CommonArguments& common) {
  const fs::path file = catalogue_of(place);
  std::error_code error;
  for (const char* part : {"", "-wal", "-shm"}) {
    fs::remove(file.string() + part, error);
    if (error) return cannot_write(file, error.value());
  }
  Result<Catalogue> catalogue = fresh_catalogue(place, common);
  if (!catalogue) return std::move(catalogue).error();
  const Result<library::CataloguePage> page = catalogue->find({.limit = 1});
  if (!page) return page.error();
  if (common.json) {
    print_json({{"catalogue", file.string()}, {"sessions", page->total}});
  } else {
    print(fmt::format("{}: {} sessions", file.string(), page->total));
  }
  return kDone;
}

Result<int> prune(const PruneArguments& a, const CommonArguments& common) {
  Result<Catalogue> catalogue = fresh_catalogue(a.find.place, common);
  if (!catalogue) return std::move(catalogue).error();
  library::Query query = a.find.query;
  for (const std::string& word : a.find.words) query.words += word + " ";
  query.limit = 1000;
  Json pruned = Json::array();
  std::uint64_t bytes = 0;
  do {
    const Result<library::CataloguePage> page = catalogue->find(query);
    if (!page) return page.error();
    for (const Entry& entry : page->entries) {
      if (entry.solves <= a.keep || entry.state == "unreadable") continue;
      const Result<std::vector<library::Prunable>> solves = library::prunable(entry.folder, a.keep);
      if (!solves) return solves.error();
      for (const library::Prunable& solve : *solves) {
        bytes += solve.bytes;
        pruned.push_back(
            {{"session", entry.folder.string()}, {"solve", solve.solve}, {"bytes", solve.bytes}});
        if (!common.json)
          print(fmt::format("{:>9.1f} MB  {}  {}", static_cast<double>(solve.bytes) * 1e-6, solve.solve,
                            entry.name));
      }
      if (a.yes) {
        if (Result<void> ok = library::prune(entry.folder, *solves); !ok) return std::move(ok).error();
      }
    }
    query.after = page->after;
  } while (query.after);
  if (common.json) {
    print_json({{"pruned", a.yes}, {"bytes", bytes}, {"solves", std::move(pruned)}});
  } else {
    print(fmt::format("{:>9.1f} MB in {} solves {}", static_cast<double>(bytes) * 1e-6, pruned.size(),
                      a.yes ? "removed" : "would go; nothing was touched: repeat with --yes"));
  }
  return kDone;
}

void add_query(Options& options, FindArguments& a) {
  add_place(options, a.place);
  options.add(
      "words", &a.words,
      "All must occur, each as the beginning of a word, in name, fabric, tags, composition, notes or id");
  options.add("--id", &a.query.id, "Article number or barcode");
  options.add("--tag", &a.query.tag, "Tag that they have");
  options.add("--state", &a.query.state, "capturing, complete or unreadable");
  options.add("--rig", &a.query.rig, "Name of the rig");
  options.add("--calibration", &a.query.calibration, "Id of the calibration");
  options.add("--from", &a.query.from, "Taken at or after this ISO time, or its beginning: 2026-11");
  options.add("--before", &a.query.before, "Taken before it");
}

Run add_find(Options& options) {
  const auto a = std::make_shared<FindArguments>();
  add_query(options, *a);
  options.add("--limit", &a->query.limit, "Sessions a page").in_range(1, 1000).shows_default();
  options.add("--after", &a->after, "Key that ended the page before");
  return [a](const CommonArguments& common) { return find(*a, common); };
}

Run add_show(Options& options) {
  const auto a = std::make_shared<TagArguments>();
  options.add("session", &a->session, "Name, folder or id").required();
  add_place(options, a->place);
  return [a](const CommonArguments& common) { return show(a->place, a->session, common); };
}

Run add_tag(Options& options) {
  const auto a = std::make_shared<TagArguments>();
  options.add("session", &a->session, "Name, folder or id").required();
  add_place(options, a->place);
  options.add("--add", &a->add, "Tags to add, by commas").by_commas().one_at_a_time();
  options.add("--remove", &a->remove, "Tags to take away, by commas").by_commas().one_at_a_time();
  options
      .add(
          "--set", &a->set,
          "KEY=VALUE: fabric, id, composition, construction, side (front, back), kind (cotton, wool, velvet, "
          "satin, dark-satin: what maps assume of its gloss), notes, weight_g_m2, thickness_mm, "
          "current_solve, left_out (indices of shots, by commas, that no solve uses); no value "
          "removes it")
      .one_at_a_time();
  return [a](const CommonArguments& common) { return tag(*a, common); };
}

Run add_undo(Options&) {
  return [](const CommonArguments& common) { return take_back(false, common); };
}

Run add_redo(Options&) {
  return [](const CommonArguments& common) { return take_back(true, common); };
}

Run add_rebuild(Options& options) {
  const auto a = std::make_shared<LibraryPlace>();
  add_place(options, *a);
  return [a](const CommonArguments& common) { return rebuild(*a, common); };
}

Run add_prune(Options& options) {
  const auto a = std::make_shared<PruneArguments>();
  add_query(options, a->find);
  options.add("--keep", &a->keep, "Newest solves of a session to keep beside its current one")
      .in_range(0, 1000)
      .shows_default();
  options.add_flag("--yes", &a->yes, "Remove them; without it they are only listed, with their bytes");
  return [a](const CommonArguments& common) { return prune(*a, common); };
}

}  // namespace

Verb library_verb() {
  return {.name = "library",
          .help = "Find, tag and tidy the sessions of some folders",
          .verbs = {{.name = "find",
                     .help = "Sessions by words, tags, state, rig and date; without any, the newest first",
                     .add = add_find,
                     .old_name = "list"},
                    {"show", "All that is known of one session", add_show},
                    {"tag", "Change tags and what else people say of a cloth", add_tag},
                    {"undo", "Take the last change back, up to twenty", add_undo},
                    {"redo", "Make the change again that was taken back last", add_redo},
                    {"rebuild", "Make the catalogue again from the folders", add_rebuild},
                    {"prune", "Remove old solves; photographs and current solves stay", add_prune}}};
}

}  // namespace weft::app
