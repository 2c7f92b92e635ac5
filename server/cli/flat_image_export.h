// haustra export CASE flat-image: the whole flattened wall as one picture.
#pragma once

#include "core/result.h"
#include "store/case_store.h"

#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace haustra::cli {

struct FlatImageOptions {
    int width = 400;  ///< pixels of the circumference
    double seamMargin = 0.0;
    bool caption = false;
    bool findings = false;                   ///< are coloured
    std::optional<double> leastProbability;  ///< of candidates that are, too
    std::string transferFunction;
    int threads = 0;
};

/// --width, --seam-margin, --caption, --transfer-function, --findings, --least-probability and
/// --threads.
void addFlatImageOptions(CLI::App& command, FlatImageOptions& options);

/// Draws products `flatmap` and `cleansed` (or `ct`) of the case, with a progress bar, and replaces
/// `file` in one step.
Result<void> exportFlatImage(const store::Case& source, const std::filesystem::path& file,
                             const FlatImageOptions& options);

}  // namespace haustra::cli
