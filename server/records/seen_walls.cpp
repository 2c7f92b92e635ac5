#include "records/seen_walls.h"

#include "protocol/limits.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <zstd.h>

namespace haustra::records {
namespace {

// `times`: 32-bit numbers, the lowest byte first, as one Zstandard frame.
constexpr char seenSchema[] = R"(
    CREATE TABLE IF NOT EXISTS seen_walls(
        reader TEXT NOT NULL,
        wall TEXT NOT NULL,
        pixels_per_mm REAL NOT NULL,
        least_ms INTEGER NOT NULL,
        case_name TEXT NOT NULL,
        scan TEXT NOT NULL,
        triangles INTEGER NOT NULL,
        times BLOB NOT NULL,
        changed_utc TEXT NOT NULL,
        PRIMARY KEY(wall, reader, pixels_per_mm, least_ms)) WITHOUT ROWID;
)";

constexpr char seenColumns[] =
    "SELECT reader, wall, pixels_per_mm, least_ms, case_name, scan, triangles, times, "
    "changed_utc FROM seen_walls WHERE wall = ?";

static_assert(std::endian::native == std::endian::little);

Result<std::vector<std::uint8_t>> packed(std::span<const std::uint32_t> times) {
    std::vector<std::uint8_t> bytes(ZSTD_compressBound(times.size_bytes()));
    const std::size_t size =
        ZSTD_compress(bytes.data(), bytes.size(), times.data(), times.size_bytes(), 1);
    if (ZSTD_isError(size))
        return fail(ErrorKind::io,
                    std::string("cannot pack the records: ") + ZSTD_getErrorName(size), "records");
    bytes.resize(size);
    return bytes;
}

tl::unexpected<Error> damaged() {
    return fail(ErrorKind::io, "the record of what a reader has seen of this wall is damaged",
                "records");
}

Result<Ledger> ledgerAt(const Statement& row) {
    Ledger ledger;
    ledger.key = {row.text(0), row.text(1), {row.real(2), int(row.integer(3))}};
    ledger.caseName = row.text(4);
    ledger.scan = row.text(5);
    ledger.changedUtc = row.text(8);
    const std::int64_t triangles = row.integer(6);
    const auto bytes = row.blob(7);
    // Of its own frame, so that no number in the file makes memory.
    if (triangles < 0 ||
        ZSTD_getFrameContentSize(bytes.data(), bytes.size()) !=
            std::uint64_t(triangles) * sizeof(std::uint32_t) ||
        std::uint64_t(triangles) > std::uint64_t(protocol::maxLedgerTriangles))
        return damaged();
    ledger.times.resize(std::size_t(triangles));
    const std::size_t size =
        ZSTD_decompress(ledger.times.data(), ledger.times.size() * sizeof(std::uint32_t),
                        bytes.data(), bytes.size());
    if (ZSTD_isError(size) || size != ledger.times.size() * sizeof(std::uint32_t)) return damaged();
    return ledger;
}

void bindKey(Statement& statement, const LedgerKey& key) {
    statement.bind(1, key.wall);
    statement.bind(2, key.reader);
    statement.bind(3, key.limits.pixelsPerMm);
    statement.bind(4, std::int64_t(key.limits.leastMs));
}

// Files of earlier versions have a column that nothing reads any more.
Result<void> dropShare(sqlite3* database) {
    return inTransaction(database, [&]() -> Result<void> {
        auto has = TRY(Statement::prepare(
            database, "SELECT count(*) FROM pragma_table_info('seen_walls') WHERE name = 'share'"));
        {
            const ResetAfter reset(has);
            if (!TRY(has.step()) || has.integer(0) == 0) return {};
        }
        return run(database, "ALTER TABLE seen_walls DROP COLUMN share", "take up the records");
    });
}

}  // namespace

SeenStore::SeenStore(Database database, Statement find, Statement ofWall, Statement count,
                     Statement makeRoom, Statement write, Statement forget)
    : database_(std::move(database)),
      find_(std::move(find)),
      ofWall_(std::move(ofWall)),
      count_(std::move(count)),
      makeRoom_(std::move(makeRoom)),
      write_(std::move(write)),
      forget_(std::move(forget)) {}

