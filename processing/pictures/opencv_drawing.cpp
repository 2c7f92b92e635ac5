#include "pictures/image_libraries.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace haustra::pictures::module {

namespace {

cv::Mat pixelsOf(const Image& image) {
    // Read only where `image` is.
    return cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
}

cv::Scalar scalar(glm::u8vec3 color) {
    return {double(color.r), double(color.g), double(color.b)};
}

constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double capitalHeight = 21.0;  // of the font at scale 1, pixels

/// What text of one height is written with.
struct Pen {
    double scale = 1.0;  ///< of the font
    int thickness = 1;   ///< pixels

    explicit Pen(double textHeight)
        : scale(textHeight / capitalHeight),
          thickness(std::max(1, int(std::lround(textHeight / 10.0)))) {}
    double widthOf(const std::string& text) const {
        return cv::getTextSize(text, font, scale, thickness, nullptr).width;
    }
};

void drawMarks(const Marks& marks, cv::Mat& pixels, int firstRow) {
    const Pen pen(marks.textHeight);
    const cv::Scalar dark(0, 0, 0);
    // The rims of all before any of the marks.
    for (const bool rim : {true, false}) {
        const int wide = rim ? pen.thickness + 2 : pen.thickness;
        for (const Marks::Line& line : marks.lines)
            cv::line(pixels, {line.from.x, line.from.y - firstRow},
                     {line.to.x, line.to.y - firstRow}, rim ? dark : scalar(line.color), wide,
                     cv::LINE_8);
        for (const Marks::Words& words : marks.words) {
            const double left = words.at.x - words.anchor.x * pen.widthOf(words.text),
                         base = words.at.y + (1.0 - words.anchor.y) * marks.textHeight - firstRow;
            cv::putText(pixels, words.text, {int(std::lround(left)), int(std::lround(base))}, font,
                        pen.scale, rim ? dark : scalar(words.color), wide, cv::LINE_AA);
        }
    }
}

}  // namespace

Result<Image> sideBySide(const std::vector<Image>& panels) try {
    std::vector<cv::Mat> parts;
    for (const Image& panel : panels) {
        if (!parts.empty())
            parts.emplace_back(panel.height, separatorPixels, CV_8UC3, scalar(separatorColor));
        parts.push_back(pixelsOf(panel));
    }
    cv::Mat joined;
    cv::hconcat(parts, joined);
    return Image{joined.cols, joined.rows, {joined.datastart, joined.dataend}};
} catch (const std::exception&) {
    return fail(ErrorKind::badInput, "the panels are of different heights, or too large");
}

Result<double> textWidth(const std::string& text, double textHeight) try {
    return Pen(textHeight).widthOf(text);
} catch (const std::exception&) {
    return fail(ErrorKind::badInput, "the text cannot be measured");
}

Result<void> draw(const Marks& marks, Image& band, int firstRow) try {
    // A line that is cut at an edge is drawn otherwise than one that is not: the bands' edges are
    // out of reach of what is drawn in the band.
    const int reach = int(4.0 * marks.textHeight) + 8;
    cv::Mat pixels = pixelsOf(band), wide;
    cv::copyMakeBorder(pixels, wide, reach, reach, 0, 0, cv::BORDER_CONSTANT);
    drawMarks(marks, wide, firstRow - reach);
    wide.rowRange(reach, reach + band.height).copyTo(pixels);
    return {};
} catch (const std::exception&) {
    return fail(ErrorKind::badInput, "the picture's marks cannot be drawn");
}

}  // namespace haustra::pictures::module
