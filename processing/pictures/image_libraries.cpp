#include "pictures/image_libraries.h"

#include "core/program_module.h"

#include <algorithm>

namespace haustra::pictures {

namespace {

namespace fs = std::filesystem;

Result<const ImageLibraries*> libraries() {
    static const auto loaded = loadModule("haustra-pictures.so", "haustraImageLibraries",
                                          "what reads and writes pictures");
    return loaded.map(
        [](const void* symbol) { return static_cast<const ImageLibraries*>(symbol); });
}

}  // namespace

const std::vector<std::string>& fileEndings() {
    static const std::vector<std::string> endings{".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"};
    return endings;
}

bool isPictureFile(const fs::path& file) {
    const auto& endings = fileEndings();
    return std::find(endings.begin(), endings.end(), file.extension().string()) != endings.end();
}

Result<std::unique_ptr<PictureFile>> createPicture(const fs::path& file, int width, int height,
                                                   const Provenance& provenance) {
    return TRY(libraries())->createPicture(file, width, height, provenance);
}

Result<void> writePicture(const fs::path& file, const Image& image, const Provenance& provenance) {
    const auto picture = TRY(createPicture(file, image.width, image.height, provenance));
    TRY(picture->append(image));
    return picture->finish();
}

Result<GreyPicture> readGreyPicture(const fs::path& file) {
    return TRY(libraries())->readGreyPicture(file);
}

Result<ColorPicture> readColorPicture(const fs::path& file, int maxSide) {
    return TRY(libraries())->readColorPicture(file, maxSide);
}

Result<Image> sideBySide(const std::vector<Image>& panels) {
    return TRY(libraries())->sideBySide(panels);
}

Result<void> draw(const Marks& marks, Image& band, int firstRow) {
    return TRY(libraries())->draw(marks, band, firstRow);
}

}  // namespace haustra::pictures
