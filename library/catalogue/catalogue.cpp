// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/base/parallel.h"
#include "core/describe/error_json.h"
#include "core/describe/field_json.h"
#include "core/rig/seen_rig.h"
#include "core/solve/solve.h"
#include "library/catalogue/session_files.h"
#include "library/catalogue/session_verdict.h"
#include "solve/session/current.h"

namespace weft::library {

namespace fs = std::filesystem;

// A session as the folders show it without reading it.
struct Found {
  fs::path folder;
  std::int64_t bytes = 0, written = 0;  // of session.json
  std::int64_t solved = 0;              // when the list of its solves changed; 0 where there is none

  friend bool operator==(const Found&, const Found&) = default;
};

namespace {

// Raised whenever the tables change.
constexpr int kVersion = 6;
constexpr std::size_t kMostRanked = 20'000;
constexpr int kMostLimit = 1000;
constexpr std::size_t kBatch = 500;  // of sessions that are written together, so that others write between
constexpr int kMostWords = 16;
constexpr const char* kEnding = ".weft";

constexpr const char* kTables = R"(
CREATE TABLE session(
  key INTEGER PRIMARY KEY, folder TEXT NOT NULL UNIQUE, name TEXT NOT NULL,
  bytes INTEGER, written INTEGER, solved INTEGER,
  fabric TEXT, rig TEXT, calibration TEXT, state TEXT, error TEXT,
  revision INTEGER, id TEXT, tags TEXT, composition TEXT, construction TEXT, side TEXT, notes TEXT,
  weight_g_m2 REAL, thickness_mm REAL,
  shots INTEGER, solves INTEGER, current_solve TEXT, taken TEXT, all_bytes INTEGER, warnings TEXT,
  lit_shot INTEGER, lit_sha256 TEXT, grade INTEGER, says TEXT, action TEXT, kind TEXT);
CREATE INDEX session_unfinished ON session(rig, taken DESC, key DESC) WHERE state NOT IN ('complete', 'unreadable');
CREATE INDEX session_taken ON session(taken DESC, key DESC);
CREATE INDEX session_name ON session(name);
CREATE INDEX session_id ON session(id);
CREATE TABLE tag(tag TEXT, key INTEGER, PRIMARY KEY(tag, key)) WITHOUT ROWID;
CREATE INDEX tag_key ON tag(key);
CREATE VIRTUAL TABLE words USING fts5(name, fabric, tags, composition, notes, id,
  content = 'session', content_rowid = 'key', tokenize = 'unicode61 remove_diacritics 2', prefix = '2 3');
CREATE TRIGGER session_added AFTER INSERT ON session BEGIN
  INSERT INTO words(rowid, name, fabric, tags, composition, notes, id)
  VALUES (new.key, new.name, new.fabric, new.tags, new.composition, new.notes, new.id);
END;
CREATE TRIGGER session_removed AFTER DELETE ON session BEGIN
  INSERT INTO words(words, rowid, name, fabric, tags, composition, notes, id)
  VALUES ('delete', old.key, old.name, old.fabric, old.tags, old.composition, old.notes, old.id);
  DELETE FROM tag WHERE key = old.key;
END;
CREATE TRIGGER session_changed AFTER UPDATE ON session BEGIN
  INSERT INTO words(words, rowid, name, fabric, tags, composition, notes, id)
  VALUES ('delete', old.key, old.name, old.fabric, old.tags, old.composition, old.notes, old.id);
  INSERT INTO words(rowid, name, fabric, tags, composition, notes, id)
  VALUES (new.key, new.name, new.fabric, new.tags, new.composition, new.notes, new.id);
  DELETE FROM tag WHERE key = new.key;
END;
)";

constexpr const char* kPut = R"(
INSERT INTO session(folder, name, bytes, written, solved, fabric, rig, calibration, state, error, revision,
  id, tags, composition, construction, side, notes, weight_g_m2, thickness_mm, shots, solves,
  current_solve, taken, all_bytes, warnings, lit_shot, lit_sha256, grade, says, action, kind)
VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21, ?22, ?23,
  ?24, ?25, ?26, ?27, ?28, ?29, ?30, ?31)
