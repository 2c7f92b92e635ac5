#include "pipeline/source_key.h"

#include "core/files_below.h"
#include "core/parallel.h"
#include "store/sha256.h"

#include <algorithm>
#include <vector>

namespace haustra::pipeline {
Result<store::ProductKey> sourceKey(const std::filesystem::path& source, int threads) {
    const auto files = TRY(filesBelow(source));
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
