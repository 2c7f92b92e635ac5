// Readers' bookmarks, kept in STORE/records.sqlite3.
#pragma once

#include "core/result.h"
#include "records/database.h"
#include "records/statement.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::records {

/// What a reader adds: a camera's place on a case, with a note. LPS, mm.
struct NewBookmark {
    std::string caseName;   ///< under which it was added; what it is of is the scan
    std::string scan;       ///< key of the scan that it is of
    std::string clientKey;  ///< chosen by the client, unique in the scan
    glm::dvec3 positionMm{0.0}, forward{0.0}, up{0.0};
    double arcMm = 0.0;
    std::string note;  ///< UTF-8
};

struct Bookmark : NewBookmark {
    std::uint64_t id = 0;    ///< unique in the store, growing
    std::string createdUtc;  ///< "2020-01-31T23:59:59Z"
};

struct BookmarkCounts {
    std::map<std::string, std::size_t> byScan;
    /// Of a case of this scan, those of the case of which no scan is known included.
    std::size_t of(const std::string& caseName, const std::string& scan) const;
};

/// The table of bookmarks. What add() has returned survives a crash (openDatabase). Belongs to one
/// thread; other processes may have the same file open.
///
/// Bookmarks belong to a scan, not to the case that it lies in: another scan under the case's name
/// shows none of them, and the scan under another name all. Files of before this was so had cases
/// alone: what they hold is given to a scan by adopt().
class BookmarkStore {
public:
    /// Opens the file, making it where it does not exist.
    static Result<BookmarkStore> open(const std::filesystem::path& file);

    /// Adds all in one transaction, which costs one fsync. Where a scan already holds the client
    /// key, the bookmark of that key is returned and nothing is stored: a client that has lost an
    /// acknowledgement may ask again. One that would take its scan past
    /// protocol::maxScanBookmarkBytes, with what other processes have added, is refused (badInput),
    /// and the others are added. Where the transaction fails, none is there. Some milliseconds for
    /// a scan that holds as many as it can.
    Result<std::vector<Result<Bookmark>>> add(const std::vector<NewBookmark>& bookmarks);

    /// A scan's bookmarks in the order in which they were added.
    Result<std::vector<Bookmark>> list(const std::string& scan);

    /// How many bookmarks there are now, of each scan.
    Result<BookmarkCounts> counts();

    /// The bookmarks of case `caseName` of which no scan is known are from now on of this one. For
    /// the scan that the case is of when it is first opened.
    Result<void> adopt(const std::string& caseName, const std::string& scan);

private:
    /// What each scan's bookmarks take in their list, of those that a transaction has asked for.
    using ScanBytes = std::map<std::string, std::size_t>;

    BookmarkStore(Database database, Statement insert, Statement find, Statement select,
                  Statement adopt, Statement measure);
    Result<void> findUnadopted();
    Result<std::size_t> bytesOf(const std::string& scan);
    Result<Bookmark> addOne(const NewBookmark& bookmark, ScanBytes& bytes);

    Database database_;  // first: outlives the statements
    Statement insert_, find_, list_, adopt_, measure_;
    std::set<std::string> unadopted_;  // cases with bookmarks of no known scan
};

}  // namespace haustra::records