ON CONFLICT(folder) DO UPDATE SET
  bytes = ?3, written = ?4, solved = ?5, fabric = ?6, rig = ?7, calibration = ?8, state = ?9, error = ?10,
  revision = ?11, id = ?12, tags = ?13, composition = ?14, construction = ?15, side = ?16, notes = ?17,
  weight_g_m2 = ?18, thickness_mm = ?19, shots = ?20, solves = ?21, current_solve = ?22, taken = ?23,
  all_bytes = ?24, warnings = ?25, lit_shot = ?26, lit_sha256 = ?27,
  grade = ?28, says = ?29, action = ?30, kind = ?31)";

constexpr const char* kGet =
    "SELECT key, folder, name, fabric, rig, calibration, state, error, revision, id, tags, composition, "
    "construction, side, notes, weight_g_m2, thickness_mm, shots, solves, current_solve, taken, written, "
    "all_bytes, warnings, lit_shot, lit_sha256, grade, says, action, kind FROM session WHERE key = ?";

std::int64_t nanoseconds(fs::file_time_type time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::file_clock::to_sys(time).time_since_epoch())
      .count();
}

// Nothing where it is no session.
std::optional<Found> look_at(const fs::path& folder) {
  std::error_code error;
  const fs::path document = folder / "session.json";
  Found found = {folder, static_cast<std::int64_t>(fs::file_size(document, error)), 0, 0};
  if (error) return {};
  found.written = nanoseconds(fs::last_write_time(document, error));
  if (error) return {};
  for (const char* made : {"solve", kRigLookFile}) {
    const auto written = fs::last_write_time(folder / made, error);
    if (!error) found.solved = std::max(found.solved, nanoseconds(written));
  }
  return found;
}

// Adds the sessions at and below a folder. Whether it could be listed.
bool walk(const fs::path& folder, const JobContext& context, std::vector<Found>& found) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) return false;
  std::vector<fs::path> below;
  for (; entries != fs::directory_iterator(); entries.increment(error)) {
    if (error) return false;
    if (context.stop.stop_requested()) return true;
    std::error_code ignored;
    const fs::path& path = entries->path();
    if (!entries->is_directory(ignored) || entries->is_symlink(ignored)) continue;
    if (path.filename().native().starts_with('.')) continue;
    if (path.extension() != kEnding) {
      below.push_back(path);
    } else if (std::optional<Found> session = look_at(path)) {
      found.push_back(std::move(*session));
    }
    // How many there will be is not known.
    if (found.size() % kBatch == 0) context.progress("look", 0);
  }
  for (const fs::path& each : below) walk(each, context, found);
  return true;
}

std::string joined(const std::vector<std::string>& tags) {
  return fmt::format("{}", fmt::join(tags, "\n"));
}

std::vector<std::string> parted(const std::string& text) {
  std::vector<std::string> tags;
  std::istringstream lines(text);
  for (std::string tag; std::getline(lines, tag);) tags.push_back(std::move(tag));
  return tags;
}

Entry read_entry(const Found& found) {
  Entry entry;
  entry.folder = found.folder;
  entry.name = found.folder.stem().string();
  entry.taken = entry.written = iso_time(static_cast<double>(found.written) * 1e-9);
  entry.bytes = bytes_below(found.folder);
  const Result<Session> session = read_session(found.folder);
  if (!session) {
    entry.state = "unreadable";
    entry.error = session.error();
    entry.verdict = {Grade::kUnfinished, "it cannot be read: " + session.error().why, session.error().remedy};
    return entry;
  }
  Result<Metadata> metadata = metadata_of(*session);
  if (!metadata) entry.error = metadata.error();
  if (metadata) entry.metadata = std::move(*metadata);
  entry.warnings = warnings_of(*session);
  entry.fabric = session->fabric;
  entry.rig = session->rig;
  entry.calibration = session->calibration_id;
  entry.state = session->state;
  entry.shots = static_cast<int>(session->shots.size());
  const auto lit = std::ranges::find_if(session->shots, [](const Shot& shot) {
    return shot.role == ShotRole::kLit && !shot.superseded_by && !shot.sha256.empty();
  });
  if (lit != session->shots.end()) {
    entry.lit_shot = lit->index;
    entry.lit_sha256 = lit->sha256;
  }
  if (!session->shots.empty() && !session->shots.front().time.empty())
    entry.taken = session->shots.front().time;
  entry.verdict = verdict_of(*session);
  if (found.solved != 0) {
    entry.solves = static_cast<int>(list_solves(found.folder).size());
    entry.current_solve = solve::current_solve(*session);
  }
  return entry;
}

