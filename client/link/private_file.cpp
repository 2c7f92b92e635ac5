#include "link/private_file.h"

#include "core/durable_file.h"

#include <cstdlib>
#include <system_error>

namespace haustra::link {

std::optional<std::filesystem::path> userFolder(const char* variable, const char* underHome) {
    const auto named = [](const char* name) {
        const char* value = std::getenv(name);
        return std::filesystem::path(value ? value : "");
    };
    if (const auto folder = named(variable); folder.is_absolute()) return folder;
    if (const auto home = named("HOME"); home.is_absolute()) return home / underHome;
    return std::nullopt;
}

Result<void> writePrivateFile(const std::filesystem::path& file, const std::string& text) {
    const auto folder = file.parent_path();
    if (!folder.empty()) {
        std::error_code error;
        const bool made = std::filesystem::create_directories(folder, error);
        if (error)
            return fail(ErrorKind::io, "cannot make the folder: " + error.message(),
                        folder.string());
        if (made) std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
    }
    return writeDurably(file, text, 0600);
}

}  // namespace haustra::link
