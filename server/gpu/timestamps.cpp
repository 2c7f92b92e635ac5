#include "gpu/timestamps.h"

#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

Timestamps::~Timestamps() {
    if (!queries_.empty()) glDeleteQueries(GLsizei(queries_.size()), queries_.data());
}

Timestamps::Timestamps(Timestamps&& other) noexcept {
    *this = std::move(other);
}

Timestamps& Timestamps::operator=(Timestamps&& other) noexcept {
    std::swap(queries_, other.queries_);
    std::swap(marked_, other.marked_);
    return *this;
}

void Timestamps::mark() {
    if (marked_ == queries_.size()) {
        GLuint query = 0;
        glCreateQueries(GL_TIMESTAMP, 1, &query);
        queries_.push_back(query);
    }
    glQueryCounter(queries_[marked_++], GL_TIMESTAMP);
}

std::vector<double> Timestamps::betweenMs() const {
    std::vector<double> between;
    GLuint64 before = 0;
    for (std::size_t i = 0; i < marked_; ++i) {
        GLuint64 now = 0;
        glGetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &now);
        if (i > 0) between.push_back(now > before ? double(now - before) * 1e-6 : 0.0);
        before = now;
    }
    return between;
}

}  // namespace haustra::gpu
