/* SQLite as objects. SPDX-License-Identifier: Apache-2.0 */
#include "statement.h"

#include "tsr/sink/store.h"

namespace tsr
{

Connection::Connection(const std::filesystem::path &file, int flags, const char *vfs)
{
    if (sqlite3_open_v2(file.c_str(), &handle_, flags, vfs) != SQLITE_OK) {
        const std::string reason = handle_ != nullptr ? sqlite3_errmsg(handle_) : "out of memory";
        sqlite3_close_v2(handle_);
        throw StoreError(reason);
    }
    sqlite3_extended_result_codes(handle_, 1);
}

Connection::~Connection()
{
    sqlite3_close_v2(handle_);
}

void Connection::execute(const char *sql) const
{
    if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
        fail();
    }
}

void Connection::fail() const
{
    throw StoreError(sqlite3_errmsg(handle_));
}

Statement::Statement(const Connection &connection, const char *sql) : connection_(connection)
{
    check(sqlite3_prepare_v3(connection.get(), sql, -1, SQLITE_PREPARE_PERSISTENT, &handle_, nullptr));
}

Statement::~Statement()
{
    sqlite3_finalize(handle_);
}

void Statement::check(int result) const
{
    if (result != SQLITE_OK) {
        connection_.fail();
    }
}

void Statement::reset()
{
    /* The result repeats the last step's error, which step() has thrown. */
    sqlite3_reset(handle_);
    check(sqlite3_clear_bindings(handle_));
}

Statement &Statement::bind(int parameter, std::int64_t value)
{
    check(sqlite3_bind_int64(handle_, parameter, value));
    return *this;
}

Statement &Statement::bind(int parameter, double value)
{
    check(sqlite3_bind_double(handle_, parameter, value));
    return *this;
}

Statement &Statement::bind(int parameter, std::span<const std::uint8_t> bytes)
{
    static constexpr std::uint8_t kNothing = 0; /* a null pointer would bind NULL */
    check(
        sqlite3_bind_blob64(handle_, parameter, bytes.empty() ? &kNothing : bytes.data(), bytes.size(), SQLITE_STATIC));
    return *this;
}

Statement &Statement::bind_null(int parameter)
{
    check(sqlite3_bind_null(handle_, parameter));
    return *this;
}

bool Statement::step()
{
    const int result = sqlite3_step(handle_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) {
        connection_.fail();
    }
    return result == SQLITE_ROW;
}

std::vector<std::uint8_t> Statement::bytes(int column) const
{
    const auto *first = static_cast<const std::uint8_t *>(sqlite3_column_blob(handle_, column));
    const auto len = static_cast<std::size_t>(sqlite3_column_bytes(handle_, column));
    return first == nullptr ? std::vector<std::uint8_t>() : std::vector<std::uint8_t>(first, first + len);
}

} // namespace tsr
