#include "records/database.h"

#include "records/statement.h"

#include <sqlite3.h>

namespace haustra::records {
namespace {

constexpr int busyMs = 5000;  // another process commits

}  // namespace

void CloseDatabase::operator()(sqlite3* database) const {
    sqlite3_close_v2(database);
}

Result<void> run(sqlite3* database, const char* sql, const char* doing) {
    if (sqlite3_exec(database, sql, nullptr, nullptr, nullptr) != SQLITE_OK)
        return failedSql(database, doing);
    return {};
}

Result<Database> openDatabase(const std::filesystem::path& file, const char* schema) {
    sqlite3* opened = nullptr;
    const int code =
        sqlite3_open_v2(file.c_str(), &opened,
                        SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
    Database database(opened);
    if (code != SQLITE_OK) return failedSql(opened, "open " + file.string());
    sqlite3_busy_timeout(opened, busyMs);
    TRY(run(opened, "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;",
            "prepare the records"));
    TRY(run(opened, schema, "prepare the records"));
    return database;
}

}  // namespace haustra::records
