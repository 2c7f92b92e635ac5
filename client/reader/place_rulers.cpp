#include "reader/place_rulers.h"

#include <algorithm>

namespace haustra::reader {
namespace {

// Farther from the wall than this, a place is not drawn on the flattened one.
constexpr double onWallMm = 4.0;
constexpr double leastMm = 0.1;

}  // namespace

void PlaceRulers::reset() {
    rulers_.clear();
    flatless_.clear();
    begun_.reset();
    before_.reset();
    ends_.clear();
    flatOf_ = 0;
}

void PlaceRulers::update() {
    while (!ends_.empty()) {
        if (ends_.front().request != 0) {
            const auto told = wall_.takeTold(ends_.front().request);
            if (!told) break;
            if (*told) add(PlaceRuler::End{(*told)->positionMm, (*told)->flat});
        } else {
            add(ends_.front().known);
        }
        ends_.pop_front();
    }
    if (flatOf_ != 0) {
        const auto told = wall_.takeTold(flatOf_);
        if (!told) return;
        flatOf_ = 0;
        const bool near =
            *told && (*told)->flat && glm::distance((*told)->positionMm, flatOfMm_) <= onWallMm;
        if (near) {
            for (PlaceRuler& ruler : rulers_)
                for (PlaceRuler::End* end : {&ruler.from, &ruler.to})
                    if (end->positionMm == flatOfMm_) end->flat = (*told)->flat;
        } else {
            flatless_.push_back(flatOfMm_);
        }
    }
    if (session_.phase() != Phase::open || !session_.caseInfo()->flat) return;
    if (const PlaceRuler::End* end = withoutFlat()) {
        flatOfMm_ = end->positionMm;
        flatOf_ = wall_.expect(session_.locate(flatOfMm_));
    }
}

PlaceRuler::End* PlaceRulers::withoutFlat() {
    for (PlaceRuler& ruler : rulers_)
        for (PlaceRuler::End* end : {&ruler.from, &ruler.to})
            if (!end->flat &&
                std::find(flatless_.begin(), flatless_.end(), end->positionMm) == flatless_.end())
                return end;
    return nullptr;
}

void PlaceRulers::addEnd(glm::dvec3 placeMm) {
    if (ends_.empty())
        add(PlaceRuler::End{placeMm});
    else
        ends_.push_back({0, PlaceRuler::End{placeMm}});
}
void PlaceRulers::addEnd(glm::dvec2 flat) {
    ends_.push_back({wall_.expect(session_.locate(flat)), {}});
}
void PlaceRulers::addEnd(glm::dvec3 fromMm, glm::dvec3 direction) {
    ends_.push_back({wall_.expect(session_.pick(fromMm, direction)), {}});
}

void PlaceRulers::add(const PlaceRuler::End& end) {
    if (!begun_) {
        begun_ = end;
        return;
    }
    // Two clicks on one place measure nothing: the second end is still to come.
    if (glm::distance(begun_->positionMm, end.positionMm) < leastMm) return;
    add(PlaceRuler{*std::exchange(begun_, std::nullopt), end});
}

void PlaceRulers::add(const PlaceRuler& ruler) {
    if (!before_) before_ = rulers_;  // of several that are told at once, all are one step
    rulers_.push_back(ruler);
}

void PlaceRulers::measure(const ListedFinding& finding) {
    const bool isMeasured =
        std::any_of(rulers_.begin(), rulers_.end(),
                    [&](const PlaceRuler& ruler) { return ruler.isOf(finding); });
    if (isMeasured) return;
    const auto& [from, to] = finding.finding.diameterEndsMm;
    add(PlaceRuler{{from}, {to}, finding.number});
}

void PlaceRulers::set(std::vector<PlaceRuler> rulers) {
    rulers_ = std::move(rulers);
}

void PlaceRulers::giveUp() {
    begun_.reset();
    ends_.clear();
}

}  // namespace haustra::reader