// Paths may hold bytes that are no UTF-8.
std::string text_of(const Error& error) {
  return weft::json_of(error).dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<void> put_one(Statement& put, Statement& tag, const Found& found, const Entry& e) {
  const Metadata& m = e.metadata;
  const std::string folder = e.folder.string();
  put.bind(folder).bind(e.name).bind(found.bytes).bind(found.written).bind(found.solved);
  put.bind(e.fabric).bind(e.rig).bind(e.calibration).bind(e.state);
  put.bind(e.error ? text_of(*e.error) : std::string()).bind(std::int64_t{m.revision}).bind(m.id);
  put.bind(joined(m.tags)).bind(m.composition).bind(m.construction).bind(m.side).bind(m.notes);
  put.bind(m.weight_g_m2).bind(m.thickness_mm).bind(std::int64_t{e.shots}).bind(std::int64_t{e.solves});
  put.bind(e.current_solve).bind(e.taken).bind(static_cast<std::int64_t>(e.bytes)).bind(joined(e.warnings));
  put.bind(std::int64_t{e.lit_shot}).bind(e.lit_sha256);
  put.bind(static_cast<std::int64_t>(e.verdict.grade)).bind(e.verdict.says).bind(e.verdict.action);
  put.bind(m.kind);
  if (Result<void> ok = put.run(); !ok) return ok;
  for (const std::string& each : m.tags) {
    if (Result<void> ok = tag.bind(each).bind(folder).run(); !ok) return ok;
  }
  return {};
}

std::optional<Error> error_in(const std::string& text) {
  if (text.empty()) return {};
  return error_of_json(Json::parse(text, nullptr, false), "catalogue");
}

Error unusable(const std::string& where, std::string why, std::string remedy) {
  return {ErrorKind::kUsage, "sessions cannot be searched so", where, std::move(why), std::move(remedy)};
}

// Each word as the beginning of one, all of them wanted. Quoted, a word means itself whatever it is made of.
Result<std::string> match_of(std::string words) {
  // SQLite's words end at a NUL, and their quotes with them.
  std::ranges::replace(words, '\0', ' ');
  std::istringstream parts(words);
  std::string match;
  int count = 0;
  for (std::string word; parts >> word;) {
    if (++count > kMostWords) {
      return unusable("words", fmt::format("they are more than {}", kMostWords), "search for fewer words");
    }
    std::string quoted;
    for (const char c : word) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    match += fmt::format("\"{}\"* ", quoted);
  }
  return match;
}

Result<Database> with_tables(const fs::path& file) {
  Result<Database> database = Database::open(file);
  if (!database) return database;
  int version = 0;
  {
    Result<Statement> asked = database->prepare("PRAGMA user_version");
    if (!asked) return std::move(asked).error();
    const Result<bool> row = asked->step();
    if (!row) return row.error();
    version = static_cast<int>(asked->integer(0));
  }
  if (version == kVersion) {
    // A damaged file shows here rather than in the middle of a search.
    Result<Statement> check = database->prepare("PRAGMA quick_check(1)");
    if (!check) return std::move(check).error();
    const Result<bool> row = check->step();
    if (!row) return row.error();
    if (check->text(0) == "ok") return database;
  }
  if (version != 0) {
    return Error{ErrorKind::kBadData, "catalogue cannot be used", file.string(),
                 fmt::format("it is damaged or of version {}, this is {}", version, kVersion), ""};
  }
  if (Result<void> ok = database->run("BEGIN IMMEDIATE"); !ok) return std::move(ok).error();
  Result<void> made = database->run(kTables);
  if (made) made = database->run(fmt::format("PRAGMA user_version = {}; COMMIT", kVersion).c_str());
  if (!made) return std::move(made).error();
  return database;
}

}  // namespace

