#include "coverage/calibration_libraries.h"

#include <cmath>

#include <opencv2/core.hpp>

namespace haustra::coverage::module {
namespace {

/// cv::FileStorage descends once for each level: more than any camera's file has would end the
/// stack. Counted without reading the format: what opens a level in XML, in JSON and YAML's own
/// brackets, and in YAML's indented blocks.
bool isDeep(const std::string& text) {
    constexpr int most = 32;
    int tags = 0, brackets = 0, dashes = 0;
    for (std::size_t n = 0; n < text.size(); ++n) {
        const char c = text[n], next = n + 1 < text.size() ? text[n + 1] : ' ';
        if (c == '<' && next == '/') tags = std::max(0, tags - 1);
        if (c == '<' && next != '/' && next != '!' && next != '?') ++tags;
        if (c == '/' && next == '>') tags = std::max(0, tags - 1);
        if (c == '[' || c == '{') ++brackets;
        if (c == ']' || c == '}') brackets = std::max(0, brackets - 1);
        if (c == '\n') dashes = 0;
        if (c == '-' && next == ' ') ++dashes;
        if (std::max({tags, brackets, dashes}) > most) return true;
    }
    // A block of YAML is deeper than the one around it by a space at least.
    for (std::size_t line = 0; line < text.size();) {
        const std::size_t end = std::min(text.find('\n', line), text.size());
        const std::size_t word = std::min(text.find_first_not_of(' ', line), end);
        if (word - line > 4 * most && word < end && text.find(':', word) < end) return true;
        line = end + 1;
    }
    return false;
}

class OpenCvCamera {
public:
    OpenCvCamera(const std::string& text)
        : storage_(text, cv::FileStorage::READ | cv::FileStorage::MEMORY) {}

