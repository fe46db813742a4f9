/*
 * SQLite connection and statements as objects; errors as StoreError.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_STATEMENT_H
#define TSR_SINK_STATEMENT_H

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <sqlite3.h>

namespace tsr
{

class Connection
{
  public:
    Connection(const std::filesystem::path &file, int flags, const char *vfs);
    Connection(const Connection &) = delete;
    Connection &operator=(const Connection &) = delete;
    ~Connection();

    sqlite3 *get() const { return handle_; }
    void execute(const char *sql) const;
    [[noreturn]] void fail() const;

  private:
    sqlite3 *handle_ = nullptr;
};

/* Parameters count from 1, columns from 0, as in SQLite's interface. */
class Statement
{
  public:
    Statement(const Connection &connection, const char *sql);
    Statement(const Statement &) = delete;
    Statement &operator=(const Statement &) = delete;
    ~Statement();

    void reset();
    Statement &bind(int parameter, std::int64_t value);
    Statement &bind(int parameter, double value);
    Statement &bind(int parameter, std::span<const std::uint8_t> bytes); /* kept until the next reset */
    Statement &bind_null(int parameter);
    /* True: a row is there. */
    bool step();

    std::int64_t integer(int column) const { return sqlite3_column_int64(handle_, column); }
    double number(int column) const { return sqlite3_column_double(handle_, column); }
    bool is_null(int column) const { return sqlite3_column_type(handle_, column) == SQLITE_NULL; }
    std::vector<std::uint8_t> bytes(int column) const;

  private:
    void check(int result) const;

    const Connection &connection_;
    sqlite3_stmt *handle_ = nullptr;
};

} // namespace tsr

#endif
