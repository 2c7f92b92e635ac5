#include "records/bookmarks.h"

#include "protocol/limits.h"

#include <optional>

#include <sqlite3.h>

namespace haustra::records {
namespace {

// AUTOINCREMENT: an id is never given twice, even after its row has gone.
constexpr char schema[] = R"(
    CREATE TABLE IF NOT EXISTS scan_bookmarks(
        id INTEGER PRIMARY KEY AUTOINCREMENT,
        case_name TEXT NOT NULL,
        scan TEXT NOT NULL,
        client_key TEXT NOT NULL,
        position_x REAL NOT NULL, position_y REAL NOT NULL, position_z REAL NOT NULL,
        forward_x REAL NOT NULL, forward_y REAL NOT NULL, forward_z REAL NOT NULL,
        up_x REAL NOT NULL, up_y REAL NOT NULL, up_z REAL NOT NULL,
        arc_mm REAL NOT NULL,
        note TEXT NOT NULL,
        created_utc TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now')),
        UNIQUE(scan, client_key));
)";

// Of before bookmarks had scans. Until its scan is known, a case stands for it; no key of a scan
// holds a colon.
constexpr char upgrade[] = R"(
    BEGIN IMMEDIATE;
    INSERT INTO scan_bookmarks SELECT id, case_name, 'case:' || case_name, client_key, position_x,
        position_y, position_z, forward_x, forward_y, forward_z, up_x, up_y, up_z, arc_mm, note,
        created_utc FROM bookmarks;
    DROP TABLE bookmarks;
    COMMIT;
)";

constexpr char columns[] =
    "SELECT id, case_name, scan, client_key, position_x, position_y, position_z, forward_x, "
    "forward_y, "
    "forward_z, up_x, up_y, up_z, arc_mm, note, created_utc FROM "
    "scan_bookmarks ";

constexpr char caseForScan[] = "case:";  // as `upgrade` has it

std::size_t listBytes(const NewBookmark& bookmark) {
    return bookmark.note.size() + bookmark.clientKey.size() + protocol::bookmarkOverheadBytes;
}

Bookmark bookmarkAt(const Statement& row) {
    Bookmark bookmark;
    bookmark.id = std::uint64_t(row.integer(0));
    bookmark.caseName = row.text(1);
    bookmark.scan = row.text(2);
    bookmark.clientKey = row.text(3);
    bookmark.positionMm = {row.real(4), row.real(5), row.real(6)};
    bookmark.forward = {row.real(7), row.real(8), row.real(9)};
    bookmark.up = {row.real(10), row.real(11), row.real(12)};
    bookmark.arcMm = row.real(13);
    bookmark.note = row.text(14);
    bookmark.createdUtc = row.text(15);
    return bookmark;
}

}  // namespace

BookmarkStore::BookmarkStore(Database database, Statement insert, Statement find, Statement select,
                             Statement adopt, Statement measure)
    : database_(std::move(database)),
      insert_(std::move(insert)),
      find_(std::move(find)),
      list_(std::move(select)),
      adopt_(std::move(adopt)),
      measure_(std::move(measure)) {}

Result<BookmarkStore> BookmarkStore::open(const std::filesystem::path& file) {
    auto database = TRY(openDatabase(file, schema));
    sqlite3* const opened = database.get();
    auto former =
        TRY(Statement::prepare(opened, "SELECT 1 FROM sqlite_schema WHERE name = 'bookmarks'"));
    const auto isFormer = TRY(former.step());
    former.reset();
    if (isFormer) {
        TRY(run(opened, upgrade, "upgrade the records"));
    }

    auto insert = TRY(Statement::prepare(
        opened,
        "INSERT INTO scan_bookmarks(case_name, scan, client_key, position_x, position_y, "
        "position_z, forward_x, forward_y, forward_z, up_x, up_y, up_z, arc_mm, note) "
        "VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?) RETURNING id, created_utc"));
    const std::string select = columns;
    auto find =
        TRY(Statement::prepare(opened, (select + "WHERE scan = ? AND client_key = ?").c_str()));
    auto list = TRY(Statement::prepare(opened, (select + "WHERE scan = ? ORDER BY id").c_str()));
    auto adopt = TRY(
        Statement::prepare(opened, "UPDATE OR IGNORE scan_bookmarks SET scan = ? WHERE scan = ?"));

    const std::string sum =
        "SELECT coalesce(sum(length(CAST(note AS BLOB)) + length(CAST(client_key AS BLOB)) + " +
        std::to_string(protocol::bookmarkOverheadBytes) +
        "), 0) FROM scan_bookmarks WHERE scan = ?";
    auto measure = TRY(Statement::prepare(opened, sum.c_str()));

    BookmarkStore store(std::move(database), std::move(insert), std::move(find), std::move(list),
                        std::move(adopt), std::move(measure));
    TRY(store.findUnadopted());
    return store;
}