Json json_of(const Entry& e) {
  Json json = {{"key", e.key}, {"name", e.name}, {"folder", e.folder.string()}, {"fabric", e.fabric}};
  json.update(json_of(e.metadata));
  json.update({{"rig", e.rig},
               {"calibration", e.calibration},
               {"state", e.state},
               {"taken", e.taken},
               {"shots", e.shots},
               {"solves", e.solves},
               {"current_solve", e.current_solve},
               {"written", e.written},
               {"bytes", e.bytes},
               {"warnings", e.warnings},
               {"verdict", object_of(e.verdict)},
               {"error", e.error ? weft::json_of(*e.error) : Json()}});
  return json;
}

Result<Catalogue> Catalogue::open(const fs::path& file) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  Result<Database> database = with_tables(file);
  if (!database && database.error().kind == ErrorKind::kBadData) {
    for (const char* part : {"", "-wal", "-shm"}) {
      const fs::path of_it = file.string() + part;
      if (!is_there(of_it)) continue;
      fs::rename(of_it, file.string() + ".damaged" + part, error);
      if (error) return cannot_write(file, error.value());
    }
    database = with_tables(file);
  }
  if (!database) return std::move(database).error();
  return Catalogue(std::move(*database));
}

Result<std::unordered_map<std::string, Found>> Catalogue::known(const std::string& folder) {
  // Text compares by bytes, and 0 follows the slash.
  Result<Statement> all =
      database_.prepare("SELECT folder, bytes, written, solved FROM session WHERE folder > ? AND folder < ?");
  if (!all) return std::move(all).error();
  all->bind(folder + "/").bind(folder + "0");
  std::unordered_map<std::string, Found> known;
  for (;;) {
    const Result<bool> row = all->step();
    if (!row) return row.error();
    if (!*row) return known;
    const std::string session = all->text(0);
    known[session] = {session, all->integer(1), all->integer(2), all->integer(3)};
  }
}

Result<Catalogue> Catalogue::beside() const {
  Result<Database> database = Database::open(database_.file());
  if (!database) return std::move(database).error();
  return Catalogue(std::move(*database));
}

Result<RefreshFacts> Catalogue::refresh(const std::vector<fs::path>& folders, const JobContext& context) {
  RefreshFacts facts;
  std::vector<Found> changed;
  std::vector<std::string> gone;
  for (const fs::path& folder : folders) {
    const fs::path absolute = absolute_folder(folder);
    std::vector<Found> found;
    const bool is_listed = walk(absolute, context, found);
    if (context.stop.stop_requested()) return interrupted();
    facts.sessions += found.size();
    if (!is_listed) facts.unreachable.push_back(absolute);
    Result<std::unordered_map<std::string, Found>> before = known(absolute.string());
    if (!before) return std::move(before).error();
    for (Found& session : found) {
      const auto same = before->find(session.folder.string());
      const bool is_same = same != before->end() && same->second == session;
      if (same != before->end()) before->erase(same);
      if (!is_same) changed.push_back(std::move(session));
    }
    for (const auto& [session, ignored] : *before) {
      if (is_listed) gone.push_back(session);
    }
  }

  if (Result<void> ok = forget(gone); !ok) return std::move(ok).error();
  facts.removed = gone.size();
  for (const std::size_t all = changed.size(); facts.read < all;) {
    const std::span<const Found> batch(changed.data() + facts.read, std::min(kBatch, all - facts.read));
    std::vector<Entry> entries(batch.size());
    parallel_for(batch.size(), context.threads, [&](std::size_t i, int) {
      if (!context.stop.stop_requested()) entries[i] = read_entry(batch[i]);
    });
    if (context.stop.stop_requested()) return interrupted();
    if (Result<void> ok = put(batch, entries); !ok) return std::move(ok).error();
    facts.read += batch.size();
    context.progress("read", static_cast<double>(facts.read) / static_cast<double>(all));
  }
  return facts;
}

Result<void> Catalogue::refresh(const fs::path& session) {
  const fs::path folder = absolute_folder(session);
  const std::optional<Found> found = look_at(folder);
  if (!found) return forget({folder.string()});
  const Result<bool> same = is_known(*found);
  if (!same) return same.error();
  if (*same) return {};
  const Entry entry = read_entry(*found);
  return put({&*found, 1}, {&entry, 1});
}

