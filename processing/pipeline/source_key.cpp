#include "pipeline/source_key.h"

#include "core/parallel.h"
#include "store/sha256.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <vector>

namespace haustra::pipeline {
namespace {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> filesOf(const fs::path& source) {
    std::error_code error;
    const fs::file_status status = fs::status(source, error);
    if (!fs::exists(status)) {
        return fail(ErrorKind::notFound, "there is no such file or folder", source.string());
    }
    if (!fs::is_directory(status)) return std::vector<fs::path>{source};
    std::vector<fs::path> files;
    for (auto at = fs::recursive_directory_iterator(source, error);
         !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
        if (at->is_regular_file(error)) files.push_back(at->path());
    }
    if (error) return fail(ErrorKind::io, "cannot list: " + error.message(), source.string());
    return files;
}

}  // namespace

Result<store::ProductKey> sourceKey(const fs::path& source, int threads) {
    const auto files = TRY(filesOf(source));
    std::vector<Result<store::Digest>> digests(files.size());
    parallelFor(files.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            digests[n] = store::fileDigest(files[n]);
    });
    std::vector<store::ProductKey> keys;
    for (const auto& digest : digests) {
        if (!digest) return tl::make_unexpected(digest.error());
        keys.push_back({store::toHex(*digest)});
    }
    std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.hex < b.hex; });
    return store::makeKey("source", 1, "", keys);
}

}  // namespace haustra::pipeline
