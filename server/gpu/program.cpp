#include "gpu/program.h"

#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

namespace {

std::string sourceOf(std::initializer_list<std::string_view> pieces) {
    std::string source = "#version 450 core\n";
    int number = 0;
    for (const std::string_view piece : pieces) {
        source += "#line 1 " + std::to_string(++number) + "\n";
        source += piece;
    }
    return source;
}

/// What the compiler or linker says of a shader or program.
template <class Query>
std::string logOf(Query query, GLuint id) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    query(id, GLsizei(log.size()), &length, log.data());
    log.resize(std::size_t(length));
    return log;
}

/// Compiles a shader into the program and leaves its owning to the program.
Result<void> attach(GLuint program, GLenum kind, const std::string& source, const char* what) {
    const GLuint shader = glCreateShader(kind);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    const std::string log = compiled ? std::string() : logOf(glGetShaderInfoLog, shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
    if (!compiled) return fail(ErrorKind::device, "the shader does not compile: " + log, what);
    return {};
}

Result<void> link(GLuint program, const char* what) {
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked) return {};
    return fail(ErrorKind::device,
                "the shaders do not link: " + logOf(glGetProgramInfoLog, program), what);
}

}  // namespace

Result<ComputeProgram> ComputeProgram::create(const char* what,
                                              std::initializer_list<std::string_view> pieces) {
    ComputeProgram program;
    program.id_ = glCreateProgram();
    TRY(attach(program.id_, GL_COMPUTE_SHADER, sourceOf(pieces), what));
    TRY(link(program.id_, what));
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

void ComputeProgram::dispatchGroups(int groups) const {
    const int rows = (groups + groupsInRow - 1) / groupsInRow;
    glUseProgram(id_);
    glDispatchCompute(GLuint(rows > 1 ? groupsInRow : groups), GLuint(rows), 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

Result<RasterProgram> RasterProgram::create(
    const char* what, std::initializer_list<std::string_view> vertexPieces,
    std::initializer_list<std::string_view> fragmentPieces) {
    RasterProgram raster;
    raster.program_ = glCreateProgram();
    glCreateVertexArrays(1, &raster.vertexArray_);
    glCreateFramebuffers(1, &raster.framebuffer_);
    for (const auto& [kind, pieces] :
         {std::pair(GL_VERTEX_SHADER, vertexPieces), {GL_FRAGMENT_SHADER, fragmentPieces}}) {
        TRY(attach(raster.program_, GLenum(kind), sourceOf(pieces), what));
    }
    TRY(link(raster.program_, what));
    return raster;
}

RasterProgram::~RasterProgram() {
    if (framebuffer_) glDeleteFramebuffers(1, &framebuffer_);
    if (vertexArray_) glDeleteVertexArrays(1, &vertexArray_);
    if (program_) glDeleteProgram(program_);
}

RasterProgram::RasterProgram(RasterProgram&& other) noexcept {
    *this = std::move(other);
}

RasterProgram& RasterProgram::operator=(RasterProgram&& other) noexcept {
    std::swap(program_, other.program_);
    std::swap(vertexArray_, other.vertexArray_);
    std::swap(framebuffer_, other.framebuffer_);
    return *this;
}

void RasterProgram::draw(const Texture& target, glm::ivec2 background, const StorageBuffer& indices,
                         int first, int count, int copies) const {
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, target.id_, 0);
    const GLint fill[4] = {background.x, background.y, 0, 0};
    glClearNamedFramebufferiv(framebuffer_, GL_COLOR, 0, fill);
    glVertexArrayElementBuffer(vertexArray_, indices.id_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    glBindVertexArray(vertexArray_);
    glUseProgram(program_);
    glViewport(-reachPixels, -reachPixels, 2 * reachPixels, 2 * reachPixels);
    if (count > 0) {
        const auto* offset = reinterpret_cast<const void*>(std::size_t(first) * 3 * sizeof(GLuint));
        glDrawElementsInstanced(GL_TRIANGLES, 3 * count, GL_UNSIGNED_INT, offset, copies);
    }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    // A deleted texture must not stay attached.
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBindVertexArray(0);
}

void RasterProgram::drawNearest(const RasterTarget& target, const StorageBuffer& indices, int first,
                                int count) const {
    glEnable(GL_DEPTH_TEST);
    drawInto(target, indices, first, count);
    glDisable(GL_DEPTH_TEST);
}

void RasterProgram::drawAll(const RasterTarget& target, const StorageBuffer& indices, int first,
                            int count) const {
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    drawInto(target, indices, first, count);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void RasterProgram::drawInto(const RasterTarget& target, const StorageBuffer& indices, int first,
                             int count) const {
    glVertexArrayElementBuffer(vertexArray_, indices.id_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer_);
    glBindVertexArray(vertexArray_);
    glUseProgram(program_);
    glViewport(0, 0, target.size().x, target.size().y);
    if (count > 0) {
        const auto* offset = reinterpret_cast<const void*>(std::size_t(first) * 3 * sizeof(GLuint));
        glDrawElements(GL_TRIANGLES, 3 * count, GL_UNSIGNED_INT, offset);
    }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBindVertexArray(0);
}

}  // namespace haustra::gpu
