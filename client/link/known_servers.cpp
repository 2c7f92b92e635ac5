#include "link/known_servers.h"

#include "link/fingerprint.h"
#include "link/private_file.h"

#include <fstream>
#include <sstream>
#include <vector>

namespace haustra::link {
namespace {

struct Entry {
    std::string line;    // as it stands in the file
    std::string server;  // empty in a comment
    std::string fingerprint;
};

Result<std::vector<Entry>> readEntries(const std::filesystem::path& file) {
    std::vector<Entry> entries;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        // No file is a first meeting; one that cannot be looked for is not.
        if (error)
            return fail(ErrorKind::io, "cannot read the known servers: " + error.message(),
                        file.string());
        return entries;
    }
    std::ifstream in(file);
    if (!in) return fail(ErrorKind::io, "cannot read the known servers", file.string());
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        Entry entry{line, {}, {}};
        std::istringstream words(line);
        std::string extra;
        words >> entry.server;
        if (entry.server.empty() || entry.server[0] == '#') {
            entry.server.clear();
        } else {
            words >> entry.fingerprint;
            const auto normal = normalizeFingerprint(entry.fingerprint);
            if (!normal || words >> extra)
                return fail(ErrorKind::badInput, "not a line of \"host:port fingerprint\"",
                            file.string() + ":" + std::to_string(number));
            entry.fingerprint = *normal;
        }
        entries.push_back(std::move(entry));
    }
    if (in.bad()) return fail(ErrorKind::io, "cannot read the known servers", file.string());
    return entries;
}

}  // namespace

Result<std::filesystem::path> KnownServers::defaultFile() {
    if (const auto folder = userFolder("XDG_CONFIG_HOME", ".config"))
        return *folder / "haustra" / "known_servers";
    return fail(ErrorKind::notFound,
                "no folder for the known servers: set HOME, or give --known-servers FILE");
}

Result<std::optional<std::string>> KnownServers::find(const std::string& server) const {
    const auto entries = TRY(readEntries(file_));
    for (const Entry& entry : entries)
        if (entry.server == server) return entry.fingerprint;
    return std::nullopt;
}

Result<void> KnownServers::pin(const std::string& server, const std::string& fingerprint) const {
    const auto entries = TRY(readEntries(file_));
    std::string text;
    for (const Entry& entry : entries)
        if (entry.server != server) text += entry.line + "\n";
    text += server + " " + fingerprint + "\n";
    return writePrivateFile(file_, text);
}

Result<Trust> checkPin(const Pinning& pinning, const std::string& server,
                       const std::string& fingerprint) {
    const KnownServers known(pinning.knownServersFile);
    if (pinning.expectedFingerprint) {
        if (*pinning.expectedFingerprint != fingerprint)
            return fail(ErrorKind::badInput,
                        "the server's certificate has the fingerprint " + fingerprint + ", not " +
                            *pinning.expectedFingerprint + " as given: refused",
                        server);
        TRY(known.pin(server, fingerprint));
        return Trust::known;
    }
    const auto pinned = TRY(known.find(server));
    if (!pinned) {
        TRY(known.pin(server, fingerprint));
        return Trust::firstUse;
    }
    if (*pinned == fingerprint) return Trust::known;
    return fail(ErrorKind::badInput,
                "the server's certificate CHANGED since it was first met (pinned " + *pinned +
                    ", shown now " + fingerprint +
                    "): refused. Somebody may be in between. If the certificate was replaced on "
                    "purpose, check "
                    "the new fingerprint with the server's administrator and give it with "
                    "--fingerprint (pins: " +
                    known.file().string() + ")",
                server);
}

}  // namespace haustra::link
