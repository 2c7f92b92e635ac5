// STORE/records.sqlite3, as each kind of record opens it.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <memory>

struct sqlite3;

namespace haustra::records {

struct CloseDatabase {
    void operator()(sqlite3* database) const;
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

/// Opens the file, making it where it does not exist, in WAL mode with synchronous=FULL: what has
/// been committed survives a crash of the process, and of the machine where its disk honours fsync.
/// Runs `schema`. Belongs to one thread; other connections and processes may have the same file
/// open.
Result<Database> openDatabase(const std::filesystem::path& file, const char* schema);

/// Statements without parameters or rows. `doing` is for the error: "cannot <doing>: …".
Result<void> run(sqlite3* database, const char* sql, const char* doing);

/// Runs `work`, which returns a Result, in one transaction; where it throws, or it or the commit
/// fails, nothing has changed. Whoever else writes is waited for at its beginning.
template <class Work>
auto inTransaction(sqlite3* database, const Work& work) -> decltype(work()) {
    TRY(run(database, "BEGIN IMMEDIATE", "write the records"));
    struct TakenBack {
        sqlite3* database;
        ~TakenBack() {
            if (database) (void)run(database, "ROLLBACK", "take the records back");
        }
    } takenBack{database};
    auto done = work();
    if (!done) return done;
    if (const auto committed = run(database, "COMMIT", "write the records"); !committed)
        return tl::make_unexpected(committed.error());
    takenBack.database = nullptr;
    return done;
}

}  // namespace haustra::records
