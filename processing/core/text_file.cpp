#include "core/text_file.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

namespace haustra {

Result<std::string> readTextFile(const std::filesystem::path& file, std::size_t most) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        return fail(ErrorKind::io, "this is a folder, not a file to read", file.string());
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        const int reason = errno;
        if (reason == ENOENT || reason == ENOTDIR)
            return fail(ErrorKind::notFound, "there is no such file", file.string());
        return fail(ErrorKind::io, "cannot open: " + std::generic_category().message(reason),
                    file.string());
    }
    std::string text;
    // As long as the file says; of a pipe it is not told.
    if (const auto bytes = std::filesystem::file_size(file, ignored); !ignored && bytes <= most)
        text.reserve(bytes);
    std::array<char, 1 << 16> block;
    do {
        in.read(block.data(), block.size());
        text.append(block.data(), std::size_t(in.gcount()));
    } while (in && text.size() <= most);
    if (in.bad()) return fail(ErrorKind::io, "cannot be read to its end", file.string());
    if (text.size() > most)
        return fail(ErrorKind::badInput, "is larger than " + std::to_string(most) + " bytes",
                    file.string());
    return text;
}

}  // namespace haustra
