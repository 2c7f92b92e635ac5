#include "pictures/image_libraries.h"

#include "core/program_module.h"

#include <algorithm>
#include <limits>
#include <string>

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

int mostSide(const fs::path& file) {
    const std::string ending = file.extension().string();
    if (ending == ".jpg" || ending == ".jpeg") return 65500;
    return ending == ".png" ? 1'000'000 : std::numeric_limits<int>::max();
}

Result<std::unique_ptr<PictureFile>> createPicture(const fs::path& file, int width, int height,
                                                   const Provenance& provenance) {
    // libjpeg ends the program at a picture that it cannot hold.
    if (std::max(width, height) > mostSide(file))
        return fail(ErrorKind::badInput,
                    "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                        " pixels does not fit this format, whose sides are " +
                        std::to_string(mostSide(file)) + " pixels at most",
                    file.string());
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

Result<double> textWidth(const std::string& text, double textHeight) {
    return TRY(libraries())->textWidth(text, textHeight);
}

Result<void> draw(const Marks& marks, Image& band, int firstRow) {
    return TRY(libraries())->draw(marks, band, firstRow);
}

}  // namespace haustra::pictures
