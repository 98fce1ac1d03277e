#include "sqlite.hpp"

#include <sqlite3.h>

namespace gravure::session {

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void Database::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

Statement& Statement::bind(std::int64_t value) {
  const int code = sqlite3_bind_int64(statement_.get(), next_++, value);
  bound_ = bound_ != SQLITE_OK ? bound_ : code;
  return *this;
}

Statement& Statement::bind(const std::string& value) {
  const int code =
      sqlite3_bind_text64(statement_.get(), next_++, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  bound_ = bound_ != SQLITE_OK ? bound_ : code;
  return *this;
}

Result<bool> Statement::step() {
  const int code = bound_ != SQLITE_OK ? bound_ : sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    return database_->error(code);
  }
  return code == SQLITE_ROW;
}

Result<void> Statement::run() {
  const Result<bool> stepped = step();
  const int code = sqlite3_reset(statement_.get());
  next_ = 1;
  bound_ = SQLITE_OK;
  GRAVURE_CHECK(stepped);
  return code == SQLITE_OK ? Result<void>() : database_->error(code);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  const int bytes = sqlite3_column_bytes(statement_.get(), column);
  return text == nullptr ? std::string() : std::string(text, text + bytes);
}

Result<std::unique_ptr<Database>> Database::open(const std::string& path) {
  std::unique_ptr<Database> database(new Database(path));
  sqlite3* handle = nullptr;
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_FULLMUTEX;
  const int code = sqlite3_open_v2(path.c_str(), &handle, kFlags, nullptr);
  database->handle_.reset(handle);
  if (code != SQLITE_OK) {
    return database->error(code);
  }
  sqlite3_extended_result_codes(handle, 1);
  return database;
}

Result<void> Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code == SQLITE_OK) {
    return {};
  }
  Error failure = error(code);
  if (sqlite3_get_autocommit(handle_.get()) == 0) {
    sqlite3_exec(handle_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
  return failure;
}

Result<Statement> Database::prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(handle_.get(), sql.c_str(), -1, &statement, nullptr);
  if (code != SQLITE_OK) {
    return error(code);
  }
  return Statement(*this, statement);
}

Result<std::int64_t> Database::query(const std::string& sql) const {
  GRAVURE_TRY(Statement statement, prepare(sql));
  GRAVURE_TRY(const bool row, statement.step());
  return row ? statement.integer(0) : 0;
}

Error Database::error(int code) const {
  const std::string why = handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(code);
  const auto failure = [&](ErrorCode kind, const std::string& what, const std::string& remedy) {
    return Error{kind, "journal " + path_ + ": " + what + " (" + why + "): " + remedy};
  };
  switch (code & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return failure(ErrorCode::io, "another run has it", "wait until that one has ended");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_CONSTRAINT:
    case SQLITE_ERROR:
      return failure(ErrorCode::bad_file, "it is damaged or no journal",
                     "keep it for inspection under another name; what the workpiece has got is then known only to the "
                     "board and to you");
    case SQLITE_FULL:
      return failure(ErrorCode::io, "the disk is full", "make room, or give another place with --journal");
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return failure(ErrorCode::io, "cannot be written",
                     "check the permissions of the file and its folder, or give "
                     "another place with --journal");
    default:
      return failure(ErrorCode::io, "cannot be read or written",
                     "check the disk, make room, or give another place with --journal");
  }
}

}  // namespace gravure::session
