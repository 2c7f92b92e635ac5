#include "core/text_file.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

namespace haustra {

Result<std::string> readTextFile(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        return fail(ErrorKind::io, "this is a folder, not a file to read", file.string());
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        const int reason = errno;
        return fail(reason == ENOENT || reason == ENOTDIR ? ErrorKind::notFound : ErrorKind::io,
                    "cannot open: " + std::generic_category().message(reason), file.string());
    }
    std::string text;
    std::array<char, 1 << 16> block;
    do {
        in.read(block.data(), block.size());
        text.append(block.data(), std::size_t(in.gcount()));
    } while (in);
    if (in.bad()) return fail(ErrorKind::io, "cannot be read to its end", file.string());
    return text;
}

}  // namespace haustra
