#include "reader/scan_measures.h"

#include "protocol/capabilities.h"

#include <algorithm>

namespace haustra::reader {
namespace {

bool sameEllipse(const ScanMeasure& a, const ScanMeasure& b) {
    return a.isEllipse && b.isEllipse && a.fromMm == b.fromMm && a.toMm == b.toMm &&
           a.right == b.right && a.normal == b.normal && a.scan == b.scan && a.slab == b.slab;
}

}  // namespace

void ScanMeasures::reset() {
    measures_.clear();
    asked_.clear();
    pointed_.reset();
    pointingAt_.reset();
    pointAsked_ = 0;
    pointDue_ = false;
}

void ScanMeasures::update() {
    for (const Session::ScanAnswer& answer : session_.takeScanAnswers()) {
        const ScanStatistics* values = answer.values ? &*answer.values : nullptr;
        if (answer.request == pointAsked_) {
            pointAsked_ = 0;
            pointed_.reset();
            if (values && values->samples > 0 && pointingAt_)
                pointed_ = Pointed{pointAskedMm_, askedScan_, values->meanHu};
        } else if (const auto asked = asked_.find(answer.request); asked != asked_.end()) {
            for (ScanMeasure& measure : measures_)
                if (sameEllipse(measure, asked->second)) {
                    if (values) measure.values = *values;
                    measure.refused = !values;
                }
            asked_.erase(asked);
        }
    }
    if (session_.phase() != Phase::open || !session_.serverCan(protocol::capability::scanValues))
        return;
    if (pointDue_ && pointAsked_ == 0) {
        pointDue_ = false;
        pointAskedMm_ = *pointingAt_;
        askedScan_ = pointScan_;
        ScanRegion region;
        region.centerMm = pointAskedMm_;
        region.scan = pointScan_;
        pointAsked_ = session_.measureScan(region);
    }
    // One ellipse at a time: while it is drawn there is a new one with every movement.
    if (!asked_.empty()) return;
    for (const ScanMeasure& measure : measures_) {
        if (!measure.isEllipse || measure.values || measure.refused) continue;
        ScanRegion region;
        region.centerMm = measure.centerMm();
        region.halfAMm = measure.halfAMm();
        region.halfBMm = measure.halfBMm();
        region.scan = measure.scan;
        region.slab = measure.slab;
        constexpr double leastMm = 0.05;
        if (glm::length(region.halfAMm) < leastMm || glm::length(region.halfBMm) < leastMm)
            continue;
        asked_.emplace(session_.measureScan(region), measure);
        return;
    }
}

void ScanMeasures::pointAt(std::optional<glm::dvec3> placeMm, Scan scan) {
    if (placeMm == pointingAt_ && scan == pointScan_) return;
    pointingAt_ = placeMm;
    pointScan_ = scan;
    pointDue_ = placeMm.has_value();
    if (!placeMm) pointed_.reset();
}

void ScanMeasures::set(std::vector<ScanMeasure> measures) {
    measures_ = std::move(measures);
}

void ScanMeasures::draw(const ScanMeasure& measure, bool begins) {
    if (begins || measures_.empty())
        measures_.push_back(measure);
    else
        measures_.back() = measure;
}

}  // namespace haustra::reader
