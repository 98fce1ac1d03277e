#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gravure/core/error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace gravure::session {

class Database;

/// A prepared statement; errors of binding show when it is stepped.
class Statement {
 public:
  Statement& bind(std::int64_t value);
  Statement& bind(const std::string& value);
  /// True: there is a row.
  Result<bool> step();
  /// Steps once and is ready to be bound anew.
  Result<void> run();
  std::int64_t integer(int column) const;
  std::string text(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Statement(const Database& database, sqlite3_stmt* statement) : database_(&database), statement_(statement) {}
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int next_ = 1;
  int bound_ = 0;
};

/// An SQLite file. Messages name it and say what to do.
class Database {
 public:
  static Result<std::unique_ptr<Database>> open(const std::string& path);
  Result<void> execute(const std::string& sql);
  Result<Statement> prepare(const std::string& sql) const;
  /// The one value of a query.
  Result<std::int64_t> query(const std::string& sql) const;
  Error error(int code) const;
  const std::string& path() const noexcept { return path_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  explicit Database(std::string path) : path_(std::move(path)) {}
  std::string path_;
  std::unique_ptr<sqlite3, Close> handle_;
};

}  // namespace gravure::session
