// The places that a line names, for a person to look at.
#pragma once

#include "core/printed_text.h"

namespace haustra::segmentation {

/// The first few of them are named.
class ToldPlaces {
public:
    explicit ToldPlaces(std::size_t most = 6) : most_(most) {}

    void add(glm::dvec3 placeMm) {
        if (++count_ <= most_) named_ += (count_ == 1 ? "" : ", ") + placeText(placeMm);
    }
    bool none() const { return count_ == 0; }
    /// "(12, -40, 118) mm, (9, 14, 97) mm and elsewhere"
    std::string text() const { return named_ + (count_ > most_ ? " and elsewhere" : ""); }

private:
    std::size_t most_, count_ = 0;
    std::string named_;
};

}  // namespace haustra::segmentation
