#include "occlusion_queries.h"

#include <cmath>
#include <string>

#include <epoxy/gl.h>
#include <glm/gtc/matrix_transform.hpp>

namespace haustra::bench {
namespace {

constexpr const char* vertexText = R"(#version 450 core
layout(location = 0) in vec3 fromEyeMm;
layout(location = 0) uniform mat4 clipFromEye;
out vec3 place;
invariant gl_Position;
void main() { place = fromEyeMm; gl_Position = clipFromEye * vec4(fromEyeMm, 1.0); }
)";
constexpr const char* fragmentText = R"(#version 450 core
in vec3 place;
layout(location = 1) uniform vec2 focusMm;
void main() { float mm = length(place); if (mm < focusMm.x || mm > focusMm.y) discard; }
)";

GLuint program() {
    const GLuint made = glCreateProgram();
    for (const auto& [kind, text] :
         {std::pair(GL_VERTEX_SHADER, vertexText), {GL_FRAGMENT_SHADER, fragmentText}}) {
        const GLuint shader = glCreateShader(GLenum(kind));
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(made, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(made);
    return made;
}

}  // namespace

Result<std::vector<Visibility>> queryTriangles(const TriMesh& wall, const PinholePicture& picture,
                                               const CenterlineCamera& camera, long& queries) {
    const glm::dvec3 ahead = glm::normalize(camera.forward),
                     right = glm::normalize(glm::cross(ahead, camera.up)),
                     down = glm::cross(ahead, right);
    const double tangent = std::tan(glm::radians(0.5 * picture.fovDegrees));
    std::vector<glm::vec3> places;
    for (const glm::dvec3& vertex : wall.vertices) {
        const glm::dvec3 v = vertex - camera.positionMm;
        places.emplace_back(glm::dot(v, right), glm::dot(v, down), -glm::dot(v, ahead));
    }
    // What is in the frustum and the depth of field, as any program would cull it.
    std::vector<std::int32_t> candidates;
    for (std::size_t n = 0; n < wall.triangles.size(); ++n) {
        bool outside[5] = {true, true, true, true, true};
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 p = places[std::size_t(wall.triangles[n][corner])];
            const float reach = float(tangent) * -p.z;
            outside[0] &= p.x > reach, outside[1] &= -p.x > reach, outside[2] &= p.y > reach,
                outside[3] &= -p.y > reach,
                outside[4] &= glm::length(p) > float(picture.farthestMm);
        }
        if (!outside[0] && !outside[1] && !outside[2] && !outside[3] && !outside[4])
            candidates.push_back(std::int32_t(n));
    }

    GLuint vertices = 0, indices = 0, array = 0, depth = 0, frame = 0;
    glCreateBuffers(1, &vertices), glCreateBuffers(1, &indices);
    glNamedBufferStorage(vertices, GLsizeiptr(places.size() * sizeof(glm::vec3)), places.data(), 0);
    glNamedBufferStorage(indices, GLsizeiptr(wall.triangles.size() * sizeof(glm::ivec3)),
                         wall.triangles.data(), 0);
    glCreateVertexArrays(1, &array);
    glVertexArrayVertexBuffer(array, 0, vertices, 0, sizeof(glm::vec3));
    glVertexArrayElementBuffer(array, indices);
    glEnableVertexArrayAttrib(array, 0);
    glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array, 0, 0);
    glCreateRenderbuffers(1, &depth);
    glNamedRenderbufferStorage(depth, GL_DEPTH_COMPONENT32F, picture.side, picture.side);
    glCreateFramebuffers(1, &frame);
    glNamedFramebufferRenderbuffer(frame, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    const GLuint shader = program();
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glBindVertexArray(array);
    glUseProgram(shader);
    glViewport(0, 0, picture.side, picture.side);
    const glm::mat4 clip =
        glm::perspective(glm::radians(float(picture.fovDegrees)), 1.0f, 0.1f, 1000.0f);
    glUniformMatrix4fv(0, 1, GL_FALSE, &clip[0][0]);
    const auto draw = [&](std::int32_t triangle) {
        glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(std::size_t(triangle) * 3 * sizeof(GLuint)));
    };
    const auto count = [&](const std::vector<std::int32_t>& triangles) {
        std::vector<GLuint> names(triangles.size()), samples(triangles.size());
        glGenQueries(GLsizei(names.size()), names.data());
        for (std::size_t n = 0; n < names.size(); ++n) {
            glBeginQuery(GL_SAMPLES_PASSED, names[n]);
            draw(triangles[n]);
            glEndQuery(GL_SAMPLES_PASSED);
        }
        for (std::size_t n = 0; n < names.size(); ++n)
            glGetQueryObjectuiv(names[n], GL_QUERY_RESULT, &samples[n]);
        glDeleteQueries(GLsizei(names.size()), names.data());
        queries += long(names.size());
        return samples;
    };
    const float everywhere[2] = {0.0f, 1e9f},
                focus[2] = {float(picture.nearestMm), float(picture.farthestMm)};
    const float far = 1.0f;
    glClearNamedFramebufferfv(frame, GL_DEPTH, 0, &far);
    glUniform2fv(1, 1, everywhere);
    const auto total = count(candidates);
    std::vector<std::int32_t> covering;
    std::vector<GLuint> totals;
    for (std::size_t n = 0; n < candidates.size(); ++n)
        if (total[n] > 0) covering.push_back(candidates[n]), totals.push_back(total[n]);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    for (const std::int32_t triangle : covering)
        draw(triangle);
    glDepthMask(GL_FALSE);
    glUniform2fv(1, 1, focus);
    const auto observed = count(covering);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
    std::vector<Visibility> seen(wall.triangles.size(), Visibility::unseen);
    for (std::size_t n = 0; n < covering.size(); ++n)
        if (observed[n] > 0)
            seen[std::size_t(covering[n])] =
                observed[n] == totals[n] ? Visibility::fully : Visibility::partly;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindVertexArray(0);
    glDeleteProgram(shader);
    glDeleteFramebuffers(1, &frame);
    glDeleteRenderbuffers(1, &depth);
    glDeleteVertexArrays(1, &array);
    glDeleteBuffers(1, &vertices), glDeleteBuffers(1, &indices);
    if (glGetError() != GL_NO_ERROR) return fail(ErrorKind::device, "OpenGL reported an error");
    return seen;
}

}  // namespace haustra::bench
