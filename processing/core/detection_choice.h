// How a reader wants what detection found to be shown.
#pragma once

#include <optional>

namespace haustra {

/// When findings are shown: never; once the reader has read the case without them; from the start.
enum class DetectionMode { off, secondReader, concurrent };

struct DetectionChoice {
    DetectionMode mode = DetectionMode::off;
    bool firstPassDone = false;  ///< of a second reader: the case has been read without findings
    /// Candidates below the operating point are shown from this probability on, 0…1; where it is
    /// missing, none of them is.
    std::optional<double> leastProbability = {};

    /// Whether findings may be shown now.
    bool shows() const {
        return mode == DetectionMode::concurrent ||
               (mode == DetectionMode::secondReader && firstPassDone);
    }
    bool operator==(const DetectionChoice&) const = default;
};

}  // namespace haustra
