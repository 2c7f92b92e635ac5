#include "pictures/image_libraries.h"

#include <algorithm>

#include <dlfcn.h>

namespace haustra::pictures {

namespace {

namespace fs = std::filesystem;

/// Loaded once, and for good: from ../lib/haustra beside the program, installed or not.
Result<const ImageLibraries*> load() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path module =
        program.parent_path().parent_path() / "lib" / "haustra" / "haustra-pictures.so";
    void* loaded = error ? nullptr : ::dlopen(module.c_str(), RTLD_LAZY | RTLD_LOCAL);
    const void* symbol = loaded ? ::dlsym(loaded, "haustraImageLibraries") : nullptr;
    if (symbol) return static_cast<const ImageLibraries*>(symbol);
    const char* why = error ? "this program's own folder is not known" : ::dlerror();
    return fail(ErrorKind::io,
                std::string("what reads and writes pictures cannot be loaded: ") +
                    (why ? why : "it is of another version"),
                module.string());
}

Result<const ImageLibraries*> libraries() {
    static const Result<const ImageLibraries*> loaded = load();
    return loaded;
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
