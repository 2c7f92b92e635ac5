#include "reader/reader_name.h"

#include "link/private_file.h"
#include "protocol/limits.h"
#include "reader/random_key.h"

#include <algorithm>
#include <fstream>

namespace haustra::reader {

Result<std::string> checkReaderName(const std::string& name) {
    if (name.empty() || name.size() > protocol::maxReaderBytes ||
        !std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c < 127; }))
        return fail(ErrorKind::badInput, "a reader's name is 1 to " +
                                             std::to_string(protocol::maxReaderBytes) +
                                             " visible ASCII characters without a blank");
    return name;
}

Result<std::filesystem::path> defaultReaderFile() {
    if (const auto folder = link::userFolder("XDG_DATA_HOME", ".local/share"))
        return *folder / "haustra" / "reader";
    return fail(ErrorKind::notFound, "no folder for the reader's name: set HOME");
}

Result<std::string> readerNameIn(const std::filesystem::path& file) {
    // An empty one is what a full disk has left.
    std::error_code error;
    const auto bytes = std::filesystem::file_size(file, error);
    if (error == std::errc::no_such_file_or_directory || (!error && bytes == 0)) {
        TRY(link::writePrivateFile(file, randomKey() + "\n"));
    }
    std::ifstream in(file);
    std::string name;
    if (!std::getline(in, name))
        return fail(ErrorKind::io, "cannot read the reader's name", file.string());
    if (!checkReaderName(name))
        return fail(ErrorKind::badInput, "this is no reader's name; remove the file for another",
                    file.string());
    return name;
}

}  // namespace haustra::reader
