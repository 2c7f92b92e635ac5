#include "records/bookmarks.h"

#include <optional>

#include <sqlite3.h>

namespace haustra::records {
namespace {

// AUTOINCREMENT: an id is never given twice, even after its row has gone.
constexpr char schema[] = R"(
    PRAGMA journal_mode = WAL;
    PRAGMA synchronous = FULL;
    CREATE TABLE IF NOT EXISTS bookmarks(
        id INTEGER PRIMARY KEY AUTOINCREMENT,
        case_name TEXT NOT NULL,
        client_key TEXT NOT NULL,
        position_x REAL NOT NULL, position_y REAL NOT NULL, position_z REAL NOT NULL,
        forward_x REAL NOT NULL, forward_y REAL NOT NULL, forward_z REAL NOT NULL,
        up_x REAL NOT NULL, up_y REAL NOT NULL, up_z REAL NOT NULL,
        arc_mm REAL NOT NULL,
        note TEXT NOT NULL,
        created_utc TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now')),
        UNIQUE(case_name, client_key));
)";

constexpr char columns[] =
    "SELECT id, case_name, client_key, position_x, position_y, position_z, forward_x, forward_y, "
    "forward_z, up_x, up_y, up_z, arc_mm, note, created_utc FROM bookmarks ";

constexpr int busyMs = 5000;  // another process commits

Result<void> run(sqlite3* database, const char* sql, const char* doing) {
    if (sqlite3_exec(database, sql, nullptr, nullptr, nullptr) != SQLITE_OK)
        return failedSql(database, doing);
    return {};
}

std::size_t listBytes(const NewBookmark& bookmark) {
    return bookmark.note.size() + bookmark.clientKey.size() + 256;
}

Bookmark bookmarkAt(const Statement& row) {
    Bookmark bookmark;
    bookmark.id = std::uint64_t(row.integer(0));
    bookmark.caseName = row.text(1);
    bookmark.clientKey = row.text(2);
    bookmark.positionMm = {row.real(3), row.real(4), row.real(5)};
    bookmark.forward = {row.real(6), row.real(7), row.real(8)};
    bookmark.up = {row.real(9), row.real(10), row.real(11)};
    bookmark.arcMm = row.real(12);
    bookmark.note = row.text(13);
    bookmark.createdUtc = row.text(14);
    return bookmark;
}

}  // namespace

void BookmarkStore::Close::operator()(sqlite3* database) const {
    sqlite3_close_v2(database);
}

BookmarkStore::BookmarkStore(std::unique_ptr<sqlite3, Close> database, Statement insert,
                             Statement find, Statement select)
    : database_(std::move(database)),
      insert_(std::move(insert)),
      find_(std::move(find)),
      list_(std::move(select)) {}

Result<BookmarkStore> BookmarkStore::open(const std::filesystem::path& file) {
    sqlite3* opened = nullptr;
    const int code =
        sqlite3_open_v2(file.c_str(), &opened,
                        SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
    std::unique_ptr<sqlite3, Close> database(opened);
    if (code != SQLITE_OK) return failedSql(opened, "open " + file.string());
    sqlite3_busy_timeout(opened, busyMs);
    if (const auto made = run(opened, schema, "prepare the records"); !made)
        return tl::make_unexpected(made.error());

    auto insert = Statement::prepare(
        opened,
        "INSERT INTO bookmarks(case_name, client_key, position_x, position_y, position_z, "
        "forward_x, forward_y, forward_z, up_x, up_y, up_z, arc_mm, note) "
        "VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?) RETURNING id, created_utc");
    if (!insert) return tl::make_unexpected(insert.error());
    const std::string select = columns;
    auto find =
        Statement::prepare(opened, (select + "WHERE case_name = ? AND client_key = ?").c_str());
    if (!find) return tl::make_unexpected(find.error());
    auto list = Statement::prepare(opened, (select + "WHERE case_name = ? ORDER BY id").c_str());
    if (!list) return tl::make_unexpected(list.error());

    BookmarkStore store(std::move(database), std::move(*insert), std::move(*find),
                        std::move(*list));
    auto sizes = Statement::prepare(
        opened,
        "SELECT case_name, sum(length(CAST(note AS BLOB)) + length(CAST(client_key AS BLOB)) + "
        "256) FROM bookmarks GROUP BY case_name");
    if (!sizes) return tl::make_unexpected(sizes.error());
    auto row = sizes->step();
    for (; row && *row; row = sizes->step())
        store.caseBytes_[sizes->text(0)] = std::size_t(sizes->integer(1));
    if (!row) return tl::make_unexpected(row.error());
    return store;
}

Result<Bookmark> BookmarkStore::addOne(const NewBookmark& bookmark) {
    find_.bind(1, bookmark.caseName);
    find_.bind(2, bookmark.clientKey);
    const auto found = find_.step();
    std::optional<Bookmark> known;
    if (found && *found) known = bookmarkAt(find_);
    find_.reset();
    if (!found) return tl::make_unexpected(found.error());
    if (known) return *known;

    if (caseBytes_[bookmark.caseName] + listBytes(bookmark) > maxCaseBytes)
        return fail(ErrorKind::badInput, "the case holds as many bookmarks as it can", "bookmarks");
    int parameter = 0;
    insert_.bind(++parameter, bookmark.caseName);
    insert_.bind(++parameter, bookmark.clientKey);
    for (const glm::dvec3& vector : {bookmark.positionMm, bookmark.forward, bookmark.up})
        for (int axis = 0; axis < 3; ++axis)
            insert_.bind(++parameter, vector[axis]);
    insert_.bind(++parameter, bookmark.arcMm);
    insert_.bind(++parameter, bookmark.note);
    const auto inserted = insert_.step();
    Bookmark added{bookmark, 0, {}};
    if (inserted && *inserted) {
        added.id = std::uint64_t(insert_.integer(0));
        added.createdUtc = insert_.text(1);
    }
    insert_.reset();
    if (!inserted) return tl::make_unexpected(inserted.error());
    caseBytes_[bookmark.caseName] += listBytes(bookmark);
    return added;
}

Result<std::vector<Result<Bookmark>>> BookmarkStore::add(
    const std::vector<NewBookmark>& bookmarks) {
    sqlite3* const database = database_.get();
    // IMMEDIATE: whoever else writes is waited for here, not found out half way.
    if (const auto begun = run(database, "BEGIN IMMEDIATE", "write the records"); !begun)
        return tl::make_unexpected(begun.error());
    const auto bytesBefore = caseBytes_;
    const auto giveUp = [&](const Error& error) {
        sqlite3_exec(database, "ROLLBACK", nullptr, nullptr, nullptr);
        caseBytes_ = bytesBefore;
        return tl::make_unexpected(error);
    };
    std::vector<Result<Bookmark>> added;
    for (const NewBookmark& bookmark : bookmarks) {
        added.push_back(addOne(bookmark));
        if (!added.back() && added.back().error().kind == ErrorKind::io)
            return giveUp(added.back().error());
    }
    if (const auto committed = run(database, "COMMIT", "write the records"); !committed)
        return giveUp(committed.error());
    return added;
}

Result<std::vector<Bookmark>> BookmarkStore::list(const std::string& caseName) {
    std::vector<Bookmark> bookmarks;
    list_.bind(1, caseName);
    auto row = list_.step();
    for (; row && *row; row = list_.step())
        bookmarks.push_back(bookmarkAt(list_));
    list_.reset();
    if (!row) return tl::make_unexpected(row.error());
    return bookmarks;
}

}  // namespace haustra::records
