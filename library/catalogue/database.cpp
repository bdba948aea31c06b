// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/database.h"

#include <utility>

namespace weft::library {
namespace {

constexpr int kWait_ms = 5000;

ErrorKind kind_of(int code) {
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return ErrorKind::kTryAgain;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return ErrorKind::kBadData;
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return ErrorKind::kCannotCreate;
    case SQLITE_ERROR:
    case SQLITE_MISUSE:
    case SQLITE_RANGE:
      return ErrorKind::kInternal;
    default:
      return ErrorKind::kInputOutput;
  }
}

}  // namespace

Statement& Statement::bind(std::string_view text) {
  sqlite3_bind_text(statement_.get(), next_++, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  return *this;
}
Statement& Statement::bind(std::int64_t number) {
  sqlite3_bind_int64(statement_.get(), next_++, number);
  return *this;
}
Statement& Statement::bind(double number) {
  sqlite3_bind_double(statement_.get(), next_++, number);
  return *this;
}

Result<bool> Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return database_->error();
}

Result<void> Statement::run() {
  Result<bool> row = step();
  sqlite3_reset(statement_.get());
  next_ = 1;
  if (!row) return std::move(row).error();
  return {};
}

std::string Statement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return bytes == nullptr
             ? std::string()
             : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

Result<Database> Database::open(const std::filesystem::path& file) {
  Database opened(file);
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &handle,
                                   SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  opened.database_.reset(handle);
  if (code != SQLITE_OK) return opened.error();
  sqlite3_busy_timeout(handle, kWait_ms);
  if (Result<void> ok = opened.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL"); !ok)
    return std::move(ok).error();
  return opened;
}

Result<void> Database::run(const char* sql) {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) return error();
  return {};
}

Result<void> Database::together(const std::function<Result<void>()>& write) {
  if (Result<void> ok = run("BEGIN IMMEDIATE"); !ok) return ok;
  Result<void> done = write();
  if (done) done = run("COMMIT");
  if (!done) (void)run("ROLLBACK");
  return done;
}

Result<Statement> Database::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr) !=
      SQLITE_OK)
    return error();
  return Statement(*this, statement);
}

Error Database::error() const {
  const int code = database_ ? sqlite3_extended_errcode(database_.get()) : SQLITE_NOMEM;
  const char* why = database_ ? sqlite3_errmsg(database_.get()) : "out of memory";
  return {kind_of(code), "catalogue cannot be used", file_.string(), why,
          "see that its disk has room and may be written to; weft library rebuild makes it again"};
}

}  // namespace weft::library
