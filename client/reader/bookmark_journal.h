// The bookmarks that no server has acknowledged yet, on disk: what a reader wrote outlives a crash,
// a closed window and a refusal.
#pragma once

#include "reader/case_info.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haustra::reader {

struct JournalEntry {
    std::string server, fingerprint;     ///< "host:port", and its certificate's SHA-256
    std::string caseName, scan;          ///< that the reader saw
    std::int64_t notedMs = 0;            ///< when, since 1970
    Bookmark bookmark;                   ///< not acknowledged
    std::optional<std::string> refusal;  ///< why the server refused it, where it did
};

/// A folder with one file a bookmark, of one line of JSON. Not one file of many lines: two clients
/// of one user then never write the same file, need no lock that a network's file system may not
/// honour or a dead client may hold, and what damages a file costs one bookmark. The object holds
/// only the path: each call works on the folder as it is.
class BookmarkJournal {
public:
    explicit BookmarkJournal(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// $XDG_DATA_HOME/haustra/bookmarks, else ~/.local/share/haustra/bookmarks. Fails where neither
    /// variable is set.
    static Result<std::filesystem::path> defaultFolder();

    /// Writes the entry, replacing the one of the same client key. It is on the disk when this
    /// returns without an error, readable by the user alone. Two fsyncs.
    Result<void> write(const JournalEntry& entry) const;
    /// Does nothing where there is no such entry.
    Result<void> erase(const std::string& clientKey) const;

    struct Contents {
        std::vector<JournalEntry> entries;  ///< oldest first
        std::vector<Error> errors;          ///< one for each file that is no entry, or unreadable
    };
    /// A file that is no sound entry is renamed to end in .damaged, and told; one of a newer format
    /// stays, and is told. Without the folder there is nothing.
    Contents read() const;

    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

}  // namespace haustra::reader
