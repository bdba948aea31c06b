// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"

// SQLite with values and Results. What fails is a kInputOutput of the file, kTryAgain where another process
// holds it, kBadData where it is no database.

namespace weft::library {

class Database;

/// One prepared statement. Texts are copied.
class Statement {
 public:
  /// Binds the next parameter.
  Statement& bind(std::string_view text);
  Statement& bind(std::int64_t number);
  Statement& bind(double number);

  /// Whether there is one more row.
  Result<bool> step();
  /// Runs a statement without rows to its end, and makes it ready for other values.
  Result<void> run();

  /// Values of the row, by column.
  std::string text(int column) const;
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  double number(int column) const { return sqlite3_column_double(statement_.get(), column); }

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  Statement(const Database& database, sqlite3_stmt* statement)
      : database_(&database), statement_(statement) {}

  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int next_ = 1;
};

/// One connection. Not for two threads at once.
class Database {
 public:
  /// Opens a file, and makes it if there is none. Readers go on while another connection writes (WAL);
  /// whoever finds the file locked waits up to five seconds.
  static Result<Database> open(const std::filesystem::path& file);

  /// Statements without parameters and rows.
  Result<void> run(const char* sql);
  /// Runs `write` as one transaction, which an error takes back.
  Result<void> together(const std::function<Result<void>()>& write);
  /// `sql` is one of this program's own: a mistake in it is kInternal.
  Result<Statement> prepare(std::string_view sql) const;
  const std::filesystem::path& file() const { return file_; }
  /// The error of the last call.
  Error error() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  explicit Database(std::filesystem::path file) : file_(std::move(file)) {}

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace weft::library
