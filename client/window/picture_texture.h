// A picture on the graphics card.
#pragma once

#include "tiles/picture.h"

#include <imgui.h>

namespace haustra::window {

/// One texture that holds the newest picture of a pane. Made, used and destroyed on the thread
/// with the OpenGL context.
class PictureTexture {
public:
    PictureTexture() = default;
    ~PictureTexture();
    PictureTexture(const PictureTexture&) = delete;
    PictureTexture& operator=(const PictureTexture&) = delete;

    /// Uploads `picture` where `count` tells that it is another than the last.
    void show(const tiles::Picture& picture, std::uint64_t count);
    bool empty() const { return count_ == 0; }
    ImTextureID id() const;

private:
    unsigned texture_ = 0;
    int width_ = 0, height_ = 0;
    std::uint64_t count_ = 0;
};

}  // namespace haustra::window
