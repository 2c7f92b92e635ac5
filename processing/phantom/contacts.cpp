#include "phantom/contacts.h"

#include "phantom/colon_skeleton.h"
#include "phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace haustra::phantom {
namespace {

constexpr double kBinMm = 15.0;
constexpr double kLeastAreaMm2 = 10.0;

}  // namespace

void ContactFinder::look(const Volume<std::uint8_t>& lumen, const Volume<std::uint8_t>& sites,
                         const ColonField& field, int fieldOffset, const Ileum* ileum, int begin,
                         int end, int threads) {
    const Grid& grid = lumen.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    constexpr auto inIleum = std::uint8_t(Site::ileum);
    const auto isLumen = [&](std::size_t v) { return lumen[v] || sites[v] == inIleum; };
    std::vector<std::vector<Touch>> bySlice(std::size_t(end - begin));
    parallelFor(bySlice.size(), 1, threads, [&](std::size_t from, std::size_t to) {
        for (std::size_t n = from; n < to; ++n) {
            const int k = begin + int(n);
            for (int j = 0; j < grid.size.y; ++j) {
                for (int i = 0; i < grid.size.x; ++i) {
                    const glm::ivec3 v(i, j, k);
                    const std::size_t at = grid.index(v);
                    if (!isLumen(at)) continue;
                    for (int axis = 0; axis < 3; ++axis) {
                        glm::ivec3 w = v;
                        if (++w[axis] >= grid.size[axis] || isLumen(grid.index(w))) {
                            // Side by side, they join or are two lumens a film apart.
                            if (w[axis] >= grid.size[axis]) continue;
                            if (!lumen[at] == !lumen[grid.index(w)]) continue;
                        }
                        while (w[axis] < grid.size[axis] && !isLumen(grid.index(w)) &&
                               (w[axis] - v[axis]) * spacing[axis] <= kContactMm)
                            ++w[axis];
                        if (w[axis] >= grid.size[axis] || !isLumen(grid.index(w))) continue;
                        const bool here = lumen[at], there = lumen[grid.index(w)];
                        if (!here && !there) continue;
                        glm::ivec3 a = v, b = w;
                        if (!here) std::swap(a, b);  // a is colon
                        const auto& sa = field.at(a.x, a.y, a.z + fieldOffset);
                        const glm::dvec3 pa = grid.patientFromVoxelPoint(a),
                                         pb = grid.patientFromVoxelPoint(b);
                        Touch touch;
                        touch.arcMm = sa.arcMm;
                        touch.ileum = here != there;
                        double depth = -sa.lumenMm;
                        if (touch.ileum) {
                            // Colon and ileum do join at an open valve.
                            if (glm::distance(pa, ileum->valve().at) < 20.0) continue;
                            touch.otherArcMm = float(ileum->tube().at(pb).arcMm);
                            depth -=
                                ileum->lumenMm(pb, field.at(b.x, b.y, b.z + fieldOffset).lumenMm);
                        } else {
                            const auto& sb = field.at(b.x, b.y, b.z + fieldOffset);
                            const auto& path = shape_.path();
                            if (std::abs(sa.arcMm - sb.arcMm) <
                                2.0 * loopSeparationMm(path.at(sa.arcMm).radiusMm,
                                                       path.at(sb.arcMm).radiusMm))
                                continue;
                            touch.otherArcMm = sb.arcMm;
                            depth -= sb.lumenMm;
                            if (touch.arcMm > touch.otherArcMm)
                                std::swap(touch.arcMm, touch.otherArcMm);
                        }
                        const double apart = std::max(0.0, glm::distance(pa, pb) - depth);
                        if (apart >= kContactMm) continue;
                        touch.apartMm = float(apart);
                        // Each axis sees its share of an oblique face.
                        touch.areaMm2 = float(grid.voxelVolumeMm3() / spacing[axis] / 1.5);
                        touch.at = glm::vec3(0.5 * (pa + pb));
                        bySlice[n].push_back(touch);
                    }
                }
            }
        }
    });
    for (const auto& slice : bySlice)
        touches_.insert(touches_.end(), slice.begin(), slice.end());
}

std::vector<Structure::Contact> ContactFinder::contacts() const {
    // Bins of the two arcs; neighbouring bins are one contact.
    using Bin = std::tuple<bool, int, int>;
    std::map<Bin, std::vector<const Touch*>> bins;
    for (const Touch& touch : touches_) {
        bins[{touch.ileum, int(touch.arcMm / kBinMm), int(touch.otherArcMm / kBinMm)}].push_back(
            &touch);
    }
    std::vector<Structure::Contact> contacts;
    std::map<Bin, bool> taken;
    for (const auto& [first, unused] : bins) {
        if (taken[first]) continue;
        std::vector<Bin> open = {first};
        taken[first] = true;
        Structure::Contact contact;
        contact.ileum = std::get<0>(first);
        contact.leastMm = kContactMm;
        double arc = 0.0, other = 0.0;
        glm::dvec3 at(0.0);
        while (!open.empty()) {
            const auto [ileum, a, b] = open.back();
            open.pop_back();
            for (const Touch* touch : bins.at({ileum, a, b})) {
                contact.areaMm2 += touch->areaMm2;
                contact.leastMm = std::min(contact.leastMm, double(touch->apartMm));
                arc += touch->areaMm2 * touch->arcMm, other += touch->areaMm2 * touch->otherArcMm;
                at += double(touch->areaMm2) * glm::dvec3(touch->at);
            }
            for (int n = 0; n < 9; ++n) {
                const Bin beside{ileum, a + n % 3 - 1, b + n / 3 - 1};
                if (!bins.contains(beside) || taken[beside]) continue;
                taken[beside] = true;
                open.push_back(beside);
            }
        }
        if (contact.areaMm2 < kLeastAreaMm2) continue;
        contact.arcMm = arc / contact.areaMm2, contact.otherArcMm = other / contact.areaMm2;
        contact.positionMm = at / contact.areaMm2;
        contacts.push_back(contact);
    }
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const auto& a, const auto& b) { return a.areaMm2 > b.areaMm2; });
    return contacts;
}

}  // namespace haustra::phantom
