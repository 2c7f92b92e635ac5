#include "render/scene/raycaster.h"

namespace haustra::render {

Result<void> checkPictureSize(glm::ivec2 size) {
    if (size.x >= 1 && size.y >= 1 && size.x <= maxPictureSide && size.y <= maxPictureSide)
        return {};
    return fail(ErrorKind::badInput, "a picture of " + std::to_string(size.x) + "x" +
                                         std::to_string(size.y) +
                                         " pixels is not within 1x1 to 2048x2048");
}

Result<void> checkBand(const Band& band) {
    TRY(checkPictureSize(band.pictureSize));
    if (band.rows < 1 || band.firstRow < 0 || band.rows > band.pictureSize.y - band.firstRow)
        return fail(ErrorKind::badInput, "the band leaves the picture");
    return {};
}

Result<void> checkBand(const Band& band, const Image& picture) {
    TRY(checkBand(band));
    const glm::ivec2 size = band.pictureSize;
    if (picture.width != size.x || picture.height != size.y ||
        picture.rgb.size() != 3 * std::size_t(size.x) * std::size_t(size.y))
        return fail(ErrorKind::badInput, "the picture is not of the band's size");
    return {};
}

}  // namespace haustra::render
