#include "reader/bookmark_journal.h"

#include "core/text_file.h"
#include "link/private_file.h"
#include "protocol/limits.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace haustra::reader {
namespace {

using nlohmann::json;

constexpr int format = 1;
constexpr char extension[] = ".json";
constexpr std::size_t maxFileBytes = 1 << 20;

// It names a file.
bool isKey(const std::string& key) {
    return !key.empty() && key.size() <= protocol::maxClientKeyBytes &&
           key.find_first_not_of("0123456789abcdef") == std::string::npos;
}

json listOf(glm::dvec3 v) {
    return {v.x, v.y, v.z};
}
glm::dvec3 vectorOf(const json& list) {
    const auto numbers = list.get<std::array<double, 3>>();
    const glm::dvec3 v(numbers[0], numbers[1], numbers[2]);
    if (!isFinite(v)) throw std::runtime_error("a number is not finite");
    return v;
}

std::string lineOf(const JournalEntry& entry) {
    // Each field by name: one that is added does not compile until it is kept here, and read below.
    const auto& [id, camera, arcMm, note, createdUtc, mark, clientKey] = entry.bookmark;
    static_cast<void>(id), static_cast<void>(createdUtc), static_cast<void>(mark);  // the server's
    json line = {{"format", format},
                 {"server", entry.server},
                 {"fingerprint", entry.fingerprint},
                 {"case", entry.caseName},
                 {"scan", entry.scan},
                 {"noted_ms", entry.notedMs},
                 {"key", clientKey},
                 {"position_mm", listOf(camera.positionMm)},
                 {"forward", listOf(camera.forward)},
                 {"up", listOf(camera.up)},
                 {"arc_mm", arcMm},
                 {"note", note}};
    if (entry.refusal) line["refusal"] = *entry.refusal;
    return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

// Throws where a field is missing or of another kind.
JournalEntry entryOf(const json& line) {
    JournalEntry entry;
    line.at("server").get_to(entry.server);
    line.at("fingerprint").get_to(entry.fingerprint);
    line.at("case").get_to(entry.caseName);
    line.at("scan").get_to(entry.scan);
    line.at("noted_ms").get_to(entry.notedMs);
    Bookmark& bookmark = entry.bookmark;
    line.at("key").get_to(bookmark.clientKey);
    bookmark.camera.positionMm = vectorOf(line.at("position_mm"));
    bookmark.camera.forward = vectorOf(line.at("forward"));
    bookmark.camera.up = vectorOf(line.at("up"));
    line.at("arc_mm").get_to(bookmark.arcMm);
    line.at("note").get_to(bookmark.note);
    if (line.contains("refusal")) entry.refusal = line["refusal"].get<std::string>();
    if (!std::isfinite(bookmark.arcMm) || bookmark.note.size() > protocol::maxNoteBytes)
        throw std::runtime_error("a number is not finite, or the note too long");
    return entry;
}

// Nothing where it is none. Of a newer format: an entry without a key.
std::optional<JournalEntry> parsed(const std::string& text, const std::string& key) {
    try {
        const json line = json::parse(text);
        if (line.at("format").get<int>() > format) return JournalEntry{};
        JournalEntry entry = entryOf(line);
        if (isKey(key) && entry.bookmark.clientKey == key) return entry;
    } catch (const std::exception&) {
        // Said by the caller, with the file's name.
    }
    return std::nullopt;
}

Error setAside(const std::filesystem::path& file) {
    std::filesystem::path aside;
    std::error_code error;
    int n = 1;
    do {
        aside = file.string() + (n == 1 ? ".damaged" : ".damaged-" + std::to_string(n));
        ++n;
    } while (std::filesystem::exists(aside, error));
    std::filesystem::rename(file, aside, error);
    return {ErrorKind::badInput,
            error ? "a bookmark that is not saved yet is damaged, and cannot be set aside: " +
                        error.message()
                  : "a bookmark that is not saved yet is damaged; its file is kept under this name",
            error ? file.string() : aside.string()};
}

}  // namespace

Result<std::filesystem::path> BookmarkJournal::defaultFolder() {
    if (const auto folder = link::userFolder("XDG_DATA_HOME", ".local/share"))
        return *folder / "haustra" / "bookmarks";
    return fail(ErrorKind::notFound, "no folder for bookmarks that are not saved yet: set HOME");
}

Result<void> BookmarkJournal::write(const JournalEntry& entry) const {
    if (!isKey(entry.bookmark.clientKey))
        return fail(ErrorKind::badInput, "a bookmark's key cannot name a file", folder_.string());
    return link::writePrivateFile(folder_ / (entry.bookmark.clientKey + extension), lineOf(entry));
}

Result<void> BookmarkJournal::erase(const std::string& clientKey) const {
    if (!isKey(clientKey)) return {};
    const auto file = folder_ / (clientKey + extension);
    if (::unlink(file.c_str()) == 0 || errno == ENOENT || errno == ENOTDIR) return {};
    return fail(
        ErrorKind::io,
        std::string("cannot remove a bookmark that the server has: ") + std::strerror(errno),
        file.string());
}

BookmarkJournal::Contents BookmarkJournal::read() const {
    Contents contents;
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (std::filesystem::directory_iterator item(folder_, error), end; !error && item != end;
         item.increment(error))
        if (item->path().extension() == extension) files.push_back(item->path());
    if (error && error != std::errc::no_such_file_or_directory)
        contents.errors.push_back(
            {ErrorKind::io, "cannot read the bookmarks that are not saved yet: " + error.message(),
             folder_.string()});
    for (const auto& file : files) {
        const auto text = readTextFile(file, maxFileBytes);
        if (!text && text.error().kind == ErrorKind::notFound)
            continue;  // another client has removed it meanwhile: the server has it
        // A file that is too long is damaged; one that cannot be read to its end may be sound.
        if (!text && text.error().kind != ErrorKind::badInput) {
            contents.errors.push_back(
                {ErrorKind::io,
                 "a bookmark that is not saved yet cannot be read: " + text.error().message,
                 file.string()});
            continue;
        }
        auto entry = parsed(text.value_or(""), file.stem().string());
        if (!entry)
            contents.errors.push_back(setAside(file));
        else if (entry->bookmark.clientKey.empty())
            contents.errors.push_back({ErrorKind::unsupported,
                                       "a bookmark that is not saved yet was written by a newer "
                                       "client; it is left to that",
                                       file.string()});
        else
            contents.entries.push_back(std::move(*entry));
    }
    std::sort(contents.entries.begin(), contents.entries.end(),
              [](const JournalEntry& a, const JournalEntry& b) {
                  return std::tie(a.notedMs, a.bookmark.clientKey) <
                         std::tie(b.notedMs, b.bookmark.clientKey);
              });
    return contents;
}

}  // namespace haustra::reader
