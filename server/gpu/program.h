// Owner of one linked compute program.
#pragma once

#include "core/result.h"

#include <initializer_list>
#include <string_view>

#include <glm/glm.hpp>

namespace haustra::gpu {

/// Belongs to the thread of the context in which it was made, which must be current when it dies.
/// Move-only.
class ComputeProgram {
public:
    /// Compiles the pieces in order as one shader, after "#version 450 core". Fails with the
    /// compiler's log, whose line numbers count from each piece's beginning; `what` names the
    /// program there.
    static Result<ComputeProgram> create(const char* what,
                                         std::initializer_list<std::string_view> pieces);
    ~ComputeProgram();
    ComputeProgram(ComputeProgram&& other) noexcept;
    ComputeProgram& operator=(ComputeProgram&& other) noexcept;

    /// Runs groups that cover `threads`, then makes their image writes visible to later reads of
    /// any kind.
    void dispatch(glm::ivec2 threads) const;

private:
    ComputeProgram() = default;
    unsigned id_ = 0;
    glm::ivec2 groupSize_{1};
};

}  // namespace haustra::gpu
