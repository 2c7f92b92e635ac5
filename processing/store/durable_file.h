// Files that are there whole or not at all, whatever happens to the machine.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace haustra::store {

/// What temporary files start with. One that outlives its writer is rubbish.
inline constexpr char temporaryPrefix[] = ".tmp-";

/// Writes the parts one after the other to a temporary file in `folder`, fsyncs it, renames it to
/// `name` and fsyncs the folder. When this returns without an error the file survives a power
/// cut; at no moment is a part of it visible as `name`. `permissions` are subject to the umask.
Result<void> writeDurably(const std::filesystem::path& folder, const std::string& name,
                          const std::vector<std::span<const std::byte>>& parts,
                          unsigned permissions = 0640);

/// The same for a file that `write` fills by pwrite and ftruncate, in any order; false: it failed,
/// and errno says why.
Result<void> writeDurably(const std::filesystem::path& folder, const std::string& name,
                          const std::function<bool(int descriptor)>& write,
                          unsigned permissions = 0640);

/// fsyncs a folder, so that the names in it survive a power cut.
Result<void> syncFolder(const std::filesystem::path& folder);

}  // namespace haustra::store
