#include "core/files_below.h"

#include <algorithm>
#include <set>
#include <string>
#include <system_error>

namespace haustra {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> filesBelow(const fs::path& path, std::size_t most) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
        return fail(ErrorKind::notFound, "there is no such file or folder", path.string());
    if (fs::is_regular_file(status)) return std::vector<fs::path>{path};
    if (!fs::is_directory(status))
        return fail(ErrorKind::badInput, "this is neither a file nor a folder", path.string());
    std::vector<fs::path> files;
    std::set<fs::path> entered{fs::canonical(path, error)};
    fs::recursive_directory_iterator end,
        walk(path, fs::directory_options::follow_directory_symlink, error);
    for (; !error && walk != end; walk.increment(error)) {
        std::error_code unknown;
        if (walk->is_directory(unknown)) {
            const fs::path folder = fs::canonical(walk->path(), unknown);
            if (unknown || !entered.insert(folder).second) walk.disable_recursion_pending();
            continue;
        }
        if (!walk->is_regular_file(unknown)) continue;
        if (files.size() == most) {
            return fail(ErrorKind::unsupported,
                        "the folder holds more than " + std::to_string(most) + " files",
                        path.string());
        }
        files.push_back(walk->path());
    }
    if (error)
        return fail(ErrorKind::io, "the folder cannot be read: " + error.message(), path.string());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace haustra
