#include "cli/froc_picture.h"

#include "pictures/drawing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace haustra::cli {
namespace {

constexpr glm::ivec2 pictureSize{900, 740};
// Of the field between the axes.
constexpr glm::ivec2 upperLeft{90, 60}, lowerRight{870, 560};
constexpr glm::u8vec3 bandColor{120, 150, 200}, gridColor{70, 70, 70}, curveColor{255, 200, 60};

class Axes {
public:
    explicit Axes(const std::vector<cad::FrocPoint>& curve)
        : first_(std::log2(curve.front().falsePositives)),
          last_(std::log2(curve.back().falsePositives)) {
        // From the tenth below all of it.
        for (const cad::FrocPoint& point : curve)
            leastPercent_ = std::min(leastPercent_, 10 * int(std::floor(10.0 * point.low)));
    }

    glm::ivec2 at(double falsePositives, double sensitivity) const {
        const double x = (std::log2(falsePositives) - first_) / std::max(1e-9, last_ - first_),
                     y = (1.0 - sensitivity) / (1.0 - 0.01 * leastPercent_);
        const glm::dvec2 extent(lowerRight - upperLeft);
        return upperLeft + glm::ivec2(glm::dvec2(x, y) * extent + 0.5);
    }
    double first() const { return first_; }
    double last() const { return last_; }
    int leastPercent() const { return leastPercent_; }

private:
    double first_, last_;
    int leastPercent_ = 90;
};

void drawGrid(const Axes& axes, pictures::Marks& marks) {
    for (double n = std::ceil(axes.first()); n <= axes.last(); n += 1.0) {
        const double falsePositives = std::exp2(n);
        const glm::ivec2 low = axes.at(falsePositives, 0.01 * axes.leastPercent());
        marks.lines.push_back({low, axes.at(falsePositives, 1.0), gridColor});
        marks.words.push_back(
            {fmt::format("{:g}", falsePositives), low + glm::ivec2(0, 14), {0.5, 0.0}});
    }
    for (int percent = axes.leastPercent(); percent <= 100; percent += 10) {
        const glm::ivec2 left = axes.at(std::exp2(axes.first()), percent / 100.0);
        marks.lines.push_back({left, {lowerRight.x, left.y}, gridColor});
        marks.words.push_back({fmt::format("{} %", percent), left - glm::ivec2(8, 0), {1.0, 0.5}});
    }
}

}  // namespace

std::string frocCsv(const std::vector<cad::FrocPoint>& curve) {
    std::string csv;
    for (const std::string_view note : frocNotes)
        csv += fmt::format("# {}\n", note);
    csv += "false_positives_per_scan,sensitivity_from_6_mm,low,high,threshold\n";
    for (const cad::FrocPoint& p : curve)
        csv += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{:.6f}\n", p.falsePositives, p.sensitivity,
                           p.low, p.high, p.threshold);
    return csv;
}

Result<Image> frocPicture(const std::vector<cad::FrocPoint>& curve, const std::string& title) {
    Image picture = blankImage(pictureSize);
    if (curve.empty()) return picture;
    pictures::Marks marks;
    marks.textHeight = 11.0;
    const Axes axes(curve);
    drawGrid(axes, marks);
    // The band as uprights, so that the curve and the grid are seen through it.
    for (std::size_t n = 0; n + 1 < curve.size(); ++n) {
        const glm::ivec2 fromLow = axes.at(curve[n].falsePositives, curve[n].low),
                         fromHigh = axes.at(curve[n].falsePositives, curve[n].high),
                         toLow = axes.at(curve[n + 1].falsePositives, curve[n + 1].low),
                         toHigh = axes.at(curve[n + 1].falsePositives, curve[n + 1].high);
        for (int x = fromLow.x; x < toLow.x; x += 4) {
            const double share = double(x - fromLow.x) / std::max(1, toLow.x - fromLow.x);
            marks.lines.push_back({{x, int(glm::mix(double(fromLow.y), double(toLow.y), share))},
                                   {x, int(glm::mix(double(fromHigh.y), double(toHigh.y), share))},
                                   bandColor});
        }
    }
    for (std::size_t n = 0; n + 1 < curve.size(); ++n)
        for (const int thick : {0, 1})
            marks.lines.push_back(
                {axes.at(curve[n].falsePositives, curve[n].sensitivity) + glm::ivec2(0, thick),
                 axes.at(curve[n + 1].falsePositives, curve[n + 1].sensitivity) +
                     glm::ivec2(0, thick),
                 curveColor});
    marks.words.push_back({title, {upperLeft.x, 14}, {0.0, 0.0}});
    marks.words.push_back({"sensitivity, polyps from 6 mm; band: 95 % by bootstrap over scans",
                           {upperLeft.x, 36},
                           {0.0, 0.0}});
    marks.words.push_back(
        {"false positives a scan", {lowerRight.x, lowerRight.y + 34}, {1.0, 0.0}});
    int below = lowerRight.y + 64;
    for (const std::string_view note : frocNotes) {
        marks.words.push_back({std::string(note), {18, below}, {0.0, 0.0}});
        below += 22;
    }
    TRY(pictures::draw(marks, picture));
    return picture;
}

}  // namespace haustra::cli
