#include "core/optics.h"

#include <algorithm>
#include <cmath>

namespace haustra {

namespace {

using Points = std::vector<TransferFunctionPoint>;

constexpr double steepestHuPerMm = 65536.0, leastSpanHu = 1.0 / 16.0, leastRowHuPerMm = 1e-3;

tl::unexpected<Error> refuse(const std::string& what) {
    return fail(ErrorKind::badInput, what, "transfer function");
}

bool isColor(glm::dvec3 color) {
    // Written so that what is not a number is no colour.
    return glm::all(glm::greaterThanEqual(color, glm::dvec3(0.0))) &&
           glm::all(glm::lessThanEqual(color, glm::dvec3(1.0)));
}

/// `row` is empty, or says which row's points these are.
Result<void> checkPoints(const Points& points, const std::string& row) {
    if (points.size() < 2 || points.size() > mostTransferPoints)
        return refuse(row + std::to_string(points.size()) + " points, where 2 to 256 are needed");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const TransferFunctionPoint& point = points[i];
        const std::string at = row + "point " + std::to_string(i + 1);
        if (!(point.hu >= lowestTransferHu && point.hu <= highestTransferHu))
            return refuse(at + " has HU outside -32768 to 32767");
        if (!(point.opacity >= 0.0 && point.opacity <= 1.0))
            return refuse(at + " has an opacity outside 0 to 1");
        if (!isColor(point.color)) return refuse(at + " has a colour outside 0 to 1");
        if (i > 0 && point.hu < points[i - 1].hu)
            return refuse(at + " has a lower HU than the point before");
    }
    if (!(points.back().hu > points.front().hu)) return refuse(row + "all points have the same HU");
    if (!(points.back().hu - points.front().hu >= leastSpanHu))
        return refuse(row + "the points span less than 1/16 HU");
    return {};
}

Result<void> checkLight(const Headlight& light) {
    const auto within = [](double value, double least, double most) {
        return value >= least && value <= most;
    };
    const auto bad = [](const char* what) { return fail(ErrorKind::badInput, what, "light"); };
    if (!within(light.halfDepthMm, 0.01, 1e9))
        return bad("the half depth is not within 0.01 to 1000000000 mm");
    if (!within(light.ambient, 0.0, 10.0) || !within(light.diffuse, 0.0, 10.0) ||
        !within(light.specular, 0.0, 10.0))
        return bad("the ambient, diffuse or specular share is not within 0 to 10");
    if (!within(light.shininess, 1.0, 1000.0)) return bad("the shininess is not within 1 to 1000");
    return {};
}

}  // namespace

TransferFunctionPoint pointAt(const Points& points, double hu) {
    const auto above = std::upper_bound(
        points.begin(), points.end(), hu,
        [](double value, const TransferFunctionPoint& point) { return value < point.hu; });
    if (above == points.begin()) return points.front();
    if (above == points.end()) return points.back();
    const TransferFunctionPoint &a = above[-1], &b = above[0];
    const double share = (hu - a.hu) / (b.hu - a.hu);
    return {hu, glm::mix(a.color, b.color, share), glm::mix(a.opacity, b.opacity, share)};
}

Result<void> checkTransferFunction(const TransferFunction& transferFunction) {
    TRY(checkPoints(transferFunction.points, ""));
    if (transferFunction.rows.size() > mostGradientRows)
        return refuse(std::to_string(transferFunction.rows.size()) +
                      " rows, where at most 64 are allowed");
    std::size_t points = transferFunction.points.size();
    double before = 0.0;
    for (std::size_t i = 0; i < transferFunction.rows.size(); ++i) {
        const GradientRow& row = transferFunction.rows[i];
        const std::string at = "row " + std::to_string(i + 1);
        if (!(row.gradientHuPerMm >= before + leastRowHuPerMm &&
              row.gradientHuPerMm <= steepestHuPerMm))
            return refuse(at +
                          " has a gradient magnitude not 0.001 over the row before's, or over "
                          "65536");
        before = row.gradientHuPerMm;
        TRY(checkPoints(row.points, at + ": "));
        points += row.points.size();
    }
    if (points > mostTransferPointsInAll)
        return refuse(std::to_string(points) +
                      " points in all rows together, where at most 1024 are allowed");
    return {};
}

Result<void> checkOptics(const Optics& optics) {
    TRY(checkTransferFunction(optics.transferFunction));
    if (optics.preIntegrated && !optics.transferFunction.rows.empty())
        return refuse("a transfer function with gradient rows cannot be pre-integrated");
    return checkLight(optics.light);
}

}  // namespace haustra
