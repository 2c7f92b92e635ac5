// Files that are there whole or not at all, whatever happens to the machine.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <functional>
#include <string_view>

namespace haustra {

/// What temporary files start with. One that outlives its writer is rubbish.
inline constexpr char temporaryPrefix[] = ".tmp-";

/// A file in the making: it has a name of its own beside `file` until it is published, and is
/// removed where it is not. Two that are made of one `file` at once do not disturb each other.
class DurableFile {
public:
    /// Makes it, empty. `permissions` are subject to the umask.
    explicit DurableFile(std::filesystem::path file, unsigned permissions = 0666);
    ~DurableFile();
    DurableFile(const DurableFile&) = delete;
    DurableFile& operator=(const DurableFile&) = delete;

    /// Fails (io) where it could not be made.
    Result<void> isMade() const;
    /// To be read and written; −1 where it is not made.
    int descriptor() const { return descriptor_; }
    /// Its name until then, for who cannot write to a descriptor.
    const std::filesystem::path& beside() const { return beside_; }

    /// Puts it in place of `file`, in one step: at no moment is a part of it visible there. When
    /// this returns without an error it survives a power cut, where its folder may be read. Fails
    /// (io); the old file stands then, or the new one, whole.
    Result<void> publish();

private:
    std::filesystem::path file_, beside_;
    int descriptor_ = -1, error_ = 0;
    bool isThere_;  // under the temporary name
};

/// Writes a file whole, as DurableFile does.
Result<void> writeDurably(const std::filesystem::path& file, std::string_view text,
                          unsigned permissions = 0666);

/// The same for a file that `write` fills, in any order; false: it failed, and errno says why.
Result<void> writeDurably(const std::filesystem::path& file,
                          const std::function<bool(int descriptor)>& write,
                          unsigned permissions = 0666);

/// fsyncs a folder, so that the names in it survive a power cut. One that may not be read is passed
/// over.
Result<void> syncFolder(const std::filesystem::path& folder);

}  // namespace haustra