Result<void> BookmarkStore::findUnadopted() {
    auto scans =
        TRY(Statement::prepare(database_.get(), "SELECT DISTINCT scan FROM scan_bookmarks"));
    unadopted_.clear();
    auto row = scans.step();
    for (; row && *row; row = scans.step())
        if (const std::string scan = scans.text(0); scan.starts_with(caseForScan))
            unadopted_.insert(scan);
    if (!row) return tl::make_unexpected(row.error());
    return {};
}

Result<std::size_t> BookmarkStore::bytesOf(const std::string& scan) {
    const ResetAfter reset(measure_);
    measure_.bind(1, scan);
    TRY(measure_.step());
    return std::size_t(measure_.integer(0));
}

Result<void> BookmarkStore::adopt(const std::string& caseName, const std::string& scan) {
    const std::string former = caseForScan + caseName;
    if (!unadopted_.contains(former)) return {};
    adopt_.bind(1, scan);
    adopt_.bind(2, former);
    const auto adopted = adopt_.step();
    adopt_.reset();
    if (!adopted) return tl::make_unexpected(adopted.error());
    return findUnadopted();
}

Result<Bookmark> BookmarkStore::addOne(const NewBookmark& bookmark, ScanBytes& bytes) {
    find_.bind(1, bookmark.scan);
    find_.bind(2, bookmark.clientKey);
    const auto found = find_.step();
    std::optional<Bookmark> known;
    if (found && *found) known = bookmarkAt(find_);
    find_.reset();
    if (!found) return tl::make_unexpected(found.error());
    if (known) return *known;

    auto taken = bytes.find(bookmark.scan);
    if (taken == bytes.end())
        taken = bytes.emplace(bookmark.scan, TRY(bytesOf(bookmark.scan))).first;
    if (taken->second + listBytes(bookmark) > protocol::maxScanBookmarkBytes)
        return fail(ErrorKind::badInput, "the scan holds as many bookmarks as it can", "bookmarks");
    int parameter = 0;
    insert_.bind(++parameter, bookmark.caseName);
    insert_.bind(++parameter, bookmark.scan);
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
    taken->second += listBytes(bookmark);
    return added;
}

Result<std::vector<Result<Bookmark>>> BookmarkStore::add(
    const std::vector<NewBookmark>& bookmarks) {
    return inTransaction(database_.get(), [&]() -> Result<std::vector<Result<Bookmark>>> {
        std::vector<Result<Bookmark>> added;
        ScanBytes bytes;
        for (const NewBookmark& bookmark : bookmarks) {
            added.push_back(addOne(bookmark, bytes));
            if (!added.back() && added.back().error().kind == ErrorKind::io)
                return tl::make_unexpected(added.back().error());
        }
        return added;
    });
}

std::size_t BookmarkCounts::of(const std::string& caseName, const std::string& scan) const {
    std::size_t count = 0;
    for (const std::string& key : {scan, caseForScan + caseName})
        if (const auto found = byScan.find(key); found != byScan.end()) count += found->second;
    return count;
}

Result<BookmarkCounts> BookmarkStore::counts() {
    auto rows = TRY(Statement::prepare(database_.get(),
                                       "SELECT scan, count(*) FROM scan_bookmarks GROUP BY scan"));
    BookmarkCounts counts;
    auto row = rows.step();
    for (; row && *row; row = rows.step())
        counts.byScan[rows.text(0)] = std::size_t(rows.integer(1));
    if (!row) return tl::make_unexpected(row.error());
    return counts;
}

Result<std::vector<Bookmark>> BookmarkStore::list(const std::string& scan) {
    std::vector<Bookmark> bookmarks;
    list_.bind(1, scan);
    auto row = list_.step();
    for (; row && *row; row = list_.step())
        bookmarks.push_back(bookmarkAt(list_));
    list_.reset();
    if (!row) return tl::make_unexpected(row.error());
    return bookmarks;
}

}  // namespace haustra::records
