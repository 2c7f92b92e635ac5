// The server's certificate and key.
#pragma once

#include "core/result.h"

#include <filesystem>

namespace haustra::net {

/// PEM files.
struct Identity {
    std::filesystem::path certificate;  ///< may be a chain, the server's own first
    std::filesystem::path key;          ///< without a passphrase
};

/// `folder`/certificate.pem and key.pem (mode 0600). Where the certificate is missing both are
/// made: a P-256 key and a self-signed certificate for ten years, which clients pin by its
/// fingerprint. Of servers that start at once on a new store one makes them, and the others have
/// the same. Fails (io) where the folder cannot be written.
Result<Identity> identityIn(const std::filesystem::path& folder);

}  // namespace haustra::net
