// Which pictures are on the reader's screen, and how long they have been.
#pragma once

#include "link/connection.h"

#include <cstdint>
#include <map>
#include <vector>

namespace haustra::reader {

/// So much longer a picture has been on screen than was told before.
struct ShownTime {
    std::uint32_t picture = 0;
    int ms = 0;
};

/// A picture is on screen from when it is shown in a viewport until another is, or the viewport is
/// hidden. Belongs to one thread; times must not fall.
class ScreenTime {
public:
    using Clock = link::Clock;
    /// Does nothing where it is shown already.
    void show(int viewport, std::uint32_t picture, Clock::time_point now);
    void hide(int viewport, Clock::time_point now);
    /// What has come since the last call, whole milliseconds of it, in the order of pictures; at
    /// most `most`, the rest comes next.
    std::vector<ShownTime> take(Clock::time_point now, std::size_t most);
    /// Over another link pictures are counted anew: nothing is shown, nothing waits.
    void reset();

private:
    struct Shown {
        std::uint32_t picture;
        Clock::time_point since;
    };
    void count(Shown& shown, Clock::time_point now);
    std::map<int, Shown> shown_;                        // by viewport
    std::map<std::uint32_t, Clock::duration> waiting_;  // by picture
};

}  // namespace haustra::reader
