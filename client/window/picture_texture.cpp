#include "window/picture_texture.h"

#include <cstdint>

#include <SDL_opengl.h>

namespace haustra::window {

PictureTexture::~PictureTexture() {
    if (texture_) glDeleteTextures(1, &texture_);
}

void PictureTexture::show(const tiles::Picture& picture, std::uint64_t count) {
    if (count == count_) return;
    count_ = count;
    if (count == 0) return;
    if (!texture_) glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (picture.width == width_ && picture.height == height_) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_BGRA, GL_UNSIGNED_BYTE,
                        picture.pixels.data());
        return;
    }
    width_ = picture.width;
    height_ = picture.height;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_, height_, 0, GL_BGRA, GL_UNSIGNED_BYTE,
                 picture.pixels.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

ImTextureID PictureTexture::id() const {
    return reinterpret_cast<ImTextureID>(std::intptr_t(texture_));
}

}  // namespace haustra::window
