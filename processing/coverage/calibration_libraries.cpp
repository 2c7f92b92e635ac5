#include "coverage/calibration_libraries.h"

#include "core/program_module.h"

namespace haustra::coverage {
namespace {

Result<const CalibrationLibraries*> libraries() {
    static const auto loaded =
        loadModule("haustra-calibration.so", "haustraCalibrationLibraries", "what calibrates");
    return loaded.map(
        [](const void* symbol) { return static_cast<const CalibrationLibraries*>(symbol); });
}

}  // namespace

Result<BoardView> findBoard(const Image& picture, const Board& board) {
    return TRY(libraries())->findBoard(picture, board);
}

Result<FieldEllipse> findField(const std::vector<Image>& pictures) {
    return TRY(libraries())->findField(pictures);
}

Result<Calibration> calibrate(const std::vector<BoardView>& views,
                              const CalibrationOptions& options) {
    return TRY(libraries())->calibrate(views, options);
}

Result<Colonoscope> lensOfOpenCvText(const std::string& text, const std::string& place) {
    return TRY(libraries())->lensOfOpenCvText(text, place);
}

Result<std::string> openCvText(const Colonoscope& scope, const std::string& ending) {
    return TRY(libraries())->openCvText(scope, ending);
}

}  // namespace haustra::coverage
