// The file of pinned certificates: which fingerprint each server showed when first met.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <optional>
#include <string>

namespace haustra::link {

/// A text file with one "host:port fingerprint" a line; blank lines and lines that start with '#'
/// are kept as they are. The object holds only the path: each call reads the file anew, so that
/// several clients can share it.
class KnownServers {
public:
    explicit KnownServers(std::filesystem::path file) : file_(std::move(file)) {}

    /// $XDG_CONFIG_HOME/haustra/known_servers, else ~/.config/haustra/known_servers. Fails where
    /// neither variable is set.
    static Result<std::filesystem::path> defaultFile();

    /// The fingerprint pinned for `server`, or nothing (also where there is no file yet). Fails on
    /// a file that cannot be read or a line that is not understood, so that damage never counts as
    /// a first meeting.
    Result<std::optional<std::string>> find(const std::string& server) const;

    /// Pins `fingerprint` for `server`, replacing an older pin. Atomic: a reader sees the old file
    /// or the new one. Makes the folder, readable by its owner only.
    Result<void> pin(const std::string& server, const std::string& fingerprint) const;

    const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
};

/// What to do about the certificate that a server shows.
struct Pinning {
    std::filesystem::path knownServersFile;
    std::optional<std::string>
        expectedFingerprint;  ///< given by the user: must match, and is pinned
};

enum class Trust { known, firstUse };

/// Decides whether the certificate with `fingerprint` is that of `server`, and pins it on first
/// use. Fails, naming both fingerprints and the file, where the certificate changed.
Result<Trust> checkPin(const Pinning& pinning, const std::string& server,
                       const std::string& fingerprint);

}  // namespace haustra::link
