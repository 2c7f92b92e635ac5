// Readers' bookmarks, kept in STORE/records.sqlite3.
#pragma once

#include "core/result.h"
#include "records/statement.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::records {

/// What a reader adds: a camera's place on a case, with a note. LPS, mm.
struct NewBookmark {
    std::string caseName;
    std::string clientKey;  ///< chosen by the client, unique in the case
    glm::dvec3 positionMm{0.0}, forward{0.0}, up{0.0};
    double arcMm = 0.0;
    std::string note;  ///< UTF-8
};

struct Bookmark : NewBookmark {
    std::uint64_t id = 0;    ///< unique in the store, growing
    std::string createdUtc;  ///< "2020-01-31T23:59:59Z"
};

/// What all bookmarks of a case may take together, so that their list fits in one message: each
/// counts its note's and key's bytes and 256 more.
inline constexpr std::size_t maxCaseBytes = 4'000'000;

/// The table of bookmarks. SQLite in WAL mode with synchronous=FULL: what add() has returned
/// survives a crash of the process, and of the machine where its disk honours fsync. Belongs to
/// one thread; other processes may have the same file open.
class BookmarkStore {
public:
    /// Opens the file, making it where it does not exist.
    static Result<BookmarkStore> open(const std::filesystem::path& file);

    /// Adds all in one transaction, which costs one fsync. Where a case already holds the client
    /// key, the bookmark of that key is returned and nothing is stored: a client that has lost an
    /// acknowledgement may ask again. One that would take its case past maxCaseBytes is refused
    /// (badInput), and the others are added. Where the transaction fails, none is there.
    Result<std::vector<Result<Bookmark>>> add(const std::vector<NewBookmark>& bookmarks);

    /// A case's bookmarks in the order in which they were added.
    Result<std::vector<Bookmark>> list(const std::string& caseName);

private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    BookmarkStore(std::unique_ptr<sqlite3, Close> database, Statement insert, Statement find,
                  Statement select);
    Result<Bookmark> addOne(const NewBookmark& bookmark);

    std::unique_ptr<sqlite3, Close> database_;  // first: outlives the statements
    Statement insert_, find_, list_;
    std::map<std::string, std::size_t> caseBytes_;
};

}  // namespace haustra::records
