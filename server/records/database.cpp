#include "records/database.h"

#include "records/statement.h"

#include <string>
#include <system_error>

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

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
    // Notes and readers' names are no business of other users of the machine. SQLite makes its own
    // files beside it with its permissions; an older Haustra's may be there. It is not opened where
    // it is there: to close it would take off the locks of this process.
    constexpr unsigned ownersAndGroups = 0640;
    const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, ownersAndGroups);
    if (made >= 0) {
        ::close(made);
    } else {
        for (const char* part : {"", "-wal", "-shm"}) {
            std::error_code ignored;  // none, or another user's
            std::filesystem::permissions(file.string() + part, std::filesystem::perms::others_all,
                                         std::filesystem::perm_options::remove, ignored);
        }
    }
    const std::string preparing = "prepare " + file.string();
    sqlite3* opened = nullptr;
    const int code =
        sqlite3_open_v2(file.c_str(), &opened,
                        SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
    Database database(opened);
    if (code != SQLITE_OK) return failedSql(opened, "open " + file.string());
    sqlite3_busy_timeout(opened, busyMs);
    TRY(run(opened, "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;", preparing.c_str()));
    TRY(run(opened, schema, preparing.c_str()));
    return database;
}

}  // namespace haustra::records