Result<bool> Catalogue::is_known(const Found& found) {
  Result<Statement> same = database_.prepare(
      "SELECT 1 FROM session WHERE folder = ? AND bytes = ? AND written = ? AND solved = ?");
  if (!same) return std::move(same).error();
  return same->bind(found.folder.string()).bind(found.bytes).bind(found.written).bind(found.solved).step();
}

Result<void> Catalogue::keep_only(const std::vector<fs::path>& folders) {
  Result<Statement> all = database_.prepare("SELECT folder FROM session");
  if (!all) return std::move(all).error();
  std::vector<std::string> gone;
  for (;;) {
    const Result<bool> row = all->step();
    if (!row) return row.error();
    if (!*row) break;
    const std::string session = all->text(0);
    const bool is_kept = std::ranges::any_of(folders, [&](const fs::path& folder) {
      return session.starts_with(absolute_folder(folder).string() + "/");
    });
    if (!is_kept) gone.push_back(session);
  }
  return forget(gone);
}

Result<void> Catalogue::forget(const std::vector<std::string>& folders) {
  if (folders.empty()) return {};
  return database_.together([&]() -> Result<void> {
    Result<Statement> forget = database_.prepare("DELETE FROM session WHERE folder = ?");
    if (!forget) return std::move(forget).error();
    for (const std::string& folder : folders) {
      if (Result<void> ok = forget->bind(folder).run(); !ok) return ok;
    }
    return {};
  });
}

Result<void> Catalogue::put(std::span<const Found> found, std::span<const Entry> entries) {
  return database_.together([&]() -> Result<void> {
    Result<Statement> put = database_.prepare(kPut);
    if (!put) return std::move(put).error();
    Result<Statement> tag =
        database_.prepare("INSERT OR IGNORE INTO tag SELECT ?, key FROM session WHERE folder = ?");
    if (!tag) return std::move(tag).error();
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (Result<void> ok = put_one(*put, *tag, found[i], entries[i]); !ok) return ok;
    }
    return {};
  });
}

Result<std::vector<std::int64_t>> Catalogue::keys_of(const Query& query) {
  const Result<std::string> match = match_of(query.words);
  if (!match) return match.error();
  std::string sql = "SELECT s.key FROM session s";
  std::vector<std::string> values;
  const auto only = [&](const char* condition) {
    sql += sql.find(" WHERE ") == std::string::npos ? " WHERE " : " AND ";
    sql += condition;
  };
  const auto with = [&](const char* condition, const std::string& value) {
    if (value.empty()) return;
    only(condition);
    values.push_back(value);
  };
  if (!match->empty()) {
    sql = fmt::format(
        "SELECT s.key FROM (SELECT rowid, rank FROM words WHERE words MATCH ? LIMIT {}) hit JOIN session s "
        "ON s.key = hit.rowid WHERE 1",
        kMostRanked);
    values.push_back(*match);
  }
  if (query.unfinished) only("s.state NOT IN ('complete', 'unreadable')");
  if (query.warned) only(fmt::format("s.grade <> {}", static_cast<int>(Grade::kGood)).c_str());
  with("s.id = ?", query.id);
  with("s.key IN (SELECT key FROM tag WHERE tag = ?)", query.tag);
  with("s.state = ?", query.state);
  with("s.fabric = ?", query.fabric);
  with("s.rig = ?", query.rig);
  with("s.calibration = ?", query.calibration);
  with("s.taken >= ?", query.from);
  with("s.taken < ?", query.before);
  with("s.folder = ? || '/' || s.name || '.weft'", query.in.string());
  sql +=
      match->empty() ? " ORDER BY s.taken DESC, s.key DESC" : " ORDER BY hit.rank, s.taken DESC, s.key DESC";
  Result<Statement> rows = database_.prepare(sql);
  if (!rows) return std::move(rows).error();
  for (const std::string& value : values) rows->bind(value);
  std::vector<std::int64_t> keys;
  for (;;) {
    const Result<bool> row = rows->step();
    if (!row) return row.error();
    if (!*row) return keys;
    keys.push_back(rows->integer(0));
  }
}

