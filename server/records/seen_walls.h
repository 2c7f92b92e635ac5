// What of which wall which reader has had on screen, kept in STORE/records.sqlite3.
#pragma once

#include "core/result.h"
#include "core/seen_limits.h"
#include "records/database.h"
#include "records/statement.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haustra::records {

/// Whose it is, of which wall, and when a place counts: with other limits another one begins, so
/// that none mixes what was counted by different ones.
struct LedgerKey {
    std::string reader;  ///< as the reader's clients name themselves
    std::string wall;    ///< of its content: a wall that was made anew, and differs, is another
    SeenLimits limits;
    bool operator==(const LedgerKey&) const = default;
};

struct Ledger {
    LedgerKey key;
    std::string caseName, scan;        ///< under which it was read last
    std::vector<std::uint32_t> times;  ///< µs on screen of each triangle of the wall
    std::string changedUtc = {};       ///< "2020-01-31T23:59:59Z"; the store's own
};

/// The table of ledgers. What has been kept survives a crash (openDatabase). Belongs to one thread;
/// other processes may have the same file open.
class SeenStore {
public:
    /// Opens the file, making it where it does not exist.
    static Result<SeenStore> open(const std::filesystem::path& file);

    /// Keeps all in one transaction, which costs one fsync. Of each triangle the longer time
    /// counts, the one that is kept or the new one: of two programs that serve one reader neither
    /// takes away what the other has kept. Of a reader's ledgers of a wall past
    /// protocol::maxReaderLedgers those go that have changed longest ago, that of the usual limits
    /// last. One past protocol::maxWallLedgers of its wall or too large (badInput), or whose record
    /// is damaged (wrongState), is refused, and the others are kept; where the transaction fails,
    /// none is. Some milliseconds for a million triangles.
    Result<std::vector<Result<void>>> keep(std::span<const Ledger> ledgers);

    /// Nothing where there is none. Fails (io) where what is kept is damaged.
    Result<std::optional<Ledger>> find(const LedgerKey& key);
    /// Of this store: another program that serves the reader keeps what it has of it again.
    Result<void> forget(const LedgerKey& key);
    /// Of a wall at most so many, the newest first. Fails (io) where one is damaged.
    Result<std::vector<Ledger>> ofWall(const std::string& wall, int most);

private:
    SeenStore(Database database, Statement find, Statement ofWall, Statement count,
              Statement makeRoom, Statement write, Statement forget);
    /// Nothing where there is none; an error within where it is damaged.
    Result<std::optional<Result<Ledger>>> row(const LedgerKey& key);
    Result<bool> isFull(const std::string& wall);
    /// For one ledger more of this reader.
    Result<void> makeRoom(const LedgerKey& key);
    Result<void> keepOne(const Ledger& ledger);

    Database database_;  // first: outlives the statements
    Statement find_, ofWall_, count_, makeRoom_, write_, forget_;
};

}  // namespace haustra::records