Result<SeenStore> SeenStore::open(const std::filesystem::path& file) {
    auto database = TRY(openDatabase(file, seenSchema));
    TRY(dropShare(database.get()));
    const std::string select = seenColumns,
                      byKey = " AND reader = ? AND pixels_per_mm = ? AND least_ms = ?";
    const auto prepared = [&](const std::string& sql) {
        return Statement::prepare(database.get(), sql.c_str());
    };
    auto find = TRY(prepared(select + byKey));
    auto ofWall = TRY(prepared(select + " ORDER BY changed_utc DESC, reader LIMIT ?"));
    auto count = TRY(prepared("SELECT count(*) FROM seen_walls WHERE wall = ?"));
    auto makeRoom = TRY(prepared(
        "DELETE FROM seen_walls WHERE (wall, reader, pixels_per_mm, least_ms) IN (SELECT wall, "
        "reader, pixels_per_mm, least_ms FROM seen_walls WHERE wall = ? AND reader = ? ORDER BY "
        "pixels_per_mm = ? AND least_ms = ? DESC, changed_utc DESC LIMIT -1 OFFSET " +
        std::to_string(protocol::maxReaderLedgers - 1) + ")"));
    auto write =
        TRY(prepared("INSERT OR REPLACE INTO seen_walls(wall, reader, pixels_per_mm, least_ms, "
                     "case_name, scan, triangles, times, changed_utc) "
                     "VALUES(?,?,?,?,?,?,?,?, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))"));
    auto forget = TRY(prepared("DELETE FROM seen_walls WHERE wall = ?" + byKey));
    return SeenStore(std::move(database), std::move(find), std::move(ofWall), std::move(count),
                     std::move(makeRoom), std::move(write), std::move(forget));
}

Result<std::optional<Result<Ledger>>> SeenStore::row(const LedgerKey& key) {
    const ResetAfter reset(find_);
    bindKey(find_, key);
    if (!TRY(find_.step())) return std::optional<Result<Ledger>>();
    return std::optional<Result<Ledger>>(ledgerAt(find_));
}

Result<std::optional<Ledger>> SeenStore::find(const LedgerKey& key) {
    auto found = TRY(row(key));
    if (!found) return std::optional<Ledger>();
    return TRY(std::move(*found));
}

Result<void> SeenStore::forget(const LedgerKey& key) {
    const ResetAfter reset(forget_);
    bindKey(forget_, key);
    TRY(forget_.step());
    return {};
}

Result<std::vector<Ledger>> SeenStore::ofWall(const std::string& wall, int most) {
    const ResetAfter reset(ofWall_);
    ofWall_.bind(1, wall);
    ofWall_.bind(2, std::int64_t(most));
    std::vector<Ledger> ledgers;
    while (TRY(ofWall_.step()))
        ledgers.push_back(TRY(ledgerAt(ofWall_)));
    return ledgers;
}

Result<bool> SeenStore::isFull(const std::string& wall) {
    const ResetAfter reset(count_);
    count_.bind(1, wall);
    return TRY(count_.step()) && count_.integer(0) >= protocol::maxWallLedgers;
}

Result<void> SeenStore::makeRoom(const LedgerKey& key) {
    const ResetAfter reset(makeRoom_);
    bindKey(makeRoom_, {key.reader, key.wall, SeenLimits{}});
    TRY(makeRoom_.step());
    return {};
}

Result<void> SeenStore::keepOne(const Ledger& ledger) {
    auto times = ledger.times;
    if (times.size() > std::size_t(protocol::maxLedgerTriangles))
        return fail(ErrorKind::badInput, "the wall has more triangles than a record may have",
                    "seen");
    const auto before = TRY(row(ledger.key));
    if (!before) TRY(makeRoom(ledger.key));
    if (before) {
        // Not io, as it is of this reader alone: the others' are kept.
        if (!*before || (*before)->times.size() != times.size())
            return fail(ErrorKind::wrongState, damaged().value().message, "records");
        for (std::size_t t = 0; t < times.size(); ++t)
            times[t] = std::max(times[t], (*before)->times[t]);
    } else if (TRY(isFull(ledger.key.wall))) {
        return fail(ErrorKind::badInput,
                    "so many readers' records of this wall are kept that there is no room for "
                    "another",
                    "seen");
    }
    const auto blob = TRY(packed(times));
    const ResetAfter reset(write_);
    bindKey(write_, ledger.key);
    write_.bind(5, ledger.caseName);
    write_.bind(6, ledger.scan);
    write_.bind(7, std::int64_t(times.size()));
    write_.bind(8, std::span<const std::uint8_t>(blob));
    TRY(write_.step());
    return {};
}

Result<std::vector<Result<void>>> SeenStore::keep(std::span<const Ledger> ledgers) {
    return inTransaction(database_.get(), [&]() -> Result<std::vector<Result<void>>> {
        std::vector<Result<void>> kept;
        for (const Ledger& ledger : ledgers) {
            kept.push_back(keepOne(ledger));
            if (!kept.back() && kept.back().error().kind == ErrorKind::io)
                return tl::make_unexpected(kept.back().error());
        }
        return kept;
    });
}

}  // namespace haustra::records