Result<Entry> Catalogue::entry(std::int64_t key) {
  Result<Statement> get = database_.prepare(kGet);
  if (!get) return std::move(get).error();
  const Result<bool> row = get->bind(key).step();
  if (!row) return row.error();
  if (!*row) {
    return Error{ErrorKind::kNoInput, "there is no such session", fmt::format("entry {}", key),
                 "it is no longer in its folder", "search again"};
  }
  Entry e;
  e.key = get->integer(0);
  e.folder = get->text(1);
  e.name = get->text(2);
  e.fabric = get->text(3);
  e.rig = get->text(4);
  e.calibration = get->text(5);
  e.state = get->text(6);
  e.error = error_in(get->text(7));
  e.metadata = {.revision = static_cast<int>(get->integer(8)),
                .id = get->text(9),
                .tags = parted(get->text(10)),
                .composition = get->text(11),
                .construction = get->text(12),
                .side = get->text(13),
                .kind = get->text(29),
                .notes = get->text(14),
                .weight_g_m2 = get->number(15),
                .thickness_mm = get->number(16)};
  e.shots = static_cast<int>(get->integer(17));
  e.solves = static_cast<int>(get->integer(18));
  e.current_solve = get->text(19);
  e.taken = get->text(20);
  e.written = iso_time(static_cast<double>(get->integer(21)) * 1e-9);
  e.bytes = static_cast<std::uint64_t>(get->integer(22));
  e.warnings = parted(get->text(23));
  e.lit_shot = static_cast<int>(get->integer(24));
  e.lit_sha256 = get->text(25);
  e.verdict = {static_cast<Grade>(std::clamp<std::int64_t>(get->integer(26), 0, std::ssize(kGradeNames) - 1)),
               get->text(27), get->text(28)};
  return e;
}

Result<CataloguePage> Catalogue::find(const Query& query) {
  if (query.limit < 1 || query.limit > kMostLimit) {
    return unusable("limit", fmt::format("{} sessions a page", query.limit),
                    fmt::format("ask for 1 to {}", kMostLimit));
  }
  const Result<std::vector<std::int64_t>> keys = keys_of(query);
  if (!keys) return keys.error();
  CataloguePage page;
  page.total = keys->size();
  std::size_t at = 0;
  if (query.after) {
    const auto last = std::ranges::find(*keys, *query.after);
    if (last == keys->end()) {
      return unusable("after", fmt::format("entry {} is not found any more", *query.after),
                      "begin with the first page again");
    }
    at = static_cast<std::size_t>(last - keys->begin()) + 1;
  }
  const std::size_t end = std::min(keys->size(), at + static_cast<std::size_t>(query.limit));
  for (; at < end; ++at) {
    Result<Entry> found = entry((*keys)[at]);
    if (!found) return std::move(found).error();
    page.entries.push_back(std::move(*found));
  }
  if (end < keys->size()) page.after = (*keys)[end - 1];
  return page;
}

Result<Entry> Catalogue::find_one(const std::string& name) {
  Result<Statement> rows = database_.prepare(
      "SELECT key FROM session WHERE name = ?1 OR folder = ?1 OR (id = ?1 AND id <> '') LIMIT 2");
  if (!rows) return std::move(rows).error();
  Result<bool> row = rows->bind(name).step();
  if (!row) return std::move(row).error();
  if (!*row) {
    return Error{ErrorKind::kNoInput, "there is no such session", name, "no name, folder or id is that",
                 "search for it with weft library find"};
  }
  const std::int64_t key = rows->integer(0);
  row = rows->step();
  if (!row) return std::move(row).error();
  if (*row) {
    return Error{ErrorKind::kUsage, "several sessions are called so", name, "",
                 "give the folder; weft library find shows them"};
  }
  return entry(key);
}

Result<std::vector<std::pair<std::string, int>>> Catalogue::tags() {
  Result<Statement> rows =
      database_.prepare("SELECT tag, count(*) AS n FROM tag GROUP BY tag ORDER BY n DESC, tag");
  if (!rows) return std::move(rows).error();
  std::vector<std::pair<std::string, int>> tags;
  for (;;) {
    const Result<bool> row = rows->step();
    if (!row) return row.error();
    if (!*row) return tags;
    tags.emplace_back(rows->text(0), static_cast<int>(rows->integer(1)));
  }
}

}  // namespace weft::library
