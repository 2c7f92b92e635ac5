#include "records/statement.h"

#include <sqlite3.h>

namespace haustra::records {

tl::unexpected<Error> failedSql(sqlite3* database, const std::string& doing) {
    return fail(ErrorKind::io,
                "cannot " + doing + ": " +
                    (database ? sqlite3_errmsg(database) : "there is not enough memory"),
                "records");
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Result<Statement> Statement::prepare(sqlite3* database, const char* sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database, sql, -1, &statement, nullptr) != SQLITE_OK)
        return failedSql(database, "read the records");
    return Statement(statement);
}

void Statement::bind(int parameter, std::int64_t value) {
    sqlite3_bind_int64(statement_.get(), parameter, value);
}
void Statement::bind(int parameter, double value) {
    sqlite3_bind_double(statement_.get(), parameter, value);
}
void Statement::bind(int parameter, const std::string& text) {
    sqlite3_bind_text(statement_.get(), parameter, text.data(), int(text.size()), SQLITE_TRANSIENT);
}

void Statement::bind(int parameter, std::span<const std::uint8_t> blob) {
    sqlite3_bind_blob64(statement_.get(), parameter, blob.data(), blob.size(), SQLITE_TRANSIENT);
}

Result<bool> Statement::step() {
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    return failedSql(sqlite3_db_handle(statement_.get()), "use the records");
}

void Statement::reset() {
    sqlite3_reset(statement_.get());
    sqlite3_clear_bindings(statement_.get());
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}
double Statement::real(int column) const {
    return sqlite3_column_double(statement_.get(), column);
}
std::string Statement::text(int column) const {
    const auto* text = sqlite3_column_text(statement_.get(), column);
    const int bytes = sqlite3_column_bytes(statement_.get(), column);
    return text ? std::string(reinterpret_cast<const char*>(text), std::size_t(bytes))
                : std::string();
}
std::span<const std::uint8_t> Statement::blob(int column) const {
    const auto* bytes =
        static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
    return {bytes, std::size_t(sqlite3_column_bytes(statement_.get(), column))};
}

}  // namespace haustra::records
