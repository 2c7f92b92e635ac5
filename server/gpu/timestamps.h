// When the GPU reaches places in its commands.
#pragma once

#include <cstddef>
#include <vector>

namespace haustra::gpu {

/// Marks places in the context's commands, and tells the time between them once they are done.
/// Belongs to the thread of the context, which must be current when it dies. Move-only.
class Timestamps {
public:
    Timestamps() = default;
    ~Timestamps();
    Timestamps(Timestamps&& other) noexcept;
    Timestamps& operator=(Timestamps&& other) noexcept;

    /// Forgets all marks.
    void restart() { marked_ = 0; }
    void mark();
    /// Milliseconds from each mark to the next. Waits for the last.
    std::vector<double> betweenMs() const;

private:
    std::vector<unsigned> queries_;
    std::size_t marked_ = 0;
};

}  // namespace haustra::gpu
