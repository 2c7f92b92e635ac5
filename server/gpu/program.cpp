#include "gpu/program.h"

#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

Result<ComputeProgram> ComputeProgram::create(const char* what,
                                              std::initializer_list<std::string_view> pieces) {
    std::string source = "#version 450 core\n";
    int number = 0;
    for (const std::string_view piece : pieces) {
        source += "#line 1 " + std::to_string(++number) + "\n";
        source += piece;
    }
    const char* text = source.c_str();
    ComputeProgram program;
    program.id_ = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
    GLint linked = GL_FALSE;
    if (program.id_) glGetProgramiv(program.id_, GL_LINK_STATUS, &linked);
    if (!linked) {
        std::string log(4096, '\0');
        GLsizei length = 0;
        if (program.id_) glGetProgramInfoLog(program.id_, GLsizei(log.size()), &length, log.data());
        log.resize(std::size_t(length));
        return fail(ErrorKind::device, "the shader does not compile: " + log, what);
    }
    GLint group[3] = {1, 1, 1};
    glGetProgramiv(program.id_, GL_COMPUTE_WORK_GROUP_SIZE, group);
    program.groupSize_ = {group[0], group[1]};
    return program;
}

ComputeProgram::~ComputeProgram() {
    if (id_) glDeleteProgram(id_);
}

ComputeProgram::ComputeProgram(ComputeProgram&& other) noexcept {
    *this = std::move(other);
}

ComputeProgram& ComputeProgram::operator=(ComputeProgram&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(groupSize_, other.groupSize_);
    return *this;
}

void ComputeProgram::dispatch(glm::ivec2 threads) const {
    const glm::ivec2 groups = (threads + groupSize_ - 1) / groupSize_;
    glUseProgram(id_);
    glDispatchCompute(GLuint(groups.x), GLuint(groups.y), 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

}  // namespace haustra::gpu
