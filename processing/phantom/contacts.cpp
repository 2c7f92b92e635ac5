#include "phantom/contacts.h"

#include "core/voxel_sweep.h"
#include "phantom/colon_skeleton.h"
#include "phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace haustra::phantom {
namespace {

constexpr double binMm = 15.0;
constexpr double leastAreaMm2 = 10.0;

/// The lumens of the colon and of the ileum in some slices.
struct Lumens {
    const Volume<std::uint8_t>&colon, &sites;

    bool isColon(glm::ivec3 v) const { return colon.at(v) != 0; }
    bool isLumen(glm::ivec3 v) const {
        return colon.at(v) != 0 || sites.at(v) == std::uint8_t(Site::ileum);
    }
    /// The first voxel of another lumen that one meets from `v` on along an axis, up to contactMm
    /// away: beyond a wall; or right beside `v`, where one of the two is colon and the other ileum.
    std::optional<glm::ivec3> facing(glm::ivec3 v, int axis) const {
        const Grid& grid = colon.grid();
        const double spacingMm = grid.spacingMm()[axis];
        glm::ivec3 w = v;
        if (++w[axis] >= grid.size[axis]) return std::nullopt;
        // Two voxels of the same organ side by side are one lumen.
        if (isLumen(w) && isColon(v) == isColon(w)) return std::nullopt;
        while (w[axis] < grid.size[axis] && !isLumen(w) &&
               (w[axis] - v[axis]) * spacingMm <= contactMm)
            ++w[axis];
        if (w[axis] >= grid.size[axis] || !isLumen(w)) return std::nullopt;
        return w;
    }
};

}  // namespace

void ContactFinder::look(const Volume<std::uint8_t>& lumen, const Volume<std::uint8_t>& sites,
                         const ColonField& field, int fieldOffset, const Ileum* ileum, int begin,
                         int end, int threads) {
    const Grid& grid = lumen.grid();
    const Lumens lumens{lumen, sites};
    std::vector<std::vector<Touch>> bySlice(std::size_t(end - begin));
    const auto lookFrom = [&](glm::ivec3 v) {
        if (!lumens.isLumen(v)) return;
        for (int axis = 0; axis < 3; ++axis) {
            const auto other = lumens.facing(v, axis);
            if (!other || (!lumens.isColon(v) && !lumens.isColon(*other))) continue;
            glm::ivec3 a = v, b = *other;
            if (!lumens.isColon(a)) std::swap(a, b);
            auto touch = lumens.isColon(b) ? touchOfLoops(a, b, grid, field, fieldOffset)
                                           : touchOfIleum(a, b, grid, field, fieldOffset, *ileum);
            if (!touch) continue;
            // Each axis sees its share of an oblique face.
            touch->areaMm2 = float(grid.voxelVolumeMm3() / grid.spacingMm()[axis] / 1.5);
            bySlice[std::size_t(v.z - begin)].push_back(*touch);
        }
    };
    parallelFor(bySlice.size(), 1, threads, [&](std::size_t from, std::size_t to) {
        visitBox({0, 0, begin + int(from)}, {grid.size.x - 1, grid.size.y - 1, begin + int(to) - 1},
                 lookFrom);
    });
    for (const auto& slice : bySlice)
        touches_.insert(touches_.end(), slice.begin(), slice.end());
}

std::optional<ContactFinder::Touch> ContactFinder::touchAt(glm::dvec3 a, glm::dvec3 b,
                                                           double depthMm) {
    const double apart = std::max(0.0, glm::distance(a, b) - depthMm);
    if (apart >= contactMm) return std::nullopt;
    Touch touch;
    touch.apartMm = float(apart);
    touch.at = glm::vec3(0.5 * (a + b));
    return touch;
}

std::optional<ContactFinder::Touch> ContactFinder::touchOfLoops(glm::ivec3 a, glm::ivec3 b,
                                                                const Grid& grid,
                                                                const ColonField& field,
                                                                int fieldOffset) const {
    const auto& sa = field.at(a.x, a.y, a.z + fieldOffset);
    const auto& sb = field.at(b.x, b.y, b.z + fieldOffset);
    const auto& path = shape_.path();
    if (std::abs(sa.arcMm - sb.arcMm) <
        2.0 * loopSeparationMm(path.at(sa.arcMm).radiusMm, path.at(sb.arcMm).radiusMm))
        return std::nullopt;
    double depthMm = -sa.lumenMm;
    depthMm -= sb.lumenMm;
    auto touch = touchAt(grid.patientFromVoxelPoint(a), grid.patientFromVoxelPoint(b), depthMm);
    if (touch) std::tie(touch->arcMm, touch->otherArcMm) = std::minmax(sa.arcMm, sb.arcMm);
    return touch;
}

std::optional<ContactFinder::Touch> ContactFinder::touchOfIleum(glm::ivec3 a, glm::ivec3 b,
                                                                const Grid& grid,
                                                                const ColonField& field,
                                                                int fieldOffset,
                                                                const Ileum& ileum) const {
    const glm::dvec3 pa = grid.patientFromVoxelPoint(a), pb = grid.patientFromVoxelPoint(b);
    // Colon and ileum do join at an open valve.
    if (glm::distance(pa, ileum.valve().at) < 20.0) return std::nullopt;
    const auto& sa = field.at(a.x, a.y, a.z + fieldOffset);
    double depthMm = -sa.lumenMm;
    depthMm -= ileum.lumenMm(pb, field.at(b.x, b.y, b.z + fieldOffset).lumenMm);
    auto touch = touchAt(pa, pb, depthMm);
    if (touch) {
        touch->ileum = true;
        touch->arcMm = sa.arcMm;
        touch->otherArcMm = float(ileum.tube().at(pb).arcMm);
    }
    return touch;
}

std::vector<Structure::Contact> ContactFinder::contacts() const {
    // Bins of the two arcs; neighbouring bins are one contact.
    using Bin = std::tuple<bool, int, int>;
    std::map<Bin, std::vector<const Touch*>> bins;
    for (const Touch& touch : touches_) {
        bins[{touch.ileum, int(touch.arcMm / binMm), int(touch.otherArcMm / binMm)}].push_back(
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
        contact.leastMm = contactMm;
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
        if (contact.areaMm2 < leastAreaMm2) continue;
        contact.arcMm = arc / contact.areaMm2, contact.otherArcMm = other / contact.areaMm2;
        contact.positionMm = at / contact.areaMm2;
        contacts.push_back(contact);
    }
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const auto& a, const auto& b) { return a.areaMm2 > b.areaMm2; });
    return contacts;
}

}  // namespace haustra::phantom
