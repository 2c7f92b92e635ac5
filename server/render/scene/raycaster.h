// What all raycasters have in common. They differ in the order in which they visit the volume and
// in who does the work, never in the picture: samples lie at whole steps from the eye, and
// interpolation, classification and light are the same (optics.h).
#pragma once

#include "core/raycasters.h"
#include "core/result.h"
#include "render/scene/picture.h"

#include <cstddef>
#include <string>
#include <vector>

namespace haustra::render {

/// Some rows of a picture: a frame may be drawn in several bands, and left unfinished. Whatever
/// the bands, the pixels are the same.
struct Band {
    glm::ivec2 pictureSize{0};
    int firstRow = 0, rows = 0;
    static Band whole(int width, int height) { return {{width, height}, 0, height}; }
};

/// Longest side of a picture, pixels.
inline constexpr int maxPictureSide = 2048;

/// Fail (badInput) where a picture has no pixels or a side over maxPictureSide; where a band is
/// empty or leaves the picture, or the picture is not allocated at its size.
Result<void> checkPictureSize(glm::ivec2 size);
Result<void> checkBand(const Band& band);
Result<void> checkBand(const Band& band, const Image& picture);

/// How long a part of the last band took, by the clock of whoever did it.
struct PassTime {
    std::string name;
    double ms = 0.0;
};

/// Draws one scene. Belongs to one thread: that of the GL context where it uses one, which must be
/// current there and outlive it. Equal views give equal pixels, whatever was drawn before.
class Raycaster {
public:
    virtual ~Raycaster() = default;
    Raycaster() = default;
    Raycaster(const Raycaster&) = delete;
    Raycaster& operator=(const Raycaster&) = delete;

    virtual RaycasterKind kind() const = 0;
    /// Draws the band's rows into `picture`, which has the whole picture's size; sRGB, over black
    /// or over the view's backdrop. Fails (badInput) on a bad view or band, (device) where the
    /// driver reports an error; the band's rows are then undefined.
    virtual Result<void> render(const CameraView& view, const Band& band, Image& picture) = 0;
    virtual std::size_t gpuBytes() const { return 0; }
    /// Of the last band.
    virtual std::vector<PassTime> passTimes() const { return {}; }
};

}  // namespace haustra::render
