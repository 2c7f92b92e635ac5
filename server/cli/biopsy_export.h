// haustra export CASE biopsy: the electronic biopsy image of the whole wall.
#pragma once

#include "core/result.h"
#include "store/case_store.h"

#include <filesystem>

namespace CLI {
class App;
}

namespace haustra::cli {

struct BiopsyImageOptions {
    int length = 4000, around = 200;  ///< pixels, along the colon and around it
    int finer = 2;                    ///< rays a pixel, along either side
    bool fixedTransfer = false;       ///< else the transfer function is derived from the scan
    int threads = 0;
};

/// --length, --around, --finer and --fixed-transfer.
void addBiopsyImageOptions(CLI::App& command, BiopsyImageOptions& options);

/// Draws it from the case's products, without a GPU, and replaces `file` in one step.
Result<void> exportBiopsyImage(const store::Case& source, const std::filesystem::path& file,
                               const BiopsyImageOptions& options);

}  // namespace haustra::cli
