// What the reader measures in the scan: the value under the mouse, rulers, ellipses.
#pragma once

#include "reader/session.h"

#include <map>
#include <optional>
#include <vector>

namespace haustra::reader {

/// A length, or the values within an ellipse, in a plane of the scan. Patient coordinates.
struct ScanMeasure {
    bool isEllipse = false;
    glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit; of the plane
    /// Of a ruler its ends; of an ellipse the opposite corners of the box around it, of which
    /// `right` is the direction of a side (unit).
    glm::dvec3 fromMm{0.0}, toMm{0.0}, right{1.0, 0.0, 0.0};
    Scan scan = Scan::original;              ///< whose values an ellipse has
    Slab slab{};                             ///< that it was drawn on, and has the values of
    std::optional<ScanStatistics> values{};  ///< of an ellipse, once the server has told them
    bool refused = false;                    ///< it will not

    double lengthMm() const { return glm::distance(fromMm, toMm); }
    glm::dvec3 centerMm() const { return 0.5 * (fromMm + toMm); }
    glm::dvec3 halfAMm() const { return 0.5 * glm::dot(toMm - fromMm, right) * right; }
    glm::dvec3 halfBMm() const { return 0.5 * (toMm - fromMm) - halfAMm(); }
};

/// Of the value under the mouse one question is under way, and the newest place waits. Belongs to
/// the session's thread; the session must outlive it.
class ScanMeasures {
public:
    explicit ScanMeasures(Session& session) : session_(session) {}
    /// Another case is open.
    void reset();
    /// Takes in answers, asks what is due. Call at every step of the loop.
    void update();

    /// The mouse is over this place of the scan; nothing: over none.
    void pointAt(std::optional<glm::dvec3> placeMm, Scan scan);
    struct Pointed {
        glm::dvec3 placeMm;
        Scan scan;
        double hu;
    };
    /// The last place that has an answer, while the mouse is over the scan.
    const std::optional<Pointed>& pointed() const { return pointed_; }

    const std::vector<ScanMeasure>& measures() const { return measures_; }
    void set(std::vector<ScanMeasure> measures);
    /// While a hand draws it, the last of them is replaced.
    void draw(const ScanMeasure& measure, bool begins);
    bool waits() const { return pointAsked_ != 0 || !asked_.empty() || pointDue_; }

private:
    Session& session_;
    std::vector<ScanMeasure> measures_;
    std::map<std::uint64_t, ScanMeasure> asked_;  // ellipses, by request
    std::optional<Pointed> pointed_;
    std::optional<glm::dvec3> pointingAt_;
    glm::dvec3 pointAskedMm_{0.0};
    Scan pointScan_ = Scan::original, askedScan_ = Scan::original;
    std::uint64_t pointAsked_ = 0;
    bool pointDue_ = false;
};

}  // namespace haustra::reader