    bool isOpen() const { return storage_.isOpened(); }
    /// Of the samples' spelling now and before.
    cv::FileNode node(const char* name, const char* former) const {
        const cv::FileNode found = storage_[name];
        return found.empty() ? storage_[former] : found;
    }
    std::optional<double> number(const char* name, const char* former) const {
        return numberOf(node(name, former));
    }
    /// A matrix of one channel, or a plain list.
    std::optional<std::vector<double>> numbers(const char* name, const char* former) const {
        const cv::FileNode found = node(name, former);
        const cv::FileNode list = found.isMap() ? found["data"] : found;
        constexpr std::size_t most = 64;
        if (!list.isSeq() || list.size() > most) return std::nullopt;
        std::vector<double> values;
        for (const cv::FileNode& value : list) {
            const auto one = numberOf(value);
            if (!one) return std::nullopt;
            values.push_back(*one);
        }
        return values;
    }

private:
    static std::optional<double> numberOf(const cv::FileNode& node) {
        if (!node.isInt() && !node.isReal()) return std::nullopt;
        const double value = node.real();
        return std::isfinite(value) ? std::optional(value) : std::nullopt;
    }
    cv::FileStorage storage_;
};

}  // namespace

Result<Colonoscope> lensOfOpenCvText(const std::string& text, const std::string& place) try {
    const auto wrong = [&](const std::string& what) {
        return fail(ErrorKind::badInput, what, place);
    };
    if (text.find("amera_") == text.npos || text.find('\0') != text.npos)
        return wrong("this is no lens file: neither Haustra's nor OpenCV's");
    if (isDeep(text)) return wrong("this is no camera's file: it is nested too deeply");
    const OpenCvCamera camera(text);
    if (!camera.isOpen()) return wrong("the file is neither XML, YAML nor JSON of OpenCV");
    const auto matrix = camera.numbers("camera_matrix", "Camera_Matrix");
    if (!matrix || matrix->size() != 9)
        return wrong("the file's camera_matrix is not one of nine finite numbers");
    const auto& m = *matrix;
    if (m[1] != 0.0 || m[3] != 0.0 || m[6] != 0.0 || m[7] != 0.0 || m[8] != 1.0)
        return wrong("the file's camera_matrix has a skew, or is not [f 0 c; 0 f c; 0 0 1]");
    auto d = camera.numbers("distortion_coefficients", "Distortion_Coefficients");
    if (!d) return wrong("the file's distortion_coefficients are no list of finite numbers");
    const auto width = camera.number("image_width", "image_Width"),
               height = camera.number("image_height", "image_Height");
    for (const auto& side : {width, height})
        if (!side || !(*side >= 1.0 && *side <= mostScopePixels && *side == std::floor(*side)))
            return wrong("the file's image_width and image_height are not a picture's");
    const auto fisheye = camera.number("fisheye_model", "fisheye_model");
    if (!fisheye && d->size() == 4)
        return wrong(
            "the file has four distortion_coefficients, which may be a fisheye's or a pinhole's: "
            "fisheye_model, 1 or 0, must tell");
    Colonoscope scope = olympusCfQ160l();
    scope.name = "camera from OpenCV";
    scope.lens = {};
    scope.lens.mu = m[0], scope.lens.mv = m[4], scope.lens.u0 = m[2], scope.lens.v0 = m[5];
    if (fisheye && *fisheye != 0.0) {
        if (d->size() != 4)
            return wrong("a fisheye's distortion_coefficients are four, not " +
                         std::to_string(d->size()));
        std::copy(d->begin(), d->end(), scope.lens.k.begin() + 1);
    } else {
        for (std::size_t n = 5; n < d->size(); ++n)
            if ((*d)[n] != 0.0)
                return wrong(
                    "a pinhole camera with more than k1, k2, p1, p2, k3 is not known here");
        d->resize(5, 0.0);
        scope.lens.projection = Projection::perspective;
        scope.lens.k = {1.0, (*d)[0], (*d)[1], (*d)[4], 0.0};
        scope.lens.decentring = {(*d)[2], (*d)[3]};
    }
    if (const auto sound = checkLens(scope.lens); !sound) return wrong(sound.error().message);
    scope.pictureSize = {int(*width), int(*height)};
    const FieldEllipse open = wholePicture(scope.pictureSize);
    scope.openCenter = open.center, scope.openRadii = open.radii;
    scope.fieldDegrees = fieldWithin(scope.lens, open, scope.pictureSize);
    return scope;
} catch (const std::exception&) {
    return fail(ErrorKind::badInput, "the file is neither XML, YAML nor JSON of OpenCV", place);
}

Result<std::string> openCvText(const Colonoscope& scope, const std::string& ending) try {
    const FisheyeLens& lens = scope.lens;
    const double f = lens.k[0];
    const bool fisheye = lens.projection == Projection::equidistance &&
                         lens.decentring == std::array{0.0, 0.0},
               pinhole = lens.projection == Projection::perspective && lens.k[4] == 0.0;
    if (!fisheye && !pinhole)
        return fail(
            ErrorKind::unsupported,
            "OpenCV has no lens of this projection: calibrate with opencv-fisheye or brown");
    const cv::Mat matrix =
        (cv::Mat_<double>(3, 3) << lens.mu * f, 0, lens.u0, 0, lens.mv * f, lens.v0, 0, 0, 1);
    // Scaled so that k₁ is 1; decentring is of the raised direction, as OpenCV's.
    const cv::Mat distortion = fisheye ? (cv::Mat_<double>(4, 1) << lens.k[1] / f, lens.k[2] / f,
                                          lens.k[3] / f, lens.k[4] / f)
                                       : (cv::Mat_<double>(5, 1) << lens.k[1] / f, lens.k[2] / f,
                                          lens.decentring[0], lens.decentring[1], lens.k[3] / f);
    // It writes YAML by any other name.
    if (ending != ".xml" && ending != ".yml" && ending != ".yaml" && ending != ".json")
        return fail(ErrorKind::badInput, "OpenCV's files end in .xml, .yml, .yaml or .json",
                    ending);
    cv::FileStorage storage(ending, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    storage << "image_width" << scope.pictureSize.x << "image_height" << scope.pictureSize.y
            << "fisheye_model" << int(fisheye) << "camera_matrix" << matrix
            << "distortion_coefficients" << distortion;
    return storage.releaseAndGetString();
} catch (const std::exception&) {
    return fail(ErrorKind::unsupported, "OpenCV cannot write this lens");
}

}  // namespace haustra::coverage::module

extern "C" const haustra::coverage::CalibrationLibraries haustraCalibrationLibraries = [] {
    using namespace haustra::coverage;
    cv::setNumThreads(1);  // no threads of its own
    // What it throws is told in one sentence, where it is caught: not on stderr too.
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
    return CalibrationLibraries{&module::findBoard, &module::findField, &module::calibrate,
                                &module::lensOfOpenCvText, &module::openCvText};
}();
